#include "base/random.hpp"
#include "rank/crash_score_cases.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <vector>

namespace crashrank::detail {
namespace {

using test::Random;

constexpr std::array<Measure, 4> scored{Measure::delta_v, Measure::energy, Measure::intrusion,
                                        Measure::harm};
constexpr std::size_t pedestrian = 5;

/// A cell at a time in which a car changes the velocity of a body against its heading.
ExposureCell impact(double time_s, double change_mps) {
  ExposureCell cell;
  cell.index = static_cast<std::int32_t>(time_s / exposure_cell_s);
  cell.action.dvx_mps = -change_mps;
  cell.action.path_mps = change_mps;
  cell.action.edge_m2ps = 0.75 * change_mps;
  return cell;
}

CrashEffects effects_of(std::size_t body, const std::vector<ExposureCell>& cells) {
  CrashEffects effects;
  effects.add(body, cells);
  return effects;
}

double risk_at(const Scene& scene, double change_mps) {
  Exposure e;
  e.delta_v_mps = change_mps;
  return injury_risk(scene.nominal.model, e);
}

TEST(CrashScore, WithoutContactsIsZero) {
  for (const Measure measure : scored) {
    const Scene scene = scene_of(measure);
    EXPECT_EQ(CrashScore().score(scene, {}, scene.nominal), 0.0);
    EXPECT_EQ(CrashScore().lower_bound(scene, {}), 0.0);
  }
}

TEST(CrashScore, OfOneImpactIsTheRiskAtItsExposure) {
  const Scene scene = scene_of(Measure::harm);
  const CrashEffects effects = effects_of(ego_body, {impact(0.1, 12.0)});
  EXPECT_NEAR(CrashScore().score(scene, effects, scene.nominal), risk_at(scene, 12.0), 1e-12);
  const std::vector<PersonRisk> people = CrashScore().people(scene, effects);
  ASSERT_EQ(people.size(), 1U);
  EXPECT_NEAR(people[0].exposure_mps, 12.0, 1e-12);
  EXPECT_NEAR(people[0].exposure_pdof_deg, 0.0, 1e-9);
  EXPECT_NEAR(people[0].exposure_time_s, 0.1, exposure_cell_s);
}

TEST(CrashScore, SeparateImpactsCombineAsProbabilities) {
  const Scene scene = scene_of(Measure::harm);
  const double p = risk_at(scene, 12.0);
  const double q = risk_at(scene, 9.0);
  const CrashEffects apart = effects_of(ego_body, {impact(0.1, 12.0), impact(1.1, 9.0)});
  EXPECT_NEAR(CrashScore().score(scene, apart, scene.nominal), 1.0 - (1.0 - p) * (1.0 - q), 1e-12);
  const CrashEffects together = effects_of(ego_body, {impact(0.1, 12.0), impact(0.2, 9.0)});
  EXPECT_NEAR(CrashScore().score(scene, together, scene.nominal), risk_at(scene, 21.0), 1e-12);
  const Scene speed = scene_of(Measure::delta_v);
  EXPECT_NEAR(CrashScore().score(speed, apart, speed.nominal), 21.0, 1e-12);
}

TEST(CrashScore, ANudgeAtWalkingPaceInjuresNobodySeriously) {
  const Scene scene = scene_of(Measure::harm);
  const auto risk = [&](double change_mps) {
    return CrashScore().score(scene, effects_of(pedestrian, {impact(0.1, change_mps)}),
                              scene.nominal);
  };
  EXPECT_GT(risk(0.5), 0.0);
  EXPECT_LE(risk(1.5), 0.001);
  double before = 0.0;
  for (double v = 0.1; v < 30.0; v += 0.1) {
    const double now = risk(v);
    EXPECT_GE(now, before) << v;
    EXPECT_LE(now - before, 0.01) << v;
    before = now;
  }
  // The curve's own point: 10 % at 29 km/h.
  EXPECT_NEAR(risk(29.0 / 3.6), 0.1, 0.002);
}

/// A random record of a body, with forces from all sides and gaps.
std::vector<ExposureCell> any_cells(Random& random) {
  std::vector<ExposureCell> cells;
  std::int32_t index = 0;
  const std::uint32_t count = 1 + random.below(40);
  for (std::uint32_t i = 0; i < count; ++i) {
    index += 1 + static_cast<std::int32_t>(random.below(8) == 0 ? random.below(100) : 0U);
    ExposureCell cell = impact(0.0, random.uniform(0.0, 4.0));
    cell.index = index;
    cell.action.dvy_mps = random.uniform(-2.0, 2.0);
    cell.action.path_mps += 2.0;
    cell.action.rebound_x_mps = 0.2 * cell.action.dvx_mps;
    cell.action.edge_m2ps = cell.action.path_mps * random.uniform(0.3, 1.5);
    cell.action.light_mps = cell.action.path_mps * random.uniform(0.0, 0.2);
    cell.action.struck_mps = random.uniform(0.0, 12.0);
    cell.action.intruded_m3 = random.uniform(0.0, 0.01);
    cell.action.deepest_m = random.uniform(0.0, 0.05);
    cell.road_mps = static_cast<float>(random.uniform(0.0, 30.0));
    cells.push_back(cell);
  }
  return cells;
}

TEST(CrashScore, LowerBoundsHoldWhileASimulationGoesOn) {
  constexpr std::uint64_t seed = 501;
  constexpr std::array<RiskModel, 4> models{RiskModel::tum, RiskModel::malliaris_monfort,
                                            RiskModel::malliaris_rosen, RiskModel::joksch_monfort};
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  CrashScore scorer;
  for (int i = 0; i < 400; ++i) {
    Scene scene = scene_of(scored[random.below(4)]);
    scene.harm.model = scene.nominal.model = models[random.below(4)];
    const std::size_t other = random.below(6);
    const std::vector<ExposureCell> own = any_cells(random);
    const std::vector<ExposureCell> others = any_cells(random);
    CrashEffects whole;
    whole.add(ego_body, own);
    whole.add(other, others);
    ContactEffect contact;
    contact.dissipated_j = random.uniform(0.0, 1e6);
    whole.contacts.push_back(contact);
    const double score = scorer.score(scene, whole, scene.nominal);
    for (int part = 0; part < 5; ++part) {
      CrashEffects some;
      some.add(ego_body, {own.data(), random.below(static_cast<std::uint32_t>(own.size()) + 1)});
      some.add(other, {others.data(), random.below(static_cast<std::uint32_t>(others.size()) + 1)});
      ASSERT_LE(scorer.lower_bound(scene, some), score) << "case " << i;
    }
    ASSERT_LE(scorer.lower_bound(scene, whole), score) << "case " << i;
  }
}

TEST(CrashScore, SamplesTogetherAndOneByOneAgree) {
  constexpr std::uint64_t seed = 502;
  Random random(seed);
  const Scene scene = scene_of(Measure::harm);
  CrashEffects effects;
  effects.add(ego_body, any_cells(random));
  effects.add(pedestrian, any_cells(random));
  const std::vector<HarmSample> samples = harm_samples(scene.harm);
  std::vector<double> scores(samples.size(), 0.0);
  CrashScore scorer;
  scorer.add_scores(scene, effects, samples, scores.data());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(scores[i], scorer.score(scene, effects, samples[i])) << i;
  }
}

}  // namespace
}  // namespace crashrank::detail
