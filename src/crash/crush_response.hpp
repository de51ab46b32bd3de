#pragma once

#include "crashrank/internal/vehicle/strength.hpp"

#include "crashrank/mesh/profile.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace crashrank::detail {

/// A body's strength, converted to single precision once per contact. The force-deflection curve at
/// any place of the body then takes a few products (`crush_curves` in crush_curves-inl.hpp).
struct CrushResponse {
  struct Side {
    float yield = 0.0F;   ///< N/m², per metre of outline and of height
    float slope = 1.0F;   ///< N/m³
    float length = 0.0F;  ///< m
  };

  CrushResponse() = default;
  CrushResponse(const CrushStrength& strength, double factor) : rigid(strength.rigid) {
    const auto side = [](const CrushLaw& law) {
      return Side{static_cast<float>(law.yield_npm), static_cast<float>(law.slope_npm2),
                  static_cast<float>(std::min(law.length_m, 1e6))};
    };
    front = side(strength.front);
    flank = side(strength.side);
    rear = side(strength.rear);
    const auto bounded = [](double value) {
      return static_cast<float>(std::clamp(value, -1e6, 1e6));
    };
    rails = bounded(strength.core.rails_half_width_m);
    cage = bounded(strength.core.cage_half_width_m);
    cage_front = bounded(strength.core.cage_front_m);
    cage_rear = bounded(strength.core.cage_rear_m);
    engine = static_cast<float>(strength.core.engine_m);
    inside = static_cast<float>(strength.core.inside);
    outside = static_cast<float>(strength.core.outside);
    hardening = static_cast<float>(strength.hardening_npm2);
    hardening_length = static_cast<float>(strength.hardening_length_m);
    rigid_slope = static_cast<float>(strength.rigid_npm2);
    while (cabin_band < profile_bands && profile_edges_m[cabin_band] < strength.core.floor_m) {
      ++cabin_band;
    }
    for (std::size_t band = lowest_pressing_band; band < profile_bands; ++band) {
      // The lowest band bears for what is below, which does not press.
      const double low_m = band == lowest_pressing_band ? 0.0 : profile_edges_m[band];
      share[band] =
          static_cast<float>(factor * strength.share_of_band(low_m, profile_edges_m[band + 1]));
    }
  }

  Side front;
  Side flank;
  Side rear;
  // Places in body axes, m.
  float rails = 0.0F;  ///< half the distance between the outer sides of the rails
  float cage = 0.0F;   ///< half the width of the passenger compartment
  float cage_front = 0.0F;
  float cage_rear = 0.0F;
  float engine = 0.0F;   ///< length of the rigid engine in the front
  float inside = 1.0F;   ///< strength factor in the core
  float outside = 1.0F;  ///< strength factor outside the core
  float hardening = 0.0F;
  float hardening_length = 0.0F;
  float rigid_slope = 0.0F;
  std::array<float, profile_bands> share{};  ///< share of the strength in each height band
  std::size_t cabin_band = 0;                ///< lowest height band of the compartment
  bool rigid = false;
};

}  // namespace crashrank::detail
