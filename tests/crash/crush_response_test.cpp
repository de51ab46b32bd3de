#include "crash/crush_response.hpp"
#include "crash/crush_curves-inl.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

namespace crashrank {
namespace {

using detail::CrushResponse;
using test::Random;

float log_uniform(Random& random, double low, double high) {
  return static_cast<float>(std::exp(random.uniform(std::log(low), std::log(high))));
}

namespace lanes = detail::HWY_NAMESPACE;

/// One lane of `CrushCurves`; all eight lanes are equal.
struct CrushCurve {
  float yield = 0.0F;
  float slope = 1.0F;
  float length = 0.0F;
  float hardening = 0.0F;
  float hardening_length = 0.0F;
  float rigid = 0.0F;

  HWY_ATTR lanes::CrushCurves eight() const {
    return {lanes::all(yield),
            lanes::all(slope),
            lanes::all(length),
            lanes::all(hardening),
            lanes::all(hardening_length),
            lanes::all(rigid)};
  }
  HWY_ATTR float force_at(float depth) const;
  HWY_ATTR float depth_at(float force) const;
};

HWY_ATTR float any_lane(const lanes::F8& eight) {
  alignas(32) std::array<float, 8> lane{};
  lanes::store(eight, lane.data());
  for (const float value : lane) EXPECT_EQ(value, lane[0]);
  return lane[3];
}

float CrushCurve::force_at(float depth) const {
  return any_lane(eight().force_at(lanes::all(depth)));
}

float CrushCurve::depth_at(float force) const {
  return any_lane(lanes::CrushCorners(eight()).depth_at(lanes::all(force)));
}

struct SharedCrush {
  float force = 0.0F;
  float depth_a = 0.0F;
};

HWY_ATTR SharedCrush share_crush(const CrushCurve& a, const CrushCurve& b, float depth) {
  const lanes::M8 everywhere = lanes::less(lanes::all(0.0F), lanes::all(1.0F));
  const lanes::SharedCrush shared =
      lanes::share_crush(a.eight(), b.eight(), lanes::all(depth), everywhere);
  return {any_lane(shared.force), any_lane(shared.depth_a)};
}

HWY_ATTR float force_at_origin(const CrushResponse& response, std::size_t band, float nx, float ny,
                               float depth) {
  const lanes::F8 zero = lanes::all(0.0F);
  return any_lane(lanes::crush_curves(response, band, zero, zero, lanes::all(nx), lanes::all(ny))
                      .force_at(lanes::all(depth)));
}

HWY_ATTR float inside_compartment(const CrushResponse& response, float x, float y, float nx) {
  return any_lane(
      lanes::inside_compartment(response, lanes::all(x), lanes::all(y), lanes::all(nx)));
}

/// A random curve, sometimes without yield force, crush length limit, hardening or rigid part.
CrushCurve random_curve(Random& random) {
  CrushCurve curve;
  curve.yield = random.below(5) == 0 ? 0.0F : log_uniform(random, 1e2, 1e6);
  curve.slope = log_uniform(random, 3e4, 3e6);
  curve.length = random.below(5) == 0 ? 1e6F : log_uniform(random, 0.05, 2.0);
  curve.hardening = random.below(5) == 0 ? 0.0F : log_uniform(random, 1e3, 1e8);
  curve.hardening_length = log_uniform(random, 0.02, 0.5);
  curve.rigid = random.below(5) == 0 ? 0.0F : log_uniform(random, 1e5, 1e9);
  return curve;
}

constexpr int cases = 20000;

TEST(CrushCurve, DepthInvertsForce) {
  constexpr std::uint64_t seed = 201;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (int i = 0; i < cases; ++i) {
    const CrushCurve curve = random_curve(random);
    const float depth = log_uniform(random, 1e-3, 3.0);
    const float force = curve.force_at(depth);
    // The force has the rounding error of the yield force, which the slope converts to depth.
    const float rounding = 1e-6F * force / curve.slope;
    ASSERT_NEAR(curve.depth_at(force), depth, 1e-4F * depth + rounding) << "case " << i;
    ASSERT_GE(curve.force_at(depth * 1.01F), force) << "case " << i;
    ASSERT_EQ(curve.depth_at(curve.yield), 0.0F);
    ASSERT_EQ(curve.depth_at(0.5F * curve.yield), 0.0F);
  }
}

TEST(CrushCurve, ForceHasItsThreeSlopes) {
  CrushCurve curve;
  curve.yield = 1e5F;
  curve.slope = 1e6F;
  curve.length = 0.5F;
  curve.hardening = 4e6F;
  curve.hardening_length = 0.25F;
  curve.rigid = 1e8F;
  EXPECT_FLOAT_EQ(curve.force_at(0.0F), 1e5F);
  EXPECT_FLOAT_EQ(curve.force_at(0.5F), 6e5F);
  EXPECT_FLOAT_EQ(curve.force_at(0.75F), 1.85e6F);
  EXPECT_FLOAT_EQ(curve.force_at(1.0F), 1.85e6F + 0.25F * 1.05e8F);
}

TEST(ShareCrush, BothCurvesHaveTheSameForce) {
  constexpr std::uint64_t seed = 202;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  double most = 0.0;
  for (int i = 0; i < cases; ++i) {
    const CrushCurve a = random_curve(random);
    const CrushCurve b = random_curve(random);
    const float depth = log_uniform(random, 1e-3, 3.0);
    const SharedCrush shared = share_crush(a, b, depth);
    ASSERT_GE(shared.depth_a, 0.0F) << "case " << i;
    ASSERT_LE(shared.depth_a, depth) << "case " << i;
    ASSERT_GE(shared.force, std::min(a.yield, b.yield) * (1.0F - 1e-5F)) << "case " << i;
    // The depths of both curves at that force add up to the total.
    const float own = a.depth_at(shared.force);
    const float other = b.depth_at(shared.force);
    const float rounding = 1e-6F * shared.force * (1.0F / a.slope + 1.0F / b.slope);
    ASSERT_NEAR(own + other, depth, 1e-4F * depth + rounding) << "case " << i;
    ASSERT_NEAR(own, shared.depth_a, 1e-4F * depth + rounding) << "case " << i;
    // A body above its yield force has the force that belongs to its own depth.
    for (const auto& [curve, part] :
         {std::pair{&a, shared.depth_a}, std::pair{&b, depth - shared.depth_a}}) {
      if (shared.force <= curve->yield * 1.0001F) continue;
      const float steepest = curve->slope + curve->hardening + curve->rigid;
      const float expected = curve->force_at(part);
      most = std::max(most, static_cast<double>(std::abs(expected - shared.force) / shared.force));
      ASSERT_NEAR(expected, shared.force,
                  1e-4F * shared.force + steepest * (1e-6F * depth + rounding))
          << "case " << i;
    }
  }
  std::printf("forces differ by at most %.3g\n", most);
}

TEST(ShareCrush, RisesWithTheDepth) {
  constexpr std::uint64_t seed = 203;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (int i = 0; i < cases / 20; ++i) {
    const CrushCurve a = random_curve(random);
    const CrushCurve b = random_curve(random);
    SharedCrush before;
    for (float depth = 0.002F; depth < 3.0F; depth *= 1.2F) {
      const SharedCrush shared = share_crush(a, b, depth);
      ASSERT_GE(shared.force, before.force) << "case " << i << " at " << depth;
      ASSERT_GE(shared.depth_a, before.depth_a - 1e-6F * depth) << "case " << i << " at " << depth;
      before = shared;
    }
  }
}

TEST(ShareCrush, ExchangeOfTheCurvesExchangesTheDepths) {
  constexpr std::uint64_t seed = 204;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (int i = 0; i < cases; ++i) {
    const CrushCurve a = random_curve(random);
    const CrushCurve b = random_curve(random);
    const float depth = log_uniform(random, 1e-3, 3.0);
    const SharedCrush one = share_crush(a, b, depth);
    const SharedCrush other = share_crush(b, a, depth);
    ASSERT_NEAR(one.force, other.force, 1e-5F * one.force) << "case " << i;
    ASSERT_NEAR(one.depth_a + other.depth_a, depth, 1e-4F * depth) << "case " << i;
  }
}

TEST(CrushResponse, ForcesOfAllBandsAddUpToTheLaw) {
  CrushStrength strength;
  strength.front = {100e3, 1000e3, 0.5};
  strength.side = {50e3, 500e3, 0.3};
  strength.rear = {80e3, 700e3, 0.4};
  strength.low_m = 0.0;
  strength.high_m = 1.0;
  const CrushResponse response(strength, 2.0);
  EXPECT_FALSE(response.rigid);
  const auto sum = [&](float nx, float ny, float depth) {
    double force = 0.0;
    for (std::size_t band = 0; band < profile_bands && profile_edges_m[band] < 1.0; ++band) {
      force += static_cast<double>(force_at_origin(response, band, nx, ny, depth));
    }
    return force;
  };
  // Pressed from the front, the left and the rear: the normals of the pressing pieces point inward.
  EXPECT_NEAR(sum(-1, 0, 0.2F), 2 * (100e3 + 0.2 * 1000e3), 1.0);
  EXPECT_NEAR(sum(0, -1, 0.2F), 2 * (50e3 + 0.2 * 500e3), 1.0);
  EXPECT_NEAR(sum(1, 0, 0.2F), 2 * (80e3 + 0.2 * 700e3), 1.0);
  EXPECT_TRUE(CrushResponse(CrushStrength::unyielding(), 1.0).rigid);
}

TEST(CrushResponse, IntrusionIsMeasuredFromTheNearestSide) {
  CrushStrength strength;
  strength.core.cage_half_width_m = 0.7;
  strength.core.cage_front_m = 2.0;
  strength.core.cage_rear_m = 0.5;
  const CrushResponse response(strength, 1.0);
  EXPECT_FLOAT_EQ(inside_compartment(response, 1.75F, 0.0F, -1.0F), 0.25F);
  EXPECT_FLOAT_EQ(inside_compartment(response, 0.6F, 0.0F, -1.0F), 0.1F);
  EXPECT_FLOAT_EQ(inside_compartment(response, 1.2F, -0.5F, -1.0F), 0.2F);
  EXPECT_LE(inside_compartment(response, 2.5F, 0.0F, -1.0F), 0.0F);
  EXPECT_LE(inside_compartment(response, 1.2F, 0.8F, -1.0F), 0.0F);
}

}  // namespace
}  // namespace crashrank
