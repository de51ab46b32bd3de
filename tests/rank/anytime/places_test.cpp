#include "rank/anytime/ranker_case.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using scenes::Scene;

/// Traffic with manoeuvres, some of them infeasible and some listed twice.
Scene with_ties_and_demands(std::uint64_t seed) {
  oracle::Random random(seed);
  Scene scene = seed % 2 == 0 ? scenes::traffic(seed) : scenes::congestion(seed);
  if (seed % 3 == 0) scenes::add_predictions(random, scene, 2);
  scene.scenario.grid = CandidateGrid{2, 2};
  std::vector<ListedCandidate>& listed = scene.scenario.listed;
  listed.clear();
  for (int i = 0; i < 8; ++i) {
    if (i > 0 && random.chance(0.4)) {
      listed.push_back(listed[static_cast<std::size_t>(
          random.integer(0, static_cast<std::int64_t>(listed.size()) - 1))]);
    } else {
      listed.emplace_back();
      listed.back().acceleration_mps2 = random.real(-16, 6);
      listed.back().steering_rad = random.real(-0.1, 0.1);
    }
    listed.back().name = "listed " + std::to_string(i);
  }
  return scene;
}

struct Seen {
  std::size_t answers = 0;
  std::size_t places = 0;  ///< places that answers leave open, of all candidates
  std::size_t demoted = 0;
  std::size_t tied = 0;
};

void expect_places_hold(const RankResult& partial, const RankResult& whole, Seen& seen) {
  ++seen.answers;
  for (const CandidateResult& told : partial.ranking) {
    const auto last =
        std::find_if(whole.ranking.begin(), whole.ranking.end(),
                     [&](const CandidateResult& each) { return each.candidate == told.candidate; });
    ASSERT_NE(last, whole.ranking.end());
    ASSERT_LE(told.best_place, last->place - 1) << "candidate " << told.candidate;
    ASSERT_GE(told.worst_place, last->place - 1) << "candidate " << told.candidate;
    ASSERT_TRUE(!partial.complete || told.best_place == told.worst_place);
    // Results of the search remain valid.
    if (told.searched) {
      ASSERT_TRUE(told.feasible == last->feasible || partial.infeasible == Infeasible::keep);
      ASSERT_EQ(told.collision_probability, last->collision_probability);
      ASSERT_EQ(told.collides, last->collides);
    }
    if (told.first_touch) {
      ASSERT_TRUE(!told.score || told.contacts.empty());
      ASSERT_EQ(told.first_touch->actor, last->contacts.front().actor);
      ASSERT_EQ(told.first_touch->time_of_impact_s, last->contacts.front().time_of_impact_s);
      ASSERT_EQ(told.first_touch->closing_speed_mps, last->contacts.front().closing_speed_mps);
    }
    seen.places += told.worst_place - told.best_place;
  }
  ASSERT_TRUE(!partial.proved || partial.in_race.front() == whole.ranking.front().candidate);
}

TEST(Places, PartialAnswersContainTheFinalPlace) {
  const std::uint64_t seed = first_seed(1900);
  const std::uint64_t scenes = scenes_to_try(24);
  const std::uint64_t cuts = test::wished("CRASHRANK_RANKER_CUTS", 8);
  Seen seen;
  std::size_t candidates = 0;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed + i));
    const Scene scene = with_ties_and_demands(seed + i);
    RankOptions options = options_of(Measure::harm);
    if (i % 4 == 3) options.infeasible = Infeasible::keep;
    const RankResult whole = scene.ranked(options);
    candidates += whole.ranking.size();
    for (const CandidateResult& c : whole.ranking) {
      seen.demoted += c.feasible ? 0 : 1;
      seen.tied += c.sharing > 1 ? 1 : 0;
    }
    const auto within = [&](const RankBudget& budget) {
      Result<RankResult> result = rank_within(scene.scenario, scene.models, options, budget);
      EXPECT_TRUE(result.ok());
      return result.ok() ? std::move(*result) : RankResult{};
    };
    const RankResult all = within({});
    ASSERT_TRUE(all.complete);
    expect_places_hold(all, whole, seen);
    for (std::uint64_t cut = 0; cut < cuts; ++cut) {
      RankBudget budget;
      budget.work = all.effort->work * cut * cut / (cuts * cuts);
      expect_places_hold(within(budget), whole, seen);
      if (HasFatalFailure()) return;
    }
    RankBudget first;
    first.first_place_only = true;
    expect_places_hold(within(first), whole, seen);
    // A ranking that its caller cancels after some candidates.
    RankOptions ended = options;
    const std::size_t known = i % whole.ranking.size();
    ended.on_progress = [known](std::size_t evaluated, std::size_t) { return evaluated < known; };
    expect_places_hold(scene.ranked(ended), whole, seen);
    if (HasFatalFailure()) return;
  }
  std::printf(
      "%llu scenes from seed %llu, %zu candidates, %zu demoted, %zu tied; %zu answers, which leave "
      "%.2f places open in the mean\n",
      static_cast<unsigned long long>(scenes), static_cast<unsigned long long>(seed), candidates,
      seen.demoted, seen.tied, seen.answers,
      static_cast<double>(seen.places * scenes) /
          static_cast<double>(std::max<std::size_t>(1, seen.answers * candidates)));
  EXPECT_GT(seen.demoted, scenes / 4);
  EXPECT_GT(seen.tied, scenes / 4);
}

}  // namespace
}  // namespace crashrank
