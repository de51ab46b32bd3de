#pragma once

#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/motion/motion.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {

/// How far A's and B's points can be from their bodies' origins, m.
struct Radii {
  double a = 0.0;
  double b = 0.0;
};

/// Both bodies at one instant, seen in the axes of A's body as they stand at that instant.
struct RelativeState {
  double time = 0.0;
  double horizon = 0.0;  ///< no kink in either motion between `time` and this
  Pose a_in_world;
  Pose b_in_a;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();        ///< velocity of A's origin less that of B's
  Eigen::Vector3d omega_a = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d omega_b = Eigen::Vector3d::Zero();
  /// No point of A accelerates against a point of B by more than this until the horizon, m/s².
  double acceleration = 0.0;
  double margin = 0.0;  ///< above the rounding of poses and transformed corners, m
};

inline double point_acceleration(const MotionBound& bound, double radius) {
  return bound.acceleration_mps2 +
         (bound.angular_radps * bound.angular_radps + bound.angular_radps2) * radius;
}

/// No chain of operations from a motion's parameters to a corner is longer than 64, and
/// none of its terms exceeds this, so that 64 u of it bounds their rounding. A position is its
/// start and a way that may cancel: the start is at most as far as the present place and the way
/// together. An angle of w·t radians is off by up to u·w·t, and moves a corner by that times its
/// radius.
inline double term_bound(const Motion& motion, const Pose& pose, double radius, double t) {
  const MotionBound past = motion.bound(0.0, t);
  return pose.translation.cwiseAbs().sum() + 4.0 * past.speed_mps * t +
         (1.0 + past.angular_radps * t) * radius;
}

inline RelativeState relative_state(const Motion& motion_a, const Motion& motion_b,
                                    const Radii& radii, double t, double until) {
  RelativeState s;
  s.time = t;
  s.horizon = std::min({motion_a.next_kink(t), motion_b.next_kink(t), until});
  Pose b_in_world;
  Velocity va;
  Velocity vb;
  motion_a.state_at(t, s.a_in_world, va);
  motion_b.state_at(t, b_in_world, vb);
  s.b_in_a = relative(s.a_in_world, b_in_world);
  const Eigen::Matrix3d back = s.a_in_world.rotation.transpose();
  s.v = rotate(back, va.linear_mps - vb.linear_mps);
  s.omega_a = rotate(back, va.angular_radps);
  s.omega_b = rotate(back, vb.angular_radps);
  s.acceleration = point_acceleration(motion_a.bound(t, s.horizon), radii.a) +
                   point_acceleration(motion_b.bound(t, s.horizon), radii.b);
  s.margin = 0x1p-47 * (term_bound(motion_a, s.a_in_world, radii.a, t) +
                        term_bound(motion_b, b_in_world, radii.b, t));
  return s;
}

/// For how long a gap stays open that closes at `closing` m/s now and faster by at most
/// `acceleration` m/s² a second: the root of gap = closing·t + acceleration·t²/2, rounded down.
inline double open_for(double gap, double closing, double acceleration) {
  if (!(gap > 0.0)) return 0.0;
  const double root = std::sqrt(closing * closing + 2.0 * acceleration * gap);
  double seconds = std::numeric_limits<double>::infinity();
  if (closing >= 0.0) {
    if (closing + root > 0.0) seconds = 2.0 * gap / (closing + root);
  } else if (acceleration > 0.0) {
    seconds = (root - closing) / acceleration;
  }
  return seconds * (1.0 - 1e-12);
}

/// How fast the gap along a unit direction n (A's axes, from A to B) closes, at most, between any
/// point of one triangle and any of the other, both in A's frame at the state's time. Velocities
/// are linear over a triangle, so its corners bound them.
inline double closing_speed(const Eigen::Vector3d& n, const TriangleD& a, const TriangleD& b,
                            const RelativeState& s) {
  const Eigen::Vector3d turn_a = n.cross(s.omega_a);
  const Eigen::Vector3d turn_b = n.cross(s.omega_b);
  double a_most = -std::numeric_limits<double>::infinity();
  double b_least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    a_most = std::max(a_most, turn_a.dot(a.corner[i]));
    b_least = std::min(b_least, turn_b.dot(b.corner[i] - s.b_in_a.translation));
  }
  return n.dot(s.v) + a_most - b_least;
}

}  // namespace crashrank::detail
