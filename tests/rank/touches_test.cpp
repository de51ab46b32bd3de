#include "base/random.hpp"
#include "rank/anytime/ranker_case.hpp"
#include "rank/futures_cases.hpp"
#include "rank/scenes.hpp"
#include "rank/shipped_cast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using scenes::of;
using scenes::Scene;
using test::Random;

/// Lateral offsets at which the mirror of the shipped hatch touches a person whom its sides pass
/// by.
constexpr double nearest_m = 1.15;
constexpr double furthest_m = 1.25;
constexpr std::size_t pedestrian = 3;
constexpr std::size_t pole = 5;

Scene empty_street(double speed_mps) {
  Scene scene;
  scenes::name_shipped_cast(scene.scenario);
  scene.models = scenes::shipped_cast();
  scene.scenario.ego.speed_mps = speed_mps;
  scene.scenario.horizon_s = 4.0;
  scene.scenario.measure = Measure::harm;
  scene.add_candidate("on", 0.0);
  scene.add_candidate("brake", -6.0);
  return scene;
}

/// Persons who stand within reach of a mirror, one behind the other.
Scene persons_beside(Random& random) {
  Scene scene = empty_street(random.uniform(5.0, 30.0));
  const std::uint32_t persons = 2 + random.below(4);
  double x = 5.0;
  for (std::uint32_t i = 0; i < persons; ++i) {
    x += random.uniform(1.0, 8.0);
    const double side = random.below(2) == 0 ? 1.0 : -1.0;
    scene.add_actor("person " + std::to_string(i), pedestrian, x,
                    side * random.uniform(nearest_m, furthest_m));
  }
  return scene;
}

bool has_force(const CandidateResult& candidate) {
  return std::any_of(candidate.contacts.begin(), candidate.contacts.end(),
                     [](const Contact& c) { return c.severity.other.delta_v_mps > 0.0; });
}

TEST(Touches, EveryPersonWhomAMirrorBrushesCounts) {
  constexpr std::uint64_t seed = 41;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  int several = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene all = persons_beside(random);
    std::vector<double> sum(all.scenario.listed.size(), 0.0);
    std::vector<std::size_t> touched(sum.size(), 0);
    for (const ScenarioActor& person : all.scenario.actors) {
      Scene alone = all;
      alone.scenario.actors.assign(1, person);
      for (const CandidateResult& c : alone.ranked().ranking) {
        ASSERT_FALSE(has_force(c));
        sum[c.candidate] += c.score.value_or(-1.0);
        touched[c.candidate] += c.collides ? 1 : 0;
      }
    }
    for (const CandidateResult& c : all.ranked().ranking) {
      EXPECT_NEAR(c.score.value_or(-1.0), sum[c.candidate], 1e-12) << "scene " << i;
      ASSERT_EQ(c.contacts.size(), touched[c.candidate]) << "scene " << i;
      for (std::size_t k = 1; k < c.contacts.size(); ++k) {
        EXPECT_LE(c.contacts[k - 1].time_of_impact_s, c.contacts[k].time_of_impact_s);
      }
      if (touched[c.candidate] > 1) ++several;
    }
  }
  std::printf("%d candidates touch several persons\n", several);
  EXPECT_GT(several, 40);
}

// The pole stops the car before its mirror reaches the person behind it.
TEST(Touches, EndWithTheFirstForce) {
  Scene scene = empty_street(15.0);
  scene.add_actor("before", pedestrian, 10.0, 1.15);
  const RankResult brushed = scene.ranked();
  scene.add_actor("behind", pedestrian, 45.0, 1.15);
  EXPECT_EQ(of(scene.ranked(), "on").contacts.size(), 2U);
  scene.add_actor("pole", pole, 20.0, 0.0);
  const RankResult all = scene.ranked();
  const CandidateResult& on = of(all, "on");
  ASSERT_GE(on.contacts.size(), 2U);
  EXPECT_EQ(on.contacts[0].actor, 0U);
  EXPECT_DOUBLE_EQ(on.contacts[0].severity.harm, of(brushed, "on").contacts[0].severity.harm);
  for (const Contact& contact : on.contacts) EXPECT_NE(contact.actor, 1U);
}

// The event of a force shortly after a touch begins with the touch, whose directions count for it.
TEST(Touches, DoNotDependOnTheHeading) {
  const auto harm_at = [](double heading_rad, double pole_m) {
    Scene scene = empty_street(15.0);
    scene.add_actor("brushed", pedestrian, 10.0, 1.15);
    scene.add_actor("pole", pole, pole_m, 0.0);
    scene.scenario.ego.pose = pose_from_angles({0, 0, 0}, heading_rad, 0.0, 0.0);
    for (ScenarioActor& actor : scene.scenario.actors) {
      const Eigen::Vector3d at = scene.scenario.ego.pose.rotation * actor.pose.translation;
      actor.pose = pose_from_angles(at, heading_rad, 0.0, 0.0);
    }
    return scene.ranked();
  };
  int soon = 0;
  for (double pole_m = 11.5; pole_m < 16.0; pole_m += 0.5) {
    const RankResult ahead = harm_at(0.0, pole_m);
    const CandidateResult& on = of(ahead, "on");
    ASSERT_GE(on.contacts.size(), 2U);
    const double gap_s = on.contacts[1].time_of_impact_s - on.contacts[0].time_of_impact_s;
    if (on.contacts[0].actor == 0 && gap_s < 0.2) ++soon;
    for (const double heading_rad : {0.5, 1.570796, 3.0}) {
      const RankResult turned = harm_at(heading_rad, pole_m);
      EXPECT_NEAR(*of(turned, "on").score, *on.score, 1e-3 * *on.score) << pole_m;
    }
  }
  EXPECT_GE(soon, 3);
}

// A parked car slows the ego between a touch and the press on the same person.
TEST(Touches, CountBesideALaterForceOnTheSamePerson) {
  Scene scene = empty_street(30.0);
  scene.scenario.listed.resize(1);
  scene.add_actor("brushed", pedestrian, 18.55, -1.18);
  const double alone = *scene.ranked().ranking.front().score;
  scene.add_actor("parked", 0, 20.8, 0.5).occupants = 0.0;
  for (const bool before : {false, true}) {
    if (before) scene.add_actor("first", pedestrian, 8.0, -1.18);
    const RankResult result = scene.ranked();
    double harm = 0.0;
    int contacts = 0;
    for (const Contact& contact : result.ranking.front().contacts) {
      if (contact.actor != 0) continue;
      harm += contact.severity.harm;
      ++contacts;
    }
    EXPECT_EQ(contacts, 2) << "another person before: " << before;
    EXPECT_GE(harm, alone - 1e-12) << "another person before: " << before;
  }
}

// Parts of a wall that act as one are one contact, whichever is named first.
TEST(Touches, OfJoinedPartsAreOneContact) {
  std::vector<double> energies;
  for (const double side : {1.0, -1.0}) {
    Scene scene = empty_street(15.0);
    scene.scenario.listed.resize(1);
    const std::size_t wall = scene.add_model(
        "wall", scenes::box_mesh({0.2F, 2.0F, 1.0F}, 1, {0, 0, 1.0F}), BodyKind::building);
    scene.add_actor("brushed", pedestrian, 8.0, 1.15);
    scene.add_actor("one", wall, 18.0, 2.0 * side);
    scene.add_actor("two", wall, 18.0, -2.0 * side);
    const RankResult result = scene.ranked(Measure::closing_energy);
    const CandidateResult& on = result.ranking.front();
    EXPECT_EQ(on.contacts.size(), 2U);
    EXPECT_EQ(on.contacts[0].actor, 0U);
    energies.push_back(*on.score);
  }
  EXPECT_DOUBLE_EQ(energies[0], energies[1]);
}

TEST(Touches, HaveTheMeanOverTheFutures) {
  constexpr std::uint64_t seed = 42;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (int i = 0; i < 4; ++i) {
    Scene scene = persons_beside(random);
    for (ScenarioActor& person : scene.scenario.actors) {
      person.existence_probability = random.uniform(0.1, 0.9);
      Prediction stays;
      stays.pose = person.pose;
      stays.probability = random.uniform(0.1, 0.9);
      Prediction walks = stays;
      walks.probability = 1.0 - stays.probability;
      walks.speed_mps = 1.5;
      person.predictions = {stays, walks};
    }
    futures::expect_mean_of_singles(scene, futures::options_with(i == 0));
  }
}

TEST(Touches, AreTheSameForARanker) {
  constexpr std::uint64_t seed = 43;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (int i = 0; i < 12; ++i) {
    Scene scene = persons_beside(random);
    for (ScenarioActor& person : scene.scenario.actors) {
      if (random.below(2) == 0) person.existence_probability = random.uniform(0.1, 0.9);
    }
    for (const Measure measure : {Measure::harm, Measure::closing_energy}) {
      const Case c(scene, measure);
      Ranker ranker = c.ranker(measure);
      constexpr std::uint64_t cuts = 8;
      const std::uint64_t all = ranker.rank(c.candidates).effort.work;
      for (std::uint64_t cut = 0; cut <= cuts; ++cut) {
        RankBudget budget;
        budget.work = all * cut / cuts;
        const RankerAnswer answer = ranker.rank(c.candidates, budget);
        EXPECT_TRUE(answer.complete || cut < cuts);
        for (const RankedCandidate& told : answer.ranking) {
          const double score = c.scores[told.candidate];
          EXPECT_LE(told.interval.lowest, score) << "scene " << i << ", cut " << cut;
          EXPECT_GE(told.interval.highest, score) << "scene " << i << ", cut " << cut;
          EXPECT_TRUE(!told.known || scenes::same_bits(told.score, score));
          EXPECT_TRUE(told.known || cut < cuts);
        }
      }
    }
  }
}

}  // namespace
}  // namespace crashrank
