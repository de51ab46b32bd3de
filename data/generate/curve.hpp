#pragma once

#include "mesh.hpp"

#include <utility>
#include <vector>

namespace generate {

/// A closed smooth outline in a plane: the uniform cubic B-spline of its control points. It stays
/// inside their hull and never wiggles; a point given twice makes a tight corner, three times a
/// sharp one.
class Outline {
public:
  explicit Outline(const std::vector<Vec2>& control, int per_span = 10);

  /// Distance to the outline, m, negative inside.
  double distance(const Vec2& point) const;

  /// The same where it lies between the limits; else any value beyond the limit that it is beyond,
  /// which is quick to say far from the outline.
  double distance_within(const Vec2& point, double low, double high) const;

  const std::vector<Vec2>& points() const { return points_; }

private:
  struct Cell {
    std::vector<int> near;  // segments that can be the nearest one for a point of this cell
    int side = 0;           // -1 inside, 1 outside, 0 the outline runs through
    double least = 0.0;     // bounds on the distance within the cell
    double most = 0.0;
  };
  const Cell* cell_of(const Vec2& point) const;
  double exact_distance(const Vec2& point, const std::vector<int>* candidates, int side) const;
  bool inside(const Vec2& point) const;
  double segment_distance_squared(const Vec2& point, int segment) const;

  std::vector<Vec2> points_;
  std::vector<Cell> cells_;
  Vec2 origin_ = Vec2::Zero();
  int columns_ = 0;
  int rows_ = 0;
};

/// A polygon with its corners kept: Outline of every corner three times.
Outline polygon(const std::vector<Vec2>& corners);

/// A polygon whose corners are rounded a little: Outline of every corner twice.
Outline rounded_polygon(const std::vector<Vec2>& corners);

/// A smooth function through given points (cubic Hermite, slopes limited so that it has no hump
/// between them), constant outside.
class Ramp {
public:
  Ramp(std::initializer_list<std::pair<double, double>> knots);
  double operator()(double x) const;

private:
  std::vector<double> x_, y_, slope_;
};

}  // namespace generate
