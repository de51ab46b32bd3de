#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/motion/time_of_impact.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crashrank {

/// Damage of a crash to one body.
struct BodyDamage {
  /// Damaged triangles in ascending order of their indices: those that intersect the other body or
  /// pass through its surface while the two move as in the simulated contact, see `rank`. If a body
  /// is inside the other at the start, all of its triangles are damaged.
  std::vector<std::uint32_t> triangles;
  /// indices of the parts of the mesh with damaged triangles, ascending
  std::vector<std::uint32_t> parts;
  double area_m2 = 0.0;  ///< of those triangles
  Box region;  ///< where the surfaces intersect, in body coordinates; empty if they do not
  Pose pose;   ///< body to world at first contact
};

/// Mechanical result of a crash for one body. Velocities in its own axes before the crash.
struct BodyOutcome {
  double delta_v_mps = 0.0;            ///< magnitude
  double delta_v_x_mps = 0.0;          ///< forward, m/s
  double delta_v_y_mps = 0.0;          ///< to the left, m/s
  double yaw_rate_change_radps = 0.0;  ///< to the left, rad/s
  /// What the body lives through in the whole crash, see PersonRisk::exposure_mps; harm reads it.
  double exposure_mps = 0.0;
  double pdof_deg = 0.0;        ///< where the force comes from, clockwise from ahead, [0, 360)
  int clock = 12;               ///< the PDOF as an hour, 12 ahead
  double crush_energy_j = 0.0;  ///< work done in deforming the body, J
  double ees_mps = 0.0;         ///< energy-equivalent speed, m/s
  double crush_m = 0.0;         ///< crush depth, m
  /// into the compartment, in excess of earlier intrusion by the same body, m
  double intrusion_m = 0.0;
  double harm = 0.0;  ///< persons, as weighted; measure harm only
  std::string cdc;    ///< collision deformation classification, SAE J224
};

/// Result of a contact for its two bodies, starting from the states after earlier contacts.
struct ContactSeverity {
  /// Harm was evaluated, since the measure needs it. Changes of velocity are those of the
  /// simulation under every measure.
  bool simulated = false;
  bool slides = false;        ///< the surfaces slide along each other
  double duration_s = 0.0;    ///< of the crush phase, s
  double dissipated_j = 0.0;  ///< energy turned into damage and heat, J
  BodyOutcome ego;            ///< result for the ego
  BodyOutcome other;          ///< result for the other
  double harm = 0.0;          ///< persons, as weighted
};

/// A force is expected of contacts above this speed, m/s, before the bodies have closed by this
/// distance, m, and this time has passed, s: see Contact::contact_without_force. Design choices.
inline constexpr double least_forced_speed_mps = 0.5;
inline constexpr double force_within_m = 0.1;  ///< at constant speed along the normal
inline constexpr double force_within_s = 0.1;  ///< s

/// A contact of the ego with another body. Points and directions in world coordinates. Of contacts
/// after the first, which the simulation finds, `gap_m` is 0, `point_m` the mean point of the force
/// and `normal` the direction of `closing`.
struct Contact {
  /// Index into Scenario::actors; of joined fixed bodies the one touched first, later the one hit.
  std::size_t actor = 0;
  ImpactState state = ImpactState::contact;  ///< contact, grazing or contained
  double time_of_impact_s = 0.0;             ///< from the decision, s
  double gap_m = 0.0;                        ///< between the surfaces then, at most the tolerance
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< point of contact, world, m
  /// Unit, from the ego towards the other; zero for a body that lies inside another.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// velocity of the ego relative to the other body at the point, m/s
  Eigen::Vector3d closing = Eigen::Vector3d::Zero();
  /// Magnitude of `closing`, m/s.
  double closing_speed_mps = 0.0;
  /// Component of `closing` along the normal, m/s. Depends on the facet that is touched first.
  double normal_speed_mps = 0.0;
  /// The exact meshes meet, found by the search for first contacts, with more than
  /// `least_forced_speed_mps` along the normal (without a normal: of `closing_speed_mps`), but no
  /// force between the two bodies begins within `force_within_m` along it and `force_within_s`. The
  /// crash model then says nothing of this contact, and the score interval of the candidate extends
  /// to what the energy of the scene allows.
  bool contact_without_force = false;
  /// ½·m₁m₂/(m₁+m₂)·closing_speed²: the energy that would be dissipated if the bodies stuck
  /// together and their relative velocity passed through the common centre of mass.
  double closing_energy_j = 0.0;
  /// Duration of the simulated motion along which damage was evaluated, from the begin of the
  /// contact to the end of its force, s: `severity.duration_s`. 0 if the bodies do not press on
  /// each other.
  double crush_s = 0.0;
  /// Largest displacement during that motion of the point of the ego at `point_m`, in the frame of
  /// the other body, m. The sum of both crush depths in a perpendicular impact; more if the
  /// surfaces slide.
  double travel_m = 0.0;
  /// Damage to the ego, including damage by fixed bodies that adjoin `actor` and that the ego
  /// presses on in the same contact.
  BodyDamage ego;
  BodyDamage other;          ///< damage to `actor`
  ContactSeverity severity;  ///< mechanical result of the contact
};

/// Index of the ego, used where a body is identified by an index into Scenario::actors.
inline constexpr std::size_t ego_body = static_cast<std::size_t>(-1);

/// A contact between two bodies other than the ego, at least one of which was hit earlier in the
/// same crash. World axes.
struct FurtherContact {
  std::size_t a = 0;    ///< index into Scenario::actors; it is movable, b may be fixed
  std::size_t b = 0;    ///< index of the other body
  double time_s = 0.0;  ///< from the decision, s
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< mean point of the force, m
  /// velocity of a relative to b at the point, m/s
  Eigen::Vector3d closing = Eigen::Vector3d::Zero();
  double closing_speed_mps = 0.0;  ///< magnitude of `closing`
  double closing_energy_j = 0.0;   ///< as in Contact
  bool slides = false;             ///< the surfaces slide along each other
  double duration_s = 0.0;         ///< of the force, s
  double dissipated_j = 0.0;       ///< energy turned into damage and heat, J
  double harm = 0.0;               ///< persons, as weighted
  BodyOutcome outcome_a;           ///< result for a
  BodyOutcome outcome_b;           ///< result for b
  BodyDamage damage_a;             ///< triangles of a
  BodyDamage damage_b;             ///< triangles of b
};

/// Simulated motion of the centre of mass of a body that contact forces acted on, from its state
/// before the first force to the end of the simulation. World axes; all members have one length.
struct BodyMotion {
  std::size_t body = ego_body;         ///< `ego_body`, or an index into Scenario::actors
  std::vector<double> t_s;             ///< from the decision, rising
  std::vector<double> x_m;             ///< position, m
  std::vector<double> y_m;             ///< m
  std::vector<double> yaw_rad;         ///< heading, left positive, from x
  std::vector<double> vx_mps;          ///< velocity, m/s
  std::vector<double> vy_mps;          ///< m/s
  std::vector<double> yaw_rate_radps;  ///< left positive, rad/s
  std::vector<char> pressed;           ///< 1: a contact force acted since the time before
};

/// An approach within the tolerance without intersection.
struct Graze {
  std::size_t actor = 0;  ///< index into Scenario::actors
  double time_s = 0.0;    ///< s
};

}  // namespace crashrank
