#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

namespace crashrank::detail {

/// Part of a triangle within a height band: a convex polygon; z over the ground, m.
struct BandFacet {
  std::array<Eigen::Vector3d, 5> corner;
  std::size_t count = 0;  ///< below 3: nothing
};

/// The part of a triangle between two heights.
BandFacet clip_to_band(const std::array<Eigen::Vector3d, 3>& triangle, double low, double high);

/// A mesh within one height band.
struct BandSurface {
  const TriangleMesh* mesh = nullptr;
  const std::vector<std::uint32_t>* triangles = nullptr;  ///< those that reach into the band
  Box bounds;                                             ///< around all triangles of the mesh
  double ground_m = 0.0;                                  ///< body z of the ground
  double low_m = 0.0;                                     ///< edges of the band over the ground
  double high_m = 0.0;

  /// A triangle of the mesh, z over the ground.
  std::array<Eigen::Vector3d, 3> triangle(std::uint32_t index) const;
  /// Calls back with the part of every triangle within the band.
  template <class Visit> void for_each_facet(Visit&& visit) const {
    for (const std::uint32_t index : *triangles) {
      const BandFacet facet = clip_to_band(triangle(index), low_m, high_m);
      if (facet.count >= 3) visit(facet);
    }
  }
};

/// Cells over a band seen from above, a free rim of four around it. Rows lie evenly about the
/// middle: all places of a mirrored band have the mirrored bits.
struct Raster {
  double low_x = 0.0;
  double middle_y = 0.0;
  double half_rows = 0.0;
  double cell_m = 0.0;
  double cells_per_m = 0.0;
  std::ptrdiff_t columns = 0;
  std::ptrdiff_t rows = 0;

  std::ptrdiff_t column_of(double x) const {
    return static_cast<std::ptrdiff_t>((x - low_x) * cells_per_m);
  }
  std::ptrdiff_t row_of(double y) const {
    return static_cast<std::ptrdiff_t>((y - middle_y) * cells_per_m + half_rows);
  }
  bool holds(std::ptrdiff_t column, std::ptrdiff_t row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }
  std::size_t index(std::ptrdiff_t column, std::ptrdiff_t row) const {
    return static_cast<std::size_t>(row * columns + column);
  }
  std::size_t size() const { return static_cast<std::size_t>(columns * rows); }
  Eigen::Vector2d corner(std::ptrdiff_t column, std::ptrdiff_t row) const {
    return {low_x + cell_m * static_cast<double>(column),
            middle_y + cell_m * (static_cast<double>(row) - half_rows)};
  }
  Eigen::Vector2d center(std::ptrdiff_t column, std::ptrdiff_t row) const {
    return {low_x + cell_m * (static_cast<double>(column) + 0.5),
            middle_y + cell_m * ((static_cast<double>(row) + 0.5) - half_rows)};
  }
};

/// Raster over a band. `cell_m` grows where the raster would exceed 4 million cells, or edges and
/// areas of all facets together 10 million. No columns where the band has no facet.
Raster raster_over(const BandSurface& surface, double cell_m);

/// Calls back for the cells that a line passes through, each of which shares a side with the one
/// before, with the shares of the line at which it enters and leaves them (Amanatides and Woo
/// 1987).
template <class Visit>
void visit_cells(const Raster& raster, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                 Visit&& visit) {
  std::ptrdiff_t column = raster.column_of(from.x());
  std::ptrdiff_t row = raster.row_of(from.y());
  const std::ptrdiff_t columns = raster.column_of(to.x()) - column;
  const std::ptrdiff_t rows = raster.row_of(to.y()) - row;
  if (columns == 0 && rows == 0) {
    visit(raster.index(column, row), 0.0, 1.0);
    return;
  }
  // Shares of the line at which it leaves the cell through its next column and through its next
  // row, and from one to the next.
  const Eigen::Vector2d along = to - from;
  const Eigen::Vector2d border =
      raster.corner(column + (columns > 0 ? 1 : 0), row + (rows > 0 ? 1 : 0)) - from;
  constexpr double never = 1e300;
  double at_column = columns == 0 ? never : border.x() / along.x();
  double at_row = rows == 0 ? never : border.y() / along.y();
  const double per_column = columns == 0 ? 0.0 : raster.cell_m / std::abs(along.x());
  const double per_row = rows == 0 ? 0.0 : raster.cell_m / std::abs(along.y());
  std::ptrdiff_t columns_left = std::abs(columns);
  std::ptrdiff_t rows_left = std::abs(rows);
  double entered = 0.0;
  while (columns_left > 0 || rows_left > 0) {
    const bool next_column = rows_left == 0 || (columns_left > 0 && at_column <= at_row);
    const double left = std::max(entered, std::min(1.0, next_column ? at_column : at_row));
    visit(raster.index(column, row), entered, left);
    entered = left;
    if (next_column) {
      column += columns > 0 ? 1 : -1;
      at_column += per_column;
      --columns_left;
    } else {
      row += rows > 0 ? 1 : -1;
      at_row += per_row;
      --rows_left;
    }
  }
  visit(raster.index(column, row), entered, 1.0);
}

/// Highest point of a mesh over each cell of a coarse raster.
class SkyMap {
public:
  explicit SkyMap(const BandSurface& surface);
  /// Returns true if something of the mesh lies above a height over a place.
  bool covers(const Eigen::Vector2d& place, double height_m) const;

private:
  Raster raster_;
  std::vector<HeightRange> heights_;
};

/// Heights of the surface over each cell; empty where nothing of the band lies.
std::vector<HeightRange> rasterise_heights(const BandSurface& surface, const Raster& raster);

/// What a cell belongs to.
enum class Cell : std::uint8_t {
  solid,    ///< the body
  outside,  ///< free, and a way in the plane leads to it from outside
  inside,   ///< free space inside the body
};

/// Divides the raster into the body and what is free. The surface is made one cell fatter, which
/// closes gaps; what is free then is made one cell fatter, which takes that back. Space that no way
/// leads to is free inside where it is `least_free_width_m` wide and either the section at half the
/// height of the band does not wind around it or it lies mostly open to the sky.
/// `sky` is filled where it is needed.
std::vector<Cell> divide_cells(const BandSurface& surface, const Raster& raster,
                               const std::vector<HeightRange>& heights, std::optional<SkyMap>& sky);

}  // namespace crashrank::detail
