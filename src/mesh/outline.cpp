#include "mesh/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

constexpr double most_cells = 4e6;
/// What all segments together may be long, in cells: bounds time and memory on meshes of many large
/// triangles.
constexpr double most_cells_passed = 10e6;

double cross(const Vector2d& p, const Vector2d& q) { return p.x() * q.y() - p.y() * q.x(); }

/// Cells over a section, a free rim of four around it. Rows lie evenly about the middle of the
/// section: all places of a mirrored section have the mirrored bits.
struct Raster {
  double low_x = 0.0;
  double middle_y = 0.0;
  double half_rows = 0.0;
  double cell_m = 0.0;
  std::ptrdiff_t columns = 0;
  std::ptrdiff_t rows = 0;

  std::ptrdiff_t column_of(const Vector2d& p) const {
    return static_cast<std::ptrdiff_t>((p.x() - low_x) / cell_m);
  }
  std::ptrdiff_t row_of(const Vector2d& p) const {
    return static_cast<std::ptrdiff_t>((p.y() - middle_y) / cell_m + half_rows);
  }
  std::size_t index(std::ptrdiff_t column, std::ptrdiff_t row) const {
    return static_cast<std::size_t>(row * columns + column);
  }
  std::size_t size() const { return static_cast<std::size_t>(columns * rows); }
  Vector2d corner(std::ptrdiff_t column, std::ptrdiff_t row) const {
    return Vector2d(low_x + cell_m * static_cast<double>(column),
                    middle_y + cell_m * (static_cast<double>(row) - half_rows));
  }
};

Raster raster_over(const std::vector<SectionSegment>& segments, double cell_m) {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d high = -low;
  double length = 0.0;
  for (const SectionSegment& s : segments) {
    for (const Vector2d& p : s) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    length += (s[1] - s[0]).norm();
  }
  const Vector2d size = high - low;
  while ((size.x() / cell_m + 10.0) * (size.y() / cell_m + 10.0) > most_cells ||
         length / cell_m > most_cells_passed) {
    cell_m *= 1.25;
  }
  Raster raster;
  raster.cell_m = cell_m;
  raster.low_x = low.x() - 4.37 * cell_m;
  raster.columns = static_cast<std::ptrdiff_t>(size.x() / cell_m) + 10;
  // An odd number: no corner lies in the middle, as near to one side of an even body as to the
  // other.
  raster.rows = (static_cast<std::ptrdiff_t>(size.y() / cell_m) + 10) | 1;
  raster.middle_y = 0.5 * (low.y() + high.y());
  raster.half_rows = 0.5 * static_cast<double>(raster.rows);
  return raster;
}

/// Segments by the cell that they pass through: `first` by cell, then one index each.
struct CellSegments {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> segment;
};

/// Calls back for the cells that a segment passes through, each of which shares a side with the one
/// before; corners that it cuts off by less than an eighth of a cell may be left out.
template <class Visit>
void visit_cells(const Raster& raster, const SectionSegment& s, Visit&& visit) {
  const Vector2d along = s[1] - s[0];
  const auto steps = static_cast<int>(std::min(along.norm() / (0.25 * raster.cell_m), 1e7)) + 1;
  std::ptrdiff_t column = raster.column_of(s[0]);
  std::ptrdiff_t row = raster.row_of(s[0]);
  visit(raster.index(column, row));
  for (int i = 1; i <= steps; ++i) {
    const Vector2d p = s[0] + (static_cast<double>(i) / steps) * along;
    const std::ptrdiff_t next_column = raster.column_of(p);
    const std::ptrdiff_t next_row = raster.row_of(p);
    if (next_column == column && next_row == row) continue;
    if (next_column != column && next_row != row) {
      // Across a corner: through the cell beside it on whose side the segment passes.
      const Vector2d corner =
          raster.corner(std::max(column, next_column), std::max(row, next_row)) - s[0];
      const bool column_first = corner.x() / along.x() < corner.y() / along.y();
      visit(column_first ? raster.index(next_column, row) : raster.index(column, next_row));
    }
    column = next_column;
    row = next_row;
    visit(raster.index(column, row));
  }
}

CellSegments sort_into_cells(const Raster& raster, const std::vector<SectionSegment>& segments) {
  CellSegments cells;
  cells.first.assign(raster.size() + 1, 0);
  for (const SectionSegment& s : segments) {
    visit_cells(raster, s, [&](std::size_t cell) { ++cells.first[cell + 1]; });
  }
  for (std::size_t i = 1; i < cells.first.size(); ++i) cells.first[i] += cells.first[i - 1];
  cells.segment.resize(cells.first.back());
  std::vector<std::size_t> next(cells.first.begin(), cells.first.end() - 1);
  for (std::uint32_t i = 0; i < segments.size(); ++i) {
    visit_cells(raster, segments[i], [&](std::size_t cell) { cells.segment[next[cell]++] = i; });
  }
  return cells;
}

/// Calls back for the cells around one, itself included.
template <class Visit> void visit_around(const Raster& raster, std::size_t cell, Visit&& visit) {
  const auto column = static_cast<std::ptrdiff_t>(cell) % raster.columns;
  const auto row = static_cast<std::ptrdiff_t>(cell) / raster.columns;
  for (std::ptrdiff_t j = row - 1; j <= row + 1; ++j) {
    for (std::ptrdiff_t i = column - 1; i <= column + 1; ++i) {
      if (i >= 0 && j >= 0 && i < raster.columns && j < raster.rows) visit(raster.index(i, j));
    }
  }
}

/// What the segments enclose, and they themselves: they are made one cell fatter, which closes
/// gaps; what can then be reached from outside is made one cell fatter, which takes that back.
std::vector<char> enclosed_cells(const Raster& raster, const CellSegments& cells) {
  const auto occupied = [&](std::size_t cell) { return cells.first[cell + 1] > cells.first[cell]; };
  std::vector<char> fat(raster.size(), 0);
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (occupied(cell)) visit_around(raster, cell, [&](std::size_t c) { fat[c] = 1; });
  }
  std::vector<char> outside(raster.size(), 0);
  std::vector<std::size_t> open{0};
  outside[0] = 1;
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    const auto column = static_cast<std::ptrdiff_t>(cell) % raster.columns;
    const auto row = static_cast<std::ptrdiff_t>(cell) / raster.columns;
    const auto enter = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
      if (i < 0 || j < 0 || i >= raster.columns || j >= raster.rows) return;
      const std::size_t c = raster.index(i, j);
      if (outside[c] != 0 || fat[c] != 0) return;
      outside[c] = 1;
      open.push_back(c);
    };
    enter(column + 1, row);
    enter(column - 1, row);
    enter(column, row + 1);
    enter(column, row - 1);
  }
  std::vector<char> solid(raster.size(), 1);
  for (std::size_t cell = 0; cell < raster.size(); ++cell) {
    if (outside[cell] == 0) continue;
    visit_around(raster, cell, [&](std::size_t c) {
      if (!occupied(c)) solid[c] = 0;
    });
  }
  return solid;
}

/// Chooses between places that a mirror image exchanges, or that are passed in reverse in it: the
/// one further ahead, of those the one further out.
bool is_preferred(const Vector2d& p, const Vector2d& q, double middle_y) {
  if (p.x() != q.x()) return p.x() > q.x();
  return std::abs(p.y() - middle_y) > std::abs(q.y() - middle_y);
}

/// The point of the segments that is nearest to `p` within two cells; `p` where there is none.
Vector2d snap(const Raster& raster, const std::vector<SectionSegment>& segments,
              const CellSegments& cells, const Vector2d& p) {
  constexpr std::ptrdiff_t reach = 2;
  double best = static_cast<double>(reach * reach) * raster.cell_m * raster.cell_m;
  Vector2d at = p;
  const std::ptrdiff_t column = raster.column_of(p);
  const std::ptrdiff_t row = raster.row_of(p);
  for (std::ptrdiff_t j = row - reach; j <= row + reach; ++j) {
    for (std::ptrdiff_t i = column - reach; i <= column + reach; ++i) {
      if (i < 0 || j < 0 || i >= raster.columns || j >= raster.rows) continue;
      const std::size_t cell = raster.index(i, j);
      for (std::size_t k = cells.first[cell]; k < cells.first[cell + 1]; ++k) {
        const SectionSegment& s = segments[cells.segment[k]];
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
  return at;
}

/// Marks the points between two kept ones that a line through the kept ones is too far from
/// (Douglas and Peucker 1973). Of points that are as far but for rounding the preferred one, or the
/// first and the last that are preferred alike: the same points whichever way the line runs.
void keep_between(const OutlineLoop& line, std::size_t from, std::size_t to, double tolerance_m,
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
OutlineLoop simplified(OutlineLoop loop, double tolerance_m, double middle_y) {
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
  OutlineLoop simple;
  for (std::size_t k = 0; k + 1 < loop.size(); ++k) {
    if (kept[k] != 0 && (simple.empty() || simple.back() != loop[k])) simple.push_back(loop[k]);
  }
  while (simple.size() > 1 && simple.front() == simple.back()) simple.pop_back();
  return simple;
}

}  // namespace

double loop_area_m2(const OutlineLoop& loop) {
  double area = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    area += cross(loop[i] - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
  }
  return 0.5 * area;
}

std::vector<OutlineLoop> trace_outlines(const std::vector<SectionSegment>& segments, double cell_m,
                                        double tolerance_m) {
  std::vector<OutlineLoop> loops;
  if (segments.empty()) return loops;
  const Raster raster = raster_over(segments, cell_m);
  const CellSegments cells = sort_into_cells(raster, segments);
  const std::vector<char> solid = enclosed_cells(raster, cells);

  // Along the border with the solid cells to the left: steps of one cell in the directions 0 (+x),
  // 1 (+y), 2 (-x), 3 (-y). `begun` marks edges below solid cells, with which every loop begins.
  std::vector<char> begun(raster.size(), 0);
  const auto is_solid = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    return i >= 0 && j >= 0 && i < raster.columns && j < raster.rows &&
           solid[raster.index(i, j)] != 0;
  };
  constexpr std::array<std::ptrdiff_t, 4> step_x{1, 0, -1, 0};
  constexpr std::array<std::ptrdiff_t, 4> step_y{0, 1, 0, -1};
  // Cells to the left and to the right of the edge that leaves a corner in a direction.
  constexpr std::array<std::ptrdiff_t, 4> left_x{0, -1, -1, 0};
  constexpr std::array<std::ptrdiff_t, 4> left_y{0, 0, -1, -1};
  for (std::ptrdiff_t row = 0; row < raster.rows; ++row) {
    for (std::ptrdiff_t column = 0; column < raster.columns; ++column) {
      if (!is_solid(column, row) || is_solid(column, row - 1) ||
          begun[raster.index(column, row)] != 0) {
        continue;
      }
      OutlineLoop loop;
      std::ptrdiff_t x = column;
      std::ptrdiff_t y = row;
      std::size_t direction = 0;
      do {
        if (direction == 0) begun[raster.index(x, y)] = 1;
        loop.push_back(snap(raster, segments, cells, raster.corner(x, y)));
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
      loop = simplified(std::move(loop), tolerance_m, raster.middle_y);
      if (loop.size() < 2) continue;
      // Around what is thinner than a cell, moving the points onto the segments can turn it over.
      if (loop_area_m2(loop) < 0.0) std::reverse(loop.begin(), loop.end());
      loops.push_back(std::move(loop));
    }
  }
  return loops;
}

}  // namespace crashrank::detail
