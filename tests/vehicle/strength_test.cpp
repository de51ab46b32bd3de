#include "crashrank/internal/vehicle/strength.hpp"

#include "crashrank/mesh/profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace crashrank {
namespace {

/// Sum of a car's core shares over its width, over the width: 1 if the core keeps the mean.
double mean_over_width(const CrushStrength& s, double width, bool caged) {
  constexpr int strips = 20000;
  double sum = 0.0;
  for (int i = 0; i < strips; ++i) {
    const double y = width * ((i + 0.5) / strips - 0.5);
    const double half = caged ? s.core.cage_half_width_m : s.core.rails_half_width_m;
    sum += std::abs(y) < half ? s.core.inside : s.core.outside;
  }
  return sum / strips;
}

TEST(Strength, FullWidthIsCampbellsLine) {
  constexpr double without_inertia = 0.92;
  for (const double mass : {900.0, 1500.0, 2400.0}) {
    CarShape shape;
    shape.mass_kg = mass;
    const CrushStrength s = car_strength(shape);
    EXPECT_NEAR(mean_over_width(s, shape.width_m, false), 1.0, 0.02);
    // Speed and residual crush of Campbell's line: v = 2.2 m/s + 26.8 1/s · C.
    for (double crush = 0.0; crush < s.front.length_m; crush += 0.1) {
      const double speed = 2.2 + 26.8 * crush;
      const double energy =
          0.5 * mass * 2.2 * 2.2 +
          shape.width_m * (s.front.yield_npm * crush + 0.5 * s.front.slope_npm2 * crush * crush) /
              without_inertia;
      EXPECT_NEAR(energy, 0.5 * mass * speed * speed, 0.02 * 0.5 * mass * speed * speed)
          << mass << " kg, " << crush << " m";
    }
  }
}

TEST(Strength, BandsShareTheWholePressure) {
  CrushStrength s;
  s.low_m = 0.2;
  s.high_m = 0.8;
  s.rest = 0.25;
  double load = 0.0;
  for (std::size_t band = 0; band < profile_bands; ++band) {
    const double low = profile_edges_m[band];
    const double high = profile_edges_m[band + 1];
    const double share = s.share_of_band(low, high);
    EXPECT_GT(share, 0.0);
    if (low >= 0.2 && high <= 0.8) load += share;
    if (low >= 0.8) {
      EXPECT_NEAR(share, 0.25 * (high - low) / 0.6, 1e-12);
    }
  }
  EXPECT_NEAR(load, 1.0, 1e-12);
  // A band cut in two shares the same.
  EXPECT_NEAR(s.share_of_band(0.1, 0.3) + s.share_of_band(0.3, 1.1), s.share_of_band(0.1, 1.1),
              1e-12);
}

TEST(Strength, AHeavierCarIsStronger) {
  CarShape light;
  CarShape heavy;
  heavy.mass_kg = 2.0 * light.mass_kg;
  const CrushStrength p = car_strength(light);
  const CrushStrength q = car_strength(heavy);
  EXPECT_NEAR(q.front.yield_npm, 2.0 * p.front.yield_npm, 1e-6 * q.front.yield_npm);
  EXPECT_NEAR(q.front.slope_npm2, 2.0 * p.front.slope_npm2, 1e-6 * q.front.slope_npm2);
  EXPECT_LT(p.side.yield_npm, p.front.yield_npm);
  EXPECT_LT(p.rear.slope_npm2, p.front.slope_npm2);
}

TEST(Strength, TheCoreLiesInsideTheCar) {
  const CarShape shape;
  const CrushStrength s = car_strength(shape);
  EXPECT_LT(s.core.rails_half_width_m, s.core.cage_half_width_m);
  EXPECT_LT(s.core.cage_half_width_m, 0.5 * shape.width_m);
  EXPECT_LT(s.core.cage_rear_m, s.core.cage_front_m);
  EXPECT_LT(s.core.cage_front_m, shape.rear_axle_x_m + shape.wheelbase_m);
  EXPECT_GT(s.core.cage_rear_m, shape.rear_axle_x_m);
  // The free crush length ends before the compartment.
  EXPECT_LE(s.front.length_m, shape.front_x_m - s.core.cage_front_m);
  EXPECT_LE(s.rear.length_m, s.core.cage_rear_m - shape.rear_x_m);
  EXPECT_GT(s.core.inside, 1.0);
  EXPECT_LT(s.core.outside, 1.0);
  EXPECT_TRUE(CrushStrength::unyielding().rigid);
  EXPECT_FALSE(s.rigid);
}

TEST(Strength, AHoneycombFoldsAtItsPressure) {
  const Honeycomb honeycomb{0.342e6, 0.54, 0.2, 0.85};
  const CrushStrength s = honeycomb_strength(honeycomb);
  EXPECT_FALSE(s.rigid);
  for (const CrushLaw& law : {s.front, s.side, s.rear}) {
    EXPECT_EQ(law.length_m, honeycomb.depth_m);
    // A wall of the honeycomb's height: the pressure times the area, within 1 % at any depth.
    const double share = s.share_of_band(honeycomb.low_m, honeycomb.high_m);
    for (const double crush : {0.0, 0.54}) {
      const double pressure = (law.yield_npm + law.slope_npm2 * crush) * share / 0.65;
      EXPECT_NEAR(pressure, honeycomb.pressure_pa, 0.01 * honeycomb.pressure_pa);
    }
  }
}

}  // namespace
}  // namespace crashrank
