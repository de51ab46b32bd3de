#include "scenario/demand.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

/// Poses that are differenced are at least so far apart. Longer hides peaks, shorter shows the
/// rounding of the poses: a centimetre gives up to 0.2 m/s² here.
constexpr double least_apart_s = 0.3;
/// Below this the ratio of yaw rate to speed does not give the steering.
constexpr double least_steered_mps = 1.0;
/// Limits below this are those of a vehicle that cannot do it at all: a demand stays finite.
constexpr double least_limit = 0.1;

/// Times are read from text: what is meant to be 0.3 s apart may be a rounding less.
constexpr double rounding_s = 1e-9;
// An absent wheelbase is this share of the vehicle's length; passenger cars lie between 0.56 and
// 0.64.
constexpr double wheelbase_per_length = 0.6;

double demanded(double demand, double limit) { return demand / std::max(limit, least_limit); }

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

/// Three poses of a plan, the middle one listed, the others as far before and after it as those
/// that are listed are apart, or several times as far.
struct Window {
  Placed last;
  Placed middle;
  Placed next;

  double before_s() const { return middle.time_s - last.time_s; }
  double after_s() const { return next.time_s - middle.time_s; }
  double half_s() const { return 0.5 * (next.time_s - last.time_s); }
  double center_s() const { return 0.5 * (next.time_s + last.time_s); }

  /// Mean of the acceleration, weighted towards the middle.
  Vector2d acceleration() const {
    return ((next.at_m - middle.at_m) / after_s() - (middle.at_m - last.at_m) / before_s()) /
           half_s();
  }
  /// The same along its way.
  double gain_mps2() const {
    return (way_m(middle, next) / after_s() - way_m(last, middle) / before_s()) / half_s();
  }
  /// What coordinates that are rounded to a centimetre leave open of an acceleration.
  double open_mps2() const {
    constexpr double rounded_m = 0.01;
    return rounded_m * (1.0 / after_s() + 1.0 / before_s()) / half_s();
  }
  double speed_mps() const {
    return (way_m(last, middle) + way_m(middle, next)) / (2.0 * half_s());
  }
  double yaw_rate_radps() const {
    return angle_between(last.heading_rad, next.heading_rad) / (2.0 * half_s());
  }
};

/// Steering of timed poses as it follows from windows in their order.
class Steering {
public:
  Steering(const EgoLimits& limits, double begin_s) : limits_(limits), time_s_(begin_s) {
    known_ = std::abs(limits.speed_mps) >= least_steered_mps;
    if (known_) angle_rad_ = angle_of(limits.yaw_rate_radps / limits.speed_mps);
  }

  void follow(const Window& window, bool reverses, ManoeuvreDemand& demand) {
    const double speed = window.speed_mps();
    if (speed < least_steered_mps) return;
    const double angle = angle_of(window.yaw_rate_radps() / (reverses ? -speed : speed));
    demand.steering =
        std::max({demand.steering, demanded(std::abs(angle), limits_.max_steering_rad),
                  slip_rad(window, reverses) / most_slip_rad});
    const double apart_s = window.center_s() - time_s_;
    if (known_ && apart_s < least_apart_s - rounding_s) return;
    if (known_) {
      demand.steering_rate = std::max(
          demand.steering_rate,
          demanded(std::abs(angle - angle_rad_) / apart_s, limits_.max_steering_rate_radps));
    }
    known_ = true;
    angle_rad_ = angle;
    time_s_ = window.center_s();
  }

private:
  /// A vehicle that steers its front wheels follows its rear axle but for a few degrees of slip.
  static constexpr double most_slip_rad = 0.26;

  double angle_of(double curvature_per_m) const {
    return std::atan(limits_.wheelbase_m * curvature_per_m);
  }
  /// Between the heading and the way of the origin or of the rear axle, whichever slips less: poses
  /// are those of one or of the other.
  double slip_rad(const Window& window, bool reverses) const {
    const double of_origin = slip_rad(window, reverses, limits_.center_m.x());
    if (std::isnan(limits_.rear_axle_x_m)) return of_origin;
    return std::min(of_origin,
                    slip_rad(window, reverses, limits_.center_m.x() - limits_.rear_axle_x_m));
  }
  /// Of the point so far behind the centre of mass.
  static double slip_rad(const Window& window, bool reverses, double behind_m) {
    const auto point = [behind_m](const Placed& at) -> Vector2d {
      return at.at_m - behind_m * Vector2d(std::cos(at.heading_rad), std::sin(at.heading_rad));
    };
    const Vector2d way = (reverses ? -1.0 : 1.0) * (point(window.next) - point(window.last));
    const double heading = window.last.heading_rad +
                           0.5 * angle_between(window.last.heading_rad, window.next.heading_rad);
    return std::abs(angle_between(heading, std::atan2(way.y(), way.x())));
  }

  const EgoLimits& limits_;
  double time_s_;
  double angle_rad_ = 0.0;
  bool known_ = false;
};

void add_window(const Window& window, const EgoLimits& limits, double grip_mps2, Steering& steering,
                ManoeuvreDemand& demand) {
  const auto beyond = [&](double acceleration) {
    return std::max(acceleration - window.open_mps2(), 0.0);
  };
  demand.grip = std::max(demand.grip, demanded(beyond(window.acceleration().norm()), grip_mps2));
  const double gain = window.gain_mps2();
  if (gain > 0.0) {
    demand.engine = std::max(demand.engine, demanded(beyond(gain), limits.max_acceleration_mps2));
  } else {
    demand.brakes = std::max(
        demand.brakes, demanded(beyond(-gain), std::min(grip_mps2, limits.max_deceleration_mps2)));
  }
  const Vector2d way = window.next.at_m - window.last.at_m;
  const double heading = window.middle.heading_rad;
  const bool reverses = way.dot(Vector2d(std::cos(heading), std::sin(heading))) < 0.0;
  steering.follow(window, reverses, demand);
}

/// The last time at which a pose is listed.
double last_pose_s(const Motion& motion) { return std::max(motion.rest_time(), 0.0); }

/// Shorter looks at a plan would show nothing but its rounding.
constexpr double shortest_s = 0.1;

/// How far apart poses are around one of them, from those to its neighbours, 0 without one. A far
/// neighbour counts little: over a long time a sudden stop would look gentle.
double spacing_of(double before_s, double after_s) {
  const double larger = std::max(before_s, after_s);
  const double smaller = std::min(before_s, after_s);
  return std::max(smaller > 0.0 ? std::min(larger, 2.0 * smaller) : larger, shortest_s);
}

/// Chords of so wide a turn do not give it.
bool is_too_wide(const Window& window) {
  constexpr double widest_rad = 0.8;
  return std::abs(angle_between(window.last.heading_rad, window.middle.heading_rad)) > widest_rad ||
         std::abs(angle_between(window.middle.heading_rad, window.next.heading_rad)) > widest_rad;
}

ManoeuvreDemand demand_of_poses(const Motion& motion, const EgoLimits& limits,
                                const FollowedWay& way) {
  ManoeuvreDemand demand;
  const double end_s = last_pose_s(motion);
  const bool ends_early = end_s < way.until_s - rounding_s;
  const Placed first = placed_at(motion, 0.0, limits.center_m);
  const bool speed_known = !std::isnan(limits.speed_mps);
  Steering steering(limits, first.time_s);
  double before_s = 0.0;  // since the pose before
  double next_pose_s = 0.0;
  double time_s = 0.0;
  // Times of poses, not a counter.
  // NOLINTNEXTLINE(cert-flp30-c)
  for (; time_s < way.until_s && time_s <= end_s; time_s = next_pose_s) {
    next_pose_s = motion.next_kink(time_s);
    const double to_next_s = next_pose_s <= end_s ? next_pose_s - time_s : 0.0;
    const double spacing_s = spacing_of(before_s, to_next_s);
    const double half_s =
        spacing_s * std::max(std::ceil(least_apart_s / spacing_s - rounding_s), 1.0);
    before_s = to_next_s;
    double after_s = half_s;
    if (time_s + half_s > end_s && !ends_early) after_s = std::min(half_s, end_s - time_s);
    if (after_s < shortest_s - rounding_s) break;
    if (time_s < half_s - rounding_s && !speed_known) continue;
    Window window;
    window.middle = placed_at(motion, time_s, limits.center_m);
    window.next = placed_at(motion, time_s + after_s, limits.center_m);
    window.next.time_s = time_s + after_s;
    window.last = time_s < half_s - rounding_s
                      ? placed_before(first, limits, half_s - time_s)
                      : placed_at(motion, time_s - half_s, limits.center_m);
    const double grip =
        time_s >= way.off_road_from_s ? limits.off_road_grip_mps2 : limits.grip_mps2;
    if (!is_too_wide(window)) add_window(window, limits, grip, steering, demand);
  }
  return demand;
}

/// Of a motion with constant acceleration and steering or yaw rate.
ManoeuvreDemand demand_of_path(const Candidate& candidate, const EgoLimits& limits,
                               const FollowedWay& way) {
  ManoeuvreDemand demand;
  const Motion& motion = candidate.motion;
  const double road_s = std::min(way.until_s, way.off_road_from_s);
  demand.grip = demanded(motion.bound(0.0, road_s).acceleration_mps2, limits.grip_mps2);
  double grip = limits.grip_mps2;
  if (way.off_road_from_s < way.until_s) {
    grip = std::min(grip, limits.off_road_grip_mps2);
    demand.grip = std::max(
        demand.grip, demanded(motion.bound(way.off_road_from_s, way.until_s).acceleration_mps2,
                              limits.off_road_grip_mps2));
  }
  Pose pose;
  Velocity velocity;
  motion.state_at(0.0, pose, velocity);
  const double speed = velocity.linear_mps.dot(pose.rotation.col(0));
  const double gain = candidate.acceleration_mps2 * (speed < 0.0 ? -1.0 : 1.0);
  if (gain > 0.0) {
    demand.engine = demanded(gain, limits.max_acceleration_mps2);
  } else if (speed != 0.0) {
    const bool brakes_off_road = motion.rest_time() > way.off_road_from_s;
    demand.brakes = demanded(
        -gain, std::min(brakes_off_road ? grip : limits.grip_mps2, limits.max_deceleration_mps2));
  }
  const double angle = std::atan(limits.wheelbase_m * candidate.curvature_per_m);
  demand.steering = demanded(std::abs(angle), limits.max_steering_rad);
  return demand;
}

}  // namespace

EgoLimits ego_limits(const Scenario& scenario, double ego_length_m, const Eigen::Vector3d& center_m,
                     double rear_axle_x_m) {
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
  double share = wheelbase_per_length;
  if (ego.model < scenario.models.size() && scenario.models[ego.model].box_m) {
    const double of_kind = box_axles(scenario.models[ego.model].kind).wheelbase;
    if (of_kind > 0.0) share = of_kind;
  }
  limits.wheelbase_m = ego.wheelbase_m.value_or(share * length);
  limits.speed_mps = ego.speed_mps;
  limits.yaw_rate_radps = ego.yaw_rate_radps;
  limits.center_m = center_m;
  limits.rear_axle_x_m = rear_axle_x_m;
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
