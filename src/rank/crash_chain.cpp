#include "rank/crash_chain.hpp"

#include "crash/pair_order.hpp"
#include "rank/held_manoeuvre.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Largest steering angle of the wheels, rad.
constexpr double most_steering_rad = 0.7;

SideEffect side_of(std::size_t body, const BodyContact& contact) {
  return {body, contact.delta_v_mps.norm(), contact.crush_energy_j};
}

SceneOptions options_of(const Scene& scene, const HarmSample& sample) {
  SceneOptions options;
  options.variant = variant_of(sample);
  options.contact.travel_m *= sample.step;
  options.contact.shortest_s *= sample.step;
  options.contact.longest_s *= sample.step;
  options.contact.speed_change *= sample.step;
  options.rolling_step_s *= sample.step;
  options.after = scene.harm.after_contact;
  options.grip = scene.grip;
  options.drivable = scene.road.drivable;
  options.off_road_grip = scene.road.off_road_grip.value_or(scene.grip);
  // Like candidates without contact, the simulation is evaluated at least until the horizon.
  options.until_s = scene.slice_s.back();
  options.fastest_plan_mps = scene.fastest_plan_mps;
  options.records_track =
      (scene.futures.size() > 1 || scene.futures.leaves_out()) && !scene.futures.displaces_ego();
  return options;
}

}  // namespace

double closing_energy_j(double mass_a_kg, double mass_b_kg, double speed_mps) {
  double reduced = mass_a_kg * mass_b_kg / (mass_a_kg + mass_b_kg);
  if (std::isinf(mass_a_kg)) reduced = mass_b_kg;
  if (std::isinf(mass_b_kg)) reduced = mass_a_kg;
  return 0.5 * reduced * speed_mps * speed_mps;
}

ContactVariant variant_of(const HarmSample& sample) {
  // The friction of a sample is stated for a pair of painted panels; other pairs scale with it.
  const double panels = friction_between(Surface::sheet_metal, Surface::sheet_metal);
  return {sample.friction / panels, sample.strength, 1.0};
}

HeldControls controls_after(const Scene& scene, const Motion& plan, const Vehicle& vehicle,
                            double contact_s) {
  const HeldManoeuvre held = held_manoeuvre(plan, vehicle.center_m, contact_s);
  HeldControls controls;
  controls.brake = std::clamp(held.braking_mps2 / (scene.grip * standard_gravity_mps2),
                              brake_after_contact, 1.0);
  controls.steering_rad = std::clamp(std::atan(held.curvature_per_m * vehicle.wheelbase_m),
                                     -most_steering_rad, most_steering_rad);
  return controls;
}

void CrashChain::prepare(const Scene& scene) {
  bodies_.reserve(scene.actors.size() + 1);
  actors_.reserve(scene.actors.size() + 1);
  sorted_.reserve(scene.actors.size() + 1);
  std::size_t pieces = scene.ego.vehicle->profile->pieces.size();
  for (const Body& actor : scene.actors) {
    pieces = std::max(pieces, actor.vehicle->profile->pieces.size());
  }
  for (const std::optional<EnteringBody>& kind : scene.entering) {
    if (kind) pieces = std::max(pieces, kind->body.vehicle->profile->pieces.size());
  }
  for (const JoinedBodies& joined : scene.joined) {
    pieces = std::max(pieces, joined.vehicle.profile->pieces.size());
  }
  run_.prepare(scene.actors.size() + 1, pieces, scene.futures.max_future_count() > 1);
}

void CrashChain::begin(const Scene& scene, const Motion& plan, std::size_t future,
                       const Contact& first, const HarmSample& sample) {
  first_actor_ = first.actor;
  first_closing_mps_ = first.closing_speed_mps;
  first_closing_energy_j_ = first.closing_energy_j;
  begin_s_ = first.time_of_impact_s;
  origin_m_ = first.point_m.head<2>();
  bodies_.clear();
  actors_.clear();
  const auto add = [&](std::size_t index, std::size_t number, const Vehicle& vehicle,
                       const Motion& motion) {
    SceneBody body;
    body.vehicle = &vehicle;
    body.plan = &motion;
    if (vehicle.movable()) {
      const HeldControls held = controls_after(scene, motion, vehicle, first.time_of_impact_s);
      body.brake = held.brake;
      body.steering_rad = held.steering_rad;
      body.footing = &body_of(scene, index).footing;
    }
    body.number = static_cast<std::uint32_t>(number);
    if (index != ego_body) body.adjoins = scene.adjoining[number];
    bodies_.push_back(body);
    actors_.push_back(index);
  };
  add(ego_body, scene.actors.size(), *scene.ego.vehicle, plan);
  std::size_t partner = 0;
  SceneBody& ego = bodies_.front();
  const Vector3d across(-first.closing.y(), first.closing.x(), 0.0);
  const double speed = across.norm();
  if (speed > 0.0) ego.shift_m = (sample.shift_m / speed) * across;
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    const std::uint32_t followed = scene.futures.plan(future, i);
    if (followed == Futures::absent) continue;
    const Motion& motion = scene.futures.plans[followed].motion;
    const std::size_t joined = scene.joined_of[i];
    if (joined == Scene::not_joined) {
      add(i, i, *scene.actors[i].vehicle, motion);
    } else if (scene.joined[joined].members.front() == i) {
      const bool hit = scene.joined_of[first.actor] == joined;
      add(hit ? first.actor : i, i, scene.joined[joined].vehicle, motion);
    }
  }
  sort_actors(first.time_of_impact_s);
  while (actors_[partner] != first.actor) ++partner;
  SceneOptions options = options_of(scene, sample);
  options.contact.overlapping = !(first.time_of_impact_s > 0.0);
  run_.begin({bodies_.data(), bodies_.size()}, 0, partner, first.time_of_impact_s, first.point_m,
             options);
}

/// Sorts the bodies by their properties and states, so that the result does not depend on the order
/// of the actors.
void CrashChain::sort_actors(double time_s) {
  sorted_.clear();
  for (const SceneBody& body : bodies_) {
    ContactBody state;
    state.vehicle = body.vehicle;
    body.plan->state_at(time_s, state.pose, state.velocity);
    sorted_.push_back({state, body, actors_[sorted_.size()]});
  }
  std::sort(sorted_.begin() + 1, sorted_.end(), [](const SortedBody& p, const SortedBody& q) {
    if (goes_second(q.at, p.at)) return true;
    return !goes_second(p.at, q.at) && p.actor < q.actor;
  });
  for (std::size_t i = 1; i < sorted_.size(); ++i) {
    bodies_[i] = sorted_[i].body;
    actors_[i] = sorted_[i].actor;
  }
}

void CrashChain::mark_relevant_plans(const Scene& scene, std::vector<char>& relevant) const {
  const std::vector<Plan>& plans = scene.futures.plans;
  for (std::size_t p = 0; p < plans.size(); ++p) {
    const std::size_t actor = plans[p].actor;
    if (relevant[p] != 0 || !scene.futures.exists(actor) || scene.futures.is_certain(actor)) {
      continue;
    }
    SceneBody body;
    body.vehicle = scene.actors[actor].vehicle.get();
    body.plan = &plans[p].motion;
    if (run_.would_act(body, scene.actors.size() + 1)) relevant[p] = 1;
  }
}

void CrashChain::finish() {
  while (run_.advance(std::numeric_limits<int>::max())) {
  }
}

void CrashChain::finish_recording(std::vector<BodyMotion>& motion) {
  std::vector<std::size_t> place(actors_.size(), actors_.size());
  const auto add = [&](BodyMotion& to, double time_s, const PlanarBody& body, bool pressed) {
    to.t_s.push_back(time_s);
    to.x_m.push_back(origin_m_.x() + body.x);
    to.y_m.push_back(origin_m_.y() + body.y);
    to.yaw_rad.push_back(std::atan2(body.sine, body.cosine));
    to.vx_mps.push_back(body.vx);
    to.vy_mps.push_back(body.vy);
    to.yaw_rate_radps.push_back(body.spin);
    to.pressed.push_back(pressed ? 1 : 0);
  };
  bool going = true;
  while (going) {
    const double before_s = run_.now_s();
    going = run_.advance(1);
    for (std::size_t i = 0; i < actors_.size(); ++i) {
      if (!run_.touched(i)) continue;
      if (place[i] == actors_.size()) {
        place[i] = motion.size();
        motion.emplace_back();
        motion.back().body = actors_[i];
        ContactBody planned;
        planned.vehicle = bodies_[i].vehicle;
        bodies_[i].plan->state_at(before_s, planned.pose, planned.velocity);
        planned.pose.translation += bodies_[i].shift_m;
        add(motion.back(), before_s,
            make_planar(planned, Vector3d(origin_m_.x(), origin_m_.y(), 0.0)), false);
      }
      add(motion[place[i]], run_.now_s(), run_.body(i), run_.pressed(i));
    }
  }
  static_assert(ego_body + 1 == 0);
  std::sort(motion.begin(), motion.end(),
            [](const BodyMotion& p, const BodyMotion& q) { return p.body + 1 < q.body + 1; });
}

ContactEffect CrashChain::effect(std::size_t index) const {
  const View<const SceneContact> all = contacts();
  const SceneContact& contact = all[index];
  // Closing energy counts only in the first contact of a pair. The contacts of a pair are in order
  // of time.
  const bool again = std::any_of(all.begin(), all.begin() + index, [&](const SceneContact& before) {
    return before.a == contact.a && before.b == contact.b;
  });
  ContactEffect e;
  if (!again) {
    e.closing_energy_j =
        closing_energy_j(contact.given_a.vehicle->mass_kg, contact.given_b.vehicle->mass_kg,
                         contact.is_first ? first_closing_mps_ : closing_of(contact).norm());
  }
  e.restitution = contact.outcome.restitution;
  e.dissipated_j = contact.outcome.dissipated_j;
  e.sides[0] = side_of(body(contact.a), contact.outcome.a);
  e.sides[1] = side_of(contact.is_first ? first_actor_ : body(contact.b), contact.outcome.b);
  return e;
}

Vector3d closing_of(const SceneContact& contact) {
  const Vector3d& point = contact.outcome.begin_point_m;
  const auto at = [&](const ContactBody& body) {
    return velocity_of_point(body.velocity, body.pose.translation, point);
  };
  Vector3d closing = at(contact.given_a) - at(contact.given_b);
  closing.z() = 0.0;
  return closing;
}

bool CrashChain::first_acts() const {
  const View<const SceneContact> all = contacts();
  return std::any_of(all.begin(), all.end(), [](const SceneContact& c) { return c.is_first; });
}

void CrashChain::effects(CrashEffects& effects, std::vector<std::size_t>& order) const {
  const View<const SceneContact> all = contacts();
  effects.clear();
  effects.begin_s = begin_s_;
  order.clear();
  for (std::size_t k = 0; k < all.size(); ++k) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
    const SceneContact& c = all[p];
    const SceneContact& d = all[q];
    if (c.begin_s != d.begin_s) return c.begin_s < d.begin_s;
    if (c.a != d.a) return c.a < d.a;
    return c.b != d.b ? c.b < d.b : p < q;
  });
  const bool is_over = run_.over();
  if (is_over && !first_acts()) {
    // If the same bodies have a contact with force later, their closing energy counts in that one.
    const bool presses_later = std::any_of(all.begin(), all.end(), [&](const SceneContact& c) {
      return body(c.a) == ego_body && body(c.b) == first_actor_;
    });
    ContactEffect effect;
    effect.sides[1].body = first_actor_;
    if (!presses_later) effect.closing_energy_j = first_closing_energy_j_;
    effects.contacts.push_back(effect);
    order.insert(order.begin(), touch);
  }
  for (std::size_t k = effects.contacts.size(); k < order.size(); ++k) {
    effects.contacts.push_back(effect(order[k]));
  }
  const std::int32_t until = run_.current_cell();
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    View<const ExposureCell> cells = run_.exposure_cells(i);
    std::size_t count = cells.size();
    while (!is_over && count > 0 && cells[count - 1].index >= until) --count;
    const bool is_in_first = actors_[i] == ego_body || actors_[i] == first_actor_;
    if (count > 0 || is_in_first) effects.add(actors_[i], {cells.data(), count});
  }
}

}  // namespace crashrank::detail
