#include "crashrank/crash/contact_law.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/rank/rank.hpp"

#include "oracle/random.hpp"
#include "rank/random_scene.hpp"
#include "rank/scenes.hpp"
#include "rank/shipped_cast.hpp"

#include "crash/scene_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

// Damage consists of the triangles that the exact collider finds along the motion simulated by the
// contact law. Here the motion comes from a separate simulation, and triangles are tested without
// trees.

namespace crashrank {
namespace {

using Eigen::Vector3d;
using scenes::box_mesh;
using scenes::Scene;

bool holds(const BodyDamage& damage, std::size_t triangle) {
  return std::binary_search(damage.triangles.begin(), damage.triangles.end(),
                            static_cast<std::uint32_t>(triangle));
}

/// The simulation after the first contact of the ego with an actor, set up from the scenario.
class OwnSimulation {
public:
  OwnSimulation(const Scene& scene, const RankResult& result, const CandidateResult& c)
      : contact_(c.contacts.at(0)),
        ego_(describe(scene, scene.scenario.ego.model)),
        other_(describe(scene, scene.scenario.actors[contact_.actor].model)) {
    const Motion& plan = result.candidates[c.candidate].motion;
    const Motion other_plan = *make_motion(scene.scenario.actors[contact_.actor]);
    const detail::Footing footing = detail::footing_of(ego_);
    const detail::Footing other_footing = detail::footing_of(other_);
    detail::SceneOptions options;
    options.variant = {result.harm.friction / 0.3, 1.0, 1.0};
    options.grip = scene.scenario.grip;
    std::array<detail::SceneBody, 2> bodies;
    bodies[0].vehicle = &ego_;
    bodies[0].plan = &plan;
    bodies[0].footing = &footing;
    bodies[1].vehicle = &other_;
    bodies[1].plan = &other_plan;
    bodies[1].footing = other_.movable() ? &other_footing : nullptr;
    for (detail::SceneBody& body : bodies) body.brake = 0.45;
    detail::SceneRun run;
    run.begin({bodies.data(), bodies.size()}, 0, 1, contact_.time_of_impact_s, contact_.point_m,
              options);
    while (run.advance(1000)) {
    }
    outcome = run.contacts()[0].outcome;
  }

  ContactOutcome outcome;

private:
  static Vehicle describe(const Scene& scene, std::size_t index) {
    VehicleFacts facts;
    facts.kind = scene.scenario.models[index].kind;
    facts.mass_kg = scene.scenario.models[index].mass_kg;
    return *describe_vehicle(scene.models[index].mesh, facts);
  }

  const Contact& contact_;
  Vehicle ego_;
  Vehicle other_;
};

/// A car that hits an obstacle at an angle.
Scene car_against(TriangleMesh car, TriangleMesh other, BodyKind kind, double speed_mps, double yaw,
                  double y) {
  Scene scene;
  scene.scenario.ego.model = scene.add_model("car", std::move(car), BodyKind::car, 1500.0);
  const double way_m = 25.0;
  scene.scenario.ego.pose =
      pose_from_angles({-way_m * std::cos(yaw), y - way_m * std::sin(yaw), 0.0}, yaw, 0.0, 0.0);
  scene.scenario.ego.speed_mps = speed_mps;
  scene.scenario.horizon_s = 2.0 * way_m / speed_mps;
  scene.add_actor("other", scene.add_model("other", std::move(other), kind), 2.0, 0.0);
  scene.add_candidate("keep going", 0.0);
  return scene;
}

TriangleMesh car_box() { return box_mesh({2.1F, 0.9F, 0.7F}, 16, {0.0F, 0.0F, 0.7F}); }
TriangleMesh wall_box() { return box_mesh({2.0F, 20.0F, 1.5F}, 1, {0.0F, 0.0F, 1.5F}); }

const CandidateResult& only(const RankResult& result) { return result.ranking.front(); }

// Triangles with a corner inside the wall at a recorded pose are damaged. Damaged triangles reach
// the wall at some pose, up to the displacement between two poses.
TEST(Damage, TrianglesInsideTheWallAlongTheMotionAreDamaged) {
  constexpr std::uint64_t seed = 401;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  oracle::Random random(seed);
  std::size_t inside_count = 0;
  std::size_t sliding = 0;
  for (int round = 0; round < 25; ++round) {
    const double speed = random.real(1.0, 45.0);
    const double yaw = random.real(-1.4, 1.4);
    SCOPED_TRACE("round " + std::to_string(round) + ": " + std::to_string(speed) + " m/s at " +
                 std::to_string(yaw));
    const Scene scene =
        car_against(car_box(), wall_box(), BodyKind::building, speed, yaw, random.real(-3.0, 3.0));
    const RankResult result = scene.ranked();
    const CandidateResult& c = only(result);
    ASSERT_GE(c.contacts.size(), 1U);
    const Contact& contact = c.contacts[0];
    const OwnSimulation own(scene, result, c);
    EXPECT_EQ(own.outcome.a.delta_v_mps.norm(), contact.severity.ego.delta_v_mps);
    EXPECT_EQ(contact.crush_s, own.outcome.motion.poses[own.outcome.motion.count - 1].time_s);
    sliding += own.outcome.slides ? 1 : 0;
    const View<const ContactPoses> record = own.outcome.motion.all();
    const TriangleMesh& mesh = scene.models[0].mesh;
    const Pose wall = record[0].b;
    constexpr double margin_m = 0.01;
    double step_m = 0.1;
    for (std::size_t k = 1; k < record.size(); ++k) {
      step_m = std::max(step_m, (record[k].a.translation - record[k - 1].a.translation).norm());
    }
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      bool inside = false;
      bool near = false;
      for (const ContactPoses& poses : record) {
        const Pose to_wall = relative(wall, poses.a);
        Box box;
        for (const std::uint32_t vertex : mesh.triangles[i]) {
          const Vector3d p = carry(to_wall, mesh.vertices[vertex]);
          box.grow(Eigen::Vector3f(p.cast<float>()));
          const Vector3d depth(2.0 - std::abs(p.x()), 20.0 - std::abs(p.y()),
                               1.5 - std::abs(p.z() - 1.5));
          inside = inside || depth.minCoeff() > margin_m;
        }
        near = near || (box.max.x() > -2.0 - step_m && box.min.x() < 2.0 + step_m &&
                        box.min.z() < 3.0 + step_m);
      }
      inside_count += inside ? 1 : 0;
      EXPECT_TRUE(!inside || holds(contact.ego, i)) << i;
      EXPECT_TRUE(near || !holds(contact.ego, i)) << i;
      if (testing::Test::HasFailure()) return;
    }
  }
  std::printf("%zu triangles inside, %zu contacts slide\n", inside_count, sliding);
  EXPECT_GT(inside_count, 5000U);
  EXPECT_GT(sliding, 5U);
}

// Brute force over all pairs of triangles of two moving bodies, at the pose with the largest
// displacement of the contact point and at the end of the force.
TEST(Damage, ContainsAllPairsAtTheFurthestAndTheLastPose) {
  constexpr std::uint64_t seed = 402;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  oracle::Random random(seed);
  std::size_t found = 0;
  for (int round = 0; round < 25; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Scene scene = car_against(car_box(), box_mesh({1.9F, 0.8F, 0.8F}, 8, {0.1F, 0.0F, 0.8F}),
                              BodyKind::car, random.real(2.0, 30.0), random.real(-3.0, 3.0), 0.0);
    scene.scenario.actors[0].pose =
        pose_from_angles({0.0, 0.0, 0.0}, random.real(-3.0, 3.0), 0.0, 0.0);
    scene.scenario.actors[0].yaw_rate_radps = random.real(-0.3, 0.3);
    const RankResult result = scene.ranked();
    const CandidateResult& c = only(result);
    ASSERT_GE(c.contacts.size(), 1U);
    const Contact& contact = c.contacts[0];
    const OwnSimulation own(scene, result, c);
    EXPECT_EQ(own.outcome.a.delta_v_mps.norm(), contact.severity.ego.delta_v_mps);
    const View<const ContactPoses> record = own.outcome.motion.all();
    const auto way = [&](const ContactPoses& poses) {
      const auto seen = [&](const ContactPoses& at) {
        const Pose other_in_ego = relative(at.a, at.b);
        return other_in_ego;
      };
      const Vector3d in_ego =
          inverse(record[0].a).rotation * (contact.point_m - record[0].a.translation);
      const Pose first = inverse(seen(record[0]));
      const Pose now = inverse(seen(poses));
      return (now.rotation * in_ego + now.translation - first.rotation * in_ego - first.translation)
          .norm();
    };
    std::size_t furthest = 0;
    for (std::size_t k = 1; k < record.size(); ++k) {
      if (way(record[k]) > way(record[furthest])) furthest = k;
    }
    EXPECT_NEAR(contact.travel_m, way(record[furthest]), 1e-9);
    const TriangleMesh& ego = scene.models[0].mesh;
    const TriangleMesh& other = scene.models[1].mesh;
    for (const std::size_t k : {furthest, record.size() - 1}) {
      if (k == 0) continue;
      const Pose other_in_ego = relative(record[k].a, record[k].b);
      for (std::size_t j = 0; j < other.size(); ++j) {
        TriangleD b;
        for (int corner = 0; corner < 3; ++corner) {
          const auto at = static_cast<std::size_t>(corner);
          b.corner[at] = carry(other_in_ego, other.vertices[other.triangles[j][at]]);
        }
        for (std::size_t i = 0; i < ego.size(); ++i) {
          if (!triangles_intersect(to_double(ego.triangle(i)), b)) continue;
          ++found;
          EXPECT_TRUE(holds(contact.ego, i)) << i;
          EXPECT_TRUE(holds(contact.other, j)) << j;
        }
      }
      if (testing::Test::HasFailure()) return;
    }
  }
  std::printf("%zu pairs\n", found);
  EXPECT_GT(found, 1000U);
}

// A shipped car, head-on into a wall: the damaged region is as deep as the crush from the contact
// law, up to the length of an outline piece, and deeper at higher speed.
TEST(Damage, ReachesAsDeepAsTheSimulatedCrush) {
  constexpr double piece_m = 0.05;
  const TriangleMesh car = scenes::shipped_mesh("sedan");
  const double front_m = static_cast<double>(car.bounds().max.x());
  double before = 0.0;
  double area_before = 0.0;
  for (const double speed : {3.0, 6.0, 10.0, 15.0, 20.0, 28.0}) {
    const Scene scene = car_against(car, wall_box(), BodyKind::building, speed, 0.0, 3.0);
    const RankResult result = scene.ranked(Measure::area);
    const CandidateResult& c = only(result);
    ASSERT_GE(c.contacts.size(), 1U);
    const Contact& contact = c.contacts[0];
    const OwnSimulation own(scene, result, c);
    const double depth = front_m - static_cast<double>(contact.ego.region.min.x());
    std::printf(
        "%.0f m/s: region %.3f m deep, law %.3f m, way of the point %.3f m, %zu triangles\n", speed,
        depth, own.outcome.a.crush_depth_m, contact.travel_m, contact.ego.triangles.size());
    EXPECT_NEAR(depth, own.outcome.a.crush_depth_m + own.outcome.b.crush_depth_m, piece_m);
    EXPECT_NEAR(depth, contact.travel_m, 1e-3);
    EXPECT_GT(depth, before);
    EXPECT_GE(contact.ego.area_m2, area_before);
    before = depth;
    area_before = contact.ego.area_m2;
    // The damage of the wall is where the car hits it.
    const Box& region = contact.other.region;
    EXPECT_NEAR(region.min.x(), -2.0, 1e-3);
    EXPECT_GT(region.min.y(), 3.0 + static_cast<double>(car.bounds().min.y()) - 0.01);
    EXPECT_LT(region.max.y(), 3.0 + static_cast<double>(car.bounds().max.y()) + 0.01);
    EXPECT_LT(region.max.z(), car.bounds().max.z() + 0.01F);
  }
}

TEST(Damage, OfTheFirstPlacesAloneIsThatOfAll) {
  for (std::uint64_t seed = 410; seed < 414; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = scenes::congestion(seed);
    RankOptions options;
    options.measure = Measure::harm;
    const RankResult all = scene.ranked(options);
    options.damaged_places = 2;
    for (const unsigned workers : {1U, 2U}) {
      options.workers = workers;
      const RankResult some = scene.ranked(options);
      ASSERT_EQ(some.ranking.size(), all.ranking.size());
      for (std::size_t row = 0; row < all.ranking.size(); ++row) {
        const CandidateResult& p = all.ranking[row];
        const CandidateResult& q = some.ranking[row];
        EXPECT_EQ(p.candidate, q.candidate);
        EXPECT_EQ(p.score, q.score);
        EXPECT_EQ(p.sample_scores, q.sample_scores);
        const bool shown = row < 2;
        EXPECT_EQ(q.ego.triangles, shown ? p.ego.triangles : std::vector<std::uint32_t>());
        ASSERT_EQ(p.contacts.size(), q.contacts.size());
        for (std::size_t i = 0; shown && i < p.contacts.size(); ++i) {
          EXPECT_EQ(p.contacts[i].ego.triangles, q.contacts[i].ego.triangles);
          EXPECT_EQ(p.contacts[i].other.triangles, q.contacts[i].other.triangles);
        }
      }
    }
  }
}

TEST(Damage, ExchangingEgoAndActorExchangesTheDamage) {
  constexpr std::uint64_t seed = 403;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  oracle::Random random(seed);
  std::size_t compared = 0;
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const TriangleMesh one = car_box();
    const TriangleMesh two = box_mesh({1.9F, 0.8F, 0.8F}, 9, {0.1F, 0.0F, 0.8F});
    const double yaw_one = random.real(-0.9, 0.9);
    const double yaw_two = 3.14 + random.real(-0.9, 0.9);
    const double speed_one = random.real(3.0, 25.0);
    const double speed_two = random.real(3.0, 25.0);
    const auto make = [&](bool exchanged) {
      Scene scene;
      const auto first = scene.add_model("one", exchanged ? two : one, BodyKind::car, 1500.0);
      const auto second = scene.add_model("two", exchanged ? one : two, BodyKind::car, 1500.0);
      const auto placed = [](double yaw, double speed) {
        // Without contact both centres would be at the origin after one second.
        return pose_from_angles({-speed * std::cos(yaw), -speed * std::sin(yaw), 0}, yaw, 0, 0);
      };
      scene.scenario.ego.model = first;
      scene.scenario.ego.pose = exchanged ? placed(yaw_two, speed_two) : placed(yaw_one, speed_one);
      scene.scenario.ego.speed_mps = exchanged ? speed_two : speed_one;
      ScenarioActor& actor = scene.add_actor("other", second, 0.0, 0.0);
      actor.pose = exchanged ? placed(yaw_one, speed_one) : placed(yaw_two, speed_two);
      actor.speed_mps = exchanged ? speed_one : speed_two;
      scene.add_candidate("keep going", 0.0);
      return scene;
    };
    const Contact here = only(make(false).ranked()).contacts.at(0);
    const Contact there = only(make(true).ranked()).contacts.at(0);
    EXPECT_NEAR(here.crush_s, there.crush_s, 1e-3);
    EXPECT_NEAR(here.travel_m, there.travel_m, 1e-3);
    EXPECT_EQ(here.ego.triangles, there.other.triangles);
    EXPECT_EQ(here.other.triangles, there.ego.triangles);
    compared += here.ego.triangles.size() + here.other.triangles.size();
  }
  EXPECT_GT(compared, 1000U);
}

// If the outlines of the contact law do not press, as at heights outside its bands, only the first
// pair of triangles counts: a tall body drives into the beam of a gantry whose post is beside its
// path.
TEST(Damage, WithoutForceOnlyTheFirstPairIsDamaged) {
  TriangleMesh gantry = box_mesh({0.5F, 3.0F, 0.3F}, 4, {0.0F, 0.0F, 4.5F});
  const TriangleMesh post = box_mesh({0.5F, 0.5F, 2.4F}, 1, {0.0F, 8.0F, 2.4F});
  const auto first = static_cast<std::uint32_t>(gantry.vertices.size());
  gantry.vertices.insert(gantry.vertices.end(), post.vertices.begin(), post.vertices.end());
  for (auto [a, b, c] : post.triangles) {
    gantry.triangles.push_back({a + first, b + first, c + first});
  }
  const Scene scene = car_against(box_mesh({2.1F, 0.9F, 2.35F}, 16, {0.0F, 0.0F, 2.35F}),
                                  std::move(gantry), BodyKind::building, 12.0, 0.1, 0.0);
  const RankResult result = scene.ranked();
  ASSERT_EQ(result.ranking.size(), 1U);
  ASSERT_EQ(only(result).contacts.size(), 1U);
  const Contact& contact = only(result).contacts[0];
  EXPECT_EQ(contact.severity.ego.delta_v_mps, 0.0);
  EXPECT_EQ(contact.ego.triangles.size(), 1U);
  EXPECT_EQ(contact.other.triangles.size(), 1U);
  EXPECT_EQ(contact.crush_s, 0.0);
  EXPECT_EQ(contact.travel_m, 0.0);
}

// The damage of the ego does not depend on how the wall is divided: the seam is at the middle of
// the front of the car.
TEST(Damage, DoesNotDependOnHowAWallIsDivided) {
  for (const double speed : {5.0, 15.0, 25.0}) {
    const Scene whole = car_against(car_box(), wall_box(), BodyKind::building, speed, 0.2, 0.3);
    Scene parts = whole;
    parts.scenario.actors.clear();
    const auto half = parts.add_model("half", box_mesh({2.0F, 10.0F, 1.5F}, 1, {0.0F, 0.0F, 1.5F}),
                                      BodyKind::building);
    parts.add_actor("left", half, 2.0, 10.0);
    parts.add_actor("right", half, 2.0, -10.0);
    for (const Measure measure : {Measure::polygons, Measure::intrusion}) {
      const RankResult one = whole.ranked(measure);
      const RankResult many = parts.ranked(measure);
      std::vector<std::uint32_t> differ;
      std::set_symmetric_difference(only(one).ego.triangles.begin(), only(one).ego.triangles.end(),
                                    only(many).ego.triangles.begin(),
                                    only(many).ego.triangles.end(), std::back_inserter(differ));
      EXPECT_TRUE(differ.empty()) << speed << " m/s: " << differ.size();
      EXPECT_GT(only(one).ego.triangles.size(), 20U);
    }
  }
}

}  // namespace
}  // namespace crashrank
