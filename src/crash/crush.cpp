#include "crashrank/crash/crush.hpp"

#include "crash/look.hpp"
#include "crash/material.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace crashrank {
namespace {

using detail::Material;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// A cell in which both bodies are seen, and how far they are pressed into each other there.
struct Cell {
  std::size_t index = 0;
  double gap = 0.0;
  double pressure = 0.0;
  double depth_a = 0.0;
  double depth_b = 0.0;
  double energy_a = 0.0;  ///< J/m²
  double energy_b = 0.0;
};

class Press {
public:
  Press(const PulseBody& a, const PulseBody& b, const ViewFrame& frame, const DepthMap& map_a,
        const DepthMap& map_b)
      : map_a_(map_a), map_b_(map_b), a_(a, frame), b_(b, frame) {
    for (std::size_t i = 0; i < map_a.grid.size(); ++i) {
      if (!map_a.covered(i) || !map_b.covered(i)) continue;
      cells_.push_back({i, map_b.least_m[i] - map_a.greatest_m[i]});
    }
    std::sort(cells_.begin(), cells_.end(),
              [](const Cell& p, const Cell& q) { return p.gap < q.gap; });
  }

  bool empty() const { return cells_.empty(); }
  double first_touch() const { return cells_.front().gap; }
  const std::vector<Cell>& cells() const { return cells_; }

  /// Work of going on from `from` to `to`, and with `keep` the state there.
  double advance(double from, double to, bool keep) {
    double work = 0.0;
    for (Cell& cell : cells_) {
      if (cell.gap >= to) break;
      Cell next = cell;
      const double way = to - std::max(from, cell.gap);
      press(to - cell.gap, way, next);
      work += (next.energy_a - cell.energy_a + next.energy_b - cell.energy_b) *
              map_a_.grid.cell_area_m2();
      if (keep) cell = next;
    }
    return work;
  }

private:
  void press(double depth, double way, Cell& cell) const {
    const std::size_t columns = map_a_.grid.columns;
    const double w = map_a_.grid.w_of(cell.index % columns);
    const double h = map_a_.grid.h_of(cell.index / columns);
    // Each law is that of the material at the body's crushed face.
    const Vector2d face_a(map_a_.greatest_m[cell.index] - cell.depth_a, w);
    const Vector2d face_b(map_b_.least_m[cell.index] + cell.depth_b, w);
    const SharedCrush shared =
        share_crush(a_.law(face_a, h, {-1.0, 0.0}), b_.law(face_b, h, {1.0, 0.0}), depth);
    if (!std::isfinite(shared.pressure_pa)) return;
    const double before = cell.pressure > 0.0 ? cell.pressure : yield(face_a, face_b, h);
    const double work = 0.5 * (before + shared.pressure_pa) * way;
    const double more_a = std::max(0.0, shared.depth_a_m - cell.depth_a);
    const double more_b = std::max(0.0, shared.depth_b_m - cell.depth_b);
    const double to_a = more_a + more_b > 0.0 ? more_a / (more_a + more_b) : 0.5;
    cell.energy_a += to_a * work;
    cell.energy_b += (1.0 - to_a) * work;
    cell.depth_a += to_a * way;
    cell.depth_b += (1.0 - to_a) * way;
    cell.pressure = shared.pressure_pa;
  }

  double yield(const Vector2d& face_a, const Vector2d& face_b, double h) const {
    constexpr double hardly_m = 1e-12;
    return share_crush(a_.law(face_a, h, {-1.0, 0.0}), b_.law(face_b, h, {1.0, 0.0}), hardly_m)
        .pressure_pa;
  }

  const DepthMap& map_a_;
  const DepthMap& map_b_;
  Material a_;
  Material b_;
  std::vector<Cell> cells_;
};

/// Reads off what a body's crush map moves. `side` is +1 for A, whose greatest u is pushed back,
/// and -1 for B.
class Reader {
public:
  Reader(const PulseBody& body, const ViewFrame& frame, const DepthMap& map, double side,
         BodyCrush& told)
      : mesh_(*body.mesh),
        tree_(body.tree),
        view_(body.pose, frame),
        map_(map),
        side_(side),
        told_(told) {}

  void run(detail::LookMemory& memory) {
    std::vector<std::uint32_t> near;
    if (tree_ != nullptr) {
      detail::triangles_where(*tree_, view_, &Reader::may_move, this, near, memory);
    } else {
      near.resize(mesh_.size());
      std::iota(near.begin(), near.end(), 0U);
    }
    std::size_t part = 0;
    for (const std::uint32_t i : near) {
      while (part < mesh_.parts.size() &&
             i >= mesh_.parts[part].first_triangle + mesh_.parts[part].triangle_count) {
        ++part;
      }
      double furthest = 0.0;
      const double area = moved_area(mesh_.triangles[i], furthest);
      if (!(furthest > 0.0)) continue;
      told_.triangles.push_back(i);
      told_.area_m2 += area;
      if (part >= mesh_.parts.size() || i < mesh_.parts[part].first_triangle) continue;
      const auto index = static_cast<std::uint32_t>(part);
      if (told_.parts.empty() || told_.parts.back().part != index) {
        told_.parts.push_back({index, 0.0, 0.0});
      }
      told_.parts.back().area_m2 += area;
      told_.parts.back().intrusion_m = std::max(told_.parts.back().intrusion_m, furthest);
    }
  }

private:
  /// False where nothing within bounds of the view is pushed.
  static bool may_move(const void* reader, const Vector3d& low, const Vector3d& high) {
    return static_cast<const Reader*>(reader)->may_move(low, high);
  }

  bool may_move(const Vector3d& low, const Vector3d& high) const {
    constexpr double rounding_m = 1e-9;
    const ViewGrid& grid = map_.grid;
    // Points ask the cell that they lie in and the ones beside it.
    const Cells columns(low.y() - grid.low_w_m, high.y() - grid.low_w_m, grid.cell_w_m,
                        grid.columns);
    const Cells rows(low.z() - grid.low_h_m, high.z() - grid.low_h_m, grid.cell_h_m, grid.rows);
    for (std::size_t row = rows.first; row < rows.end; ++row) {
      for (std::size_t column = columns.first; column < columns.end; ++column) {
        const std::size_t cell = grid.index(column, row);
        const double depth = told_.depth_m[cell];
        if (!(depth > 0.0)) continue;
        const double into =
            side_ > 0.0 ? high.x() - map_.greatest_m[cell] : map_.least_m[cell] - low.x();
        if (into + depth > -rounding_m) return true;
      }
    }
    return false;
  }

  /// Cells that a stretch covers, and one more on each side.
  struct Cells {
    std::size_t first = 0;
    std::size_t end = 0;

    Cells(double low, double high, double cell, std::size_t count) {
      const auto most = static_cast<double>(count);
      const double from = std::clamp(std::floor(low / cell) - 1.0, 0.0, most);
      const double to = std::clamp(std::floor(high / cell) + 2.0, 0.0, most);
      first = static_cast<std::size_t>(from);
      end = static_cast<std::size_t>(to);
    }
  };

  /// An index of a cell and the next nearest one.
  struct Nearest {
    std::size_t own = 0;
    std::size_t next = 0;

    Nearest(double place, std::size_t count) {
      const auto last = static_cast<double>(count) - 1.0;
      const double index = std::floor(std::clamp(place, 0.0, last));
      const double other = place < index + 0.5 ? index - 1.0 : index + 1.0;
      own = static_cast<std::size_t>(index);
      next = static_cast<std::size_t>(std::clamp(other, 0.0, last));
    }
  };

  /// How far a point is pushed; 0 where it stays.
  double pushed(const Vector3d& p) const {
    const ViewGrid& grid = map_.grid;
    // Faces that lie in the rim of the map belong to it.
    constexpr double rim = 1e-6;
    const double column = (p.y() - grid.low_w_m) / grid.cell_w_m;
    const double row = (p.z() - grid.low_h_m) / grid.cell_h_m;
    const auto columns = static_cast<double>(grid.columns);
    const auto rows = static_cast<double>(grid.rows);
    if (!(column >= -rim && column <= columns + rim && row >= -rim && row <= rows + rim)) {
      return 0.0;
    }
    const Nearest w(column, grid.columns);
    const Nearest h(row, grid.rows);
    // A floor or a flank, seen edge-on, may lie in a cell whose middle looks past it, however small
    // the cells are: it is then pushed by what the next cell sees before it.
    const double edge_on = -std::max(grid.cell_w_m, grid.cell_h_m);
    const std::size_t own = grid.index(w.own, h.own);
    for (const std::size_t cell :
         {own, grid.index(w.own, h.next), grid.index(w.next, h.own), grid.index(w.next, h.next)}) {
      if (behind(cell, p) >= edge_on) return pushed(cell, p);
    }
    return pushed(own, p);
  }

  /// How far a point lies behind the face that a cell shows.
  double behind(std::size_t cell, const Vector3d& p) const {
    return side_ > 0.0 ? map_.greatest_m[cell] - p.x() : p.x() - map_.least_m[cell];
  }

  double pushed(std::size_t cell, const Vector3d& p) const {
    if (!(told_.depth_m[cell] > 0.0)) return 0.0;
    return std::clamp(told_.depth_m[cell] - behind(cell, p), 0.0, told_.depth_m[cell]);
  }

  /// Cuts the triangle into n² even ones no longer than a cell and counts those that move.
  double moved_area(const std::array<std::uint32_t, 3>& t, double& furthest) const {
    constexpr double most_cuts = 64.0;
    const Vector3d a = view_(mesh_.vertices[t[0]]);
    const Vector3d b = view_(mesh_.vertices[t[1]]);
    const Vector3d c = view_(mesh_.vertices[t[2]]);
    const ViewGrid& grid = map_.grid;
    const Vector3d low = a.cwiseMin(b).cwiseMin(c);
    const Vector3d high = a.cwiseMax(b).cwiseMax(c);
    if (!may_move(low, high)) return 0.0;
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const auto cuts =
        static_cast<int>(std::clamp(std::ceil(longest / grid.cell_w_m), 1.0, most_cuts));
    const double share = 1.0 / cuts;
    const double piece = 0.5 * (b - a).cross(c - a).norm() * share * share;
    double moved = 0.0;
    const auto look = [&](double s, double r) {
      const double push = pushed(a + (s * share) * (b - a) + (r * share) * (c - a));
      if (!(push > 0.0)) return;
      moved += piece;
      furthest = std::max(furthest, push);
    };
    constexpr double third = 1.0 / 3.0;
    for (int s = 0; s < cuts; ++s) {
      for (int r = 0; s + r < cuts; ++r) {
        look(s + third, r + third);
        if (s + r + 1 < cuts) look(s + 2.0 * third, r + 2.0 * third);
      }
    }
    return moved;
  }

  const TriangleMesh& mesh_;
  const AabbTree* tree_;
  detail::ViewOfBody view_;
  const DepthMap& map_;
  double side_;
  BodyCrush& told_;
};

void read(const PulseBody& body, const ViewFrame& frame, const DepthMap& map, double side,
          detail::LookMemory& memory, BodyCrush& told) {
  for (const double depth : told.depth_m) {
    told.deepest_m = std::max(told.deepest_m, depth);
    told.volume_m3 += depth * map.grid.cell_area_m2();
  }
  if (body.rigid.movable() && told.energy_j > 0.0) {
    told.ees_mps = std::sqrt(2.0 * told.energy_j / body.rigid.mass_kg);
  }
  if (told.deepest_m > 0.0) Reader(body, frame, map, side, told).run(memory);
}

}  // namespace

CrushResult crush(const PulseBody& a, const PulseBody& b, const Vector3d& point_m,
                  const Vector3d& along, double energy_j, const CrushOptions& options) {
  constexpr int halvings = 40;
  CrushResult result;
  if (!(along.head<2>().norm() > 0.0)) return result;
  result.frame = view_along(along, point_m);
  Vector3d low_a;
  Vector3d high_a;
  Vector3d low_b;
  Vector3d high_b;
  detail::LookMemory memory;
  detail::view_bounds(a, result.frame, low_a, high_a, memory);
  detail::view_bounds(b, result.frame, low_b, high_b, memory);
  const Vector3d low = low_a.cwiseMax(low_b);
  const Vector3d high = high_a.cwiseMin(high_b);
  if (!(low.y() < high.y() && low.z() < high.z())) return result;
  result.grid = grid_over(low.tail<2>(), high.tail<2>(), options.cell_m, options.cell_m);
  result.a.depth_m.assign(result.grid.size(), 0.0);
  result.b.depth_m.assign(result.grid.size(), 0.0);
  result.a.end_m.assign(result.grid.size(), 0.0);
  result.b.end_m.assign(result.grid.size(), 0.0);
  if ((a.strength.rigid && b.strength.rigid) || !(energy_j > 0.0)) return result;
  DepthMap map_a;
  DepthMap map_b;
  detail::depth_map(a, result.frame, result.grid, map_a, memory);
  detail::depth_map(b, result.frame, result.grid, map_b, memory);
  Press press(a, b, result.frame, map_a, map_b);
  if (press.empty()) return result;

  const double start = press.first_touch();
  double at = start;
  while (at - start < options.deepest_m && result.energy_j < energy_j) {
    double to = at + options.step_m;
    const double left = energy_j - result.energy_j;
    if (press.advance(at, to, false) > left) {
      double low_end = at;
      for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low_end + to);
        (press.advance(at, middle, false) > left ? to : low_end) = middle;
      }
      result.energy_j += press.advance(at, to, true);
      at = to;
      break;
    }
    result.energy_j += press.advance(at, to, true);
    at = to;
  }
  result.pressed_m = at - start;
  for (const Cell& cell : press.cells()) {
    result.a.depth_m[cell.index] = cell.depth_a;
    result.b.depth_m[cell.index] = cell.depth_b;
    result.a.end_m[cell.index] = map_a.greatest_m[cell.index] - cell.depth_a;
    result.b.end_m[cell.index] = map_b.least_m[cell.index] + cell.depth_b;
    result.a.energy_j += cell.energy_a * result.grid.cell_area_m2();
    result.b.energy_j += cell.energy_b * result.grid.cell_area_m2();
  }
  read(a, result.frame, map_a, 1.0, memory, result.a);
  read(b, result.frame, map_b, -1.0, memory, result.b);
  return result;
}

}  // namespace crashrank
