// Rest positions after a contact, against a plain integrator: the contact by itself, then each body
// by itself on its wheels with explicit tyre forces, in steps of 0.1 ms.

#include "campaign.hpp"
#include "crash/contact_checks.hpp"
#include "crash/lone_contact.hpp"
#include "crash/scene_cases.hpp"
#include "crash/tyres_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace crashrank {
namespace {

using detail::Footing;
using detail::LoneContact;
using detail::PlanarBody;
using detail::SceneRun;
using test::ContactDraw;
using test::ContactScene;
using test::percentile;
using test::Random;
using test::ReferenceCar;
using test::ReferenceWheel;
using test::test_bodies;

/// Driver action in both bodies after the contact.
struct DriverAction {
  AfterContact after = AfterContact::brakes;
  double brake = 0.45;
  double steering_rad = 0.0;
  double grip = 0.7;
};

/// Returns true if crushed structure reaches the wheel at (x, y), m from the centre of mass.
bool wheel_is_in_damage(const Vehicle& v, const Box& damaged, double x, double y) {
  if (damaged.empty()) return false;
  const double at_x = x + v.center_m.x();
  const double at_y = y + v.center_m.y();
  return at_x > static_cast<double>(damaged.min.x()) - 0.3 &&
         at_x < static_cast<double>(damaged.max.x()) + 0.3 &&
         at_y > static_cast<double>(damaged.min.y()) - 0.1 &&
         at_y < static_cast<double>(damaged.max.y()) + 0.1;
}

ReferenceCar reference_car(const Vehicle& v, const DriverAction& action, const Box& damaged) {
  const Footing footing = detail::footing_of(v);
  ReferenceCar car;
  car.mass_kg = v.mass_kg;
  car.inertia_kgm2 = v.yaw_inertia_kgm2;
  car.grip = footing.wheels ? action.grip : std::min(action.grip, 0.5);
  car.cornering = footing.cornering;
  for (int axle = 0; axle < 2; ++axle) {
    for (int side = 0; side < 2; ++side) {
      ReferenceWheel wheel;
      wheel.x_m = axle == 0 ? footing.front_m : footing.rear_m;
      wheel.y_m = footing.y_m[side];
      wheel.load = (axle == 0 ? footing.front_load : footing.rear_load)[side];
      wheel.steering_rad = axle == 0 ? action.steering_rad : 0.0;
      wheel.brake = action.after == AfterContact::brakes ? action.brake : 0.0;
      wheel.locked = !footing.wheels || action.after == AfterContact::locks ||
                     wheel_is_in_damage(v, damaged, wheel.x_m, wheel.y_m);
      car.wheels.push_back(wheel);
    }
  }
  return car;
}

/// A body after a contact.
struct PushedBody {
  const Vehicle* vehicle = nullptr;
  ReferenceCar::State state = ReferenceCar::State::Zero();  ///< state in the form of ReferenceCar
  double time_s = 0.0;
  double road_from_s = -1e9;  ///< the road forces act from then on, after the impact
  Box damaged;                ///< region in which wheels are locked
};

ReferenceCar::State state_of(const PlanarBody& b) {
  ReferenceCar::State s;
  s << b.x, b.y, std::atan2(b.sine, b.cosine), b.vx, b.vy, b.spin;
  return s;
}

/// Simulates the contact of a scene step by step, with road forces outside impacts. Returns false
/// if no force acts.
bool simulate_contact_on_road(const ContactScene& scene, const DriverAction& action,
                              std::array<PushedBody, 2>& bodies) {
  ContactWorkspace workspace;
  LoneContact contact(scene.a, scene.b, {}, scene.point_m, {}, {}, workspace);
  const bool a_is_first = contact.run().given_first().vehicle == scene.a.vehicle;
  std::array<PlanarBody*, 2> motions{&workspace.state().bodies[0].motion,
                                     &workspace.state().bodies[1].motion};
  if (!a_is_first) std::swap(motions[0], motions[1]);
  std::array<ReferenceCar, 2> cars;
  for (std::size_t k = 0; k < 2; ++k) {
    bodies[k] = {};
    bodies[k].vehicle = k == 0 ? scene.a.vehicle : scene.b.vehicle;
    cars[k] = reference_car(*bodies[k].vehicle, action, {});
  }
  bool going = true;
  bool touched = false;
  while (going) {
    const double before_s = contact.run().time_s();
    going = contact.advance(1);
    const double step_s = contact.run().time_s() - before_s;
    touched = touched || contact.run().presses();
    for (std::size_t k = 0; k < 2 && touched; ++k) {
      const double change = contact.run().step_action((k == 0) == a_is_first).path_mps;
      const double middle_s = before_s + 0.5 * step_s;
      if (change > 2.0 * cars[k].grip * test::gravity_mps2 * step_s) {
        bodies[k].road_from_s = middle_s + 0.05;
      }
      if (middle_s < bodies[k].road_from_s) continue;
      const ReferenceCar::State now = state_of(*motions[k]);
      const ReferenceCar::State then = cars[k].after(now, step_s);
      motions[k]->vx += then[3] - now[3];
      motions[k]->vy += then[4] - now[4];
      motions[k]->spin += then[5] - now[5];
    }
  }
  const ContactOutcome outcome = contact.outcome();
  for (std::size_t k = 0; k < 2; ++k) {
    bodies[k].state = state_of(*motions[k]);
    bodies[k].time_s = contact.run().time_s();
    bodies[k].damaged = (k == 0 ? outcome.a : outcome.b).damaged;
  }
  return outcome.acts;
}

/// State of the body at `until_s`, or at rest before.
ReferenceCar::State rest_state(PushedBody body, const DriverAction& action, double until_s) {
  const double free_s = std::max(0.0, body.road_from_s - body.time_s);
  for (int k = 0; k < 3; ++k) body.state[k] += free_s * body.state[k + 3];
  body.time_s += free_s;
  const ReferenceCar car = reference_car(*body.vehicle, action, body.damaged);
  const double reach_m = static_cast<double>(
      std::max(body.vehicle->silhouettes.max_x, -body.vehicle->silhouettes.min_x));
  while (body.time_s < until_s) {
    const double chunk_s = std::min(0.05, until_s - body.time_s);
    body.state = car.after(body.state, chunk_s);
    body.time_s += chunk_s;
    if (std::hypot(body.state[3], body.state[4]) + reach_m * std::abs(body.state[5]) < 0.01) break;
  }
  return body.state;
}

// Campaigns set CRASHRANK_SCENE_COUNT and CRASHRANK_SCENE_SEED.
TEST(SceneReference, RestPositionsMatchAPlainIntegrator) {
  const auto [seed, count] = test::scene_campaign(431, 800);
  Random random(seed);
  SceneRun run;
  std::vector<double> places;
  std::vector<double> shares;
  std::vector<double> headings;
  std::size_t again = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    SCOPED_TRACE("scene " + std::to_string(i));
    const auto kinds = static_cast<std::uint32_t>(test_bodies().movable.size());
    const Vehicle& a = test_bodies().movable[random.below(kinds)].vehicle;
    const Vehicle& b = test_bodies().movable[random.below(kinds)].vehicle;
    const double closing = random.uniform(2, 25);
    const ContactDraw draw(random);
    DriverAction action;
    action.after = static_cast<AfterContact>(random.below(3));
    action.brake = random.uniform(0, 1);
    action.steering_rad = random.uniform(-0.3, 0.3);
    action.grip = random.uniform(0.2, 1.0);
    ContactScene scene;
    if (&a == &b || !test::make_contact(draw, a, b, closing, 0.001, scene)) continue;
    std::array<PushedBody, 2> pushed;
    if (!simulate_contact_on_road(scene, action, pushed)) continue;
    test::SceneSetup setup;
    setup.add(scene.a);
    setup.add(scene.b);
    setup.make_bodies(true, action.brake);
    for (detail::SceneBody& body : setup.bodies) body.steering_rad = action.steering_rad;
    detail::SceneOptions options;
    options.after = action.after;
    options.grip = action.grip;
    options.plan_ends_mps = 0.0;
    run.begin({setup.bodies.data(), setup.bodies.size()}, 0, 1, 0.0, scene.point_m, options);
    test::run_to_end(run);
    // Leave out scenes with further contacts or longer sliding contact.
    if (run.contacts().size() != 1 ||
        run.contacts()[0].outcome.motion.poses[run.contacts()[0].outcome.motion.count - 1].time_s >
            pushed[0].time_s) {
      ++again;
      continue;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const ReferenceCar::State rest = rest_state(pushed[k], action, run.now_s());
      const PlanarBody& body = run.body(k);
      const double way = std::hypot(rest[0] - pushed[k].state[0], rest[1] - pushed[k].state[1]);
      const double off = std::hypot(body.x - rest[0], body.y - rest[1]);
      places.push_back(off);
      shares.push_back(off / std::max(1.0, way));
      const double turned =
          std::remainder(std::atan2(body.sine, body.cosine) - rest[2], 2.0 * detail::pi);
      headings.push_back(std::abs(turned) * 180.0 / detail::pi);
    }
  }
  std::printf("%zu bodies; %zu scenes with further contacts left out\n", places.size(), again);
  for (const auto& [name, values] :
       {std::pair{"place, m", &places}, std::pair{"place over distance (at least 1 m)", &shares},
        std::pair{"heading, degrees", &headings}}) {
    std::printf("error of %s: p50 %.3g, p90 %.3g, p95 %.3g, most %.3g\n", name,
                percentile(*values, 0.5), percentile(*values, 0.9), percentile(*values, 0.95),
                percentile(*values, 1.0));
  }
  ASSERT_GT(places.size(), count / 5);
  EXPECT_LT(percentile(places, 0.5), 0.01);
  EXPECT_LT(percentile(places, 0.95), 0.05);
  EXPECT_LT(percentile(headings, 0.5), 0.1);
  EXPECT_LT(percentile(headings, 0.95), 3.0);
}

}  // namespace
}  // namespace crashrank
