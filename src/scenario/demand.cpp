#include "scenario/demand.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

/// Poses that are differenced are at least so far apart. Longer hides peaks, shorter shows the
/// rounding of the poses: a centimetre gives up to 0.2 m/s² here.
constexpr double least_apart_s = 0.3;
/// Below this the ratio of yaw rate to speed tells nothing of the steering.
constexpr double least_steered_mps = 1.0;
/// Limits below this are those of a vehicle that cannot do it at all: a demand stays finite.
constexpr double least_limit = 0.1;

/// Times are read from text: what is meant to be 0.3 s apart may be a rounding less.
constexpr double rounding_s = 1e-9;
// An absent wheelbase is this share of the vehicle's length; passenger cars lie between 0.56 and
// 0.64.
constexpr double wheelbase_per_length = 0.6;

double share(double demand, double limit) { return demand / std::max(limit, least_limit); }

double angle_between(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 6.283185307179586);
}

/// Where the centre of mass is, and the heading.
struct Placed {
  double time_s = 0.0;
  Vector2d at_m = Vector2d::Zero();
  double heading_rad = 0.0;
};

Placed placed_at(const Motion& motion, double time_s, const Eigen::Vector3d& center_m) {
  const Pose pose = motion.pose_at(time_s);
  return {time_s, (pose.rotation * center_m + pose.translation).head<2>(),
          std::atan2(pose.rotation(1, 0), pose.rotation(0, 0))};
}

/// Where the ego was before: on the arc that its speed and yaw rate make.
Placed placed_before(const Placed& first, const EgoLimits& limits, double seconds) {
  const double turned = limits.yaw_rate_radps * seconds;
  const double heading = first.heading_rad - 0.5 * turned;
  const double ahead = limits.center_m.x();
  // The origin's way, and the centre of mass about it.
  Vector2d at = first.at_m;
  at -= ahead * Vector2d(std::cos(first.heading_rad), std::sin(first.heading_rad));
  at -= limits.speed_mps * seconds * Vector2d(std::cos(heading), std::sin(heading));
  const double before = first.heading_rad - turned;
  at += ahead * Vector2d(std::cos(before), std::sin(before));
  return {first.time_s - seconds, at, before};
}

/// Length of the way between two poses, as of an arc: chords fall short of it.
double way_m(const Placed& from, const Placed& to) {
  const double half = 0.5 * angle_between(from.heading_rad, to.heading_rad);
  const double stretch = std::abs(half) < 1e-4 ? 1.0 : half / std::sin(half);
  return stretch * (to.at_m - from.at_m).norm();
}

/// Mean of the acceleration between three times, weighted towards the middle one.
Vector2d mean_acceleration(const Placed& last, const Placed& middle, const Placed& next) {
  const Vector2d before = (middle.at_m - last.at_m) / (middle.time_s - last.time_s);
  const Vector2d after = (next.at_m - middle.at_m) / (next.time_s - middle.time_s);
  return (after - before) / (0.5 * (next.time_s - last.time_s));
}

/// Steering of timed poses as it follows from three of them each time.
class Steering {
public:
  Steering(const EgoLimits& limits, double begin_s)
      : limits_(limits), time_s_(begin_s - least_apart_s) {
    if (std::isnan(limits.speed_mps)) time_s_ = begin_s;
    if (!(std::abs(limits.speed_mps) >= least_steered_mps)) return;
    angle_rad_ = std::atan(limits.wheelbase_m * limits.yaw_rate_radps / limits.speed_mps);
  }

  void follow(const Placed& last, const Placed& next, double time_s, double speed_mps,
              ManoeuvreDemand& demand) {
    if (std::abs(speed_mps) < least_steered_mps) return;
    const double yaw_rate =
        angle_between(last.heading_rad, next.heading_rad) / (next.time_s - last.time_s);
    const double angle = std::atan(limits_.wheelbase_m * yaw_rate / speed_mps);
    demand.steering = std::max(demand.steering, share(std::abs(angle), limits_.max_steering_rad));
    const double apart_s = time_s - time_s_;
    const bool is_first = !known_ && std::isnan(limits_.speed_mps);
    if (!is_first && apart_s < least_apart_s - rounding_s) return;
    known_ = true;
    if (!is_first)
      demand.steering_rate =
          std::max(demand.steering_rate,
                   share(std::abs(angle - angle_rad_) / apart_s, limits_.max_steering_rate_radps));
    angle_rad_ = angle;
    time_s_ = time_s;
  }

private:
  const EgoLimits& limits_;
  double time_s_;
  double angle_rad_ = 0.0;
  bool known_ = false;  ///< from poses
};

ManoeuvreDemand demand_of_poses(const Motion& motion, const EgoLimits& limits,
                                const FollowedWay& way) {
  ManoeuvreDemand demand;
  const Placed first = placed_at(motion, 0.0, limits.center_m);
  Steering steering(limits, first.time_s);
  Placed middle = first;
  double last_s = first.time_s;
  double next_s = first.time_s;
  for (; middle.time_s < way.until_s;
       middle = placed_at(motion, motion.next_kink(middle.time_s), limits.center_m)) {
    while (next_s - middle.time_s < least_apart_s - rounding_s) next_s = motion.next_kink(next_s);
    if (!(next_s <= way.until_s)) break;
    const bool begins = middle.time_s - first.time_s < least_apart_s - rounding_s;
    if (begins && std::isnan(limits.speed_mps)) continue;
    Placed last;
    if (begins) {
      last = placed_before(first, limits, least_apart_s - (middle.time_s - first.time_s));
    } else {
      for (double later_s = motion.next_kink(last_s);
           middle.time_s - later_s >= least_apart_s - rounding_s;
           later_s = motion.next_kink(last_s)) {
        last_s = later_s;
      }
      last = placed_at(motion, last_s, limits.center_m);
    }
    const Placed next = placed_at(motion, next_s, limits.center_m);
    const Vector2d acceleration = mean_acceleration(last, middle, next);
    const Vector2d heading(std::cos(middle.heading_rad), std::sin(middle.heading_rad));
    const double direction = (next.at_m - last.at_m).dot(heading) < 0.0 ? -1.0 : 1.0;
    const double speed =
        direction * (way_m(last, middle) + way_m(middle, next)) / (next.time_s - last.time_s);
    const double grip =
        middle.time_s >= way.off_road_from_s ? limits.off_road_grip_mps2 : limits.grip_mps2;
    demand.grip = std::max(demand.grip, share(acceleration.norm(), grip));
    const double gain = acceleration.dot(heading) * (speed < 0.0 ? -1.0 : 1.0);
    if (gain > 0.0) {
      demand.engine = std::max(demand.engine, share(gain, limits.max_acceleration_mps2));
    } else {
      demand.brakes =
          std::max(demand.brakes, share(-gain, std::min(grip, limits.max_deceleration_mps2)));
    }
    steering.follow(last, next, middle.time_s, speed, demand);
  }
  return demand;
}

/// Of a motion with constant acceleration and steering or yaw rate.
ManoeuvreDemand demand_of_path(const Candidate& candidate, const EgoLimits& limits,
                               const FollowedWay& way) {
  ManoeuvreDemand demand;
  const Motion& motion = candidate.motion;
  const double road_s = std::min(way.until_s, way.off_road_from_s);
  demand.grip = share(motion.bound(0.0, road_s).acceleration_mps2, limits.grip_mps2);
  double grip = limits.grip_mps2;
  if (way.off_road_from_s < way.until_s) {
    grip = std::min(grip, limits.off_road_grip_mps2);
    demand.grip = std::max(demand.grip,
                           share(motion.bound(way.off_road_from_s, way.until_s).acceleration_mps2,
                                 limits.off_road_grip_mps2));
  }
  Pose pose;
  Velocity velocity;
  motion.state_at(0.0, pose, velocity);
  const double speed = velocity.linear_mps.dot(pose.rotation.col(0));
  const double gain = candidate.acceleration_mps2 * (speed < 0.0 ? -1.0 : 1.0);
  if (gain > 0.0) {
    demand.engine = share(gain, limits.max_acceleration_mps2);
  } else if (speed != 0.0) {
    const bool brakes_off_road = motion.rest_time() > way.off_road_from_s;
    demand.brakes = share(
        -gain, std::min(brakes_off_road ? grip : limits.grip_mps2, limits.max_deceleration_mps2));
  }
  const double angle = std::atan(limits.wheelbase_m * candidate.curvature_per_m);
  demand.steering = share(std::abs(angle), limits.max_steering_rad);
  return demand;
}

}  // namespace

EgoLimits ego_limits(const Scenario& scenario, double ego_length_m,
                     const Eigen::Vector3d& center_m) {
  const ScenarioEgo& ego = scenario.ego;
  EgoLimits limits;
  limits.grip_mps2 = scenario.grip * standard_gravity_mps2;
  limits.off_road_grip_mps2 =
      scenario.road.off_road_grip.value_or(scenario.grip) * standard_gravity_mps2;
  limits.max_acceleration_mps2 = ego.max_acceleration_mps2;
  limits.max_deceleration_mps2 =
      ego.max_deceleration_mps2.value_or(std::numeric_limits<double>::infinity());
  limits.max_steering_rad = ego.max_steering_rad;
  limits.max_steering_rate_radps = ego.max_steering_rate_radps;
  const double length = std::max(ego_length_m, scenario_limits::min_wheelbase_m);
  limits.wheelbase_m = ego.wheelbase_m.value_or(wheelbase_per_length * length);
  limits.speed_mps = ego.speed_mps;
  limits.yaw_rate_radps = ego.yaw_rate_radps;
  limits.center_m = center_m;
  return limits;
}

ManoeuvreDemand demand_of(const Candidate& candidate, const EgoLimits& limits,
                          const FollowedWay& way) noexcept {
  return candidate.motion.holds_poses() ? demand_of_poses(candidate.motion, limits, way)
                                        : demand_of_path(candidate, limits, way);
}

bool is_feasible(const Candidate& candidate, const ManoeuvreDemand& demand) noexcept {
  return demand.greatest() <=
         (candidate.motion.holds_poses() ? feasible_posed_demand : feasible_demand);
}

}  // namespace crashrank::detail
