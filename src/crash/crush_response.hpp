#pragma once

#include "crashrank/vehicle/strength.hpp"

#include "crashrank/mesh/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace crashrank::detail {

/// Resistance at one place of a body, per metre of outline of one height band, over crush depth:
/// yield + slope·c, steeper by `hardening` from `length` on and by `rigid` after `hardening_length`
/// more. Strictly rising.
struct CrushCurve {
  float yield = 0.0F;             ///< N/m
  float slope = 1.0F;             ///< N/m², > 0
  float length = 0.0F;            ///< m
  float hardening = 0.0F;         ///< N/m²
  float hardening_length = 0.0F;  ///< m
  float rigid = 0.0F;             ///< N/m²

  /// No curve is longer than the material there is: what the crush of a thin place has used up is
  /// rigid, so that nothing leaves a body through its back. `thickness` in the measure of depths.
  void shorten(float thickness) {
    constexpr float folds = 0.35F;
    constexpr float hardens = 0.2F;
    length = std::min(length, folds * thickness);
    hardening_length = std::min(hardening_length, hardens * thickness);
  }
  float force_at(float depth) const {
    return yield + slope * depth + hardening * std::max(0.0F, depth - length) +
           rigid * std::max(0.0F, depth - length - hardening_length);
  }
  float depth_at(float force) const {
    if (force <= yield) return 0.0F;
    const float first = slope * length;
    const float over_yield = force - yield;
    if (over_yield <= first) return over_yield / slope;
    const float second = (slope + hardening) * hardening_length;
    if (over_yield - first <= second) return length + (over_yield - first) / (slope + hardening);
    return length + hardening_length + (over_yield - first - second) / (slope + hardening + rigid);
  }
};

/// What two bodies bear that are pressed together by a total depth.
struct SharedCrush {
  float force = 0.0F;    ///< N/m, the same on both
  float depth_a = 0.0F;  ///< A's part of the depth, m
};

/// Splits a depth so that both curves bear the same force. The sum of both depths is piecewise
/// linear in the force: walks up its corners, then along the piece.
inline SharedCrush share_crush(const CrushCurve& a, const CrushCurve& b, float depth) {
  const std::array<float, 3> corner_a{
      a.yield, a.yield + a.slope * a.length,
      a.yield + a.slope * a.length + (a.slope + a.hardening) * a.hardening_length};
  const std::array<float, 3> corner_b{
      b.yield, b.yield + b.slope * b.length,
      b.yield + b.slope * b.length + (b.slope + b.hardening) * b.hardening_length};
  const std::array<float, 4> compliance_a{0.0F, 1.0F / a.slope, 1.0F / (a.slope + a.hardening),
                                          1.0F / (a.slope + a.hardening + a.rigid)};
  const std::array<float, 4> compliance_b{0.0F, 1.0F / b.slope, 1.0F / (b.slope + b.hardening),
                                          1.0F / (b.slope + b.hardening + b.rigid)};
  std::size_t in_a = 0;
  std::size_t in_b = 0;
  float force = 0.0F;
  float depth_a = 0.0F;
  float done = 0.0F;
  while (in_a < 3 || in_b < 3) {
    const bool next_is_a = in_b == 3 || (in_a < 3 && corner_a[in_a] <= corner_b[in_b]);
    const float corner = next_is_a ? corner_a[in_a] : corner_b[in_b];
    const float rise = corner - force;
    const float step = rise * (compliance_a[in_a] + compliance_b[in_b]);
    if (done + step >= depth) break;
    done += step;
    depth_a += rise * compliance_a[in_a];
    force = corner;
    ++(next_is_a ? in_a : in_b);
  }
  const float both = compliance_a[in_a] + compliance_b[in_b];
  if (both > 0.0F) {
    const float rise = (depth - done) / both;
    force += rise;
    depth_a += rise * compliance_a[in_a];
  }
  return {force, std::min(depth_a, depth)};
}

/// A body's strength with everything converted once: curves anywhere on it are a few products.
class CrushResponse {
public:
  CrushResponse() = default;
  CrushResponse(const CrushStrength& strength, double factor) : rigid_(strength.rigid) {
    const auto side = [](const CrushLaw& law) {
      return Side{static_cast<float>(law.yield_npm), static_cast<float>(law.slope_npm2),
                  static_cast<float>(std::min(law.length_m, 1e6))};
    };
    front_ = side(strength.front);
    flank_ = side(strength.side);
    rear_ = side(strength.rear);
    const auto bounded = [](double value) {
      return static_cast<float>(std::clamp(value, -1e6, 1e6));
    };
    rails_ = bounded(strength.core.rails_half_width_m);
    cage_ = bounded(strength.core.cage_half_width_m);
    cage_front_ = bounded(strength.core.cage_front_m);
    cage_rear_ = bounded(strength.core.cage_rear_m);
    engine_ = static_cast<float>(strength.core.engine_m);
    inside_ = static_cast<float>(strength.core.inside);
    outside_ = static_cast<float>(strength.core.outside);
    hardening_ = static_cast<float>(strength.hardening_npm2);
    hardening_length_ = static_cast<float>(strength.hardening_length_m);
    rigid_slope_ = static_cast<float>(strength.rigid_npm2);
    for (std::size_t band = 0; band < profile_bands; ++band) {
      share_[band] = static_cast<float>(
          factor * strength.share_of_band(profile_edges_m[band], profile_edges_m[band + 1]));
    }
  }

  bool rigid() const noexcept { return rigid_; }

  /// The curve where a force along (nx, ny), unit, body axes, enters at (x, y): front or rear and
  /// flank blend with the squares of the direction's parts.
  CrushCurve at(std::size_t band, float x, float y, float nx, float ny) const {
    // How far a place is in the core: 1 inside, 0 beside it, even over the width of a rail, so that
    // nothing jumps where a body slides along.
    constexpr float per_ramp = 1.0F / 0.1F;
    const auto ramp = [](float inward) { return std::clamp(inward * per_ramp + 0.5F, 0.0F, 1.0F); };
    const float aside = std::abs(y);
    const float in_rails = ramp(rails_ - aside);
    const float in_cage = std::max(ramp(cage_ - aside), in_rails);
    const float caged = std::min(ramp(cage_front_ - x), ramp(x - cage_rear_));
    const float in_core = in_rails + (in_cage - in_rails) * caged;
    const float share = share_[band] * (outside_ + (inside_ - outside_) * in_core);
    const float ahead = nx * nx;
    const float across = ny * ny;
    const Side& end = nx < 0.0F ? front_ : rear_;
    CrushCurve curve;
    curve.yield = share * (ahead * end.yield + across * flank_.yield);
    curve.slope = share * (ahead * end.slope + across * flank_.slope);
    const float engine = nx < 0.0F ? engine_ * in_rails : 0.0F;
    curve.length = ahead * (end.length - engine) + across * flank_.length;
    curve.hardening = share_[band] * in_core * hardening_;
    curve.hardening_length = hardening_length_;
    curve.rigid = share_[band] * in_core * rigid_slope_;
    return curve;
  }

  /// How far a place pressed along nx (body axes) lies inside the passenger compartment, m; at most
  /// 0 outside and for bodies without one. From the front the engine arrives before the surface.
  float inside_compartment(float x, float y, float nx) const {
    const float engine = nx < 0.0F && std::abs(y) < rails_ ? nx * nx * engine_ : 0.0F;
    return std::min(std::min(cage_front_ + engine - x, x - cage_rear_), cage_ - std::abs(y));
  }

private:
  struct Side {
    float yield = 0.0F;
    float slope = 1.0F;
    float length = 0.0F;
  };
  Side front_;
  Side flank_;
  Side rear_;
  float rails_ = 0.0F;
  float cage_ = 0.0F;
  float cage_front_ = 0.0F;
  float cage_rear_ = 0.0F;
  float engine_ = 0.0F;
  float inside_ = 1.0F;
  float outside_ = 1.0F;
  float hardening_ = 0.0F;
  float hardening_length_ = 0.0F;
  float rigid_slope_ = 0.0F;
  std::array<float, profile_bands> share_{};
  bool rigid_ = false;
};

}  // namespace crashrank::detail
