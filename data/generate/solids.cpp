#include "solids.hpp"

#include <algorithm>
#include <cmath>

namespace generate {
namespace {

// Grid lines along one axis of a rounded box: close together on the rounded ends.
std::vector<double> box_lines(double half, double radius, double edge) {
  std::vector<double> lines;
  const int bend = radius > 0.0 ? steps(1.2 * radius, edge) : 0;
  for (int i = 0; i < bend; ++i) {
    // Equal angles on the rounding, by the half-angle's sine.
    const double a = 0.125 * (1.0 - static_cast<double>(i) / bend);
    const Vec2 turn = unit_circle(a);
    lines.push_back(-half + radius - radius * turn.y() / turn.x());
  }
  const double flat = half - radius;
  const int cells = steps(2.0 * flat, edge);
  for (int i = 0; i <= cells; ++i) lines.push_back(-flat + 2.0 * flat * i / cells);
  for (int i = bend - 1; i >= 0; --i) lines.push_back(-lines[static_cast<std::size_t>(i)]);
  return lines;
}

void add_quad(Mesh* mesh, int a, int b, int c, int d) {
  const auto p = [&](int i) { return mesh->vertices[static_cast<std::size_t>(i)]; };
  const auto add = [&](int i, int j, int k) {
    if ((p(j) - p(i)).cross(p(k) - p(i)).squaredNorm() > 1e-18) {
      mesh->triangles.push_back({i, j, k});
    }
  };
  if ((p(a) - p(c)).squaredNorm() <= (p(b) - p(d)).squaredNorm() + 1e-12) {
    add(a, b, c);
    add(a, c, d);
  } else {
    add(b, c, d);
    add(b, d, a);
  }
}

}  // namespace

Mesh sheet(const std::vector<std::vector<Vec3>>& places) {
  Mesh mesh;
  const int columns = static_cast<int>(places.front().size());
  for (const std::vector<Vec3>& row : places) {
    mesh.vertices.insert(mesh.vertices.end(), row.begin(), row.end());
  }
  for (int r = 0; r + 1 < static_cast<int>(places.size()); ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      const int i = r * columns + c;
      add_quad(&mesh, i, i + 1, i + columns + 1, i + columns);
    }
  }
  return mesh;
}

Mesh box(const Vec3& center, const Vec3& half, double radius, double edge) {
  // A rounding much finer than the grid would only make slivers.
  radius = radius < 0.25 * edge ? 0.0 : std::min(radius, 0.999 * half.minCoeff());
  std::array<std::vector<double>, 3> lines;
  for (int axis = 0; axis < 3; ++axis) {
    lines[static_cast<std::size_t>(axis)] = box_lines(half[axis], radius, edge);
  }
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      std::vector<std::vector<Vec3>> places;
      for (const double lv : lines[static_cast<std::size_t>(v)]) {
        std::vector<Vec3> row;
        for (const double lu : lines[static_cast<std::size_t>(u)]) {
          Vec3 p;
          p[axis] = side * half[axis];
          p[u] = lu * side;
          p[v] = lv;
          const Vec3 flat = half - Vec3::Constant(radius);
          const Vec3 core = p.cwiseMax(-flat).cwiseMin(flat);
          const Vec3 out = p - core;
          if (radius > 0.0) p = core + radius / out.norm() * out;
          row.push_back(center + p);
        }
        places.push_back(row);
      }
      mesh.append(sheet(places));
    }
  }
  return mesh;
}

Mesh turned(const std::vector<Vec2>& profile, const Vec3& center, double edge, int least_sides) {
  double widest = 0.0;
  for (const Vec2& p : profile) widest = std::max(widest, p.x());
  // A multiple of four, so that the lowest and highest places are met exactly.
  const int sides = 4 * ((steps(6.2832 * widest, edge, least_sides) + 2) / 4);
  std::vector<Vec2> fine;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const int n = steps((profile[i + 1] - profile[i]).norm(), edge);
    for (int k = 0; k < n; ++k) {
      fine.push_back(profile[i] + static_cast<double>(k) / n * (profile[i + 1] - profile[i]));
    }
  }
  fine.push_back(profile.back());
  std::vector<std::vector<Vec3>> places;
  for (const Vec2& p : fine) {
    std::vector<Vec3> row;
    for (int s = 0; s <= sides; ++s) {
      const Vec2 turn = unit_circle(static_cast<double>(s % sides) / sides);
      row.push_back(center + Vec3(p.x() * turn.x(), p.y(), -p.x() * turn.y()));
    }
    places.push_back(row);
  }
  return sheet(places);
}

Mesh bar(const Vec3& a, const Vec3& b, double ra, double rb, double edge, int least_sides) {
  const double length = (b - a).norm();
  Mesh mesh = turned({{0, 0}, {ra, 0}, {rb, length}, {0, length}}, Vec3::Zero(), edge, least_sides);
  const Vec3 along = (b - a) / length;
  const Vec3 helper = std::abs(along.z()) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 u = along.cross(helper).normalized();
  const Vec3 w = u.cross(along);
  for (Vec3& p : mesh.vertices) {
    const Vec3 local = p;
    p = a + local.x() * u + local.y() * along + local.z() * w;
  }
  return mesh;
}

Mesh prism(const std::vector<Vec2>& corners, double x0, double x1, double edge) {
  std::vector<Vec2> ring;
  Vec2 middle = Vec2::Zero();
  double spread = 0.0;
  for (const Vec2& corner : corners) middle += corner / static_cast<double>(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2& a = corners[i];
    const Vec2& b = corners[(i + 1) % corners.size()];
    const int n = steps((b - a).norm(), edge);
    for (int k = 0; k < n; ++k) ring.push_back(a + static_cast<double>(k) / n * (b - a));
    spread = std::max(spread, (a - middle).norm());
  }
  ring.push_back(ring.front());
  const auto row = [&](double x, double scale) {
    std::vector<Vec3> places;
    for (const Vec2& p : ring) {
      const Vec2 q = middle + scale * (p - middle);
      places.emplace_back(x, q.x(), q.y());
    }
    return places;
  };
  std::vector<std::vector<Vec3>> places;
  const int rings = steps(0.7 * spread, edge);
  const int along = steps(x1 - x0, edge);
  for (int k = 0; k < rings; ++k) places.push_back(row(x0, static_cast<double>(k) / rings));
  for (int i = 0; i <= along; ++i) places.push_back(row(x0 + (x1 - x0) * i / along, 1.0));
  for (int k = rings - 1; k >= 0; --k) places.push_back(row(x1, static_cast<double>(k) / rings));
  return sheet(places);
}

}  // namespace generate
