#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/pose.hpp"
#include "oracle/random.hpp"

#include <cmath>
#include <cstdint>

namespace oracle {

/// A random pose of B in A's frame at which the two may well touch: mostly cars on one road, turned
/// about the vertical and a little nodding; some turned any way; some not turned or by quarter
/// turns, where coordinates of both bodies can coincide exactly.
inline crashrank::Pose random_pose(Random& random, const crashrank::Box& a,
                                   const crashrank::Box& b) {
  const double pi = 3.14159265358979;
  const double kind = random.real(0.0, 1.0);
  crashrank::Pose pose;
  if (kind < 0.6) {
    pose = crashrank::pose_from_angles(Eigen::Vector3d::Zero(), random.real(-pi, pi),
                                       random.real(-0.05, 0.05), random.real(-0.05, 0.05));
  } else if (kind < 0.85) {
    pose = crashrank::pose_from_angles(Eigen::Vector3d::Zero(), random.real(-pi, pi),
                                       random.real(-pi, pi), random.real(-pi, pi));
  } else {
    for (std::int64_t turn = random.integer(0, 3); turn > 0; --turn) {
      Eigen::Matrix3d quarter;
      quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
      pose.rotation = (quarter * pose.rotation).eval();
    }
  }
  // Centre on centre, then apart by up to the sum of the half extents: from deep to just missing.
  const Eigen::Vector3d center_a = a.center().cast<double>();
  const Eigen::Vector3d reach_a = 0.5 * a.extent().cast<double>();
  const Eigen::Vector3d center_b = b.center().cast<double>();
  const Eigen::Vector3d reach_b =
      pose.rotation.cwiseAbs() * (0.5 * b.extent().cast<double>()).eval();
  pose.translation = center_a - pose.rotation * center_b;
  for (int axis = 0; axis < 3; ++axis) {
    pose.translation[axis] += random.real(-1.0, 1.0) * (reach_a[axis] + reach_b[axis]);
  }
  if (kind >= 0.85) {  // onto a coarse grid, so that the sums are exact
    for (double& t : pose.translation) t = std::round(t * 64.0) / 64.0;
    if (kind >= 0.97) pose.translation.setZero();
  } else if (random.chance(0.5)) {  // wheels on the same road
    pose.translation.z() = 0.0;
  }
  return pose;
}

}  // namespace oracle
