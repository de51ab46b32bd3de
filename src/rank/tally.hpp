#pragma once

#include "crashrank/crash/contact_law.hpp"
#include "crashrank/internal/rank/harm.hpp"
#include "rank/scene.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// Effect of a contact on one of its two bodies.
struct SideEffect {
  std::size_t body = ego_body;                            ///< index of an actor, or `ego_body`
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();  ///< world axes
  /// Part of the delta-v that changed no velocity: it counts in the contact's own delta-v, not in
  /// the sum of an event.
  Eigen::Vector3d squeeze_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();  ///< world axes
  /// forward axis of the body at the begin of the contact
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();
  double yaw_radps = 0.0;  ///< change of the yaw rate
  double road_mps = 0.0;   ///< speed over ground before the contact
  double intrusion_m = 0.0;
  double crush_j = 0.0;
};

/// Contribution of a simulated contact to a score.
struct ContactEffect {
  double begin_s = 0.0;
  double end_s = 0.0;
  double mean_force_s = 0.0;  ///< mean time of the force that counts
  double closing_mps = 0.0;   ///< closing speed at the begin
  double restitution = 0.0;
  double dissipated_j = 0.0;
  double closing_energy_j = 0.0;  ///< see Contact; 0 except in the first contact of the pair
  std::array<SideEffect, 2> sides;
};

/// Returns the effect with the restitution multiplied by `factor`, without a new simulation. Exact
/// if the impulse of the restitution phase is a fraction of that of the compression phase.
ContactEffect scale_restitution(const ContactEffect& effect, double factor);

/// Upper bound on the intrusion: the depth of the middle of the passenger compartment, m.
double max_intrusion_m(const Vehicle& v);

/// The contacts of one event of a body, taken together. Where a weak force, such as that of a
/// scrape, leads from one impact to the next, the earlier impact counts with the share that is left
/// of it when the later one begins.
struct BodyEvent {
  std::size_t number = 0;  ///< from 1; 0: none yet
  double end_s = 0.0;
  double summed_mps = 0.0;  ///< sum of the delta-v of its contacts, without directions
  double moment_m = 0.0;    ///< that sum weighted by the mean times of their forces
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();
  double greatest_mps = 0.0;  ///< largest delta-v of one of its contacts
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();  ///< forward axis at its begin
  double yaw_radps = 0.0;
  double road_mps = 0.0;            ///< speed over ground before it
  double closing_mps = 0.0;         ///< largest closing speed of a contact
  double reduced_kg = 0.0;          ///< reduced mass of the contact with the largest closing speed
  double largest_reduced_kg = 0.0;  ///< of all contacts
  double restitution = 0.0;         ///< largest of all contacts
  double leading_edge_m = 0.0;
  double intrusion_m = 0.0;         ///< largest intrusion by one other body
  std::size_t intruder = ego_body;  ///< other body of the last contact with intrusion
  double intruded_m = 0.0;          ///< intrusion by `intruder` since another body last intruded
  /// Largest risk over its contacts, each taken alone and together with those before it. A later
  /// contact that reduces the delta-v does not reduce the risk.
  double risk = 0.0;

  /// The same event with all that adds up multiplied by a share in [0, 1].
  BodyEvent scaled(double share) const;
  /// Share of it that is left at `time_s` where a weak force leads on to then.
  double left_at(double time_s) const;

  /// Delta-v of the event, m/s. Contacts on opposite sides cancel in the sum, so it is at least
  /// that of any single contact.
  double size_mps() const { return std::max(greatest_mps, delta_v_mps.norm()); }
};

/// Inputs of the harm model for the people on a body in an event.
HarmExposure exposure_of(const Scene& scene, std::size_t body, const BodyEvent& event);

/// Computes the score of one candidate in one sample from its contacts in the order of their begin
/// times. All callers get the same sums in the same order.
class Tally {
public:
  /// Allocates for a number of bodies.
  void prepare(std::size_t bodies) { bodies_.reserve(bodies); }
  /// Removes all contacts.
  void begin();
  /// Adds a simulated contact.
  void add(const Scene& scene, const ContactEffect& simulated, const HarmSample& sample);
  /// Score of the contacts added so far.
  double score(const Scene& scene) const;
  /// Lower bound on the score of any sequence of contacts that includes those added so far.
  double lower_bound(const Scene& scene) const;
  /// Contribution of the people of a body to the score; for other measures than harm, contribution
  /// of the delta-v of the ego.
  double people_score(const Scene& scene, std::size_t body) const;
  /// Risk of the people of every body with contacts, the ego first; measure harm only.
  std::vector<PersonRisk> people(const Scene& scene) const;
  /// Current event of a body: that of its last contact.
  BodyEvent event(std::size_t body) const;

private:
  struct Entry {
    std::size_t body = 0;
    BodyEvent open;
    double closed = 0.0;         ///< term of the events before the open one: a risk, or m/s
    double greatest_risk = 0.0;  ///< largest risk of one contact
  };
  Entry& entry(std::size_t body);
  const Entry* find(std::size_t body) const;
  void add_side(const Scene& scene, const ContactEffect& effect, std::size_t side,
                const HarmSample& sample);
  double term(const Scene& scene, const Entry& entry, const BodyEvent& last) const;

  double sum_ = 0.0;  ///< all terms except those of people and of the delta-v of the ego
  std::vector<Entry> bodies_;
};

}  // namespace crashrank::detail
