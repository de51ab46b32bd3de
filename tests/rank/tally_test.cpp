#include "rank/tally.hpp"

#include "crash/random.hpp"
#include "crash/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;
using test::Random;

Body body_of(BodyKind kind) {
  VehicleFacts facts;
  facts.kind = kind;
  const Result<Vehicle> v = describe_vehicle(test::box_mesh({2.0, 0.9, 0.7}, {1.2, 0, 0.7}), facts);
  Body body;
  body.vehicle = *v;
  body.mass_kg = v->mass_kg;
  return body;
}

constexpr std::array<BodyKind, 9> all_kinds{
    BodyKind::car,        BodyKind::truck,   BodyKind::bus,
    BodyKind::motorcycle, BodyKind::bicycle, BodyKind::pedestrian,
    BodyKind::barrier,    BodyKind::pole,    BodyKind::building};

/// A car that is the ego and one actor of each kind.
Scene scene_of(Measure measure) {
  Scene scene;
  scene.measure = measure;
  scene.ego = body_of(BodyKind::car);
  for (const BodyKind kind : all_kinds) scene.actors.push_back(body_of(kind));
  scene.plain.model = scene.harm.model;
  return scene;
}

ContactEffect effect(std::size_t actor, double begin_s, double end_s, const Vector3d& delta_v) {
  ContactEffect e;
  e.actor = actor;
  e.begin_s = begin_s;
  e.end_s = end_s;
  e.closing_mps = delta_v.norm();
  e.ego_delta_v_mps = delta_v;
  e.ego_impulse_ns = 1500.0 * delta_v;
  return e;
}

TEST(Tally, NothingScoresNothing) {
  for (const Measure measure : {Measure::delta_v, Measure::energy, Measure::harm}) {
    const Scene scene = scene_of(measure);
    EXPECT_EQ(Tally().score(scene), 0.0);
  }
}

TEST(Tally, ContactsWithinATenthOfASecondAreOneEvent) {
  const Scene scene = scene_of(Measure::delta_v);
  const Vector3d first(-6, 0, 0);
  const Vector3d second(0, 8, 0);
  const auto score = [&](double begin_s) {
    Tally tally;
    tally.add(scene, effect(0, 1.0, 1.2, first), scene.plain);
    tally.add(scene, effect(1, begin_s, begin_s + 0.1, second), scene.plain);
    return tally.score(scene);
  };
  // Within one event delta-v adds as a vector, counted from the end of what came before.
  EXPECT_DOUBLE_EQ(score(1.1), 10.0);
  EXPECT_DOUBLE_EQ(score(1.2), 10.0);
  EXPECT_DOUBLE_EQ(score(1.299), 10.0);
  EXPECT_DOUBLE_EQ(score(1.301), 14.0);
  EXPECT_DOUBLE_EQ(score(5.0), 14.0);
}

TEST(Tally, AnEventGoesOnFromTheLatestEnd) {
  const Scene scene = scene_of(Measure::delta_v);
  Tally tally;
  tally.add(scene, effect(0, 1.0, 1.6, {-3, 0, 0}), scene.plain);
  tally.add(scene, effect(1, 1.1, 1.2, {-3, 0, 0}), scene.plain);
  EXPECT_EQ(tally.event().number, 1U);
  EXPECT_EQ(tally.event().end_s, 1.6);
  tally.add(scene, effect(2, 1.65, 1.7, {-3, 0, 0}), scene.plain);
  EXPECT_EQ(tally.event().number, 1U);
  tally.add(scene, effect(3, 1.9, 2.0, {-3, 0, 0}), scene.plain);
  EXPECT_EQ(tally.event().number, 2U);
  EXPECT_EQ(tally.event().begin_s, 1.9);
  EXPECT_DOUBLE_EQ(tally.score(scene), 12.0);
}

TEST(Tally, SeparateEventsAreIndependentRisks) {
  Scene scene = scene_of(Measure::harm);
  const std::size_t wall = 8;
  const auto risk = [&](const std::vector<ContactEffect>& effects) {
    Tally tally;
    for (const ContactEffect& e : effects) tally.add(scene, e, scene.plain);
    return tally.score(scene);
  };
  const ContactEffect first = effect(wall, 1.0, 1.1, {-15, 0, 0});
  const ContactEffect second = effect(wall, 2.0, 2.1, {0, 12, 0});
  const double p = risk({first});
  const double q = risk({second});
  EXPECT_GT(p, 0.0);
  EXPECT_GT(q, 0.0);
  EXPECT_NEAR(risk({first, second}), 1.0 - (1.0 - p) * (1.0 - q), 1e-14);
  // Close together they are one event with the sum of the velocities.
  ContactEffect close = second;
  close.begin_s = 1.15;
  close.end_s = 1.2;
  const ContactEffect whole = effect(wall, 1.0, 1.2, {-15, 12, 0});
  ContactEffect slower = whole;
  slower.closing_mps = 15.0;
  EXPECT_NEAR(risk({first, close}), risk({slower}), 1e-14);
}

TEST(Tally, PeopleInOtherBodiesAddUp) {
  Scene scene = scene_of(Measure::harm);
  ContactEffect e = effect(0, 1.0, 1.1, Vector3d::Zero());
  e.other_delta_v_mps = 15.0;
  e.closing_mps = 20.0;
  Tally one;
  one.add(scene, e, scene.plain);
  const double single = one.score(scene);
  EXPECT_GT(single, 0.0);
  e.begin_s = 3.0;
  e.end_s = 3.1;
  one.add(scene, e, scene.plain);
  EXPECT_NEAR(one.score(scene), 2.0 * single, 1e-12);
  scene.actors[0].occupants = 3.0;
  Tally full;
  full.add(scene, e, scene.plain);
  EXPECT_NEAR(full.score(scene), 3.0 * single, 1e-12);
}

TEST(Tally, WithoutOccupantsNobodyIsHarmed) {
  Scene scene = scene_of(Measure::harm);
  scene.ego.occupants = 0.0;
  scene.actors[0].occupants = 0.0;
  ContactEffect e = effect(0, 1.0, 1.1, {-20, 0, 0});
  e.other_delta_v_mps = 20.0;
  e.ego_intrusion_m = 0.3;
  e.other_intrusion_m = 0.3;
  Tally tally;
  tally.add(scene, e, scene.plain);
  EXPECT_EQ(tally.score(scene), 0.0);
  scene.ego.occupants = 1.0;
  EXPECT_GT(tally.score(scene), 0.0);
}

TEST(Tally, OtherMeasuresSumOverContacts) {
  const Scene energy = scene_of(Measure::energy);
  const Scene intrusion = scene_of(Measure::intrusion);
  ContactEffect e = effect(0, 1.0, 1.1, {-20, 0, 0});
  e.dissipated_j = 5e4;
  e.ego_intrusion_m = 0.1;
  e.other_intrusion_m = 0.25;
  Tally joules;
  Tally metres;
  for (int i = 0; i < 3; ++i) {
    joules.add(energy, e, energy.plain);
    metres.add(intrusion, e, intrusion.plain);
  }
  EXPECT_DOUBLE_EQ(joules.score(energy), 15e4);
  EXPECT_DOUBLE_EQ(metres.score(intrusion), 3 * 0.35);
  // A rebound keeps its share of the energy.
  e.restitution = 0.2;
  HarmSample bouncing = energy.plain;
  bouncing.restitution = 2.0;
  Tally kept;
  kept.add(energy, e, bouncing);
  EXPECT_DOUBLE_EQ(kept.score(energy), (1.0 - 0.16) / (1.0 - 0.04) * 5e4);
}

TEST(Tally, ASampleScalesTheReboundOfEachContactByItself) {
  const Scene scene = scene_of(Measure::delta_v);
  HarmSample bouncing = scene.plain;
  bouncing.restitution = 1.5;
  ContactEffect soft = effect(0, 1.0, 1.1, {-6.0, 0, 0});
  ContactEffect hard = effect(1, 2.0, 2.1, {-6.0, 0, 0});
  hard.restitution = 0.2;
  Tally tally;
  tally.add(scene, soft, bouncing);
  EXPECT_DOUBLE_EQ(tally.score(scene), 6.0);
  tally.add(scene, hard, bouncing);
  EXPECT_DOUBLE_EQ(tally.score(scene), 6.0 + 6.0 * 1.3 / 1.2);
  // No contact gives back more than half of its impulse.
  bouncing.restitution = 10.0;
  Tally most;
  most.add(scene, hard, bouncing);
  EXPECT_DOUBLE_EQ(most.score(scene), 6.0 * 1.5 / 1.2);
}

double log_uniform(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

Vector3d any_direction(Random& random) {
  const double angle = random.uniform(-3.2, 3.2);
  return {std::cos(angle), std::sin(angle), 0.0};
}

/// A contact as a simulation may leave it.
ContactEffect any_effect(Random& random, const Scene& scene, double begin_s) {
  ContactEffect e;
  e.actor = random.below(static_cast<std::uint32_t>(scene.actors.size()));
  const Body& other = scene.actors[e.actor];
  e.begin_s = begin_s;
  e.end_s = begin_s + random.uniform(0.0, 0.3);
  e.closing_mps = log_uniform(random, 0.1, 70.0);
  e.ego_delta_v_mps = log_uniform(random, 0.01, 60.0) * any_direction(random);
  e.ego_impulse_ns = scene.ego.mass_kg * e.ego_delta_v_mps;
  e.ego_forward = any_direction(random);
  e.ego_road_mps = random.uniform(0.0, 50.0);
  e.other_road_mps = random.uniform(0.0, 50.0);
  e.dissipated_j = log_uniform(random, 1e2, 1e7);
  e.ego_crush_j = random.uniform(0.0, 0.5) * e.dissipated_j;
  e.other_crush_j = random.uniform(0.0, 0.5) * e.dissipated_j;
  e.ego_intrusion_m = random.uniform(0.0, 1.0) * most_intrusion_m(scene.ego.vehicle);
  if (other.vehicle.movable()) {
    e.other_delta_v_mps = log_uniform(random, 0.01, 60.0);
    e.other_intrusion_m = random.uniform(0.0, 1.0) * most_intrusion_m(other.vehicle);
  }
  e.other_pdof_deg = random.uniform(0.0, 360.0);
  return e;
}

Range around(Random& random, double value) {
  const double below = random.below(4) == 0 ? 0.0 : random.uniform(0.0, 1.0);
  const double above = random.below(4) == 0 ? 0.0 : random.uniform(0.0, 2.0);
  return {value * (1.0 - below), value * (1.0 + above)};
}

/// What a contact adds to a score besides the ego's people.
double without_ego(Scene scene, const ContactEffect& e) {
  scene.ego.occupants = 0.0;
  Tally tally;
  tally.add(scene, e, scene.plain);
  return tally.score(scene);
}

TEST(Tally, BoundsContainEveryScoreThatMayFollow) {
  constexpr std::uint64_t seed = 501;
  constexpr int cases = 5000;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  std::vector<Scene> scenes;
  for (const Measure measure : {Measure::delta_v, Measure::energy, Measure::harm}) {
    for (const BodyKind ego : {BodyKind::car, BodyKind::motorcycle, BodyKind::truck}) {
      for (const RiskModel model : {RiskModel::tum, RiskModel::malliaris_monfort,
                                    RiskModel::malliaris_rosen, RiskModel::joksch_monfort}) {
        Scene scene = scene_of(measure);
        scene.ego = body_of(ego);
        scene.harm.model = model;
        scene.plain.model = model;
        scene.harm.weights.property_per_mj = ego == BodyKind::truck ? 0.3 : 0.0;
        scenes.push_back(std::move(scene));
      }
    }
  }
  int touched = 0;
  int followed = 0;
  for (int i = 0; i < cases; ++i) {
    Scene& scene = scenes[random.below(static_cast<std::uint32_t>(scenes.size()))];
    for (Body* body : {&scene.ego, &scene.actors[0], &scene.actors[5]}) {
      body->vehicle.leading_edge_m = random.uniform(0.0, 1.5);
    }
    Tally tally;
    double time_s = 0.0;
    const auto next_begin = [&] {
      time_s += random.below(2) == 0 ? random.uniform(0.0, 0.1) : random.uniform(0.5, 2.0);
      return time_s;
    };
    for (std::uint32_t k = random.below(4); k > 0; --k) {
      const ContactEffect e = any_effect(random, scene, next_begin());
      tally.add(scene, e, scene.plain);
    }
    const ContactEffect actual = any_effect(random, scene, next_begin());
    PendingContact pending;
    pending.actor = actual.actor;
    pending.begin_s = actual.begin_s;
    pending.closing_mps = actual.closing_mps;
    pending.ego_road_mps = actual.ego_road_mps;
    pending.other_road_mps = actual.other_road_mps;
    pending.ego_delta_v_mps = around(random, actual.ego_delta_v_mps.norm());
    pending.other_delta_v_mps = around(random, actual.other_delta_v_mps);
    pending.dissipated_j = around(random, actual.dissipated_j);
    std::vector<ContactEffect> later;
    for (std::uint32_t k = random.below(3); k > 0; --k) {
      later.push_back(any_effect(random, scene, next_begin()));
    }
    Later after;
    after.any = !later.empty() || random.below(2) == 0;
    for (const ContactEffect& e : later) {
      if (scene.measure == Measure::delta_v) {
        after.most += e.ego_delta_v_mps.norm();
      } else {
        after.most += without_ego(scene, e);
      }
    }
    const Range bounds = tally.bounds(scene, pending, after);
    tally.add(scene, actual, scene.plain);
    for (const ContactEffect& e : later) tally.add(scene, e, scene.plain);
    const double score = tally.score(scene);
    ASSERT_LE(bounds.least, score) << "case " << i;
    ASSERT_GE(bounds.most, score) << "case " << i;
    followed += later.empty() ? 0 : 1;
    // How often a bound says more than nothing.
    touched += bounds.least > 0.0 && std::isfinite(bounds.most) ? 1 : 0;
  }
  std::printf("%d cases, %d with later contacts, %d with a lower bound over 0\n", cases, followed,
              touched);
  EXPECT_GT(followed, cases / 3);
  EXPECT_GT(touched, cases / 3);
}

TEST(Tally, BoundsOfAKnownContactAreItsScore) {
  constexpr std::uint64_t seed = 502;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (const Measure measure : {Measure::delta_v, Measure::energy}) {
    const Scene scene = scene_of(measure);
    for (int i = 0; i < 200; ++i) {
      const ContactEffect e = any_effect(random, scene, 1.0);
      PendingContact pending;
      pending.actor = e.actor;
      pending.begin_s = e.begin_s;
      pending.closing_mps = e.closing_mps;
      const double delta_v = e.ego_delta_v_mps.norm();
      pending.ego_delta_v_mps = {delta_v, delta_v};
      pending.dissipated_j = {e.dissipated_j, e.dissipated_j};
      Tally tally;
      const Range bounds = tally.bounds(scene, pending, {});
      tally.add(scene, e, scene.plain);
      const double score = tally.score(scene);
      ASSERT_NEAR(bounds.least, score, 1e-8 * score);
      ASSERT_NEAR(bounds.most, score, 1e-8 * score);
    }
  }
}

}  // namespace
}  // namespace crashrank::detail
