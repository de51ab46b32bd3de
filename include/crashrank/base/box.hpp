#pragma once

#include <Eigen/Core>

#include <limits>

namespace crashrank {

/// Axis-aligned box in metres, single precision, closed. The default box is empty: it overlaps
/// nothing and growing it by a point gives that point.
struct Box {
  Eigen::Vector3f min = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Vector3f max = Eigen::Vector3f::Constant(-std::numeric_limits<float>::infinity());

  bool empty() const { return (min.array() > max.array()).any(); }
  Eigen::Vector3f extent() const { return max - min; }
  Eigen::Vector3f center() const { return 0.5F * min + 0.5F * max; }

  void grow(const Eigen::Vector3f& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void grow(const Box& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  bool contains(const Box& other) const {
    return (min.array() <= other.min.array()).all() && (max.array() >= other.max.array()).all();
  }
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
