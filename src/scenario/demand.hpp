#pragma once

#include "crashrank/scenario/candidate.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <Eigen/Core>

#include <limits>

namespace crashrank::detail {

/// What the ego can do, and how it moves at time 0.
struct EgoLimits {
  double grip_mps2 = 0.0;              ///< grip on the road times standard gravity
  double off_road_grip_mps2 = 0.0;     ///< and beside it
  double max_acceleration_mps2 = 0.0;  ///< of the engine
  double max_deceleration_mps2 = 0.0;  ///< of the brakes; infinity: grip alone limits it
  double max_steering_rad = 0.0;
  double max_steering_rate_radps = 0.0;
  double wheelbase_m = 0.0;
  double speed_mps = 0.0;  ///< NaN: not known, nor is the yaw rate
  double yaw_rate_radps = 0.0;
  /// Of the mass, body coordinates, m.
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  double rear_axle_x_m = 0.0;  ///< body coordinates, m; NaN: not known
};

/// `ego_length_m` stands in for an absent wheelbase.
EgoLimits ego_limits(const Scenario& scenario, double ego_length_m, const Eigen::Vector3d& center_m,
                     double rear_axle_x_m);

/// Over what part of its way a manoeuvre is followed.
struct FollowedWay {
  double until_s = 0.0;  ///< to its first contact, or the horizon
  double off_road_from_s = std::numeric_limits<double>::infinity();
};

/// The greatest demands of a manoeuvre as far as it is followed.
///
/// Constant accelerations: exact, but that the front wheels are taken to be turned at once; with a
/// yaw rate, the steering of its begin.
///
/// Timed poses: differences of three poses as far apart as those that are listed, at least 0.3 s,
/// the ego's own motion before the first where it is known, and standing after the last where that
/// comes before the end. A second difference is a weighted mean of the acceleration between the
/// three times, less what coordinates rounded to a centimetre leave open: no demand is overstated
/// but by what else is wrong in the poses; peaks shorter than that are understated. Steering
/// follows from the yaw rate over the speed, from 1 m/s on, and from the angle between heading and
/// the rear axle's way. O(poses · log poses), no allocation.
ManoeuvreDemand demand_of(const Candidate& candidate, const EgoLimits& limits,
                          const FollowedWay& way) noexcept;

/// Whether the vehicle can follow it.
bool is_feasible(const Candidate& candidate, const ManoeuvreDemand& demand) noexcept;

}  // namespace crashrank::detail
