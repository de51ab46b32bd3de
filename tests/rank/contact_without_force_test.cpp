#include "campaign.hpp"
#include "rank/random_scene.hpp"
#include "rank/scenes.hpp"
#include "rank/shipped_cast.hpp"

#include "crashrank/motion/time_of_impact.hpp"
#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "crashrank/scenario/scenario_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

/// A car whose front is at x = 2 m drives at `speed_mps` over a kerb of 8 cm from x = 12 m on.
Scene car_and_kerb(double speed_mps, double wall_ahead_m) {
  Scene scene;
  scene.scenario.measure = Measure::harm;
  scene.scenario.horizon_s = 3.0;
  scene.scenario.ego.model =
      scene.add_model("car", box_mesh({2, 1, 0.75F}, 1, {0, 0, 0.75F}), BodyKind::car, 1500.0);
  scene.scenario.ego.speed_mps = speed_mps;
  const std::size_t kerb =
      scene.add_model("kerb", box_mesh({0.2F, 5, 0.04F}, 1, {0, 0, 0.04F}), BodyKind::barrier);
  const std::size_t wall =
      scene.add_model("wall", box_mesh({0.5F, 5, 1}, 1, {0, 0, 1}), BodyKind::building);
  scene.add_actor("kerb", kerb, 12.2, 0.0);
  scene.add_actor("wall", wall, 2.5 + wall_ahead_m, 0.0);
  scene.add_candidate("on", 0.0);
  return scene;
}

TEST(ContactWithoutForce, ABodyWithoutOutlineIsTouchedButAddsNoHarm) {
  Scene scene = car_and_kerb(10.0, 100.0);
  const RankResult result = scene.ranked();
  EXPECT_FALSE(result.actors[0].has_outline);
  EXPECT_TRUE(result.actors[1].has_outline);
  const CandidateResult& on = of(result, "on");
  ASSERT_EQ(on.contacts.size(), 1U);
  const Contact& contact = on.contacts.front();
  EXPECT_EQ(contact.actor, 0U);
  EXPECT_NEAR(contact.time_of_impact_s, 1.0, 1e-4);
  EXPECT_NEAR(contact.normal_speed_mps, 10.0, 1e-9);
  EXPECT_TRUE(contact.contact_without_force);
  EXPECT_TRUE(on.futures.front().contact_without_force);
  EXPECT_EQ(*on.score, 0.0);
  // What the energy allows: at most everybody in the ego.
  EXPECT_NEAR(on.score_interval.highest, 1.0, 1e-6);
  scene.scenario.actors.erase(scene.scenario.actors.begin());
  EXPECT_FALSE(of(scene.ranked(), "on").collides);
}

TEST(ContactWithoutForce, ALaterCrashCountsAsWithoutTheBodyThatHasNoOutline) {
  Scene scene = car_and_kerb(10.0, 20.0);
  const CandidateResult over_kerb = of(scene.ranked(), "on");
  ASSERT_EQ(over_kerb.contacts.size(), 2U);
  EXPECT_TRUE(over_kerb.contacts[0].contact_without_force);
  EXPECT_FALSE(over_kerb.contacts[1].contact_without_force);
  scene.scenario.actors.erase(scene.scenario.actors.begin());
  const CandidateResult free = of(scene.ranked(), "on");
  EXPECT_FALSE(free.contacts.front().contact_without_force);
  EXPECT_GT(*free.score, 0.0);
  EXPECT_NEAR(*over_kerb.score, *free.score, 1e-3 * *free.score);
  EXPECT_LT(free.score_interval.highest, over_kerb.score_interval.highest);
}

TEST(ContactWithoutForce, AnEarlierClipHidesNone) {
  Scene scene = car_and_kerb(10.0, 100.0);
  const std::size_t cone =
      scene.add_model("cone", box_mesh({0.1F, 0.1F, 0.3F}, 1, {0, 0, 0.3F}), BodyKind::pole, 1.0);
  scene.add_actor("cone", cone, 7.0, 0.5);
  const CandidateResult clips = of(scene.ranked(), "on");
  ASSERT_EQ(clips.contacts.front().actor, 2U);
  EXPECT_FALSE(clips.contacts.front().contact_without_force);
  EXPECT_TRUE(clips.futures.front().contact_without_force);
  EXPECT_EQ(clips.futures.front().unforced_actor, 0U);
  EXPECT_NEAR(clips.score_interval.highest, 1.0, 1e-6);
  // Nor does one that is pushed along.
  scene.scenario.models[cone].mass_kg = 10.0;
  scene.scenario.actors.back().pose.translation.y() = 0.0;
  const CandidateResult pushes = of(scene.ranked(), "on");
  EXPECT_FALSE(pushes.contacts.front().contact_without_force);
  EXPECT_EQ(pushes.futures.front().unforced_actor, 0U);
  // What throws the ego off its plan leaves open what comes after.
  scene.scenario.models[cone].mass_kg = 800.0;
  const CandidateResult hits = of(scene.ranked(), "on");
  EXPECT_FALSE(hits.futures.front().contact_without_force);
}

TEST(ContactWithoutForce, SlowContactsAreNone) {
  for (const double speed_mps : {0.45, 0.55}) {
    Scene scene = car_and_kerb(speed_mps, 100.0);
    scene.scenario.actors.front().pose.translation.x() = 2.7;
    const CandidateResult on = of(scene.ranked(), "on");
    ASSERT_EQ(on.contacts.size(), 1U);
    EXPECT_EQ(on.contacts.front().contact_without_force, speed_mps > least_forced_speed_mps);
    EXPECT_EQ(on.score_interval.highest > *on.score, speed_mps > least_forced_speed_mps);
  }
}

TEST(ContactWithoutForce, RankerAndRankAgree) {
  for (const double wall_ahead_m : {20.0, 100.0}) {
    Scene scene = car_and_kerb(10.0, wall_ahead_m);
    scene.scenario.harm.intervals = false;
    scene.add_candidate("brake", -9.0);
    const RankResult whole = scene.ranked();
    Result<Ranker> ranker = Ranker::prepare(scene.scenario, scene.models, {});
    ASSERT_TRUE(ranker.ok());
    const RankerAnswer answer = ranker->rank(whole.candidates, {});
    ASSERT_TRUE(answer.status.ok());
    EXPECT_TRUE(answer.complete && answer.proved);
    for (std::size_t place = 0; place < answer.ranking.size(); ++place) {
      const RankedCandidate& ranked = answer.ranking[place];
      const CandidateResult& same = whole.ranking[place];
      ASSERT_EQ(ranked.candidate, same.candidate);
      EXPECT_EQ(ranked.score, *same.score);
      EXPECT_EQ(ranked.interval.highest, same.score_interval.highest);
      EXPECT_EQ(ranked.contact_without_force, same.futures.front().contact_without_force);
    }
  }
}

TEST(ContactWithoutForce, AnEgoWithoutOutlineIsRefused) {
  Scene scene = car_and_kerb(10.0, 20.0);
  std::swap(scene.models[0], scene.models[1]);
  const Result<RankResult> result = rank(scene.scenario, scene.models);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(
      result.error().message(),
      "models.car.mesh: has no material between 0.1 and 4 m over its ground, but the ego needs "
      "it; check its scale, its up axis and its origin on the ground");
}

/// Contacts of the egos in the likeliest futures of rankings.
struct ContactCount {
  std::size_t candidates = 0;  ///< with a contact
  std::size_t without_force = 0;
  std::size_t small_overlaps = 0;  ///< of those without force
};

Result<Motion> shifted_motion(ScenarioActor actor, const Eigen::Vector3d& shift_m) {
  actor.pose.translation += shift_m;
  for (TimedPose& each : actor.poses) each.pose.translation += shift_m;
  return make_motion(actor);
}

/// Returns true if a shift of the other body by 2 cm across the closing velocity avoids the contact
/// for half a second.
bool is_small_overlap(const Scenario& scenario, const std::vector<Model>& models, const Motion& ego,
                      const Contact& contact) {
  constexpr double small_m = 0.02;
  const ScenarioActor& actor = scenario.actors[contact.actor];
  const Eigen::Vector3d aside =
      Eigen::Vector3d(-contact.closing.y(), contact.closing.x(), 0.0).normalized();
  ImpactWorkspace workspace;
  for (const Eigen::Vector3d& direction :
       {aside, Eigen::Vector3d(-aside), Eigen::Vector3d(Eigen::Vector3d::UnitZ()),
        Eigen::Vector3d(-Eigen::Vector3d::UnitZ())}) {
    const Result<Motion> other = shifted_motion(actor, small_m * direction);
    if (!other) continue;
    const Impact impact =
        time_of_impact(models[scenario.ego.model].tree, ego, models[actor.model].tree, *other, 0.0,
                       contact.time_of_impact_s + 0.5, workspace);
    if (impact.state == ImpactState::none || impact.state == ImpactState::grazing) return true;
  }
  return false;
}

void count_contacts(const Scenario& asked, const std::vector<Model>& models, const char* name,
                    ContactCount& count) {
  Scenario scenario = asked;
  scenario.measure = Measure::harm;
  scenario.harm.intervals = false;
  const Result<RankResult> result = rank(scenario, models);
  ASSERT_TRUE(result.ok()) << name << ": " << result.error().message();
  const Scenario likeliest = likeliest_future(scenario);
  for (const CandidateResult& ranked : result->ranking) {
    count.candidates += ranked.contacts.empty() ? 0U : 1U;
    for (const Contact& contact : ranked.contacts) {
      if (!contact.contact_without_force) continue;
      ++count.without_force;
      const Candidate& candidate = result->candidates[ranked.candidate];
      const bool is_small = is_small_overlap(likeliest, models, candidate.motion, contact);
      count.small_overlaps += is_small ? 1U : 0U;
      std::printf(
          "%s, '%s': '%s' after %.3f s at (%.2f, %.2f, %.2f) m, %.1f m/s along the normal%s\n",
          name, candidate.name.c_str(), scenario.actors[contact.actor].name.c_str(),
          contact.time_of_impact_s, contact.point_m.x(), contact.point_m.y(), contact.point_m.z(),
          contact.normal_speed_mps, is_small ? ", overlap under 2 cm" : "");
    }
  }
}

void print_count(const char* scenes, const ContactCount& count) {
  std::printf(
      "%s: %zu candidates with a contact; contacts without force: %zu, and %zu with "
      "overlaps under 2 cm\n",
      scenes, count.candidates, count.without_force - count.small_overlaps, count.small_overlaps);
}

TEST(ContactWithoutForceCampaign, CountsThoseOfShippedScenarios) {
  ContactCount count;
  std::size_t scenarios = 0;
  std::vector<std::filesystem::path> files;
  for (const char* folder : {CRASHRANK_SCENARIOS, CRASHRANK_SCENARIOS "/choosers"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    Result<Scenario> scenario = load_scenario_file(file.string());
    ASSERT_TRUE(scenario.ok()) << file;
    const Result<std::vector<Model>> models = load_scenario_models(*scenario);
    ASSERT_TRUE(models.ok()) << models.error().message();
    count_contacts(*scenario, *models, file.stem().string().c_str(), count);
    ++scenarios;
  }
  print_count((std::to_string(scenarios) + " shipped scenarios").c_str(), count);
  EXPECT_GT(count.candidates, 0U);
}

// In full: CRASHRANK_SCENE_COUNT=10000.
TEST(ContactWithoutForceCampaign, CountsThoseOfRandomScenes) {
  const auto [seed, scenes] = test::scene_campaign(1, 12);
  ContactCount count;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    Scene scene = scenes::traffic(seed + i);
    if (i % 2 == 1) {
      scene.scenario.models.clear();
      scenes::name_shipped_cast(scene.scenario);
      scene.models = scenes::shipped_cast();
    }
    count_contacts(scene.scenario, scene.models, ("seed " + std::to_string(seed + i)).c_str(),
                   count);
  }
  print_count((std::to_string(scenes) + " random scenes").c_str(), count);
  EXPECT_GT(count.candidates, 0U);
}

}  // namespace
}  // namespace crashrank
