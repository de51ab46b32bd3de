#include "crashrank/crash/strength.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace crashrank {
namespace {

/// Slope of a body that is crushed flat, Pa/m: next to rigid.
constexpr double bottomed_papm = 1e8;

double limit_of(const CrushPressure& law) {
  return std::isinf(law.depth_m) ? law.depth_m : law.yield_pa + law.slope_papm * law.depth_m;
}

/// Depth at which a law resists with that pressure.
double depth_at(const CrushPressure& law, double pressure) {
  if (law.rigid || pressure <= law.yield_pa) return 0.0;
  const double limit = limit_of(law);
  if (pressure <= limit) return (pressure - law.yield_pa) / law.slope_papm;
  return law.depth_m + (pressure - limit) / bottomed_papm;
}

/// Work per area to that depth.
double work_to(const CrushPressure& law, double depth) {
  const double even = std::min(depth, law.depth_m);
  const double past = depth - even;
  double work = even * (law.yield_pa + 0.5 * law.slope_papm * even);
  if (past > 0.0) work += past * (limit_of(law) + 0.5 * bottomed_papm * past);
  return work;
}

}  // namespace

CrushPressure pressure_at(const CrushStrength& strength, const Eigen::Vector3d& point_m,
                          const Eigen::Vector2d& inward) {
  CrushPressure pressure;
  pressure.rigid = strength.rigid;
  if (strength.rigid) return pressure;
  const double length = inward.squaredNorm();
  const double ahead = length > 0.0 ? inward.x() * inward.x() / length : 1.0;
  const CrushLaw& end = inward.x() <= 0.0 ? strength.front : strength.rear;
  const bool carries = point_m.z() >= strength.low_m && point_m.z() <= strength.high_m;
  const double share = (carries ? 1.0 : strength.rest) *
                       strength.core.share_at(point_m.x(), point_m.y()) /
                       (strength.high_m - strength.low_m);
  pressure.yield_pa = share * (ahead * end.yield_npm + (1.0 - ahead) * strength.side.yield_npm);
  pressure.slope_papm = share * (ahead * end.slope_npm2 + (1.0 - ahead) * strength.side.slope_npm2);
  pressure.depth_m = ahead >= 0.5 ? end.depth_m : strength.side.depth_m;
  return pressure;
}

SharedCrush share_crush(const CrushPressure& a, const CrushPressure& b, double depth_m) {
  SharedCrush shared;
  if (a.rigid && b.rigid) {
    shared.pressure_pa = std::numeric_limits<double>::infinity();
    return shared;
  }
  if (depth_m <= 0.0) return shared;
  // The sum of both depths is piecewise linear in the pressure: find the piece, then go along it.
  std::array<double, 4> corner{a.yield_pa, b.yield_pa, limit_of(a), limit_of(b)};
  if (a.rigid) corner = {b.yield_pa, b.yield_pa, limit_of(b), limit_of(b)};
  if (b.rigid) corner = {a.yield_pa, a.yield_pa, limit_of(a), limit_of(a)};
  std::sort(corner.begin(), corner.end());
  const auto sum = [&](double pressure) { return depth_at(a, pressure) + depth_at(b, pressure); };
  std::size_t piece = 0;
  while (piece + 1 < corner.size() && std::isfinite(corner[piece + 1]) &&
         sum(corner[piece + 1]) <= depth_m) {
    ++piece;
  }
  const double start = corner[piece];
  const bool last = piece + 1 == corner.size() || !std::isfinite(corner[piece + 1]);
  const double step = last ? std::max(start, 1.0) : corner[piece + 1] - start;
  const double rise = sum(start + step) - sum(start);
  shared.pressure_pa = start + (rise > 0.0 ? step * (depth_m - sum(start)) / rise : 0.0);
  shared.depth_a_m = depth_at(a, shared.pressure_pa);
  shared.depth_b_m = depth_at(b, shared.pressure_pa);
  shared.energy_a_jpm2 = a.rigid ? 0.0 : work_to(a, shared.depth_a_m);
  shared.energy_b_jpm2 = b.rigid ? 0.0 : work_to(b, shared.depth_b_m);
  return shared;
}

CrushStrength car_strength(const CarShape& shape) {
  constexpr double no_crush_mps = 2.2;
  constexpr double test_mps = 15.6;
  constexpr double test_crush_m = 0.5;
  constexpr double b1 = (test_mps - no_crush_mps) / test_crush_m;
  constexpr double rails = 0.6;
  constexpr double cage = 0.82;
  constexpr double behind_axle = 0.14;
  constexpr double outside = 0.1;
  CrushStrength strength;
  strength.front = {shape.mass_kg * no_crush_mps * b1 / shape.width_m,
                    shape.mass_kg * b1 * b1 / shape.width_m};
  strength.side = {0.5 * strength.front.yield_npm, strength.front.slope_npm2};
  strength.rear = {strength.front.yield_npm, 0.8 * strength.front.slope_npm2};
  strength.core.rails_half_width_m = rails * 0.5 * shape.width_m;
  strength.core.cage_half_width_m = cage * 0.5 * shape.width_m;
  strength.core.cage_front_m = shape.rear_axle_x_m + (1.0 - behind_axle) * shape.wheelbase_m;
  strength.core.cage_rear_m = shape.rear_axle_x_m + behind_axle * shape.wheelbase_m;
  strength.core.outside = outside;
  strength.core.inside = (1.0 - outside * (1.0 - rails)) / rails;
  return strength;
}

}  // namespace crashrank
