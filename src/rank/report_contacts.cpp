#include "rank/report_contacts.hpp"

#include "crashrank/crash/contact_law.hpp"
#include "rank/adjoin.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

void fill_outcome(const ContactBody& body, const Model& model, const BodyContact& from, bool slides,
                  BodyOutcome& to) {
  const Vehicle& v = *body.vehicle;
  const Vector3d local = body.pose.rotation.transpose() * from.delta_v_mps;
  to.delta_v_mps = from.delta_v_mps.norm();
  to.delta_v_x_mps = local.x();
  to.delta_v_y_mps = local.y();
  to.yaw_rate_change_radps = from.delta_yaw_rate_radps;
  to.pdof_deg = from.pdof_deg;
  to.clock = clock_of(to.pdof_deg);
  to.crush_energy_j = from.crush_energy_j;
  to.ees_mps = v.movable() ? std::sqrt(2.0 * from.crush_energy_j / v.mass_kg) : 0.0;
  to.intrusion_m = from.intrusion_m;
  if (from.damaged.empty()) return;
  const Box bounds = model.mesh.bounds();
  const double damage_m = damage_depth_m(from.damaged, bounds);
  // Penetration along a flank can exceed the depth of the damaged region, which limits the crush.
  to.crush_m = std::min(from.crush_depth_m, damage_m);
  to.cdc = cdc_code({to.pdof_deg, from.damaged, bounds, damage_m, slides});
}

/// Actor that is the second body of a contact; of joined bodies the member nearest to the force.
std::size_t second_body(const Scene& scene, const CrashChain& chain, const SceneContact& contact) {
  const std::size_t body = chain.body(contact.b);
  const std::size_t joined = scene.joined_of[body];
  if (joined == Scene::not_joined) return body;
  const std::vector<std::size_t>& members = scene.joined[joined].members;
  const auto away_m = [&](std::size_t actor) {
    return distance_m(rectangle_of(scene.actors[actor]), contact.outcome.point_m.head<2>());
  };
  return *std::min_element(members.begin(), members.end(),
                           [&](std::size_t p, std::size_t q) { return away_m(p) < away_m(q); });
}

/// A later contact of the ego, found by the simulation and not by the exact search. The bodies are
/// already deformed then.
Contact later_contact(const Scene& scene, const CrashChain& chain, const SceneContact& from) {
  Contact contact;
  contact.actor = second_body(scene, chain, from);
  contact.time_of_impact_s = from.begin_s;
  contact.point_m = from.outcome.point_m;
  contact.closing = closing_of(from);
  contact.closing_speed_mps = contact.closing.norm();
  // The undeformed surfaces already intersect, so no facet defines a normal: use the closing
  // direction.
  if (contact.closing_speed_mps > 0.0) contact.normal = contact.closing.normalized();
  contact.normal_speed_mps = contact.closing_speed_mps;
  contact.closing_energy_j = closing_energy_j(
      scene.ego.mass_kg, scene.actors[contact.actor].mass_kg, contact.closing_speed_mps);
  return contact;
}

FurtherContact further_contact(const Scene& scene, const CrashChain& chain,
                               const SceneContact& from) {
  FurtherContact contact;
  contact.a = chain.body(from.a);
  contact.b = second_body(scene, chain, from);
  const Body& a = scene.actors[contact.a];
  const Body& b = scene.actors[contact.b];
  contact.time_s = from.begin_s;
  contact.point_m = from.outcome.point_m;
  contact.closing = closing_of(from);
  contact.closing_speed_mps = contact.closing.norm();
  contact.closing_energy_j = closing_energy_j(a.mass_kg, b.mass_kg, contact.closing_speed_mps);
  contact.slides = from.outcome.slides;
  contact.duration_s = from.outcome.duration_s;
  contact.dissipated_j = from.outcome.dissipated_j;
  fill_outcome(from.given_a, *a.model, from.outcome.a, contact.slides, contact.outcome_a);
  fill_outcome(from.given_b, *b.model, from.outcome.b, contact.slides, contact.outcome_b);
  return contact;
}

void fill_severity(const Scene& scene, const SceneContact& from, Contact& contact) {
  ContactSeverity& severity = contact.severity;
  severity.simulated = needs_crash(scene.measure);
  severity.slides = from.outcome.slides;
  severity.duration_s = from.outcome.duration_s;
  severity.dissipated_j = from.outcome.dissipated_j;
  fill_outcome(from.given_a, *scene.ego.model, from.outcome.a, severity.slides, severity.ego);
  fill_outcome(from.given_b, *scene.actors[contact.actor].model, from.outcome.b, severity.slides,
               severity.other);
}

/// Damage of a contact in which the surfaces touch, but the outlines do not press on each other.
DamagePlan plan_touch(const Scene& scene, const Touch& touch) {
  const Contact& contact = touch.contact;
  ContactMotion motion;
  motion.count = 1;
  motion.poses[0].a = touch.ego;
  motion.poses[0].b = touch.other;
  return plan_damage(scene,
                     {ego_body, contact.actor, contact.state, contact.gap_m, touch.triangle_ego,
                      touch.triangle_other, contact.point_m},
                     motion, {});
}

/// Actors that pressed on the first body in a contact; joined bodies count with all their members.
std::vector<std::size_t> pressed_actors(const Scene& scene, const CrashChain& chain,
                                        const SceneContact& from) {
  std::vector<std::size_t> pressed;
  for (std::size_t k = 0; k < from.pressed_count; ++k) {
    const std::size_t actor = chain.body(from.pressed[k]);
    const std::size_t joined = scene.joined_of[actor];
    if (joined == Scene::not_joined) {
      pressed.push_back(actor);
    } else {
      const std::vector<std::size_t>& members = scene.joined[joined].members;
      pressed.insert(pressed.end(), members.begin(), members.end());
    }
  }
  return pressed;
}

}  // namespace

Contact first_contact(const Scene& scene, const Motion& ego, std::size_t actor, const Motion& plan,
                      const Impact& impact) {
  const Body& other = scene.actors[actor];
  Contact contact;
  contact.actor = actor;
  contact.state = impact.state;
  contact.time_of_impact_s = impact.time_s;
  contact.gap_m = impact.gap_m;
  contact.normal = impact.normal;
  Pose ego_pose;
  Velocity ego_velocity;
  ego.state_at(impact.time_s, ego_pose, ego_velocity);
  Pose other_pose;
  Velocity other_velocity;
  plan.state_at(impact.time_s, other_pose, other_velocity);
  if (impact.triangle_a >= 0 && impact.triangle_b >= 0) {
    contact.point_m = 0.5 * (impact.point_a_m + impact.point_b_m);
  } else {
    // One body contains the other: the point is the centre of the smaller one, or the mean of both
    // centres if they are equal.
    const Vector3d own = ego_pose.rotation * scene.ego.center_m + ego_pose.translation;
    const Vector3d theirs = other_pose.rotation * other.center_m + other_pose.translation;
    contact.point_m = scene.ego.radius_m < other.radius_m   ? own
                      : other.radius_m < scene.ego.radius_m ? theirs
                                                            : Vector3d(0.5 * (own + theirs));
  }
  contact.closing = velocity_of_point(ego_velocity, ego_pose.translation, contact.point_m) -
                    velocity_of_point(other_velocity, other_pose.translation, contact.point_m);
  contact.closing_speed_mps = contact.closing.norm();
  contact.normal_speed_mps = std::max(0.0, contact.closing.dot(contact.normal));
  contact.closing_energy_j =
      closing_energy_j(scene.ego.mass_kg, other.mass_kg, contact.closing_speed_mps);
  return contact;
}

Touch first_touch(const Scene& scene, const Motion& ego, std::size_t actor, const Motion& plan,
                  const Impact& impact) {
  Touch touch;
  touch.contact = first_contact(scene, ego, actor, plan, impact);
  touch.triangle_ego = impact.triangle_a;
  touch.triangle_other = impact.triangle_b;
  touch.ego = ego.pose_at(impact.time_s);
  touch.other = plan.pose_at(impact.time_s);
  return touch;
}

OutcomePair outcomes_of(CandidateResult& result, const ReportedContact& reported) {
  if (reported.is_further) {
    FurtherContact& contact = result.further[reported.index];
    return {contact.outcome_a, contact.outcome_b};
  }
  ContactSeverity& severity = result.contacts[reported.index].severity;
  return {severity.ego, severity.other};
}

std::vector<ReportedContact> report_contacts(const Scene& scene, const CrashChain& chain,
                                             const Touch& first,
                                             const std::vector<std::size_t>& order,
                                             CandidateResult& result,
                                             std::vector<DamagePlan>& plans) {
  std::vector<ReportedContact> reported;
  std::vector<DamagePlan> further_plans;
  const auto add = [&](const Contact& contact) {
    result.contacts.push_back(contact);
    result.contacts.back().severity.simulated = needs_crash(scene.measure);
    plans.emplace_back();
  };
  add(first.contact);
  for (const std::size_t k : order) {
    if (k == CrashChain::touch) {
      plans.back() = plan_touch(scene, first);
      reported.push_back({false, 0});
      continue;
    }
    const SceneContact& from = chain.contacts()[k];
    const std::vector<std::size_t> pressed = pressed_actors(scene, chain, from);
    const View<const std::size_t> pressed_view{pressed.data(), pressed.size()};
    DamageQuery query;
    if (from.a != 0) {
      result.further.push_back(further_contact(scene, chain, from));
      reported.push_back({true, result.further.size() - 1});
      const FurtherContact& contact = result.further.back();
      query = {contact.a, contact.b, ImpactState::contact, 0.0, -1, -1, contact.point_m};
      further_plans.push_back(plan_damage(scene, query, from.outcome.motion, pressed_view));
      continue;
    }
    const bool is_first = from.is_first;
    if (!is_first) add(later_contact(scene, chain, from));
    const std::size_t index = is_first ? 0 : result.contacts.size() - 1;
    Contact& contact = result.contacts[index];
    fill_severity(scene, from, contact);
    reported.push_back({false, index});
    query = {ego_body, contact.actor, contact.state, contact.gap_m, -1, -1, contact.point_m};
    if (is_first) {
      query.triangle_a = first.triangle_ego;
      query.triangle_b = first.triangle_other;
    }
    DamagePlan plan = plan_damage(scene, query, from.outcome.motion, pressed_view);
    contact.crush_s = plan.crush_s;
    contact.travel_m = plan.travel_m;
    plans[index] = std::move(plan);
  }
  for (DamagePlan& plan : further_plans) plans.push_back(std::move(plan));
  return reported;
}

}  // namespace crashrank::detail
