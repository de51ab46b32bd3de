#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace crashrank {

/// How a body is looked at: along a horizontal direction, with what lies across it to the left and
/// up. Coordinates u (along), w (left), h (up) are metres from the origin; rows of `axes` are the
/// three directions.
struct ViewFrame {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows: depth, width, height
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();  ///< m

  /// A point in the frame, m.
  Eigen::Vector3d into(const Eigen::Vector3d& point_m) const { return axes * (point_m - origin_m); }
};

/// The frame that looks along the horizontal part of `along` (not vertical), its origin at a point
/// on the ground, so that h is the height over it.
CRASHRANK_API ViewFrame view_along(const Eigen::Vector3d& along, const Eigen::Vector3d& origin_m);

/// Cells of a view: `columns` across w, `rows` across h.
struct ViewGrid {
  double low_w_m = 0.0;     ///< where the first column begins, m
  double low_h_m = 0.0;     ///< where the first row begins, m
  double cell_w_m = 0.05;   ///< width of a cell, m
  double cell_h_m = 0.05;   ///< height of a cell, m
  std::size_t columns = 0;  ///< cells along the width
  std::size_t rows = 0;     ///< cells along the height

  /// Number of cells.
  std::size_t size() const noexcept { return columns * rows; }
  /// Middle of a column, m.
  double w_of(std::size_t column) const {
    return low_w_m + cell_w_m * (static_cast<double>(column) + 0.5);
  }
  /// Middle of a row, m.
  double h_of(std::size_t row) const {
    return low_h_m + cell_h_m * (static_cast<double>(row) + 0.5);
  }
  /// Area of a cell, m².
  double cell_area_m2() const noexcept { return cell_w_m * cell_h_m; }
  /// Place of a cell in the lists.
  std::size_t index(std::size_t column, std::size_t row) const { return row * columns + column; }
};

/// No grid has more cells than this: a wider one gets larger cells.
inline constexpr std::size_t max_view_cells = std::size_t{1} << 20;

/// A grid over [low, high] (w, h) with cells of about that size.
CRASHRANK_API ViewGrid grid_over(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                                 double cell_w_m, double cell_h_m);

/// The two outermost surfaces of a body seen along u, sampled at the middles of the cells: its
/// least and greatest u. Cells that the body does not cover hold +infinity and -infinity.
struct DepthMap {
  ViewGrid grid;                   ///< its cells
  std::vector<double> least_m;     ///< nearest depth in each cell, m
  std::vector<double> greatest_m;  ///< furthest depth in each cell, m

  /// True where the surface covers the cell.
  bool covered(std::size_t cell) const { return least_m[cell] <= greatest_m[cell]; }
};

/// Bounds of a body's triangles in a view: (u, w, h).
CRASHRANK_API void view_bounds(const TriangleMesh& mesh, const Pose& body_in_world,
                               const ViewFrame& frame, Eigen::Vector3d& low, Eigen::Vector3d& high);

/// Looks at a body. What is sampled are the triangles themselves, so the map of a finer mesh of the
/// same shape tends to that shape's. O(triangles + cells covered).
CRASHRANK_API DepthMap depth_map(const TriangleMesh& mesh, const Pose& body_in_world,
                                 const ViewFrame& frame, const ViewGrid& grid);

}  // namespace crashrank
