#pragma once

#include "crashrank/crash/contact_law.hpp"
#include "rank/contact_severity.hpp"
#include "rank/scene.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// Bodies that nothing moves near a contact with one of them: they press at the same time.
struct FixedGroup {
  static constexpr std::size_t most = 64;
  std::vector<ContactBody> bodies;
  std::vector<std::size_t> actors;  ///< by body; of joined ones the first

  void reserve() {
    bodies.reserve(most);
    actors.reserve(most);
  }
};

/// Two bodies as the simulation of their contact begins.
struct CrashSetup {
  ContactBody a;  ///< the ego
  ContactBody b;
  View<const ContactBody> fixed;
};

/// `group` is filled and referred to by the result. `met` are bodies that press no more.
CrashSetup set_up_crash(const Scene& scene, const EgoAtContact& ego, const Contact& contact,
                        View<const std::size_t> met, FixedGroup& group);

/// A body's mass and motion about its centre of mass; immovable ones stand.
struct RigidState {
  double mass_kg = 0.0;                                ///< infinity: nothing moves it
  double inertia_kgm2 = 1.0;                           ///< in yaw
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();  ///< world, m
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  double spin_radps = 0.0;

  bool movable() const { return mass_kg < std::numeric_limits<double>::infinity(); }
};

RigidState rigid_state(const ContactBody& body);

/// The plain variant and those of the samples, as factors on the law's own values.
ContactVariant variant_of(const HarmSample& sample);

/// The steps of a sample's simulations.
ContactOptions options_of(const HarmSample& sample);

/// The two bodies as a sample has them: the ego moved across the relative velocity at the point of
/// contact, not at all where that is 0.
CrashSetup shifted(const CrashSetup& crash, const Contact& contact, const HarmSample& sample);

/// What a contact's outcome means for the ego afterwards.
EgoAfterContact after_contact(const CrashSetup& crash, const ContactOutcome& outcome);

/// Adds an actor, with those it is joined to, to `met`.
void add_met(const Scene& scene, std::size_t actor, std::vector<std::size_t>& met);

/// Adds the bodies of the group that pressed to `met`.
void add_pressed(const Scene& scene, const ContactWorkspace::State& state, const FixedGroup& group,
                 std::vector<std::size_t>& met);

}  // namespace crashrank::detail
