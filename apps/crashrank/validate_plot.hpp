#pragma once

#include <optional>
#include <string>
#include <vector>

namespace crashrank::cli {

/// What a test measured and what its simulation gives, in the unit of their quantity.
struct ComparedValue {
  std::string test;
  double measured = 0.0;
  double simulated = 0.0;
};

/// Values of one shape of the bodies.
struct ComparedShape {
  std::string name;                     ///< "meshes" or "boxes"
  std::vector<ComparedValue> delta_v;   ///< km/h
  std::vector<ComparedValue> yaw_rate;  ///< its change, degrees/s

  /// Adds what was measured; all in m/s and degrees/s.
  void add(const std::string& test, double delta_v_mps, const std::optional<double>& measured_mps,
           double yaw_rate_dps, const std::optional<double>& measured_dps);
};

/// An SVG picture with a panel for each quantity that has a value: simulated over measured, the
/// line on which both are equal, and those 20 % above and below it. Points of the first shape are
/// full, of the second hollow; each names its test when it is pointed at.
std::string validate_plot(const std::string& title, const std::vector<ComparedShape>& shapes);

}  // namespace crashrank::cli
