#include "rank/tally_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// A contact that changes only the velocity of its first body.
ContactEffect effect(std::size_t a, std::size_t b, double begin_s, double end_s,
                     const Vector3d& delta_v) {
  ContactEffect e;
  e.begin_s = begin_s;
  e.end_s = e.mean_force_s = end_s;
  e.closing_mps = delta_v.norm();
  e.sides[0].body = a;
  e.sides[0].delta_v_mps = delta_v;
  e.sides[0].impulse_ns = 1500.0 * delta_v;
  e.sides[1].body = b;
  return e;
}

double score_of(const Scene& scene, const std::vector<ContactEffect>& effects) {
  return tally_of(scene, effects).score(scene);
}

TEST(Tally, WithoutContactsTheScoreIsZero) {
  for (const Measure measure : tallied) {
    const Scene scene = scene_of(measure);
    EXPECT_EQ(Tally().score(scene), 0.0);
    EXPECT_EQ(Tally().lower_bound(scene), 0.0);
    EXPECT_EQ(Tally().event(ego_body).number, 0U);
  }
}

TEST(Tally, BeginRemovesAllContacts) {
  for (const Measure measure : tallied) {
    const Scene scene = scene_of(measure);
    ContactEffect e = effect(ego_body, wall, 1.0, 1.1, {-15, 0, 0});
    e.dissipated_j = 1e5;
    e.sides[0].intrusion_m = 0.2;
    Tally tally = tally_of(scene, {e});
    EXPECT_GT(tally.score(scene), 0.0);
    tally.begin();
    EXPECT_EQ(tally.score(scene), 0.0);
    EXPECT_EQ(tally.event(ego_body).number, 0U);
  }
}

TEST(Tally, ContactsWithinATenthOfASecondAreOneEvent) {
  const Scene scene = scene_of(Measure::delta_v);
  const ContactEffect first = effect(ego_body, 0, 1.0, 1.2, {-6, 0, 0});
  const auto score = [&](double begin_s) {
    return score_of(scene, {first, effect(ego_body, 1, begin_s, begin_s + 0.1, {0, 8, 0})});
  };
  // Within one event delta-v adds as a vector; the gap counts from the end of the contact before.
  EXPECT_DOUBLE_EQ(score(1.1), 10.0);
  EXPECT_DOUBLE_EQ(score(1.2), 10.0);
  EXPECT_DOUBLE_EQ(score(1.299), 10.0);
  EXPECT_DOUBLE_EQ(score(1.4), 14.0);
  EXPECT_DOUBLE_EQ(score(5.0), 14.0);
}

/// A body that is pressed from both sides: what its velocity did not change by is not added up.
TEST(Tally, DeltaVThatChangedNoVelocityIsNotSummed) {
  const Scene scene = scene_of(Measure::delta_v);
  const ContactEffect first = effect(ego_body, 0, 1.0, 1.1, {10, 0, 0});
  ContactEffect pressed = effect(ego_body, 0, 1.15, 1.3, {9, 0, 0});
  EXPECT_DOUBLE_EQ(score_of(scene, {first, pressed}), 19.0);
  pressed.sides[0].squeeze_mps = {8, 0, 0};
  EXPECT_DOUBLE_EQ(score_of(scene, {first, pressed}), 11.0);
  // Alone it counts whole, and so it does where it is the larger one.
  EXPECT_DOUBLE_EQ(score_of(scene, {pressed}), 9.0);
  const Scene harm = scene_of(Measure::harm);
  EXPECT_EQ(score_of(harm, {pressed}), score_of(harm, {effect(ego_body, 0, 1.15, 1.3, {9, 0, 0})}));
}

/// Between 0.1 and 0.2 s after the end of an event it counts in the next one with a falling share.
TEST(Tally, TheShareOfAnEarlierEventFallsWithoutAJump) {
  for (const Measure measure : {Measure::delta_v, Measure::harm}) {
    const Scene scene = scene_of(measure);
    const ContactEffect first = effect(ego_body, 0, 1.0, 1.2, {-16, 0, 0});
    const auto score = [&](double begin_s, const Vector3d& delta_v) {
      return score_of(scene, {first, effect(ego_body, 1, begin_s, begin_s + 0.1, delta_v)});
    };
    for (const Vector3d& delta_v : {Vector3d(-12, 0, 0), Vector3d(0, 12, 0), Vector3d(8, 2, 0)}) {
      const double together = score(1.299, delta_v);
      const double apart = score(1.401, delta_v);
      for (double begin_s = 1.299; begin_s < 1.401; begin_s += 0.001) {
        const double now = score(begin_s, delta_v);
        EXPECT_NEAR(score(begin_s + 0.001, delta_v), now, 0.04 * std::max(together, apart));
        // No later contact takes back the harm of an earlier one.
        if (measure == Measure::harm) {
          EXPECT_GE(now, score_of(scene, {first}));
        }
      }
    }
  }
  // Half way: half of the first event counts in the second, half apart.
  const Scene scene = scene_of(Measure::delta_v);
  const ContactEffect first = effect(ego_body, 0, 1.0, 1.2, {-6, 0, 0});
  EXPECT_NEAR(score_of(scene, {first, effect(ego_body, 1, 1.35, 1.4, {0, 8, 0})}),
              3.0 + std::hypot(3.0, 8.0), 1e-12);
}

/// A scrape leads from one impact to the next: what is left of the first by then adds up with the
/// second, the rest is an impact of its own.
TEST(Tally, AWeakForceBetweenTwoImpactsDoesNotAddThemUp) {
  const Scene scene = scene_of(Measure::delta_v);
  ContactEffect first = effect(ego_body, 0, 1.0, 2.0, {-6, 0, 0});
  const ContactEffect second = effect(ego_body, 1, 2.05, 2.1, {0, 8, 0});
  const auto score = [&](double mean_force_s) {
    first.mean_force_s = mean_force_s;
    return score_of(scene, {first, second});
  };
  EXPECT_DOUBLE_EQ(score(1.8), 10.0);
  EXPECT_NEAR(score(1.6), 3.0 + std::hypot(3.0, 8.0), 1e-12);
  EXPECT_DOUBLE_EQ(score(1.4), 14.0);
  EXPECT_DOUBLE_EQ(score(1.1), 14.0);
  // It stays one event: by its number contacts are less than 0.1 s apart.
  Tally tally;
  tally.add(scene, first, scene.nominal);
  tally.add(scene, second, scene.nominal);
  EXPECT_EQ(tally.event(ego_body).number, 1U);
  // A contact in which little happens leads on, and does not make the first impact later.
  const ContactEffect scrape = effect(ego_body, 0, 1.2, 2.0, {-0.1, 0, 0});
  first.end_s = 1.15;
  EXPECT_NEAR(score_of(scene, {first, scrape, second}), 14.1, 0.05);
  first.end_s = 2.0;
  const Scene harm = scene_of(Measure::harm);
  double before = score_of(harm, {first});
  for (double mean_s = 1.3; mean_s < 1.9; mean_s += 0.01) {
    first.mean_force_s = mean_s;
    const double now = score_of(harm, {first, second});
    EXPECT_GE(now, score_of(harm, {first}));
    if (mean_s > 1.3) {
      EXPECT_NEAR(now, before, 0.05 * now);
    }
    before = now;
  }
}

TEST(Tally, AnEventExtendsToTheLatestEnd) {
  const Scene scene = scene_of(Measure::delta_v);
  Tally tally;
  tally.add(scene, effect(ego_body, 0, 1.0, 1.6, {-3, 0, 0}), scene.nominal);
  tally.add(scene, effect(ego_body, 1, 1.1, 1.2, {-3, 0, 0}), scene.nominal);
  EXPECT_EQ(tally.event(ego_body).number, 1U);
  EXPECT_EQ(tally.event(ego_body).end_s, 1.6);
  tally.add(scene, effect(ego_body, 2, 1.65, 1.7, {-3, 0, 0}), scene.nominal);
  EXPECT_EQ(tally.event(ego_body).number, 1U);
  EXPECT_DOUBLE_EQ(tally.event(ego_body).delta_v_mps.x(), -9.0);
  tally.add(scene, effect(ego_body, 3, 2.0, 2.1, {-3, 0, 0}), scene.nominal);
  EXPECT_EQ(tally.event(ego_body).number, 2U);
  EXPECT_DOUBLE_EQ(tally.event(ego_body).delta_v_mps.x(), -3.0);
  EXPECT_DOUBLE_EQ(tally.score(scene), 12.0);
}

TEST(Tally, EveryBodyHasEventsOfItsOwn) {
  const Scene scene = scene_of(Measure::harm);
  Tally tally;
  // The ego pushes actor 0, which within 0.1 s hits actor 2; actor 1 is hit later.
  ContactEffect push = effect(0, ego_body, 1.0, 1.1, {9, 0, 0});
  std::swap(push.sides[0], push.sides[1]);
  tally.add(scene, push, scene.nominal);
  tally.add(scene, effect(0, 2, 1.15, 1.25, {-4, 0, 0}), scene.nominal);
  tally.add(scene, effect(0, 1, 3.0, 3.1, {0, 5, 0}), scene.nominal);
  EXPECT_EQ(tally.event(0).number, 2U);
  EXPECT_EQ(tally.event(ego_body).number, 1U);
  EXPECT_EQ(tally.event(1).number, 1U);
  EXPECT_EQ(tally.event(2).number, 1U);
  EXPECT_EQ(tally.event(2).end_s, 1.25);
  EXPECT_EQ(tally.event(3).number, 0U);
}

/// Checks the events of a body with a single hit, with two hits at least 0.2 s apart, and with two
/// hits close together.
void expect_events(const Scene& scene, std::size_t body) {
  const ContactEffect first = effect(body, wall, 1.0, 1.1, {-15, 0, 0});
  const ContactEffect second = effect(body, wall, 2.0, 2.1, {0, 12, 0});
  const double p = score_of(scene, {first});
  const double q = score_of(scene, {second});
  EXPECT_GT(p, 0.0);
  EXPECT_GT(q, 0.0);
  EXPECT_NEAR(score_of(scene, {first, second}), 1.0 - (1.0 - p) * (1.0 - q), 1e-14);
  const ContactEffect third = effect(body, wall, 4.0, 4.1, {3, 10, 0});
  const double r = score_of(scene, {third});
  EXPECT_NEAR(score_of(scene, {first, second, third}), 1.0 - (1.0 - p) * (1.0 - q) * (1.0 - r),
              1e-14);
  // Close together they are one event with the sum of the changes of velocity.
  ContactEffect close = second;
  close.begin_s = 1.15;
  close.end_s = 1.2;
  ContactEffect whole = effect(body, wall, 1.0, 1.2, {-15, 12, 0});
  whole.closing_mps = 15.0;
  EXPECT_NEAR(score_of(scene, {first, close}), score_of(scene, {whole}), 1e-14);
}

/// A mirror touches with hardly any force.
TEST(Tally, WhoeverIsOutsideACarIsStruckAtAShareOfTheClosingSpeed) {
  Scene scene = scene_of(Measure::harm);
  for (std::size_t actor = 0; actor < scene.actors.size(); ++actor) {
    const BodyKind kind = scene.actors[actor].vehicle.kind;
    const bool outside =
        kind == BodyKind::motorcycle || kind == BodyKind::bicycle || kind == BodyKind::pedestrian;
    ContactEffect touch;
    touch.closing_mps = 25.0;
    touch.sides[1].body = actor;
    double last = 0.0;
    for (const double share : {0.0, 0.1, 0.3, 1.0}) {
      scene.harm.least_struck_share = share;
      const double score = tally_of(scene, {touch}).score(scene);
      HarmExposure struck;
      struck.kind = kind;
      struck.closing_speed_mps = share * 25.0;
      EXPECT_DOUBLE_EQ(score, outside ? harm_of(struck, scene.harm) : 0.0);
      EXPECT_GE(score, last);
      last = score;
    }
    EXPECT_EQ(last > 0.0, outside);
  }
}

TEST(Tally, SeparateEventsAreIndependentRisks) {
  const Scene scene = scene_of(Measure::harm);
  expect_events(scene, ego_body);
}

TEST(Tally, ActorsHaveEventsLikeTheEgo) {
  const Scene scene = scene_of(Measure::harm);
  for (const std::size_t body : {0U, 1U, 3U, 5U}) {
    SCOPED_TRACE(body);
    expect_events(scene, body);
  }
}

TEST(Tally, PeopleOfDifferentBodiesAddUp) {
  Scene scene = scene_of(Measure::harm);
  const ContactEffect one = effect(0, wall, 1.0, 1.1, {-15, 0, 0});
  const ContactEffect other = effect(1, wall, 1.0, 1.1, {-20, 0, 0});
  const double p = score_of(scene, {one});
  const double q = score_of(scene, {other});
  EXPECT_GT(p, 0.0);
  EXPECT_GT(q, 0.0);
  const Tally both = tally_of(scene, {one, other});
  EXPECT_NEAR(both.score(scene), p + q, 1e-14);
  EXPECT_NEAR(both.people_score(scene, 0), p, 1e-14);
  EXPECT_NEAR(both.people_score(scene, 1), q, 1e-14);
  EXPECT_EQ(both.people_score(scene, 2), 0.0);
  scene.actors[0].occupants = 3.0;
  EXPECT_NEAR(score_of(scene, {one, other}), 3.0 * p + q, 1e-14);
}

TEST(Tally, ReducingDeltaVDoesNotReduceTheRisk) {
  const Scene scene = scene_of(Measure::harm);
  for (const std::size_t body : {ego_body, std::size_t{0}, std::size_t{5}}) {
    const ContactEffect first = effect(body, wall, 1.0, 1.1, {-15, 0, 0});
    const ContactEffect back = effect(body, wall, 1.15, 1.2, {14, 0, 0});
    EXPECT_GE(score_of(scene, {first, back}), score_of(scene, {first}));
  }
}

/// The intrusion of a contact is its increase over earlier contacts of the same two bodies.
TEST(Tally, IntrusionsByOneBodyAddUpInAnEvent) {
  const Scene scene = scene_of(Measure::harm);
  const auto intruding = [](std::size_t by, double begin_s, double intrusion_m) {
    ContactEffect e = effect(ego_body, by, begin_s, begin_s + 0.05, {-5, 0, 0});
    e.sides[0].intrusion_m = intrusion_m;
    return e;
  };
  const auto reached = [&](const std::vector<ContactEffect>& effects) {
    return tally_of(scene, effects).event(ego_body).intrusion_m;
  };
  const ContactEffect first = intruding(0, 1.0, 0.2);
  EXPECT_DOUBLE_EQ(reached({first, intruding(0, 1.1, 0.1)}), 0.3);
  EXPECT_DOUBLE_EQ(reached({first, intruding(0, 1.1, 0.0)}), 0.2);
  // Intrusion by two bodies is that of the deeper one.
  EXPECT_DOUBLE_EQ(reached({first, intruding(1, 1.1, 0.25)}), 0.25);
  // A later event starts without intrusion.
  EXPECT_DOUBLE_EQ(reached({first, intruding(0, 2.0, 0.1)}), 0.1);
}

TEST(Tally, WithoutOccupantsNobodyIsHarmed) {
  Scene scene = scene_of(Measure::harm);
  scene.ego.occupants = 0.0;
  scene.actors[0].occupants = 0.0;
  ContactEffect e = effect(ego_body, 0, 1.0, 1.1, {-20, 0, 0});
  e.sides[1].delta_v_mps = {20, 0, 0};
  e.sides[1].impulse_ns = {3e4, 0, 0};
  for (SideEffect& side : e.sides) side.intrusion_m = 0.3;
  EXPECT_EQ(score_of(scene, {e}), 0.0);
  scene.ego.occupants = 1.0;
  EXPECT_GT(score_of(scene, {e}), 0.0);
  scene.ego.occupants = 0.0;
  scene.actors[0].occupants = 1.0;
  EXPECT_GT(score_of(scene, {e}), 0.0);
}

TEST(Tally, PropertyHarmAddsUpOverContactsAndBodies) {
  Scene scene = scene_of(Measure::harm);
  scene.ego.occupants = 0.0;
  scene.actors[0].occupants = 0.0;
  scene.actors[1].occupants = 0.0;
  scene.harm.weights.property_per_mj = 0.4;
  ContactEffect first = effect(ego_body, 0, 1.0, 1.1, {-20, 0, 0});
  first.sides[0].crush_j = 2e5;
  first.sides[1].crush_j = 3e5;
  ContactEffect second = effect(0, 1, 1.2, 1.3, {-10, 0, 0});
  second.sides[0].crush_j = 1e5;
  second.sides[1].crush_j = 5e4;
  EXPECT_NEAR(score_of(scene, {first}), 0.4 * 0.5, 1e-14);
  EXPECT_NEAR(score_of(scene, {first, second}), 0.4 * 0.65, 1e-14);
  // No later contact reduces it: the lower bound contains it, except for the margin of rounding.
  EXPECT_NEAR(tally_of(scene, {first, second}).lower_bound(scene), 0.4 * 0.65, 1e-8);
}

TEST(Tally, OtherMeasuresSumOverContacts) {
  const Scene energy = scene_of(Measure::energy);
  const Scene intrusion = scene_of(Measure::intrusion);
  ContactEffect e = effect(ego_body, 0, 1.0, 1.1, {-20, 0, 0});
  e.dissipated_j = 5e4;
  e.sides[0].intrusion_m = 0.1;
  e.sides[1].intrusion_m = 0.25;
  ContactEffect further = e;
  further.sides[0].body = 1;
  EXPECT_DOUBLE_EQ(score_of(energy, {e, e, further}), 15e4);
  EXPECT_DOUBLE_EQ(score_of(intrusion, {e, e, further}), 3 * 0.35);
  // A larger restitution dissipates less energy.
  e.restitution = 0.2;
  HarmSample bouncing = energy.nominal;
  bouncing.restitution = 2.0;
  Tally kept;
  kept.add(energy, e, bouncing);
  EXPECT_DOUBLE_EQ(kept.score(energy), (1.0 - 0.16) / (1.0 - 0.04) * 5e4);
}

TEST(Tally, DeltaVCountsOnlyThatOfTheEgo) {
  const Scene scene = scene_of(Measure::delta_v);
  ContactEffect first = effect(ego_body, 0, 1.0, 1.1, {-6, 0, 0});
  first.sides[1].delta_v_mps = {9, 0, 0};
  EXPECT_DOUBLE_EQ(score_of(scene, {first, effect(0, 1, 1.2, 1.3, {-7, 0, 0})}), 6.0);
}

TEST(Tally, ASampleScalesTheReboundOfEachContact) {
  const Scene scene = scene_of(Measure::delta_v);
  HarmSample bouncing = scene.nominal;
  bouncing.restitution = 1.5;
  const ContactEffect soft = effect(ego_body, 0, 1.0, 1.1, {-6.0, 0, 0});
  ContactEffect hard = effect(ego_body, 1, 2.0, 2.1, {-6.0, 0, 0});
  hard.restitution = 0.2;
  Tally tally;
  tally.add(scene, soft, bouncing);
  EXPECT_DOUBLE_EQ(tally.score(scene), 6.0);
  tally.add(scene, hard, bouncing);
  EXPECT_DOUBLE_EQ(tally.score(scene), 6.0 + 6.0 * 1.3 / 1.2);
  // Restitution returns at most half of the impulse.
  bouncing.restitution = 10.0;
  Tally most;
  most.add(scene, hard, bouncing);
  EXPECT_DOUBLE_EQ(most.score(scene), 6.0 * 1.5 / 1.2);
}

TEST(Tally, AReboundScalesBothSides) {
  ContactEffect e = effect(0, 1, 1.0, 1.1, {-6.0, 2.0, 0});
  e.restitution = 0.2;
  e.sides[1].delta_v_mps = {3.0, -1.0, 0};
  e.sides[1].impulse_ns = {9e3, -3e3, 0};
  for (SideEffect& side : e.sides) {
    side.yaw_radps = 0.5;
    side.crush_j = 1e4;
    side.intrusion_m = 0.1;
  }
  const ContactEffect r = scale_restitution(e, 1.5);
  constexpr double gain = 1.3 / 1.2;
  constexpr double loss = (1.0 - 0.09) / (1.0 - 0.04);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT((r.sides[i].delta_v_mps - gain * e.sides[i].delta_v_mps).norm(), 1e-14);
    EXPECT_LT((r.sides[i].impulse_ns - gain * e.sides[i].impulse_ns).norm(), 1e-10);
    EXPECT_DOUBLE_EQ(r.sides[i].yaw_radps, gain * 0.5);
    EXPECT_DOUBLE_EQ(r.sides[i].crush_j, loss * 1e4);
    EXPECT_EQ(r.sides[i].intrusion_m, 0.1);
  }
}

}  // namespace
}  // namespace crashrank::detail
