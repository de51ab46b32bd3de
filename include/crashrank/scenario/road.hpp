#pragma once

#include "crashrank/base/area.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace crashrank {

/// Where the ego may drive, and what leaving it means. Without areas the road has no end.
struct Road {
  std::vector<Area> drivable;           ///< world; a wheel in none of them has left the road
  double harm_per_leaving = 0.0;        ///< added to the harm where the road is left, persons
  std::optional<double> off_road_grip;  ///< between tyre and ground beside it; absent: as on it

  /// False where the road has no end.
  bool ends() const noexcept { return !drivable.empty(); }
};

/// Bounds on what a road may ask for; the published schema states the same numbers.
namespace road_limits {
inline constexpr std::size_t areas = 1000;          ///< most
inline constexpr std::size_t holes = 1000;          ///< most of one area
inline constexpr std::size_t corners = 10'000;      ///< most of all areas together
inline constexpr double harm_per_leaving = 1000.0;  ///< most, persons
}  // namespace road_limits

}  // namespace crashrank
