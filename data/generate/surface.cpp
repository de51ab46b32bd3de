#include "surface.hpp"

#include <cstdint>
#include <unordered_map>

namespace generate {
namespace {

constexpr int block_cells = 8;
constexpr int block_nodes = block_cells + 1;

struct Grid {
  Vec3 origin;
  double edge = 0.0;
  std::array<int, 3> blocks{};

  Vec3 node(int x, int y, int z) const { return origin + edge * Vec3(x, y, z); }
  std::int64_t key(int x, int y, int z) const {
    const std::int64_t nx = std::int64_t{blocks[0]} * block_cells;
    const std::int64_t ny = std::int64_t{blocks[1]} * block_cells;
    return x + nx * (y + ny * std::int64_t{z});
  }
};

Grid make_grid(const Vec3& low, const Vec3& high, double edge) {
  Grid grid;
  grid.edge = edge;
  for (int axis = 0; axis < 3; ++axis) {
    const double shift = axis == 1 ? 0.5 : 0.0;
    const double first = std::floor(low[axis] / edge - shift) - 1.0;
    grid.origin[axis] = (first + shift) * edge;
    const double cells = (high[axis] - grid.origin[axis]) / edge + 1.0;
    grid.blocks[static_cast<std::size_t>(axis)] =
        static_cast<int>(std::floor(cells / block_cells)) + 1;
  }
  return grid;
}

using Values = std::array<double, block_nodes * block_nodes * block_nodes>;

std::size_t at(int x, int y, int z) {
  return static_cast<std::size_t>(x + block_nodes * (y + block_nodes * z));
}

// One vertex a crossed cell, at the mean of the crossings of its edges.
bool cell_vertex(const Values& values, int x, int y, int z, Vec3* place) {
  static constexpr int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                       {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  static constexpr int edges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                       {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  double v[8];
  for (int i = 0; i < 8; ++i) {
    v[i] = values[at(x + corner[i][0], y + corner[i][1], z + corner[i][2])];
  }
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const auto& e : edges) {
    const double a = v[e[0]];
    const double b = v[e[1]];
    if ((a < 0.0) == (b < 0.0)) continue;
    const double t = a / (a - b);
    const Vec3 from(corner[e[0]][0], corner[e[0]][1], corner[e[0]][2]);
    const Vec3 to(corner[e[1]][0], corner[e[1]][1], corner[e[1]][2]);
    sum += from + t * (to - from);
    ++count;
  }
  if (count == 0) return false;
  *place = sum / count;
  return true;
}

struct Quads {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 4>> faces;
};

Quads find_quads(const Field& field, const Grid& grid) {
  struct Crossing {
    std::array<int, 3> node;
    int axis;
    bool inside_first;
  };
  Quads quads;
  std::unordered_map<std::int64_t, int> vertex_of_cell;
  std::vector<Crossing> crossings;
  Values values{};
  const double reach = 0.8661 * block_cells * grid.edge * 1.8;
  for (int bz = 0; bz < grid.blocks[2]; ++bz) {
    for (int by = 0; by < grid.blocks[1]; ++by) {
      for (int bx = 0; bx < grid.blocks[0]; ++bx) {
        const int x0 = bx * block_cells;
        const int y0 = by * block_cells;
        const int z0 = bz * block_cells;
        const Vec3 middle = grid.node(x0, y0, z0) + Vec3::Constant(0.5 * block_cells * grid.edge);
        if (std::abs(field(middle)) > reach) continue;
        for (int z = 0; z < block_nodes; ++z) {
          for (int y = 0; y < block_nodes; ++y) {
            for (int x = 0; x < block_nodes; ++x) {
              const double value = field(grid.node(x0 + x, y0 + y, z0 + z));
              // A node all but on the surface counts as inside: no hair-thin bridges.
              values[at(x, y, z)] = std::abs(value) < 0.06 * grid.edge ? -0.06 * grid.edge : value;
            }
          }
        }
        for (int z = 0; z < block_cells; ++z) {
          for (int y = 0; y < block_cells; ++y) {
            for (int x = 0; x < block_cells; ++x) {
              Vec3 place;
              if (cell_vertex(values, x, y, z, &place)) {
                const int index = static_cast<int>(quads.vertices.size());
                vertex_of_cell.emplace(grid.key(x0 + x, y0 + y, z0 + z), index);
                quads.vertices.push_back(grid.node(x0 + x, y0 + y, z0 + z) + grid.edge * place);
              }
              const bool here = values[at(x, y, z)] < 0.0;
              const std::array<double, 3> next = {values[at(x + 1, y, z)], values[at(x, y + 1, z)],
                                                  values[at(x, y, z + 1)]};
              for (int axis = 0; axis < 3; ++axis) {
                const bool there = next[static_cast<std::size_t>(axis)] < 0.0;
                if (here != there) crossings.push_back({{x0 + x, y0 + y, z0 + z}, axis, here});
              }
            }
          }
        }
      }
    }
  }
  for (const Crossing& c : crossings) {
    const int u = (c.axis + 1) % 3;
    const int v = (c.axis + 2) % 3;
    std::array<int, 4> face{};
    static constexpr int around[4][2] = {{-1, -1}, {0, -1}, {0, 0}, {-1, 0}};
    bool whole = true;
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<int, 3> cell = c.node;
      cell[static_cast<std::size_t>(u)] += around[k][0];
      cell[static_cast<std::size_t>(v)] += around[k][1];
      const auto found = vertex_of_cell.find(grid.key(cell[0], cell[1], cell[2]));
      whole = whole && found != vertex_of_cell.end();
      face[k] = whole ? found->second : -1;
    }
    if (!whole) continue;
    if (!c.inside_first) std::swap(face[1], face[3]);
    quads.faces.push_back(face);
  }
  return quads;
}

// Moves every vertex towards the middle of its neighbours, along the surface.
void even_out(const Field& field, Quads* quads, int rounds) {
  for (Vec3& vertex : quads->vertices) vertex = onto_surface(field, vertex, 2);
  std::vector<Vec3> sum(quads->vertices.size());
  std::vector<int> count(quads->vertices.size());
  for (int round = 0; round < rounds; ++round) {
    std::fill(sum.begin(), sum.end(), Vec3::Zero());
    std::fill(count.begin(), count.end(), 0);
    for (const std::array<int, 4>& face : quads->faces) {
      for (std::size_t k = 0; k < 4; ++k) {
        const auto a = static_cast<std::size_t>(face[k]);
        const auto b = static_cast<std::size_t>(face[(k + 1) % 4]);
        sum[a] += quads->vertices[b];
        ++count[a];
        sum[b] += quads->vertices[a];
        ++count[b];
      }
    }
    for (std::size_t i = 0; i < quads->vertices.size(); ++i) {
      if (count[i] == 0) continue;
      Vec3& vertex = quads->vertices[i];
      const Vec3 normal = slope(field, vertex).normalized();
      Vec3 step = 0.6 * (sum[i] / count[i] - vertex);
      step -= step.dot(normal) * normal;
      vertex = onto_surface(field, vertex + step, 1);
    }
  }
}

}  // namespace

Vec3 slope(const Field& field, const Vec3& p) {
  constexpr double d = 1e-4;
  return Vec3(field(p + Vec3(d, 0, 0)) - field(p - Vec3(d, 0, 0)),
              field(p + Vec3(0, d, 0)) - field(p - Vec3(0, d, 0)),
              field(p + Vec3(0, 0, d)) - field(p - Vec3(0, 0, d))) /
         (2.0 * d);
}

Vec3 onto_surface(const Field& field, Vec3 p, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const Vec3 g = slope(field, p);
    const double size = g.squaredNorm();
    if (size < 0.04) break;
    p -= field(p) / size * g;
  }
  return p;
}

Mesh extract_surface(const Field& field, const Vec3& low, const Vec3& high, double edge) {
  Quads quads = find_quads(field, make_grid(low, high, edge));
  even_out(field, &quads, 4);
  Mesh mesh;
  mesh.vertices = std::move(quads.vertices);
  for (const std::array<int, 4>& f : quads.faces) {
    const auto& p = mesh.vertices;
    const auto place = [&](std::size_t k) { return p[static_cast<std::size_t>(f[k])]; };
    if ((place(0) - place(2)).squaredNorm() <= (place(1) - place(3)).squaredNorm()) {
      mesh.triangles.push_back({f[0], f[1], f[2]});
      mesh.triangles.push_back({f[0], f[2], f[3]});
    } else {
      mesh.triangles.push_back({f[1], f[2], f[3]});
      mesh.triangles.push_back({f[1], f[3], f[0]});
    }
  }
  return mesh;
}

}  // namespace generate
