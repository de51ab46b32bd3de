#include "crash/rebound.hpp"

#include "crash/contact_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace crashrank {
namespace {

using test::ContactDraw;
using test::ContactScene;
using test::percentile;
using test::Random;
using test::test_bodies;

ContactOutcome rebound(const ContactScene& scene, double factor) {
  static ContactWorkspace workspace;
  ContactVariant variant;
  variant.restitution = factor;
  return simulate_contact(scene.a, scene.b, {}, scene.point_m, variant, workspace);
}

/// Delta-v of the nominal simulation, scaled for the restitution factor, divided by the delta-v
/// simulated with that factor.
double scaled_over_simulated(const ContactOutcome& plain, const ContactOutcome& varied,
                             double factor) {
  return detail::rebound_gain(plain.restitution, factor) * plain.a.delta_v_mps.norm() /
         varied.a.delta_v_mps.norm();
}

TEST(Rebound, AFactorOfOneChangesNoBit) {
  for (double e = 0.0; e <= 0.5; e += 0.01) {
    EXPECT_EQ(detail::rebound_gain(e, 1.0), 1.0);
    EXPECT_EQ(detail::rebound_loss(e, 1.0), 1.0);
  }
  EXPECT_EQ(detail::rebound_gain(0.4, 1.5), 1.5 / 1.4);
  EXPECT_EQ(detail::rebound_gain(0.0, 1.5), 1.0);
}

TEST(Rebound, FullFrontalHitsAreScaledAsSimulated) {
  for (const double speed : {2.0, 5.0, 10.0, 15.6, 25.0, 40.0}) {
    for (const double factor : {0.0, 0.5, 1.5}) {
      for (const std::size_t other : {std::size_t{5}, std::size_t{0}, std::size_t{1}}) {
        ContactScene scene;
        scene.a = {&test_bodies().movable[0].vehicle,
                   test::flat_pose(0, 0, 0),
                   {{speed, 0, 0}, {0, 0, 0}}};
        scene.b = {&test_bodies().any(other).vehicle,
                   test::flat_pose(20, 0, detail::pi),
                   {{0, 0, 0}, {0, 0, 0}}};
        // Cars drive head-on; the wall is fixed.
        if (other < 5) scene.b.velocity.linear_mps.x() = -speed;
        ASSERT_TRUE(test::move_to_contact(scene, 0.001));
        const ContactOutcome plain = rebound(scene, 1.0);
        const ContactOutcome varied = rebound(scene, factor);
        EXPECT_NEAR(scaled_over_simulated(plain, varied, factor), 1.0, 0.01)
            << test_bodies().any(other).name << " at " << speed << " m/s, factor " << factor;
        const double joules = detail::rebound_loss(plain.restitution, factor) * plain.dissipated_j;
        EXPECT_NEAR(joules / varied.dissipated_j, 1.0, 0.02)
            << test_bodies().any(other).name << " at " << speed << " m/s, factor " << factor;
      }
    }
  }
}

TEST(Rebound, ObliqueHitsAreScaledAsSimulatedWithinAFewPercent) {
  constexpr std::uint64_t seed = 701;
  constexpr int draws = 400;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  std::vector<double> errors;
  std::vector<double> spreads;
  for (int i = 0; i < draws; ++i) {
    const std::size_t a = random.below(3);
    const std::size_t b = random.below(static_cast<std::uint32_t>(test_bodies().size()));
    const double closing = std::exp(random.uniform(std::log(2.0), std::log(40.0)));
    const ContactDraw draw(random);
    ContactScene scene;
    if (!test::make_contact(draw, test_bodies().movable[a].vehicle, test_bodies().any(b).vehicle,
                            closing, 0.001, scene)) {
      continue;
    }
    test::spin(draw, scene);
    const ContactOutcome plain = rebound(scene, 1.0);
    if (!plain.acts || plain.a.delta_v_mps.norm() < 0.1 * closing) continue;
    for (const double factor : {0.5, 1.5}) {
      const ContactOutcome varied = rebound(scene, factor);
      errors.push_back(std::abs(scaled_over_simulated(plain, varied, factor) - 1.0));
      spreads.push_back(std::abs(varied.a.delta_v_mps.norm() / plain.a.delta_v_mps.norm() - 1.0));
    }
  }
  ASSERT_GT(errors.size(), 200U);
  const double median = percentile(errors, 0.5);
  const double high = percentile(errors, 0.95);
  std::printf(
      "%zu contacts: error of delta-v median %.4f, p95 %.4f; median effect of the factor %.4f\n",
      errors.size(), median, high, percentile(spreads, 0.5));
  EXPECT_LT(median, 0.01);
  EXPECT_LT(high, 0.1);
}

}  // namespace
}  // namespace crashrank
