#pragma once

#include "crashrank/scenario/scenario.hpp"
#include "scenario/number_range.hpp"

#include <cstddef>
#include <string>

namespace crashrank::detail::ranges {

inline constexpr double rad_per_deg = 0.017453292519943295;

// Of keys that several objects of a scenario have, in the units of the text.
inline constexpr NumberRange position{-scenario_limits::position_m, scenario_limits::position_m};
inline constexpr NumberRange angle{-scenario_limits::angle_deg, scenario_limits::angle_deg};
inline constexpr NumberRange speed{-scenario_limits::speed_mps, scenario_limits::speed_mps};
inline constexpr NumberRange acceleration{-scenario_limits::acceleration_mps2,
                                          scenario_limits::acceleration_mps2};
inline constexpr NumberRange yaw_rate{-scenario_limits::yaw_rate_dps,
                                      scenario_limits::yaw_rate_dps};
inline constexpr NumberRange steering{-scenario_limits::steering_deg,
                                      scenario_limits::steering_deg};
inline constexpr NumberRange steering_rate{scenario_limits::min_steering_rate_dps,
                                           scenario_limits::max_steering_rate_dps};
// Standard deviations.
inline constexpr NumberRange position_error{0.0, scenario_limits::position_error_m};
inline constexpr NumberRange heading_error{0.0, scenario_limits::heading_error_deg};
inline constexpr NumberRange speed_error{0.0, scenario_limits::speed_error_mps};
inline constexpr NumberRange occupants{0.0, harm_limits::people};
inline constexpr NumberRange honeycomb_pressure{0.0, scenario_limits::honeycomb_pa, true};
inline constexpr NumberRange honeycomb_depth{0.0, scenario_limits::honeycomb_m, true};
/// Of a prediction or a future.
inline constexpr NumberRange probability{0.0, 1.0, true};
/// That an actor exists.
inline constexpr NumberRange existence{0.0, 1.0};

/// "key[index]".
inline std::string indexed(const char* key, std::size_t index) {
  return std::string(key) + "[" + std::to_string(index) + "]";
}

}  // namespace crashrank::detail::ranges
