#pragma once

#include "crashrank/motion/motion.hpp"

#include <Eigen/Core>

namespace oracle {

/// Of the body's origin, from differences of its velocity, m/s².
inline double measured_acceleration(const crashrank::Motion& motion, double t) {
  constexpr double h = 1e-5;
  const Eigen::Vector3d change =
      motion.velocity_at(t + h).linear_mps - motion.velocity_at(t - h).linear_mps;
  return change.norm() / (2.0 * h);
}

}  // namespace oracle
