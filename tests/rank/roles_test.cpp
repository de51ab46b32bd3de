#include "base/random.hpp"
#include "rank/scenes.hpp"
#include "rank/shipped_cast.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using scenes::Scene;
using test::Random;

struct Kind {
  const char* name;
  BodyKind kind;
};
constexpr std::array<Kind, 4> role_kinds{{{"sedan", BodyKind::car},
                                          {"hatch", BodyKind::car},
                                          {"truck", BodyKind::truck},
                                          {"motorcycle", BodyKind::motorcycle}}};

/// Poses of a body that is at (x, y) at 1 s and moves and turns uniformly, or brakes and turns.
std::vector<TimedPose> drive(double x, double y, double yaw, double speed_mps, double yaw_rate,
                             double braking_mps2) {
  std::vector<TimedPose> poses;
  for (int i = 0; i <= 40; ++i) {
    const double time_s = 0.05 * i;
    const double since_s = time_s - 1.0;
    const double heading = yaw + yaw_rate * since_s;
    const double way = (speed_mps - 0.5 * braking_mps2 * since_s) * since_s;
    poses.push_back({time_s, pose_from_angles({x + way * std::cos(yaw), y + way * std::sin(yaw), 0},
                                              heading, 0.0, 0.0)});
  }
  return poses;
}

/// Two bodies that collide, one of them the ego. Models are made once for all cases.
struct Pair {
  std::array<std::size_t, 2> kind{};
  std::array<std::vector<TimedPose>, 2> poses;

  RankResult ranked(const std::vector<Model>& models, std::size_t ego) const {
    Scene scene;
    for (const std::size_t side : {ego, 1 - ego}) {
      ScenarioModel model;
      model.name = role_kinds[kind[side]].name + std::to_string(side);
      model.kind = role_kinds[kind[side]].kind;
      scene.scenario.models.push_back(model);
    }
    const std::vector<Model> both{models[kind[ego]], models[kind[1 - ego]]};
    scene.scenario.measure = Measure::harm;
    scene.scenario.harm.weights.property_per_mj = 0.25;
    scene.scenario.horizon_s = 2.0;
    scene.scenario.ego.model = 0;
    scene.scenario.ego.pose = poses[ego].front().pose;
    scene.add_candidate("drives", 0.0).poses = poses[ego];
    scene.add_actor("other", 1, 0.0, 0.0).pose = poses[1 - ego].front().pose;
    scene.scenario.actors.back().poses = poses[1 - ego];
    scene.scenario.harm.intervals = false;
    const Result<RankResult> result = rank(scene.scenario, both, {});
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message());
    return result.ok() ? *result : RankResult{};
  }
};

void expect_same_bits(const BodyOutcome& p, const BodyOutcome& q) {
  EXPECT_TRUE(scenes::same_bits(p.delta_v_mps, q.delta_v_mps))
      << p.delta_v_mps << " " << q.delta_v_mps;
  EXPECT_TRUE(scenes::same_bits(p.delta_v_x_mps, q.delta_v_x_mps));
  EXPECT_TRUE(scenes::same_bits(p.delta_v_y_mps, q.delta_v_y_mps));
  EXPECT_TRUE(scenes::same_bits(p.yaw_rate_change_radps, q.yaw_rate_change_radps));
  EXPECT_TRUE(scenes::same_bits(p.pdof_deg, q.pdof_deg));
  EXPECT_TRUE(scenes::same_bits(p.crush_energy_j, q.crush_energy_j));
  EXPECT_TRUE(scenes::same_bits(p.ees_mps, q.ees_mps));
  EXPECT_TRUE(scenes::same_bits(p.crush_m, q.crush_m));
  EXPECT_TRUE(scenes::same_bits(p.intrusion_m, q.intrusion_m));
  EXPECT_TRUE(scenes::same_bits(p.harm, q.harm)) << p.harm << " " << q.harm;
  EXPECT_EQ(p.cdc, q.cdc);
}

TEST(Roles, ExchangingEgoAndOtherChangesNoBitOfTheFirstContact) {
  constexpr std::uint64_t seed = 2601;
  constexpr int cases = 60;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  std::vector<Model> models;
  for (const Kind& kind : role_kinds) models.push_back(scenes::shipped_model(kind.name));
  int met = 0;
  int twins = 0;
  for (int i = 0; i < cases; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    Pair pair;
    for (std::size_t side = 0; side < 2; ++side) {
      pair.kind[side] = random.below(role_kinds.size());
      pair.poses[side] =
          drive(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3.1, 3.1),
                random.uniform(8, 40), random.below(2) == 0 ? 0.0 : random.uniform(-0.5, 0.5),
                random.below(2) == 0 ? 0.0 : random.uniform(0, 8));
    }
    // Two equal cars or trucks: they differ only in pose and motion.
    if (i % 4 == 0) pair.kind[1] = pair.kind[0];
    const RankResult one = pair.ranked(models, 0);
    const RankResult two = pair.ranked(models, 1);
    ASSERT_EQ(one.ranking.size(), 1U);
    ASSERT_EQ(two.ranking.size(), 1U);
    ASSERT_EQ(one.ranking[0].contacts.empty(), two.ranking[0].contacts.empty());
    if (one.ranking[0].contacts.empty()) continue;
    const Contact& p = one.ranking[0].contacts.front();
    const Contact& q = two.ranking[0].contacts.front();
    ASSERT_EQ(p.state, q.state);
    ++met;
    twins += pair.kind[0] == pair.kind[1] ? 1 : 0;
    EXPECT_TRUE(scenes::same_bits(p.time_of_impact_s, q.time_of_impact_s));
    EXPECT_TRUE(scenes::same_bits(p.gap_m, q.gap_m));
    EXPECT_TRUE(scenes::same_bits(p.closing_speed_mps, q.closing_speed_mps));
    EXPECT_TRUE(scenes::same_bits(p.normal_speed_mps, q.normal_speed_mps));
    EXPECT_TRUE(scenes::same_bits(p.closing_energy_j, q.closing_energy_j));
    EXPECT_TRUE((p.normal + q.normal).isZero(0.0));
    EXPECT_TRUE((p.closing + q.closing).isZero(0.0));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(scenes::same_bits(p.point_m[axis], q.point_m[axis]));
    }
    EXPECT_EQ(p.severity.slides, q.severity.slides);
    EXPECT_TRUE(scenes::same_bits(p.severity.duration_s, q.severity.duration_s));
    EXPECT_TRUE(scenes::same_bits(p.severity.dissipated_j, q.severity.dissipated_j));
    EXPECT_TRUE(scenes::same_bits(p.severity.harm, q.severity.harm));
    expect_same_bits(p.severity.ego, q.severity.other);
    expect_same_bits(p.severity.other, q.severity.ego);
  }
  std::printf("%d cases, %d with a contact, %d of them of twins\n", cases, met, twins);
  EXPECT_GT(met, cases / 2);
  EXPECT_GT(twins, cases / 8);
}

}  // namespace
}  // namespace crashrank
