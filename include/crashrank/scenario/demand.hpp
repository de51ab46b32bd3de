#pragma once

#include <algorithm>

namespace crashrank {

/// What a manoeuvre asks of the vehicle over what the vehicle can do, at most, as far as it is
/// followed. Above 1 the vehicle cannot follow it: what is simulated is then not what happens.
struct ManoeuvreDemand {
  /// Horizontal acceleration of the centre of mass over grip times standard gravity, beside the
  /// road over the grip there.
  double grip = 0.0;
  double engine = 0.0;    ///< acceleration along its way over ScenarioEgo::max_acceleration_mps2
  double brakes = 0.0;    ///< deceleration along its way over what brakes and grip give
  double steering = 0.0;  ///< steering angle over ScenarioEgo::max_steering_rad
  double steering_rate = 0.0;  ///< its rate over ScenarioEgo::max_steering_rate_radps

  /// The greatest of them.
  double greatest() const noexcept {
    return std::max({grip, engine, brakes, steering, steering_rate});
  }
};

/// A demand up to this still counts as feasible for a manoeuvre of timed poses.
inline constexpr double feasible_posed_demand = 1.1;
/// And for all others: stated numbers are rounded, as 8 m/s² for a grip of 0.8.
inline constexpr double feasible_demand = 1.05;

}  // namespace crashrank
