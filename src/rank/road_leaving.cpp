#include "rank/road_leaving.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

/// Smallest step of the search, m: used while a wheel is nearer to a border than this.
constexpr double least_step_m = 0.05;

/// Half the widest gap between two areas that counts as a seam of the map, m.
constexpr double seam_m = 0.05;

std::array<Vector2d, 4> wheels_of(const Body& body, const Pose& pose) {
  const Footing& footing = body.footing;
  const Eigen::Vector3d& center = body.vehicle->center_m;
  std::array<Vector2d, 4> wheels;
  std::size_t k = 0;
  for (const double x : {footing.front_m, footing.rear_m}) {
    for (const double y : {footing.y_m[0], footing.y_m[1]}) {
      const Eigen::Vector3d point = center + Eigen::Vector3d(x, y, -center.z());
      wheels[k++] = (pose.rotation * point + pose.translation).head<2>();
    }
  }
  return wheels;
}

}  // namespace

std::optional<RoadLeaving> find_leaving(const Road& road, const Body& body, const Motion& plan,
                                        double until_s, const StopCheck& stop) {
  if (!road.ends()) return std::nullopt;
  const View<const Area> areas(road.drivable);
  const auto wheel_off = [&](double time_s) -> std::optional<Vector2d> {
    for (const Vector2d& wheel : wheels_of(body, plan.pose_at(time_s))) {
      if (!holds(areas, wheel) && distance_to_border_m(areas, wheel) > seam_m) return wheel;
    }
    return std::nullopt;
  };
  const MotionBound bound = plan.bound(0.0, until_s);
  const double fastest = bound.speed_mps + bound.angular_radps * body.radius_m;
  double time_s = 0.0;
  double on_road_s = 0.0;
  std::optional<Vector2d> off = wheel_off(0.0);
  while (!off && time_s < until_s && fastest > 0.0) {
    if (stop()) return std::nullopt;
    double apart = std::numeric_limits<double>::infinity();
    for (const Vector2d& wheel : wheels_of(body, plan.pose_at(time_s))) {
      apart = std::min(apart, distance_to_border_m(areas, wheel));
    }
    on_road_s = time_s;
    time_s = std::min(time_s + std::max(apart, least_step_m) / fastest, until_s);
    off = wheel_off(time_s);
  }
  if (!off) return std::nullopt;
  constexpr int halvings = 30;
  for (int i = 0; i < halvings && time_s > 0.0; ++i) {
    const double middle_s = 0.5 * (on_road_s + time_s);
    if (const auto at_middle = wheel_off(middle_s)) {
      off = at_middle;
      time_s = middle_s;
    } else {
      on_road_s = middle_s;
    }
  }
  return RoadLeaving{time_s, plan.velocity_at(time_s).linear_mps.norm(), *off};
}

}  // namespace crashrank::detail
