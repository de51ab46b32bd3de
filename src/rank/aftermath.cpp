#include "rank/aftermath.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace crashrank::detail {
namespace {

constexpr double pose_step_s = 0.05;

using Eigen::Vector3d;

/// What is left of a speed under even deceleration, and the way until then.
struct Slowed {
  double speed = 0.0;
  double way = 0.0;
};

Slowed slow(double speed, double deceleration, double since_s) {
  const double stops_s =
      deceleration > 0.0 ? speed / deceleration : std::numeric_limits<double>::infinity();
  const double t = std::min(since_s, stops_s);
  const double left = stops_s <= since_s ? 0.0 : speed - deceleration * t;
  return {left, 0.5 * (speed + left) * t};
}

/// From the velocity of a body's centre of mass to that of its origin.
Velocity of_origin(const Velocity& of_center, const Vector3d& from_origin_m) {
  Velocity v = of_center;
  v.linear_mps -= of_center.angular_radps.cross(from_origin_m);
  return v;
}

Eigen::Matrix3d yawed(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

void Aftermath::begin(const Scene& scene, const Candidate& candidate, double start_s,
                      const EgoAtContact& ego, const EgoAfterContact& after) {
  start_s_ = start_s;
  ego_ = ego;
  after_ = after;
  center_in_body_m_ = scene.ego.vehicle.center_m;
  deceleration_mps2_ = std::max(scene.harm.after.deceleration_mps2, -candidate.acceleration_mps2);
  // Tyres that push sideways act about as far from the centre of mass as the mass does.
  const Vehicle& vehicle = scene.ego.vehicle;
  const double gyration_m = std::sqrt(vehicle.yaw_inertia_kgm2 / vehicle.mass_kg);
  spin_deceleration_radps2_ = deceleration_mps2_ / std::max(gyration_m, 0.1);
  turned_ = yawed(after.turned_rad) * ego.pose.rotation;
  center_m_ = ego.pose.rotation * center_in_body_m_ + ego.pose.translation + after.moved_m;

  const double over_s = start_s + after.duration_s;
  const double horizon_s = scene.slice_s.back();
  const double speed = after.velocity.linear_mps.norm();
  const double spin = std::abs(after.velocity.angular_radps.z());
  double follow_s = scene.harm.after.longest_s;
  if (deceleration_mps2_ > 0.0) {
    follow_s =
        std::min(follow_s, std::max(speed / deceleration_mps2_, spin / spin_deceleration_radps2_));
  }
  until_s_ = std::min(horizon_s, over_s + follow_s);

  constexpr double least_s = 1e-6;
  poses_.clear();
  poses_.push_back({start_s, ego.pose});
  if (after.duration_s > least_s) poses_.push_back({over_s, pose(0.0)});
  const double rest_s = until_s_ - poses_.back().time_s;
  const auto steps = static_cast<int>(std::ceil(std::max(rest_s, 0.0) / pose_step_s));
  for (int i = 1; i <= steps && rest_s > least_s; ++i) {
    const double since_s = rest_s * i / steps;
    poses_.push_back({over_s + since_s, pose(since_s)});
  }
  if (!motion_.become_timed({poses_.data(), poses_.size()})) motion_ = Motion::at_rest(ego.pose);
}

void Aftermath::prepare(const Scene& scene) {
  const double longest_s = std::min(scene.slice_s.back(), scene.harm.after.longest_s);
  const auto most = static_cast<std::size_t>(std::ceil(longest_s / pose_step_s)) + 3;
  poses_.resize(most);
  for (std::size_t i = 0; i < most; ++i) poses_[i] = {static_cast<double>(i), Pose{}};
  const Status held = motion_.become_timed({poses_.data(), most});
  static_cast<void>(held);
}

Velocity Aftermath::slowed(double since_s) const {
  Velocity v;
  const Vector3d& linear = after_.velocity.linear_mps;
  const double speed = linear.norm();
  if (speed > 0.0) {
    v.linear_mps = linear * (slow(speed, deceleration_mps2_, since_s).speed / speed);
  }
  const double spin = after_.velocity.angular_radps.z();
  v.angular_radps.z() =
      std::copysign(slow(std::abs(spin), spin_deceleration_radps2_, since_s).speed, spin);
  return v;
}

Pose Aftermath::pose(double since_s) const {
  const Vector3d& linear = after_.velocity.linear_mps;
  const double speed = linear.norm();
  Vector3d center = center_m_;
  if (speed > 0.0) center += linear * (slow(speed, deceleration_mps2_, since_s).way / speed);
  const double spin = after_.velocity.angular_radps.z();
  const double angle =
      std::copysign(slow(std::abs(spin), spin_deceleration_radps2_, since_s).way, spin);
  Pose result;
  result.rotation = yawed(angle) * turned_;
  result.translation = center - result.rotation * center_in_body_m_;
  return result;
}

EgoAtContact Aftermath::at(double time_s) const {
  EgoAtContact ego;
  ego.pose = motion_.pose_at(time_s);
  const Vector3d from_origin_m = ego.pose.rotation * center_in_body_m_;
  const double since_s = time_s - start_s_ - after_.duration_s;
  ego.left = of_origin(slowed(std::max(since_s, 0.0)), from_origin_m);
  ego.met = ego.left;
  if (since_s < 0.0) {
    // Within the crash the velocity goes evenly from what it was to what is left.
    const double share = -since_s / after_.duration_s;
    ego.met.linear_mps += share * (ego_.left.linear_mps - ego.left.linear_mps);
    ego.met.angular_radps += share * (ego_.left.angular_radps - ego.left.angular_radps);
  }
  return ego;
}

}  // namespace crashrank::detail
