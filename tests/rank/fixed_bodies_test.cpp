#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::of;
using scenes::Scene;

constexpr double driven_mps = 15.0;
constexpr double half_length_m = 2.0;
constexpr double half_width_m = 0.9;
constexpr double pole_half_m = 0.15;
constexpr double overlap_m = 0.01;
constexpr double pole_x_m = 15.0;
constexpr double wall_face_m = 17.0;

/// A car of 1,000 kg on ice.
Scene ice() {
  Scene scene;
  const TriangleMesh car =
      box_mesh({static_cast<float>(half_length_m), static_cast<float>(half_width_m), 0.7F}, 8,
               {0.0F, 0.0F, 0.7F});
  scene.scenario.ego.model = scene.add_model("car", car, BodyKind::car, 1000.0);
  scene.scenario.ego.speed_mps = driven_mps;
  scene.scenario.horizon_s = 3.0;
  scene.scenario.measure = Measure::harm;
  scene.scenario.grip = 0.01;
  scene.scenario.harm.intervals = false;
  scene.add_candidate("on", 0.0);
  return scene;
}

/// A pole whose edge is 1 cm inside the path of the right flank of the car.
void add_pole(Scene& scene) {
  const std::size_t pole =
      scene.add_model("pole", box_mesh({0.15F, 0.15F, 2.0F}, 2, {0, 0, 2}), BodyKind::pole);
  scene.add_actor("pole", pole, pole_x_m, -(half_width_m + pole_half_m - overlap_m));
}

/// A wall of 12 m across the path, divided into parts of equal width, from right to left.
void add_wall(Scene& scene, int parts) {
  const double half_m = 6.0 / parts;
  const std::size_t part =
      scene.add_model("part", box_mesh({0.5F, static_cast<float>(half_m), 1.5F}, 2, {0, 0, 1.5F}),
                      BodyKind::building);
  for (int i = 0; i < parts; ++i) {
    scene.add_actor("wall " + std::to_string(i), part, wall_face_m + 0.5,
                    -6.0 + half_m * (2 * i + 1));
  }
}

std::vector<const Contact*> contacts_with(const RankResult& result, std::size_t first,
                                          std::size_t last) {
  std::vector<const Contact*> found;
  for (const Contact& contact : of(result, "on").contacts) {
    if (contact.actor >= first && contact.actor <= last) found.push_back(&contact);
  }
  return found;
}

// The flank of the car still slides along the pole when its front reaches the wall 2 m behind.
TEST(FixedBodies, SeparateBodiesHaveSeparateContacts) {
  Scene both = ice();
  add_pole(both);
  Scene pole_alone = both;
  add_wall(both, 1);
  Scene wall_alone = ice();
  add_wall(wall_alone, 1);
  const RankResult result = both.ranked();
  const RankResult only_pole = pole_alone.ranked();
  const RankResult only_wall = wall_alone.ranked();
  const auto pole = contacts_with(result, 0, 0);
  const auto wall = contacts_with(result, 1, 1);
  ASSERT_FALSE(pole.empty());
  ASSERT_FALSE(wall.empty());
  EXPECT_EQ(pole.front(), &of(result, "on").contacts.front());
  // Each contact begins when the car has driven there.
  EXPECT_NEAR(pole.front()->time_of_impact_s, (pole_x_m - pole_half_m - half_length_m) / driven_mps,
              1e-3);
  EXPECT_NEAR(wall.front()->time_of_impact_s, (wall_face_m - half_length_m) / driven_mps, 0.01);
  EXPECT_NEAR(wall.front()->closing_speed_mps, driven_mps, 0.02 * driven_mps);
  // The scrape is no more severe than without the wall, the crash about as severe as without the
  // pole.
  const BodyOutcome& brush = pole.front()->severity.ego;
  const BodyOutcome& crash = wall.front()->severity.ego;
  const BodyOutcome& brush_alone = of(only_pole, "on").contacts.front().severity.ego;
  const BodyOutcome& crash_alone = of(only_wall, "on").contacts.front().severity.ego;
  EXPECT_GT(brush.delta_v_mps, 0.0);
  EXPECT_LT(brush.delta_v_mps, 1.2 * brush_alone.delta_v_mps);
  EXPECT_LT(brush.delta_v_mps, 0.02 * driven_mps);
  EXPECT_GT(crash.delta_v_mps, driven_mps);
  EXPECT_NEAR(crash.delta_v_mps, crash_alone.delta_v_mps, 0.02 * crash_alone.delta_v_mps);
  EXPECT_NEAR(crash.crush_m, crash_alone.crush_m, 0.05 * crash_alone.crush_m);
  // The wall pushes from ahead over the full front, the pole touches only the right flank.
  EXPECT_LT(std::min(crash.pdof_deg, 360.0 - crash.pdof_deg), 10.0);
  EXPECT_GT(wall.front()->ego.region.max.y(), 0.8);
  EXPECT_LT(pole.front()->ego.region.max.y(), -0.5);
  // Both tell of the same body.
  EXPECT_EQ(brush.exposure_mps, crash.exposure_mps);
  EXPECT_GE(crash.exposure_mps, 0.99 * crash.delta_v_mps);
}

TEST(FixedBodies, TheOrderOfActorsChangesNoBit) {
  Scene one = ice();
  add_pole(one);
  add_wall(one, 1);
  Scene other = ice();
  add_wall(other, 1);
  add_pole(other);
  const RankResult p = one.ranked();
  const RankResult q = other.ranked();
  const CandidateResult& a = of(p, "on");
  const CandidateResult& b = of(q, "on");
  EXPECT_TRUE(scenes::same_bits(*a.score, *b.score));
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  ASSERT_GE(a.contacts.size(), 2U);
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].actor, 1 - b.contacts[i].actor);
    EXPECT_TRUE(scenes::same_bits(a.contacts[i].time_of_impact_s, b.contacts[i].time_of_impact_s));
    EXPECT_TRUE(
        scenes::same_bits(a.contacts[i].closing_speed_mps, b.contacts[i].closing_speed_mps));
    EXPECT_TRUE(scenes::same_bits(a.contacts[i].severity.ego.delta_v_mps,
                                  b.contacts[i].severity.ego.delta_v_mps));
    EXPECT_EQ(a.contacts[i].ego.triangles, b.contacts[i].ego.triangles);
  }
}

/// Parts of a wall that may each be absent are not joined.
TEST(FixedBodies, PartsOfAWallActAsOneBesideAPole) {
  Scene whole = ice();
  add_pole(whole);
  add_wall(whole, 1);
  const RankResult reference = whole.ranked();
  ASSERT_FALSE(contacts_with(reference, 0, 0).empty());
  ASSERT_FALSE(contacts_with(reference, 1, 1).empty());
  const BodyOutcome& brush = contacts_with(reference, 0, 0).front()->severity.ego;
  const BodyOutcome& crash = contacts_with(reference, 1, 1).front()->severity.ego;
  for (const int parts : {2, 3, 5, 20}) {
    for (const bool uncertain : {false, true}) {
      SCOPED_TRACE(std::to_string(parts) + (uncertain ? " uncertain parts" : " parts"));
      Scene scene = ice();
      add_pole(scene);
      add_wall(scene, parts);
      if (uncertain)
        scene.scenario.actors[static_cast<std::size_t>(1 + parts / 2)].existence_probability =
            0.999;
      const RankResult result = scene.ranked();
      const auto pole = contacts_with(result, 0, 0);
      const auto wall = contacts_with(result, 1, static_cast<std::size_t>(parts));
      ASSERT_EQ(of(result, "on").contacts.size(), of(reference, "on").contacts.size());
      ASSERT_FALSE(pole.empty());
      ASSERT_FALSE(wall.empty());
      EXPECT_NEAR(pole.front()->severity.ego.delta_v_mps, brush.delta_v_mps, 0.02 * driven_mps);
      EXPECT_NEAR(wall.front()->severity.ego.delta_v_mps, crash.delta_v_mps,
                  0.02 * crash.delta_v_mps);
      EXPECT_NEAR(*of(result, "on").score, *of(reference, "on").score,
                  0.02 * *of(reference, "on").score);
    }
  }
}

// The front of the car reaches only the middle one of five parts.
TEST(FixedBodies, AWallIsReportedAsThePartTouchedFirst) {
  Scene scene = ice();
  add_pole(scene);
  add_wall(scene, 5);
  const RankResult result = scene.ranked();
  const auto wall = contacts_with(result, 1, 5);
  ASSERT_FALSE(wall.empty());
  for (const Contact* contact : wall) EXPECT_EQ(contact->actor, 3U);
  EXPECT_FALSE(wall.front()->other.triangles.empty());
}

// A pole in the corner of an L is inside its bounding rectangle and touches neither arm.
TEST(FixedBodies, AnLShapedWallDoesNotAdjoinABodyBetweenItsArms) {
  TriangleMesh angle = box_mesh({0.5F, 4.0F, 1.5F}, 2, {0.0F, 0.0F, 1.5F});
  const TriangleMesh arm = box_mesh({4.0F, 0.5F, 1.5F}, 2, {-4.5F, -3.5F, 1.5F});
  const auto first = static_cast<std::uint32_t>(angle.vertices.size());
  angle.vertices.insert(angle.vertices.end(), arm.vertices.begin(), arm.vertices.end());
  for (auto [a, b, c] : arm.triangles) angle.triangles.push_back({a + first, b + first, c + first});
  Scene scene = ice();
  add_pole(scene);
  scene.add_actor("angle", scene.add_model("angle", std::move(angle), BodyKind::building),
                  wall_face_m + 0.5, 0.0);
  const RankResult result = scene.ranked();
  const auto pole = contacts_with(result, 0, 0);
  const auto walls = contacts_with(result, 1, 1);
  ASSERT_FALSE(pole.empty());
  ASSERT_FALSE(walls.empty());
  EXPECT_LT(pole.front()->severity.ego.delta_v_mps, 0.1 * driven_mps);
  EXPECT_GT(walls.front()->severity.ego.delta_v_mps, driven_mps);
}

// Two blocks before the front of the car, as one wall or with a gap between them.
/// Number of bodies of a scene that the ego touches.
std::size_t bodies_touched(const Scene& scene) {
  std::vector<std::size_t> bodies;
  const RankResult result = scene.ranked();
  for (const Contact& contact : of(result, "on").contacts) {
    if (std::find(bodies.begin(), bodies.end(), contact.actor) == bodies.end()) {
      bodies.push_back(contact.actor);
    }
  }
  return bodies.size();
}

TEST(FixedBodies, PartsWithAJointAreOneBody) {
  const auto contacts = [](double gap_m) {
    Scene scene = ice();
    const std::size_t wall =
        scene.add_model("wall", box_mesh({0.5F, 0.5F, 1.5F}, 2, {0, 0, 1.5F}), BodyKind::building);
    scene.add_actor("left", wall, wall_face_m + 0.5, 0.5 + 0.5 * gap_m);
    scene.add_actor("right", wall, wall_face_m + 0.5, -0.5 - 0.5 * gap_m);
    return bodies_touched(scene);
  };
  EXPECT_EQ(contacts(0.0), 1U);
  EXPECT_EQ(contacts(0.049), 1U);
  EXPECT_EQ(contacts(0.29), 1U);
  EXPECT_EQ(contacts(0.4), 2U);
}

TEST(FixedBodies, APostBeforeAWallIsNotJoinedWithIt) {
  const auto contacts = [](double gap_m) {
    Scene scene = ice();
    const std::size_t wall =
        scene.add_model("wall", box_mesh({0.5F, 4.0F, 1.5F}, 2, {0, 0, 1.5F}), BodyKind::building);
    const std::size_t post =
        scene.add_model("post", box_mesh({0.05F, 0.05F, 1.0F}, 1, {0, 0, 1.0F}), BodyKind::pole);
    scene.add_actor("wall", wall, wall_face_m + 0.5, 0.0);
    scene.add_actor("post", post, wall_face_m - 0.05 - gap_m, 0.2);
    return bodies_touched(scene);
  };
  EXPECT_EQ(contacts(0.04), 1U);
  EXPECT_EQ(contacts(0.06), 2U);
}

/// A car along a rail of ten parts: it does not catch on the end of a part in a joint.
TEST(FixedBodies, ARailWithJointsActsLikeOneWithoutJoints) {
  const auto delta_v = [](double gap_m, double yaw_rad) {
    constexpr float half_m = 2.0F;
    Scene scene = ice();
    scene.scenario.ego.pose = pose_from_angles({0, 0, 0}, yaw_rad, 0, 0);
    const std::size_t part =
        scene.add_model("part", box_mesh({half_m, 0.2F, 0.6F}, 2, {0, 0, 0.6F}), BodyKind::barrier);
    for (int i = 0; i < 10; ++i) {
      scene.add_actor("part " + std::to_string(i), part, 4.0 + i * (2.0 * half_m + gap_m), 3.5);
    }
    const RankResult result = scene.ranked();
    double sum = 0.0;
    for (const Contact& contact : of(result, "on").contacts)
      sum += contact.severity.ego.delta_v_mps;
    return sum;
  };
  for (const double yaw_rad : {0.09, 0.17, 0.35}) {
    const double without = delta_v(0.0, yaw_rad);
    EXPECT_GT(without, 1.0);
    for (const double gap_m : {0.03, 0.06, 0.12, 0.2, 0.29}) {
      EXPECT_NEAR(delta_v(gap_m, yaw_rad) / without, 1.0, 0.1) << gap_m << " m, " << yaw_rad;
    }
  }
}

}  // namespace
}  // namespace crashrank
