#pragma once

#include "mesh/band_raster.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace crashrank::detail {

/// A closed line with the body to its left, first point not repeated.
struct OutlineLoop {
  std::vector<Eigen::Vector2d> points;  ///< m
  bool inner = false;                   ///< goes round free space inside the body

  /// Area that it encloses, m²; negative where it runs clockwise.
  double area_m2() const;
};

/// Lines around what a body has within a height band, seen from above, and the heights of its
/// surface there.
class BandOutline {
public:
  /// `cell_m`: see `raster_over`. Points lie on edges of the surface where those are near, and
  /// within `tolerance_cells` cells of the rastered line.
  BandOutline(const BandSurface& surface, double cell_m, double tolerance_cells,
              std::optional<SkyMap>& sky);

  /// Outer loops, then inner ones.
  const std::vector<OutlineLoop>& loops() const noexcept { return loops_; }
  /// Heights of the surface over the ground at a piece of a loop, up to `behind_m` behind it, and
  /// on all lines along x and along y through it.
  struct PieceHeights {
    HeightRange at_edge;
    HeightRange behind;
    HeightRange along_x;
    HeightRange along_y;
  };
  PieceHeights heights(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                       double behind_m) const;

private:
  Raster raster_;
  std::vector<HeightRange> heights_;
  std::vector<HeightRange> of_rows_;
  std::vector<HeightRange> of_columns_;
  std::vector<OutlineLoop> loops_;
};

}  // namespace crashrank::detail
