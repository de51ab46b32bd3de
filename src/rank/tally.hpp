#pragma once

#include "crashrank/crash/contact_law.hpp"
#include "rank/crash_setup.hpp"
#include "rank/scene.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <limits>

namespace crashrank::detail {

/// Contacts of one body that begin within this time of the end of one before are one event: it has
/// one delta-v, the sum of theirs, s.
inline constexpr double same_event_s = 0.1;

/// What a simulated contact adds to a score.
struct ContactEffect {
  std::size_t actor = 0;
  double begin_s = 0.0;
  double end_s = 0.0;
  double closing_mps = 0.0;  ///< at first contact
  double restitution = 0.0;  ///< of the simulation
  double dissipated_j = 0.0;
  Eigen::Vector3d ego_delta_v_mps = Eigen::Vector3d::Zero();  ///< world axes
  Eigen::Vector3d ego_impulse_ns = Eigen::Vector3d::Zero();   ///< world axes
  Eigen::Vector3d ego_forward = Eigen::Vector3d::UnitX();
  double ego_yaw_radps = 0.0;  ///< change of its yaw rate
  double ego_road_mps = 0.0;   ///< its speed before
  double other_road_mps = 0.0;
  double other_delta_v_mps = 0.0;
  double other_pdof_deg = 0.0;
  double ego_intrusion_m = 0.0;
  double other_intrusion_m = 0.0;
  double ego_crush_j = 0.0;
  double other_crush_j = 0.0;
};

ContactEffect effect_of(const Contact& contact, const CrashSetup& crash,
                        const ContactOutcome& outcome);

/// The effect with the restitution multiplied by `factor`, without another simulation: exact as far
/// as one rebound gives back part of the impulse.
ContactEffect with_rebound(const ContactEffect& effect, double factor);

/// Depth of the middle of the passenger compartment: no intrusion is greater, m.
double most_intrusion_m(const Vehicle& v);

/// The ego's contacts of one event taken together.
struct EgoEvent {
  std::size_t number = 0;  ///< counted from 1; 0: none yet
  double begin_s = 0.0;
  double end_s = 0.0;
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();  ///< at its begin
  double yaw_radps = 0.0;
  double road_mps = 0.0;     ///< before it
  double closing_mps = 0.0;  ///< greatest
  double reduced_kg = 0.0;   ///< of the contact with that
  double leading_edge_m = 0.0;
  double intrusion_m = 0.0;  ///< greatest
  /// Greatest after each of its contacts: a further contact that takes delta-v back heals nobody.
  double risk = 0.0;
};

/// Exposure of the people in the ego to an event.
HarmExposure exposure_of(const Scene& scene, const EgoEvent& event);
/// Exposure of the people in the other body of a contact.
HarmExposure exposure_of_other(const Scene& scene, const ContactEffect& effect);

/// Between what something lies.
struct Range {
  double least = 0.0;
  double most = 0.0;
};

/// What is known of a contact whose simulation has not ended.
struct PendingContact {
  std::size_t actor = 0;
  double begin_s = 0.0;
  double closing_mps = 0.0;
  double ego_road_mps = 0.0;
  double other_road_mps = 0.0;
  Range ego_delta_v_mps;
  Range other_delta_v_mps;
  Range dissipated_j;
};

/// No bound on a speed.
inline constexpr double endless_v = std::numeric_limits<double>::infinity();

/// What contacts after the pending one may add.
struct Later {
  bool any = false;                    ///< there may be one
  double most = 0.0;                   ///< to all but the ego's people
  double ego_delta_v_mps = endless_v;  ///< summed over them, at most
};

/// The score of one candidate, contact by contact in time order, in one sample. The same sums in
/// the same order wherever it is used.
class Tally {
public:
  /// Adds a contact that was simulated.
  void add(const Scene& scene, const ContactEffect& simulated, const HarmSample& sample);
  /// The score of all added so far.
  double score(const Scene& scene) const;
  /// The share of the ego's people in that score; measures but harm: of the ego's delta-v.
  double ego_score(const Scene& scene) const;
  /// The event that the last contact belongs to.
  const EgoEvent& event() const noexcept { return open_; }
  /// Score once the pending contact and what may follow have been added.
  Range bounds(const Scene& scene, const PendingContact& pending, const Later& later) const;

private:
  double ego_term(const Scene& scene) const;

  double sum_ = 0.0;     ///< all but the ego's events
  double closed_ = 0.0;  ///< the ego's events before the open one: risk, or m/s
  EgoEvent open_;
};

}  // namespace crashrank::detail
