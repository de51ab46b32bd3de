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

/// Contacts of one body that begin within this time of the end of one before are one event: it has
/// one delta-v, the sum of theirs, s.
inline constexpr double same_event_s = 0.1;

/// What a contact does to one of its two bodies.
struct SideEffect {
  std::size_t body = ego_body;                            ///< an actor, or the ego
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();  ///< world axes
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();   ///< world axes
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();     ///< its x axis as it begins
  double yaw_radps = 0.0;                                 ///< change of its yaw rate
  double road_mps = 0.0;                                  ///< its speed before
  double intrusion_m = 0.0;
  double crush_j = 0.0;
};

/// What a simulated contact adds to a score.
struct ContactEffect {
  double begin_s = 0.0;
  double end_s = 0.0;
  bool is_apart = false;     ///< an event of its own, however soon it follows
  double closing_mps = 0.0;  ///< as it begins
  double restitution = 0.0;  ///< of the simulation
  double dissipated_j = 0.0;
  double closing_energy_j = 0.0;  ///< see Contact; 0 but in the first contact of the two
  std::array<SideEffect, 2> sides;
};

/// The effect with the restitution multiplied by `factor`, without another simulation: exact as far
/// as one rebound gives back part of the impulse.
ContactEffect scale_restitution(const ContactEffect& effect, double factor);

/// Depth of the middle of the passenger compartment: no intrusion is greater, m.
double max_intrusion_m(const Vehicle& v);

/// A body's contacts of one event taken together.
struct BodyEvent {
  std::size_t number = 0;  ///< counted from 1; 0: none yet
  double end_s = 0.0;
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();
  double greatest_mps = 0.0;  ///< delta-v of one of its contacts
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();  ///< at its begin
  double yaw_radps = 0.0;
  double road_mps = 0.0;     ///< before it
  double closing_mps = 0.0;  ///< greatest
  double reduced_kg = 0.0;   ///< of the contact with that
  double leading_edge_m = 0.0;
  double intrusion_m = 0.0;         ///< greatest of one other body
  std::size_t intruder = ego_body;  ///< body of the last contact that intruded
  double intruded_m = 0.0;          ///< by that one since it last took turns
  /// Greatest of its contacts, each alone and after those before it: a further contact that takes
  /// delta-v back heals nobody.
  double risk = 0.0;

  /// Contacts on opposite sides cancel in the sum: no less than that of one of them.
  double size_mps() const { return std::max(greatest_mps, delta_v_mps.norm()); }
};

/// Exposure of the people on a body to an event.
HarmExposure exposure_of(const Scene& scene, std::size_t body, const BodyEvent& event);

/// The score of one candidate in one sample: contact by contact in the order of their begins. The
/// same sums in the same order wherever it is used.
class Tally {
public:
  /// Room for so many bodies.
  void prepare(std::size_t bodies) { bodies_.reserve(bodies); }
  /// Forgets all contacts.
  void begin();
  /// Adds a contact that was simulated.
  void add(const Scene& scene, const ContactEffect& simulated, const HarmSample& sample);
  /// The score of all added so far.
  double score(const Scene& scene) const;
  /// No score that has these contacts and any others is lower, in whatever order they come.
  double lower_bound(const Scene& scene) const;
  /// The share of a body's people in the score; measures but harm: of the ego's delta-v.
  double people_score(const Scene& scene, std::size_t body) const;
  /// What the people of every body with contacts risk, the ego first; measure harm only.
  std::vector<PersonRisk> people(const Scene& scene) const;
  /// The event of a body that its last contact belongs to.
  BodyEvent event(std::size_t body) const;

private:
  struct Entry {
    std::size_t body = 0;
    BodyEvent open;
    double closed = 0.0;         ///< events before the open one: risk, or m/s
    double greatest_risk = 0.0;  ///< of one contact
  };
  Entry& entry(std::size_t body);
  const Entry* find(std::size_t body) const;
  void add_side(const Scene& scene, const ContactEffect& effect, std::size_t side,
                const HarmSample& sample);
  double term(const Scene& scene, const Entry& entry) const;

  double sum_ = 0.0;  ///< all but people and the ego's delta-v
  std::vector<Entry> bodies_;
};

}  // namespace crashrank::detail
