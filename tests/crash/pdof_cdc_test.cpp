#include "crashrank/crash/contact_law.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace crashrank {
namespace {

using Eigen::Vector3d;

TEST(Pdof, CountsClockwiseFromAhead) {
  const Vector3d ahead(1, 0, 0);
  EXPECT_EQ(pdof_deg({-5, 0, 0}, ahead), 0.0);
  EXPECT_EQ(pdof_deg({0, 5, 0}, ahead), 90.0);
  EXPECT_EQ(pdof_deg({5, 0, 0}, ahead), 180.0);
  EXPECT_EQ(pdof_deg({0, -5, 0}, ahead), 270.0);
  EXPECT_NEAR(pdof_deg({-1, -1, 7}, ahead), 315.0, 1e-12);
  EXPECT_EQ(pdof_deg({0, 0, 3}, ahead), 0.0);
  EXPECT_NEAR(pdof_deg({-1, -1e-300, 0}, ahead), 0.0, 1e-12);
  EXPECT_LT(pdof_deg({-1, -1e-300, 0}, ahead), 360.0);
  EXPECT_NEAR(pdof_deg({0, -5, 0}, {0, 1, 0}), 0.0, 1e-12);
}

TEST(Pdof, TurnsWithTheBodyAndMirrors) {
  constexpr std::uint64_t seed = 301;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  test::Random random(seed);
  for (int i = 0; i < 1000; ++i) {
    const double heading = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double from = random.uniform(0.0, 360.0);
    const double world = heading - from * std::numbers::pi / 180.0;
    const double size = random.uniform(0.1, 1e5);
    const Vector3d forward(std::cos(heading), std::sin(heading), 0.0);
    const Vector3d impulse = -size * Vector3d(std::cos(world), std::sin(world), 0.0);
    ASSERT_NEAR(std::remainder(pdof_deg(impulse, forward) - from, 360.0), 0.0, 1e-9);
    const Vector3d mirror(1, -1, 1);
    const double mirrored = pdof_deg(impulse.cwiseProduct(mirror), forward.cwiseProduct(mirror));
    ASSERT_NEAR(std::remainder(mirrored + from, 360.0), 0.0, 1e-9);
  }
}

TEST(Pdof, ClockDirectionsReachFifteenDegreesToEitherSide) {
  EXPECT_EQ(clock_of(0.0), 12);
  EXPECT_EQ(clock_of(14.999), 12);
  EXPECT_EQ(clock_of(15.0), 1);
  EXPECT_EQ(clock_of(90.0), 3);
  EXPECT_EQ(clock_of(344.999), 11);
  EXPECT_EQ(clock_of(345.0), 12);
  EXPECT_EQ(clock_of(359.999), 12);
}

Deformation front_damage() {
  Deformation d;
  d.body.min = {-1, -0.9F, 0};
  d.body.max = {3.8F, 0.9F, 1.45F};
  d.region.min = {3.3F, -0.9F, 0.2F};
  d.region.max = {3.8F, 0.9F, 0.8F};
  d.depth_m = 0.5;
  return d;
}

TEST(Cdc, CodesStateWhereAndHow) {
  Deformation d = front_damage();
  EXPECT_EQ(cdc_code(d), "12FDEW2");
  d.region.min.y() = 0.4F;
  d.pdof_deg = 340;
  EXPECT_EQ(cdc_code(d), "11FLEW2");
  d.region.min.y() = 0.55F;
  EXPECT_EQ(cdc_code(d), "11FLEN2");
  d.region.min = {-0.8F, 0.7F, 0.2F};
  d.region.max = {3.5F, 0.9F, 0.8F};
  d.pdof_deg = 350;
  d.sideswipe = true;
  d.depth_m = 0.1;
  EXPECT_EQ(cdc_code(d), "12LDES1");
  d.region.min = {0.8F, -0.9F, 0.2F};
  d.region.max = {2.0F, -0.4F, 1.2F};
  d.pdof_deg = 90;
  d.sideswipe = false;
  d.depth_m = 0.5;
  EXPECT_EQ(cdc_code(d), "03RPAW3");
  d.region = Box{};
  EXPECT_EQ(cdc_code(d), "");
}

TEST(Cdc, AMirrorExchangesLeftAndRight) {
  constexpr std::uint64_t seed = 302;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  test::Random random(seed);
  const auto swapped = [](char c) { return c == 'L' ? 'R' : (c == 'R' ? 'L' : c); };
  for (int i = 0; i < 2000; ++i) {
    Deformation d = front_damage();
    for (int axis = 0; axis < 3; ++axis) {
      const double low = static_cast<double>(d.body.min[axis]);
      const double high = static_cast<double>(d.body.max[axis]);
      const double p = random.uniform(low, high);
      const double q = random.uniform(low, high);
      d.region.min[axis] = static_cast<float>(std::min(p, q));
      d.region.max[axis] = static_cast<float>(std::max(p, q));
    }
    d.depth_m = random.uniform(0.0, 1.0);
    d.pdof_deg = random.uniform(0.0, 360.0);
    const std::string code = cdc_code(d);
    ASSERT_EQ(code.size(), 7U);
    Deformation m = d;
    m.region.min.y() = -d.region.max.y();
    m.region.max.y() = -d.region.min.y();
    m.pdof_deg = std::fmod(360.0 - d.pdof_deg, 360.0);
    const std::string mirrored = cdc_code(m);
    ASSERT_EQ((std::stoi(code.substr(0, 2)) + std::stoi(mirrored.substr(0, 2))) % 12, 0);
    ASSERT_EQ(mirrored[2], swapped(code[2]));
    ASSERT_EQ(mirrored.substr(4), code.substr(4));
    if (code[2] == 'L' || code[2] == 'R') {
      ASSERT_EQ(mirrored[3], code[3]);
    } else if (code[3] == 'L' || code[3] == 'C' || code[3] == 'R' || code[3] == 'D') {
      ASSERT_EQ(mirrored[3], swapped(code[3]));
    } else {
      ASSERT_EQ(mirrored[3], code[3] == 'Y' ? 'Z' : 'Y');
    }
    ASSERT_DOUBLE_EQ(damage_depth_m(d.region, d.body), damage_depth_m(m.region, m.body));
  }
}

TEST(Cdc, DamageDepthIsCountedFromTheNearestFace) {
  Deformation d = front_damage();
  EXPECT_NEAR(damage_depth_m(d.region, d.body), 0.5, 1e-6);
  d.region.min = {0.8F, -0.9F, 0.2F};
  d.region.max = {2.0F, -0.4F, 1.2F};
  EXPECT_NEAR(damage_depth_m(d.region, d.body), 0.5, 1e-6);
  EXPECT_EQ(damage_depth_m(Box{}, d.body), 0.0);
}

}  // namespace
}  // namespace crashrank
