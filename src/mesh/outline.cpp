#include "mesh/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;
using Line = std::vector<Vector2d>;

double cross(const Vector2d& p, const Vector2d& q) { return p.x() * q.y() - p.y() * q.x(); }

/// Chooses between places that a mirror image exchanges, or that are passed in reverse in it: the
/// one further ahead, of those the one further out.
bool is_preferred(const Vector2d& p, const Vector2d& q, double middle_y) {
  if (p.x() != q.x()) return p.x() > q.x();
  return std::abs(p.y() - middle_y) > std::abs(q.y() - middle_y);
}

/// Edges of a surface near the border of the body, by the cell that they pass through: `first` by
/// cell, then one index each.
struct BorderEdges {
  std::vector<std::array<Vector2d, 2>> edges;
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> edge;
};

/// Distance within which places on the border are moved onto edges, cells.
constexpr std::ptrdiff_t snap_cells = 2;

BorderEdges border_edges(const BandSurface& surface, const Raster& raster,
                         const std::vector<Cell>& cells) {
  std::vector<char> near(raster.size(), 0);
  for (std::ptrdiff_t row = 1; row < raster.rows; ++row) {
    for (std::ptrdiff_t column = 1; column < raster.columns; ++column) {
      const auto solid = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
        return cells[raster.index(i, j)] == Cell::solid;
      };
      const bool here = solid(column, row);
      if (here == solid(column - 1, row) && here == solid(column, row - 1)) continue;
      for (std::ptrdiff_t j = row - snap_cells - 1; j <= row + snap_cells + 1; ++j) {
        for (std::ptrdiff_t i = column - snap_cells - 1; i <= column + snap_cells + 1; ++i) {
          if (raster.holds(i, j)) near[raster.index(i, j)] = 1;
        }
      }
    }
  }
  BorderEdges border;
  std::vector<std::array<std::uint32_t, 2>> passed;  // cell, edge
  // Most facets of fine meshes lie in few cells, none of them near the border.
  const auto is_far = [&](const BandFacet& facet) {
    constexpr std::ptrdiff_t few = 4;
    std::ptrdiff_t low_column = raster.columns;
    std::ptrdiff_t low_row = raster.rows;
    std::ptrdiff_t high_column = 0;
    std::ptrdiff_t high_row = 0;
    for (std::size_t i = 0; i < facet.count; ++i) {
      const std::ptrdiff_t column = raster.column_of(facet.corner[i].x());
      const std::ptrdiff_t row = raster.row_of(facet.corner[i].y());
      low_column = std::min(low_column, column);
      low_row = std::min(low_row, row);
      high_column = std::max(high_column, column);
      high_row = std::max(high_row, row);
    }
    if (high_column - low_column >= few || high_row - low_row >= few) return false;
    for (std::ptrdiff_t row = low_row; row <= high_row; ++row) {
      for (std::ptrdiff_t column = low_column; column <= high_column; ++column) {
        if (near[raster.index(column, row)] != 0) return false;
      }
    }
    return true;
  };
  surface.for_each_facet([&](const BandFacet& facet) {
    if (is_far(facet)) return;
    for (std::size_t i = 0; i < facet.count; ++i) {
      const Vector2d p = facet.corner[i].head<2>();
      const Vector2d q = facet.corner[(i + 1) % facet.count].head<2>();
      const auto number = static_cast<std::uint32_t>(border.edges.size());
      const std::size_t before = passed.size();
      visit_cells(raster, p, q, [&](std::size_t cell, double, double) {
        if (near[cell] != 0) passed.push_back({static_cast<std::uint32_t>(cell), number});
      });
      if (passed.size() > before) border.edges.push_back({p, q});
    }
  });
  border.first.assign(raster.size() + 1, 0);
  for (const auto& [cell, edge] : passed) ++border.first[cell + 1];
  for (std::size_t i = 1; i < border.first.size(); ++i) border.first[i] += border.first[i - 1];
  std::vector<std::uint32_t> next(border.first.begin(), border.first.end() - 1);
  border.edge.resize(passed.size());
  for (const auto& [cell, edge] : passed) border.edge[next[cell]++] = edge;
  return border;
}

/// The point of the edges that is nearest to a corner of the raster within two cells; the corner
/// itself where there is none. Cells of the border that the surface leaves free lie outside the
/// body, so the nearest point of all edges is on its outline.
Vector2d snap(const Raster& raster, const BorderEdges& border, std::ptrdiff_t x, std::ptrdiff_t y) {
  const Vector2d p = raster.corner(x, y);
  Vector2d at = p;
  for (std::ptrdiff_t reach = 1; reach <= snap_cells; ++reach) {
    // No edge of the cells further out is nearer than this.
    double best = static_cast<double>(reach * reach) * raster.cell_m * raster.cell_m;
    for (std::ptrdiff_t row = y - reach; row < y + reach; ++row) {
      for (std::ptrdiff_t column = x - reach; column < x + reach; ++column) {
        if (!raster.holds(column, row)) continue;
        const std::size_t cell = raster.index(column, row);
        for (std::uint32_t k = border.first[cell]; k < border.first[cell + 1]; ++k) {
          const std::array<Vector2d, 2>& s = border.edges[border.edge[k]];
          // From the middle: the same bits whichever end comes first.
          const Vector2d middle = 0.5 * (s[0] + s[1]);
          const Vector2d half = 0.5 * (s[1] - s[0]);
          const double length2 = half.squaredNorm();
          const double t =
              length2 > 0.0 ? std::clamp((p - middle).dot(half) / length2, -1.0, 1.0) : 0.0;
          const Vector2d q = middle + t * half;
          const double distance2 = (q - p).squaredNorm();
          if (distance2 < best || (distance2 == best && is_preferred(q, at, raster.middle_y))) {
            best = distance2;
            at = q;
          }
        }
      }
    }
    if (at != p) return at;
  }
  return at;
}

/// Marks the points between two kept ones that a line through the kept ones is too far from
/// (Douglas and Peucker 1973). Of points that are as far but for rounding the preferred one, or the
/// first and the last that are preferred alike: the same points whichever way the line runs.
void keep_between(const Line& line, std::size_t from, std::size_t to, double tolerance_m,
                  double middle_y, std::vector<char>& kept) {
  constexpr double rounding = 1e-9;
  std::vector<std::array<std::size_t, 2>> open{{from, to}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j <= i + 1) continue;
    const Vector2d along = line[j] - line[i];
    const double length2 = along.squaredNorm();
    const auto distance2_of = [&, i = i](std::size_t k) {
      const Vector2d p = line[k] - line[i];
      const double t = length2 > 0.0 ? std::clamp(p.dot(along) / length2, 0.0, 1.0) : 0.0;
      return (p - t * along).squaredNorm();
    };
    double worst = 0.0;
    for (std::size_t k = i + 1; k < j; ++k) worst = std::max(worst, distance2_of(k));
    if (!(worst > tolerance_m * tolerance_m)) continue;
    std::size_t first = i;
    std::size_t last = i;
    for (std::size_t k = i + 1; k < j; ++k) {
      if (distance2_of(k) < worst * (1.0 - rounding)) continue;
      if (first == i || is_preferred(line[k], line[first], middle_y)) first = k;
      if (!is_preferred(line[first], line[k], middle_y)) last = k;
    }
    kept[first] = kept[last] = 1;
    open.push_back({i, first});
    open.push_back({first, last});
    open.push_back({last, j});
  }
}

/// The loop without the points that are nearly on the lines between others. It is parted at its
/// rearmost and foremost points; of several the outermost to both sides.
Line simplified(Line loop, double tolerance_m, double middle_y) {
  std::array<std::size_t, 4> ends{};
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const auto take = [&](std::size_t& end, double sign_x, double sign_y) {
      const double ahead = sign_x * (loop[k].x() - loop[end].x());
      if (ahead > 0.0 || (ahead == 0.0 && sign_y * (loop[k].y() - loop[end].y()) > 0.0)) end = k;
    };
    take(ends[0], -1.0, -1.0);
    take(ends[1], -1.0, 1.0);
    take(ends[2], 1.0, -1.0);
    take(ends[3], 1.0, 1.0);
  }
  std::sort(ends.begin(), ends.end());
  const std::size_t start = ends[0];
  std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(start), loop.end());
  loop.push_back(loop.front());
  std::vector<char> kept(loop.size(), 0);
  for (std::size_t e = 0; e < ends.size(); ++e) {
    const std::size_t from = ends[e] - start;
    const std::size_t to = e + 1 < ends.size() ? ends[e + 1] - start : loop.size() - 1;
    kept[from] = 1;
    keep_between(loop, from, to, tolerance_m, middle_y, kept);
  }
  Line simple;
  for (std::size_t k = 0; k + 1 < loop.size(); ++k) {
    if (kept[k] != 0 && (simple.empty() || simple.back() != loop[k])) simple.push_back(loop[k]);
  }
  while (simple.size() > 1 && simple.front() == simple.back()) simple.pop_back();
  return simple;
}

}  // namespace

double OutlineLoop::area_m2() const {
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    area += cross(points[i] - points[0], points[(i + 1) % points.size()] - points[0]);
  }
  return 0.5 * area;
}

BandOutline::BandOutline(const BandSurface& surface, double cell_m, double tolerance_cells,
                         std::optional<SkyMap>& sky)
    : raster_(raster_over(surface, cell_m)) {
  if (raster_.columns == 0) return;
  heights_ = rasterise_heights(surface, raster_);
  of_rows_.resize(static_cast<std::size_t>(raster_.rows));
  of_columns_.resize(static_cast<std::size_t>(raster_.columns));
  for (std::size_t cell = 0; cell < heights_.size(); ++cell) {
    of_rows_[cell / of_columns_.size()].grow(heights_[cell]);
    of_columns_[cell % of_columns_.size()].grow(heights_[cell]);
  }
  const std::vector<Cell> cells = divide_cells(surface, raster_, heights_, sky);
  const BorderEdges border = border_edges(surface, raster_, cells);

  // Along the border with the solid cells to the left: steps of one cell in the directions 0 (+x),
  // 1 (+y), 2 (-x), 3 (-y). `begun` marks edges below solid cells, with which every loop begins.
  std::vector<char> begun(raster_.size(), 0);
  const auto is_solid = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    return raster_.holds(i, j) && cells[raster_.index(i, j)] == Cell::solid;
  };
  constexpr std::array<std::ptrdiff_t, 4> step_x{1, 0, -1, 0};
  constexpr std::array<std::ptrdiff_t, 4> step_y{0, 1, 0, -1};
  // Cells to the left and to the right of the edge that leaves a corner in a direction.
  constexpr std::array<std::ptrdiff_t, 4> left_x{0, -1, -1, 0};
  constexpr std::array<std::ptrdiff_t, 4> left_y{0, 0, -1, -1};
  for (std::ptrdiff_t row = 1; row < raster_.rows; ++row) {
    for (std::ptrdiff_t column = 0; column < raster_.columns; ++column) {
      if (!is_solid(column, row) || is_solid(column, row - 1) ||
          begun[raster_.index(column, row)] != 0) {
        continue;
      }
      OutlineLoop loop;
      std::ptrdiff_t twice_area = 0;  // in cells; negative around free space
      std::ptrdiff_t x = column;
      std::ptrdiff_t y = row;
      std::size_t direction = 0;
      do {
        if (direction == 0) begun[raster_.index(x, y)] = 1;
        loop.points.push_back(snap(raster_, border, x, y));
        twice_area += x * step_y[direction] - y * step_x[direction];
        x += step_x[direction];
        y += step_y[direction];
        // Left where that keeps solid cells to the left and free ones to the right, else ahead,
        // else right: bodies that touch at a corner stay apart.
        for (const std::size_t turn : {1U, 0U, 3U, 2U}) {
          const std::size_t next = (direction + turn) % 4;
          const std::size_t right = (next + 3) % 4;
          if (is_solid(x + left_x[next], y + left_y[next]) &&
              !is_solid(x + left_x[right], y + left_y[right])) {
            direction = next;
            break;
          }
        }
      } while (x != column || y != row || direction != 0);
      loop.inner = twice_area < 0;
      loop.points =
          simplified(std::move(loop.points), tolerance_cells * raster_.cell_m, raster_.middle_y);
      if (loop.points.size() < 2) continue;
      // Around what is thinner than a cell, moving the points onto the edges can turn it over.
      if ((loop.area_m2() < 0.0) != loop.inner) {
        std::reverse(loop.points.begin(), loop.points.end());
      }
      loops_.push_back(std::move(loop));
    }
  }
  std::stable_partition(loops_.begin(), loops_.end(),
                        [](const OutlineLoop& loop) { return !loop.inner; });
}

BandOutline::PieceHeights BandOutline::heights(const Vector2d& from, const Vector2d& to,
                                               double behind_m) const {
  PieceHeights heights;
  const Vector2d along = to - from;
  const double length = along.norm();
  if (!(length > 0.0)) return heights;
  const Vector2d inward(-along.y() / length, along.x() / length);
  // The piece lies within a cell of the edge of the surface.
  constexpr int edge_cells = 1;
  const auto last_across = static_cast<int>(std::ceil(behind_m / raster_.cell_m));
  const auto samples = static_cast<int>(std::ceil(length / raster_.cell_m - 1e-6));
  for (int k = 0; k < samples; ++k) {
    // From the middle, the same bits whichever way the piece runs; and between the lines of the
    // raster, on which corners of loops can lie.
    const Vector2d on_line =
        0.5 * (from + to) + (static_cast<double>(2 * k + 1 - samples) / (2 * samples)) * along;
    for (int j = -edge_cells; j <= last_across; ++j) {
      const Vector2d p = on_line + (raster_.cell_m * (static_cast<double>(j) + 0.5)) * inward;
      const std::ptrdiff_t column = raster_.column_of(p.x());
      const std::ptrdiff_t row = raster_.row_of(p.y());
      if (!raster_.holds(column, row)) continue;
      const HeightRange& here = heights_[raster_.index(column, row)];
      if (j <= edge_cells) heights.at_edge.grow(here);
      heights.behind.grow(here);
      if (j != 0) continue;
      heights.along_x.grow(of_rows_[static_cast<std::size_t>(row)]);
      heights.along_y.grow(of_columns_[static_cast<std::size_t>(column)]);
    }
  }
  return heights;
}

}  // namespace crashrank::detail
