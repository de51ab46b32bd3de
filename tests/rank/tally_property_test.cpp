#include "base/random.hpp"
#include "rank/tally_cases.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;
using test::Random;

double log_uniform(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

Vector3d any_direction(Random& random) {
  const double angle = random.uniform(-3.2, 3.2);
  return {std::cos(angle), std::sin(angle), 0.0};
}

/// The ego and three actors, the first of which is movable.
Scene small_scene(Random& random, const Scene& all, Measure measure) {
  constexpr std::array<RiskModel, 4> models{RiskModel::tum, RiskModel::malliaris_monfort,
                                            RiskModel::malliaris_rosen, RiskModel::joksch_monfort};
  Scene scene;
  scene.measure = measure;
  scene.harm.model = models[random.below(models.size())];
  scene.nominal.model = scene.harm.model;
  scene.harm.weights.property_per_mj = random.below(2) == 0 ? 0.0 : 0.3;
  scene.ego = all.actors[random.below(4)];
  scene.actors.push_back(all.actors[random.below(6)]);
  while (scene.actors.size() < 3) scene.actors.push_back(all.actors[random.below(9)]);
  const auto vary = [&](Body& body) {
    body.vehicle.leading_edge_m = random.uniform(0.0, 1.5);
    if (random.below(4) == 0) body.occupants = random.below(3);
  };
  vary(scene.ego);
  for (Body& actor : scene.actors) vary(actor);
  return scene;
}

/// A random contact between any two bodies of which one is movable.
ContactEffect any_effect(Random& random, const Scene& scene, double begin_s) {
  ContactEffect e;
  e.begin_s = begin_s;
  e.end_s = begin_s + random.uniform(0.0, 0.3);
  e.mean_force_s = random.uniform(begin_s, e.end_s);
  e.closing_mps = log_uniform(random, 0.1, 70.0);
  e.restitution = random.uniform(0.0, 0.5);
  e.dissipated_j = log_uniform(random, 1e2, 1e7);
  const auto bodies = static_cast<std::uint32_t>(scene.actors.size()) + 1;
  const auto pick = [&] {
    const std::size_t index = random.below(bodies);
    return index == scene.actors.size() ? ego_body : index;
  };
  do {
    e.sides[0].body = pick();
    e.sides[1].body = pick();
  } while (e.sides[0].body == e.sides[1].body ||
           !(body_of(scene, e.sides[0].body).vehicle.movable() ||
             body_of(scene, e.sides[1].body).vehicle.movable()));
  for (SideEffect& side : e.sides) {
    const Body& body = body_of(scene, side.body);
    side.forward = any_direction(random);
    side.impulse_ns = log_uniform(random, 10.0, 1e5) * any_direction(random);
    side.crush_j = random.uniform(0.0, 0.5) * e.dissipated_j;
    if (!body.vehicle.movable()) continue;
    side.delta_v_mps = log_uniform(random, 0.01, 60.0) * side.impulse_ns.normalized();
    side.yaw_radps = random.uniform(-5.0, 5.0);
    side.road_mps = random.uniform(0.0, 50.0);
    side.intrusion_m = random.uniform(0.0, 1.0) * max_intrusion_m(body.vehicle);
  }
  return e;
}

/// Random contacts in the order of their begin times, some within one event and some separate.
std::vector<ContactEffect> any_effects(Random& random, const Scene& scene, std::size_t count) {
  std::vector<ContactEffect> effects;
  double time_s = 0.0;
  while (effects.size() < count) {
    time_s += random.below(2) == 0 ? random.uniform(0.0, 0.1) : random.uniform(0.5, 2.0);
    effects.push_back(any_effect(random, scene, time_s));
  }
  return effects;
}

TEST(Tally, NoFurtherContactLowersAScore) {
  constexpr std::uint64_t seed = 503;
  constexpr int cases = 2000;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const Scene all = scene_of(Measure::harm);
  for (int i = 0; i < cases; ++i) {
    // A further contact can reduce the delta-v of the ego: that measure is the sum over events.
    constexpr std::array<Measure, 3> rising{Measure::energy, Measure::intrusion, Measure::harm};
    const Scene scene = small_scene(random, all, rising[random.below(3)]);
    Tally tally;
    for (const ContactEffect& e : any_effects(random, scene, 6)) {
      const double before = tally.score(scene);
      const std::array<BodyEvent, 2> earlier{tally.event(e.sides[0].body),
                                             tally.event(e.sides[1].body)};
      tally.add(scene, e, scene.nominal);
      ASSERT_GE(tally.score(scene), before * (1.0 - 1e-12)) << "case " << i;
      for (std::size_t side = 0; side < 2; ++side) {
        const BodyEvent event = tally.event(e.sides[side].body);
        if (event.number != earlier[side].number) continue;
        ASSERT_GE(event.risk, earlier[side].risk) << "case " << i;
      }
    }
  }
}

TEST(Tally, ExchangingTheSidesOfContactsChangesNothing) {
  constexpr std::uint64_t seed = 504;
  constexpr int cases = 2000;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const Scene all = scene_of(Measure::harm);
  for (int i = 0; i < cases; ++i) {
    const Scene scene = small_scene(random, all, tallied[random.below(4)]);
    const std::vector<ContactEffect> effects = any_effects(random, scene, 5);
    std::vector<ContactEffect> exchanged = effects;
    for (ContactEffect& e : exchanged) {
      if (random.below(2) == 0) std::swap(e.sides[0], e.sides[1]);
    }
    const Tally p = tally_of(scene, effects);
    const Tally q = tally_of(scene, exchanged);
    // The contribution of each body has the same bits; sums over bodies run in a different order.
    for (const std::size_t body : {ego_body, std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
      ASSERT_EQ(p.people_score(scene, body), q.people_score(scene, body)) << "case " << i;
      ASSERT_EQ(p.event(body).number, q.event(body).number) << "case " << i;
      ASSERT_EQ(p.event(body).delta_v_mps, q.event(body).delta_v_mps) << "case " << i;
    }
    ASSERT_NEAR(p.score(scene), q.score(scene), 1e-12 * p.score(scene)) << "case " << i;
    ASSERT_NEAR(p.lower_bound(scene), q.lower_bound(scene), 1e-12 * p.score(scene)) << "case " << i;
  }
}

TEST(Tally, ExchangingActorsExchangesTheirContributions) {
  constexpr std::uint64_t seed = 505;
  constexpr int cases = 1000;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const Scene all = scene_of(Measure::harm);
  const auto exchanged = [](std::size_t body) { return body < 2 ? 1 - body : body; };
  for (int i = 0; i < cases; ++i) {
    const Scene scene = small_scene(random, all, tallied[random.below(4)]);
    Scene other = scene;
    std::swap(other.actors[0], other.actors[1]);
    const std::vector<ContactEffect> effects = any_effects(random, scene, 5);
    std::vector<ContactEffect> renamed = effects;
    for (ContactEffect& e : renamed) {
      for (SideEffect& side : e.sides) side.body = exchanged(side.body);
    }
    const Tally p = tally_of(scene, effects);
    const Tally q = tally_of(other, renamed);
    ASSERT_EQ(p.score(scene), q.score(other)) << "case " << i;
    for (const std::size_t body : {ego_body, std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
      ASSERT_EQ(p.people_score(scene, body), q.people_score(other, exchanged(body)))
          << "case " << i;
    }
  }
}

TEST(Tally, LowerBoundHoldsWithFurtherContacts) {
  constexpr std::uint64_t seed = 501;
  constexpr int cases = 20000;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  const Scene all = scene_of(Measure::harm);
  int says_something = 0;
  for (int i = 0; i < cases; ++i) {
    const Scene scene = small_scene(random, all, tallied[random.below(4)]);
    HarmSample sample = scene.nominal;
    sample.restitution = random.uniform(0.5, 1.5);
    const std::vector<ContactEffect> effects = any_effects(random, scene, 1 + random.below(6));
    std::vector<bool> known(effects.size());
    for (std::size_t k = 0; k < known.size(); ++k) known[k] = random.below(2) == 0;
    Tally some;
    for (std::size_t k = 0; k < effects.size(); ++k) {
      if (known[k]) some.add(scene, effects[k], sample);
    }
    const double least = some.lower_bound(scene);
    ASSERT_LE(least, some.score(scene)) << "case " << i;
    // The known contacts mixed with others, in any order.
    std::vector<std::size_t> order(effects.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (int shuffle = 0; shuffle < 3; ++shuffle) {
      Tally whole;
      for (const std::size_t k : order) whole.add(scene, effects[k], sample);
      ASSERT_LE(least, whole.score(scene)) << "case " << i << ", order " << shuffle;
      for (std::size_t k = order.size() - 1; k > 0; --k) {
        std::swap(order[k], order[random.below(static_cast<std::uint32_t>(k + 1))]);
      }
    }
    says_something += least > 0.0 ? 1 : 0;
  }
  std::printf("%d cases, %d with a least score over 0\n", cases, says_something);
  EXPECT_GT(says_something, cases / 3);
}

}  // namespace
}  // namespace crashrank::detail
