#include "crashrank/internal/rank/harm.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

/// A wall across the lane, a person on foot on the left, a parked car on the right.
Scene square() {
  Scene scene;
  const std::size_t car =
      scene.add_model("car", box_mesh({2.0F, 0.9F, 0.7F}, 4, {0, 0, 0.7F}), BodyKind::car, 1400.0);
  const std::size_t wall =
      scene.add_model("wall", box_mesh({0.5F, 2.0F, 1.0F}, 2, {0, 0, 1}), BodyKind::building);
  const std::size_t person = scene.add_model(
      "person", box_mesh({0.2F, 0.3F, 0.85F}, 2, {0, 0, 0.85F}), BodyKind::pedestrian);
  scene.scenario.ego.model = car;
  scene.scenario.ego.speed_mps = 14.0;
  scene.scenario.measure = Measure::harm;
  scene.add_actor("wall", wall, 20.0, 0.0);
  scene.add_actor("person", person, 16.0, 4.5);
  scene.add_actor("standing", car, 20.0, -4.5);
  scene.add_candidate("wall", 0.0);
  scene.add_candidate("wall, a little slower", -0.5);
  scene.add_candidate("person", -2.0, 0.09);
  scene.add_candidate("standing car", 0.0, -0.07);
  return scene;
}

TEST(Order, ByUpperEndsSortsTheIntervalsOfTheOrderByScore) {
  const Scene scene = square();
  const RankResult by_score = scene.ranked();
  RankOptions options;
  options.order = RankOrder::upper;
  const RankResult by_upper = scene.ranked(options);
  ASSERT_EQ(by_upper.ranking.size(), by_score.ranking.size());
  std::vector<CandidateResult> sorted = by_score.ranking;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return a.score_interval.highest < b.score_interval.highest;
  });
  for (std::size_t row = 0; row < sorted.size(); ++row) {
    EXPECT_EQ(by_upper.ranking[row].candidate, sorted[row].candidate);
    EXPECT_EQ(by_upper.ranking[row].score, sorted[row].score);
    EXPECT_EQ(by_upper.ranking[row].best_place, row);
    EXPECT_EQ(by_upper.ranking[row].worst_place, row);
  }
  EXPECT_EQ(by_upper.in_race, std::vector<std::size_t>{sorted.front().candidate});
  for (const RankResult* const each : {&by_score, &by_upper}) {
    const auto named = [each](RankOrder order) {
      return each->ranking[first_by(*each, order)].candidate;
    };
    EXPECT_EQ(named(RankOrder::score), by_score.ranking.front().candidate);
    EXPECT_EQ(named(RankOrder::upper), by_upper.ranking.front().candidate);
  }
}

TEST(Stability, SamplesDeterminePlacesAndSeparability) {
  const RankResult result = square().ranked();
  ASSERT_EQ(result.samples.size(), 132U);
  ASSERT_EQ(range_sample_count(result), 129U);
  for (const CandidateResult& c : result.ranking) {
    ASSERT_EQ(c.sample_scores.size(), result.samples.size());
    EXPECT_NEAR(c.sample_scores.front(), *c.score, 1e-12);
    EXPECT_LE(c.score_interval.lowest, *c.score);
    EXPECT_GE(c.score_interval.highest, *c.score);
  }
  // Recomputes places and shares by brute force.
  const std::size_t count = result.ranking.size();
  for (std::size_t place = 0; place < count; ++place) {
    const CandidateResult& c = result.ranking[place];
    std::size_t best = count;
    std::size_t worst = 0;
    std::size_t turned = 0;
    for (std::size_t s = 0; s < 129; ++s) {
      std::size_t before = 0;
      for (std::size_t other = 0; other < count; ++other) {
        const double theirs = result.ranking[other].sample_scores[s];
        const double ours = c.sample_scores[s];
        const bool ahead = result.ranking[other].place < c.place;
        if (theirs < ours || (theirs == ours && ahead)) ++before;
      }
      best = std::min(best, before);
      worst = std::max(worst, before);
      if (place + 1 < count && result.ranking[place + 1].sample_scores[s] < c.sample_scores[s]) {
        ++turned;
      }
    }
    EXPECT_EQ(c.best_place, best);
    EXPECT_EQ(c.worst_place, worst);
    EXPECT_DOUBLE_EQ(c.overtaken, static_cast<double>(turned) / 129.0);
    EXPECT_EQ(c.place, place + 1);
    double highest = *c.score;
    double lowest = *c.score;
    for (std::size_t s = 129; s < 132; ++s) {
      highest = std::max(highest, c.sample_scores[s]);
      lowest = std::min(lowest, c.sample_scores[s]);
    }
    EXPECT_EQ(c.numerical_interval.lowest, lowest);
    EXPECT_EQ(c.numerical_interval.highest, highest);
    if (place + 1 < count) {
      const CandidateResult& next = result.ranking[place + 1];
      double next_lowest = *next.score;
      for (std::size_t s = 129; s < 132; ++s) {
        next_lowest = std::min(next_lowest, next.sample_scores[s]);
      }
      EXPECT_EQ(c.within_numerical_error, highest >= next_lowest);
    }
    EXPECT_EQ(c.separable, c.overtaken <= separable_share && !c.within_numerical_error);
  }
}

TEST(Stability, EqualCandidatesShareAPlaceAndAreNotSeparable) {
  for (const Measure measure : {Measure::harm, Measure::polygons}) {
    Scene scene = square();
    scene.scenario.measure = measure;
    scene.scenario.listed.clear();
    scene.add_candidate("a", 0.0);
    scene.add_candidate("b", 0.0);
    scene.add_candidate("slower", -4.0);
    scene.add_candidate("c", 0.0);
    scene.add_candidate("past all", 0.0, 0.5);
    const RankResult result = scene.ranked();
    ASSERT_EQ(result.ranking.size(), 5U);
    const CandidateResult& first = of(result, "a");
    EXPECT_EQ(first.sharing, 3U);
    const std::size_t row = first.place - 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const CandidateResult& c = result.ranking[row + i];
      EXPECT_EQ(c.place, first.place);
      EXPECT_EQ(c.sharing, 3U);
      EXPECT_EQ(c.score, first.score);
      EXPECT_EQ(c.best_place, first.best_place);
      EXPECT_EQ(c.worst_place, first.worst_place);
      EXPECT_LE(c.best_place, c.place - 1);
      EXPECT_GE(c.worst_place, c.place - 1);
      if (i < 2) {
        EXPECT_FALSE(c.separable);
      }
    }
    // In the order of the candidates, without the candidate itself.
    EXPECT_EQ(result.ranking[row].candidate, 0U);
    EXPECT_EQ(tied_with(result, row), (std::vector<std::size_t>{1, 3}));
    EXPECT_EQ(tied_with(result, row + 1), (std::vector<std::size_t>{0, 3}));
    EXPECT_EQ(tied_with(result, row + 2), (std::vector<std::size_t>{0, 1}));
    for (std::size_t i = 0; i < 5; ++i) {
      if (result.ranking[i].sharing != 1) continue;
      EXPECT_EQ(result.ranking[i].place, i + 1);
      EXPECT_TRUE(tied_with(result, i).empty());
    }
  }
}

TEST(Stability, EqualScoresOrderedByTieBreaksAreNotSeparable) {
  Scene scene = square();
  scene.scenario.measure = Measure::polygons;
  scene.scenario.listed.clear();
  scene.add_candidate("now", 0.0);
  scene.add_candidate("later", -0.01);
  const RankResult result = scene.ranked();
  ASSERT_EQ(result.ranking[0].score, result.ranking[1].score);
  EXPECT_EQ(result.ranking[0].candidate, 1U);
  EXPECT_EQ(result.ranking[1].place, 2U);
  EXPECT_EQ(result.ranking[0].sharing, 1U);
  EXPECT_FALSE(result.ranking[0].separable);
}

TEST(Stability, AnOrderThatOneMillimetreReversesIsNotSeparable) {
  // The ego hits the end of the wall with an overlap of 5 cm, and again at 1 cm/s less.
  Scene scene = square();
  scene.scenario.listed.clear();
  scene.scenario.actors.clear();
  scene.add_actor("wall", 1, 20.0, 2.0 + 0.9 - 0.05);
  scene.add_candidate("touches", 0.0);
  scene.add_candidate("touches, a little slower", -0.01);
  const RankResult result = scene.ranked();
  const CandidateResult& first = result.ranking[0];
  ASSERT_NE(*first.score, *result.ranking[1].score);
  ASSERT_EQ(first.sharing, 1U);
  EXPECT_TRUE(first.within_numerical_error)
      << first.numerical_interval.lowest << " to " << first.numerical_interval.highest << ", "
      << result.ranking[1].numerical_interval.lowest << " to "
      << result.ranking[1].numerical_interval.highest;
  EXPECT_FALSE(first.separable);
  // Full frontal impacts do not depend on it: with longer steps and with a shift of 1 mm the
  // slower one is better.
  const RankResult square_hits = square().ranked();
  const CandidateResult& fast = of(square_hits, "wall");
  const CandidateResult& slow = of(square_hits, "wall, a little slower");
  EXPECT_LT(slow.numerical_interval.highest, fast.numerical_interval.lowest);
  EXPECT_LT(fast.numerical_interval.highest - fast.numerical_interval.lowest, 0.02 * *fast.score);
}

TEST(Stability, NumericalSamplesAreLastAndOtherwiseNominal) {
  const std::vector<HarmSample> samples = harm_samples(HarmOptions{});
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(is_numerical(samples[i]), i + numerical_samples >= samples.size());
  }
  const HarmSample& plain = samples.front();
  for (std::size_t i = samples.size() - numerical_samples; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].friction, plain.friction);
    EXPECT_EQ(samples[i].strength, plain.strength);
    EXPECT_EQ(samples[i].step, sample_step);
    EXPECT_EQ(samples[i].restitution, plain.restitution);
    EXPECT_EQ(samples[i].model, plain.model);
    EXPECT_EQ(samples[i].occupant_speed, plain.occupant_speed);
    EXPECT_EQ(samples[i].outside_speed, plain.outside_speed);
  }
  EXPECT_EQ(samples[129].shift_m, 0.0);
  EXPECT_EQ(samples[130].shift_m, 0.001);
  EXPECT_EQ(samples[131].shift_m, -0.001);
}

TEST(Stability, ErrorsCommonToBothDoNotReduceSeparability) {
  const RankResult result = square().ranked();
  const CandidateResult& fast = of(result, "wall");
  const CandidateResult& slow = of(result, "wall, a little slower");
  // Their intervals overlap widely, but the slower one is better in every sample.
  EXPECT_LT(*slow.score, *fast.score);
  EXPECT_LT(fast.score_interval.lowest, slow.score_interval.highest);
  for (std::size_t s = 0; s < result.samples.size(); ++s) {
    EXPECT_LT(slow.sample_scores[s], fast.sample_scores[s]);
  }
}

TEST(Stability, WithoutRangesAllSamplesAreEqual) {
  Scene scene = square();
  HarmRanges& r = scene.scenario.harm.ranges;
  r.least_friction = r.most_friction = scene.scenario.harm.friction;
  r.least_strength = r.most_strength = 1.0;
  r.least_restitution = r.most_restitution = 1.0;
  r.least_risk_speed = r.most_risk_speed = 1.0;
  r.all_models = false;
  const RankResult result = scene.ranked();
  EXPECT_EQ(result.samples.size(), 2U + numerical_samples);
  for (std::size_t place = 0; place < result.ranking.size(); ++place) {
    const CandidateResult& c = result.ranking[place];
    EXPECT_NEAR(c.score_interval.lowest, *c.score, 1e-9);
    EXPECT_NEAR(c.score_interval.highest, *c.score, 1e-9);
    EXPECT_EQ(c.best_place, place);
    EXPECT_EQ(c.worst_place, place);
    EXPECT_TRUE(c.separable);
  }
  RankOptions options;
  options.harm = scene.scenario.harm;
  options.harm->intervals = false;
  const RankResult bare = scene.ranked(options);
  EXPECT_TRUE(bare.samples.empty());
  EXPECT_EQ(bare.ranking.front().score, result.ranking.front().score);
}

TEST(Stability, SamplesContainAllCornersOfTheRanges) {
  HarmOptions options;
  const std::vector<HarmSample> samples = harm_samples(options);
  ASSERT_EQ(samples.size(), 129U + numerical_samples);
  for (const RiskModel model : {RiskModel::tum, RiskModel::malliaris_monfort,
                                RiskModel::malliaris_rosen, RiskModel::joksch_monfort}) {
    EXPECT_EQ(std::count_if(samples.begin() + 1, samples.end(),
                            [model](const HarmSample& s) { return s.model == model; }),
              model == options.model ? 35 : 32);
  }
  HarmExposure e;
  e.delta_v_mps = 12.0;
  EXPECT_EQ(harm_of(e, options, samples.front()), harm_of(e, options));
}

TEST(Stability, BoundsHoldForAllDirectionsAndFronts) {
  for (const RiskModel model : {RiskModel::tum, RiskModel::malliaris_monfort,
                                RiskModel::malliaris_rosen, RiskModel::joksch_monfort}) {
    HarmOptions options;
    options.model = model;
    for (const BodyKind kind : {BodyKind::car, BodyKind::pedestrian, BodyKind::bicycle}) {
      for (int step = 1; step < 40; ++step) {
        HarmExposure e;
        e.kind = kind;
        e.delta_v_mps = step;
        e.closing_speed_mps = step;
        const double most = most_harm(e, options);
        for (int side = 0; side < 36; ++side) {
          e.direction = force_direction(10.0 * side);
          for (const double edge : {0.3, 0.6, 0.9, 1.5}) {
            e.leading_edge_m = edge;
            EXPECT_LE(harm_of(e, options), most);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace crashrank
