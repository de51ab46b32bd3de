#pragma once

#include <Eigen/Core>

#include <limits>

namespace crashrank {

/// Axis-aligned box in metres, single precision, closed. The default box is empty: it overlaps
/// nothing and growing it by a point gives that point.
struct Box {
  /// Least coordinates, m.
  Eigen::Vector3f min = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
  /// Greatest coordinates, m.
  Eigen::Vector3f max = Eigen::Vector3f::Constant(-std::numeric_limits<float>::infinity());

  /// True for a box without any point.
  bool empty() const { return (min.array() > max.array()).any(); }
  /// Size along each axis, m; negative for an empty box.
  Eigen::Vector3f extent() const { return max - min; }
  /// The middle, m; means nothing for an empty box.
  Eigen::Vector3f center() const { return 0.5F * min + 0.5F * max; }

  /// Makes it the smallest box that also holds the point.
  void grow(const Eigen::Vector3f& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  /// Makes it the smallest box that also holds the other.
  void grow(const Box& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  /// True where no point of the other lies outside; boundaries included.
  bool contains(const Box& other) const {
    return (min.array() <= other.min.array()).all() && (max.array() >= other.max.array()).all();
  }
  /// True where they share a point; touching is enough.
  bool overlaps(const Box& other) const {
    return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
  }
};

/// Half of the surface of a box, m²; 0 for an empty one. The surface-area heuristic's measure.
inline float half_area(const Box& box) {
  if (box.empty()) return 0.0F;
  const Eigen::Vector3f e = box.extent();
  return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
}

}  // namespace crashrank
