#include "scenario/motion_order.hpp"

#include <array>
#include <limits>

namespace crashrank::detail {
namespace {

/// The greater number precedes.
int compare_numbers(double a, double b) {
  if (a == b) return 0;
  return a > b ? -1 : 1;
}

template <class Matrix> int compare_members(const Matrix& a, const Matrix& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (const int order = compare_numbers(a(i), b(i)); order != 0) return order;
  }
  return 0;
}

int compare_states(const Motion& a, const Motion& b, double time_s) {
  Pose pose_a;
  Pose pose_b;
  Velocity velocity_a;
  Velocity velocity_b;
  a.state_at(time_s, pose_a, velocity_a);
  b.state_at(time_s, pose_b, velocity_b);
  const auto forward = [](const Pose& pose, const Velocity& velocity) {
    return pose.rotation.col(0).dot(velocity.linear_mps);
  };
  if (const int order = compare_numbers(forward(pose_a, velocity_a), forward(pose_b, velocity_b));
      order != 0) {
    return order;
  }
  if (const int order = compare_numbers(velocity_a.angular_radps.z(), velocity_b.angular_radps.z());
      order != 0) {
    return order;
  }
  for (const int order : {compare_members(pose_a.translation, pose_b.translation),
                          compare_members(pose_a.rotation, pose_b.rotation),
                          compare_members(velocity_a.linear_mps, velocity_b.linear_mps),
                          compare_members(velocity_a.angular_radps, velocity_b.angular_radps)}) {
    if (order != 0) return order;
  }
  return 0;
}

}  // namespace

int compare_motions(const Motion& a, const Motion& b) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double time_s : std::array{0.0, 0.25, 1.0, 3.0, 10.0, 100.0}) {
    if (const int order = compare_states(a, b, time_s); order != 0) return order;
  }
  double time_s = -infinity;
  while (true) {
    const double next_s = a.next_kink(time_s);
    if (const int order = compare_numbers(next_s, b.next_kink(time_s)); order != 0) return order;
    if (!(next_s < infinity) || !(next_s > time_s)) return 0;
    if (const int order = compare_states(a, b, next_s); order != 0) return order;
    time_s = next_s;
  }
}

}  // namespace crashrank::detail
