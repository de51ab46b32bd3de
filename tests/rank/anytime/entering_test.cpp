// Bodies that enter and leave a Ranker, against Rankers that are prepared with them.

#include "rank/anytime/ranker_case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

/// Random traffic in which an actor that moves keeps a place, and the scenario with that actor.
struct Place {
  scenes::Scene scene;
  Scenario kept;
  std::size_t actor = 0;

  static std::optional<Place> draw(std::uint64_t seed, bool uncertain) {
    Place made;
    made.scene = scenes::traffic(seed);
    std::vector<ScenarioActor>& actors = made.scene.scenario.actors;
    const auto moves = [](const ScenarioActor& a) { return a.model < scenes::pole_model; };
    const auto found = std::find_if(actors.begin(), actors.end(), moves);
    if (found == actors.end()) return std::nullopt;
    made.actor = static_cast<std::size_t>(found - actors.begin());
    for (ScenarioActor& each : actors) {
      if (uncertain && moves(each) && &each != &*found) each.existence_probability = 0.6;
    }
    if (uncertain && seed % 2 == 0) found->perception = {0.2, 0.05, 0.5};
    made.kept = made.scene.scenario;
    ScenarioActor& place = made.kept.actors[made.actor];
    place.existence_probability = 0.0;
    place.model = scenes::ego_model;
    place.pose = made.kept.ego.pose;
    place.speed_mps = 0.0;
    return made;
  }

  Result<Ranker> ranker(const Scenario& scenario, Measure measure, unsigned workers = 1) const {
    RankerOptions options;
    options.rank = options_of(measure, workers);
    options.rank.sampled_futures = 8;
    options.limits.candidates = 64;
    return Ranker::prepare(scenario, scene.models, options);
  }
  Status enter(Ranker& ranker, std::size_t model) const {
    const ScenarioActor& own = scene.scenario.actors[actor];
    return ranker.enter(actor, model, *make_motion(own), own.occupants);
  }
  Scenario with_model(std::size_t model) const {
    Scenario changed = scene.scenario;
    changed.actors[actor].model = model;
    return changed;
  }
};

/// Compares answers and explanations in all that a Ranker prepared afresh says.
void expect_same(Ranker& ranker, Ranker& fresh, View<const Candidate> candidates) {
  const RankerAnswer answer = ranker.rank(candidates);
  const RankerAnswer expected = fresh.rank(candidates);
  ASSERT_TRUE(answer.status && expected.status);
  ASSERT_TRUE(expected.complete);
  EXPECT_EQ(answer.hash, expected.hash);
  EXPECT_EQ(answer.basis, expected.basis);
  for (std::size_t i = 0; i < expected.ranking.size(); ++i) {
    const RankedCandidate& is = answer.ranking[i];
    const RankedCandidate& should = expected.ranking[i];
    EXPECT_EQ(is.actor, should.actor);
    EXPECT_EQ(is.time_of_impact_s, should.time_of_impact_s);
    EXPECT_EQ(is.collision_probability, should.collision_probability);
    EXPECT_EQ(is.least_distance_m, should.least_distance_m);
    EXPECT_EQ(is.feasible, should.feasible);
  }
  const Result<RankResult> told = ranker.explain(candidates, answer);
  const Result<RankResult> expected_told = fresh.explain(candidates, expected);
  ASSERT_TRUE(told.ok() && expected_told.ok());
  EXPECT_EQ(told->futures.futures, expected_told->futures.futures);
  for (std::size_t i = 0; i < told->ranking.size(); ++i) {
    EXPECT_EQ(told->ranking[i].score, expected_told->ranking[i].score);
    EXPECT_EQ(told->ranking[i].contacts.size(), expected_told->ranking[i].contacts.size());
  }
}

void expect_equal_to_fresh(bool uncertain, std::uint64_t seeds) {
  std::size_t drawn = 0;
  std::size_t changed = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const std::optional<Place> place = Place::draw(seed, uncertain);
    if (!place) continue;
    ++drawn;
    const std::vector<Candidate> candidates = *make_candidates(place->kept, 4.0);
    const Measure measure = measures[seed % measures.size()];
    SCOPED_TRACE(measure_name(measure));
    SCOPED_TRACE(seed);
    Result<Ranker> ranker = place->ranker(place->kept, measure, 1 + seed % 2);
    Result<Ranker> without = place->ranker(place->kept, measure);
    ASSERT_TRUE(ranker.ok() && without.ok());
    const std::uint64_t before = ranker->rank(candidates).hash;
    for (const std::size_t model :
         {place->scene.scenario.actors[place->actor].model, std::size_t{scenes::truck_model}}) {
      ASSERT_TRUE(place->enter(*ranker, model));
      Result<Ranker> fresh = place->ranker(place->with_model(model), measure);
      ASSERT_TRUE(fresh.ok());
      expect_same(*ranker, *fresh, candidates);
      const RankerAnswer answer = ranker->rank(candidates);
      changed += answer.hash != before ? 1U : 0U;
      EXPECT_EQ(ranker->explain(candidates, answer)->actors[place->actor].model, model);
      ASSERT_TRUE(ranker->leave(place->actor));
      expect_same(*ranker, *without, candidates);
    }
  }
  // Otherwise nothing was tried.
  EXPECT_GT(drawn, seeds / 2);
  EXPECT_GT(changed, drawn / 2);
}

TEST(RankerEntering, AnswersAreThoseOfARankerPreparedWithTheActor) {
  expect_equal_to_fresh(false, scenes_to_try(10));
}

TEST(RankerEntering, SoWithPredictionsAndErrorsOfStates) { expect_equal_to_fresh(true, 6); }

TEST(RankerEntering, MovesWithTheOthers) {
  const std::optional<Place> place = Place::draw(2, false);
  ASSERT_TRUE(place);
  const std::vector<Candidate> candidates = *make_candidates(place->kept, 4.0);
  Result<Ranker> ranker = place->ranker(place->kept, Measure::harm);
  ASSERT_TRUE(ranker.ok());
  std::vector<Motion> motions;
  for (const ScenarioActor& actor : place->scene.scenario.actors) {
    motions.push_back(*make_motion(actor));
  }
  // The motion of a free place is not read.
  std::vector<Motion> unread = motions;
  Pose nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::quiet_NaN();
  unread[place->actor] = Motion::at_rest(nowhere);
  const Pose& start = place->kept.ego.pose;
  EXPECT_TRUE(ranker->move_actors(start, unread));
  const ScenarioActor& own = place->scene.scenario.actors[place->actor];
  ASSERT_TRUE(ranker->enter(place->actor, own.model, Motion::at_rest(start)));
  ASSERT_TRUE(ranker->move_actors(start, motions));
  Result<Ranker> fresh = place->ranker(place->scene.scenario, Measure::harm);
  ASSERT_TRUE(fresh.ok());
  ASSERT_TRUE(fresh->move_actors(start, motions));
  expect_same(*ranker, *fresh, candidates);
}

TEST(RankerEntering, RefusesWhatCannotEnterAndChangesNothing) {
  const std::optional<Place> place = Place::draw(2, false);
  ASSERT_TRUE(place);
  const std::vector<Candidate> candidates = *make_candidates(place->kept, 4.0);
  Result<Ranker> ranker = place->ranker(place->kept, Measure::harm);
  ASSERT_TRUE(ranker.ok());
  const std::uint64_t before = ranker->rank(candidates).hash;
  const Motion still = Motion::at_rest(place->kept.ego.pose);
  const auto code = [](const Status& status) {
    EXPECT_FALSE(status);
    return status ? ErrorCode::internal : status.error().code;
  };
  const std::size_t at = place->actor;
  const std::size_t others = place->kept.actors.size();
  EXPECT_EQ(code(ranker->leave(at)), ErrorCode::usage);
  EXPECT_EQ(code(ranker->leave(others)), ErrorCode::usage);
  EXPECT_EQ(code(ranker->enter(others, scenes::car_model, still)), ErrorCode::usage);
  EXPECT_EQ(code(ranker->enter(at, place->kept.models.size(), still)), ErrorCode::usage);
  EXPECT_EQ(code(ranker->enter(at, scenes::wall_model, still)), ErrorCode::usage);
  for (const double people : {-1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(code(ranker->enter(at, scenes::car_model, still, people)), ErrorCode::bad_input);
  }
  Pose nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(ranker->enter(at, scenes::car_model, Motion::at_rest(nowhere))),
            ErrorCode::bad_input);
  EXPECT_EQ(ranker->rank(candidates).hash, before);
  EXPECT_TRUE(place->enter(*ranker, scenes::car_model));
  EXPECT_EQ(code(place->enter(*ranker, scenes::car_model)), ErrorCode::usage);
  EXPECT_TRUE(ranker->leave(at));
  EXPECT_EQ(ranker->rank(candidates).hash, before);
  // An actor that exists keeps no place.
  Result<Ranker> taken = place->ranker(place->scene.scenario, Measure::harm);
  ASSERT_TRUE(taken.ok());
  EXPECT_EQ(code(taken->leave(at)), ErrorCode::usage);
  EXPECT_EQ(code(taken->enter(at, scenes::car_model, still)), ErrorCode::usage);
}

}  // namespace
}  // namespace crashrank
