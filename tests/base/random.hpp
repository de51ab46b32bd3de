#pragma once

#include "crashrank/base/pose.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <random>

namespace crashrank::test {

/// Numbers that are the same with every standard library.
class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>((engine_() >> 32) * count >> 32);
  }
  Eigen::Vector3d vector(double half) {
    const double x = uniform(-half, half);
    const double y = uniform(-half, half);
    const double z = uniform(-half, half);
    return {x, y, z};
  }
  Eigen::Matrix3d rotation() {
    Eigen::Quaterniond q;
    do {
      const double w = uniform(-1, 1);
      const Eigen::Vector3d v = vector(1);
      q = Eigen::Quaterniond(w, v.x(), v.y(), v.z());
    } while (q.norm() > 1.0 || q.norm() < 0.1);
    return q.normalized().toRotationMatrix();
  }
  Pose pose(double half) {
    const Eigen::Matrix3d r = rotation();
    return {r, vector(half)};
  }

private:
  std::mt19937_64 engine_;
};

}  // namespace crashrank::test
