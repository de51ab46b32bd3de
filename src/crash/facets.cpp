#include "crash/facets.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

class Line {
public:
  Line(const ViewGrid& grid, double nearest, double deepest, std::vector<Facet>& facets)
      : grid_(grid), nearest_(nearest), deepest_(deepest), facets_(facets) {}

  /// A stretch with the body on its far side: out of the body is to the left of it.
  void add(Vector2d from, Vector2d to, std::size_t row) {
    if (std::min(from.x(), to.x()) >= deepest_ || std::max(from.x(), to.x()) < nearest_) return;
    if (from.x() > deepest_) from = cut(to, from);
    if (to.x() > deepest_) to = cut(from, to);
    const Vector2d whole = to - from;
    const double length = whole.norm();
    if (!(length > 0.0)) return;
    const double count = std::ceil(length / grid_.cell_w_m);
    Facet facet;
    facet.normal = Vector2d(-whole.y(), whole.x()) / length;
    facet.area_m2 = length / count * grid_.cell_h_m;
    facet.row = row;
    // A spike may be as long as it likes: pieces too far behind are not even gone over.
    double first = 0.0;
    double last = count;
    if (from.x() < nearest_) first = std::floor(count * ((nearest_ - from.x()) / whole.x()));
    if (to.x() < nearest_) last = std::ceil(count * ((nearest_ - from.x()) / whole.x())) + 1.0;
    last = std::min(last, count);
    for (double i = std::max(first - 1.0, 0.0); i < last; i += 1.0) {
      facet.point = from + ((i + 0.5) / count) * whole;
      if (facet.point.x() < nearest_) continue;
      if (facets_.size() == most_facets) return;
      facets_.push_back(facet);
    }
  }

private:
  Vector2d cut(const Vector2d& inside, const Vector2d& beyond) const {
    return inside + (beyond - inside) * ((deepest_ - inside.x()) / (beyond.x() - inside.x()));
  }

  const ViewGrid& grid_;
  double nearest_;
  double deepest_;
  std::vector<Facet>& facets_;
};

}  // namespace

void facets_of(const DepthMap& map, double nearest_m, double deepest_m,
               std::vector<Facet>& facets) {
  facets.clear();
  const ViewGrid& grid = map.grid;
  Line line(grid, nearest_m, deepest_m, facets);
  const Vector2d half(0.0, 0.5 * grid.cell_w_m);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const auto covered = [&](std::size_t column) {
      return column < grid.columns && map.covered(grid.index(column, row));
    };
    for (std::size_t column = 0; column < grid.columns; ++column) {
      if (!covered(column)) continue;
      const std::size_t cell = grid.index(column, row);
      const Vector2d here(map.least_m[cell], grid.w_of(column));
      const double back = map.greatest_m[cell];
      // At the rim of the grid the body may go on: no flank there.
      if (column == 0 || !covered(column - 1)) {
        const Vector2d edge = here - half;
        if (column > 0) line.add({back, edge.y()}, edge, row);
        line.add(edge, here, row);
      }
      if (covered(column + 1)) {
        line.add(here, {map.least_m[grid.index(column + 1, row)], grid.w_of(column + 1)}, row);
      } else {
        const Vector2d edge = here + half;
        line.add(here, edge, row);
        if (column + 1 < grid.columns) line.add(edge, {back, edge.y()}, row);
      }
    }
  }
}

}  // namespace crashrank::detail
