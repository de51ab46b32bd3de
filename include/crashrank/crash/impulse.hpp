#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/crash/motion.hpp"

#include <Eigen/Core>

#include <limits>

namespace crashrank {

/// Mass of a body and how it is spread, in body coordinates. An infinite mass is a body that
/// nothing moves (wall, pole); its inertia is not read.
struct MassProperties {
  double mass_kg = std::numeric_limits<double>::infinity();  ///< infinity: does not move
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();        ///< centre of mass
  /// About the centre of mass, symmetric, positive definite.
  Eigen::Matrix3d inertia_kgm2 = Eigen::Matrix3d::Identity();
};

/// A body at the instant of an impact, in world coordinates.
struct RigidBody {
  double mass_kg = std::numeric_limits<double>::infinity();    ///< infinity: does not move
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();          ///< centre of mass, world, m
  Eigen::Matrix3d inertia_kgm2 = Eigen::Matrix3d::Identity();  ///< about the centre of mass
  Velocity velocity;                                           ///< linear: of the centre of mass
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();          ///< the body's x axis

  /// False for a body of infinite mass.
  bool movable() const noexcept { return mass_kg < std::numeric_limits<double>::infinity(); }
};

/// A body placed in the world; `velocity` is that of its origin, as motions give it.
CRASHRANK_API RigidBody place(const MassProperties& properties, const Pose& body_in_world,
                              const Velocity& velocity);

/// Which motions an impulse may change.
enum class ImpulseSpace {
  planar,   ///< horizontal velocities and yaw: wheels on the ground, forces from the side
  spatial,  ///< all six
};

/// How bodies push each other.
struct ImpulseOptions {
  /// Of the normal velocity at the contact. About 0.1 at medium and high speed, 0.2 to 0.4 where
  /// delta-v is 1 to 2 m/s (SAE 931842).
  double restitution = 0.1;
  /// Coulomb friction between the bodies; 0.3 is what openPASS uses.
  double friction = 0.3;
  ImpulseSpace space = ImpulseSpace::planar;  ///< in the plane or in space
};

/// What the impact does to one body. World axes.
struct BodyImpulse {
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();   ///< on this body, at the contact point
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();  ///< of the centre of mass
  /// Change of its rate of turn, world axes, rad/s.
  Eigen::Vector3d delta_omega_radps = Eigen::Vector3d::Zero();
  Velocity after;                ///< linear: of the centre of mass
  double energy_change_j = 0.0;  ///< kinetic energy after less before
  /// Direction the force comes from, seen from above, degrees clockwise from the body's front,
  /// [0, 360). 0 without a horizontal impulse.
  double pdof_deg = 0.0;
  int clock = 12;  ///< the same in steps of 30 degrees, 1 to 12; 12 is 345 to 15 degrees
};

/// What an impulse does to both bodies.
struct ImpulseResult {
  /// The bodies part at the contact point, or both are immovable: nothing happens.
  bool acts = false;
  /// Friction cannot stop the sliding at the contact: a sideswipe. Otherwise a full impact, at
  /// whose end the contact does not slide. The model is less sure of sliding impacts.
  bool slides = false;
  double normal_speed_mps = 0.0;      ///< along the normal before, positive when approaching
  double separation_speed_mps = 0.0;  ///< along the normal after
  double sliding_speed_mps = 0.0;     ///< across the normal after
  /// Tangential over normal impulse that a contact without sliding would need; infinite when it
  /// would have to pull. The impact slides where this is above the friction.
  double friction_needed = 0.0;
  /// The restitution used: the one asked for, or less where that would have made energy.
  double restitution = 0.0;
  double dissipated_j = 0.0;  ///< kinetic energy of both before less after, never negative
  BodyImpulse a;              ///< to A
  BodyImpulse b;              ///< to B
};

/// Rigid impulse of two bodies at one contact point (world, m) with a unit normal from A to B.
/// Restitution acts on the normal velocity, the tangential velocity is brought to zero unless that
/// takes more than friction times the normal impulse; then the contact slides with friction at its
/// limit (Brach, planar; the same algebra in three dimensions, with the direction of friction that
/// of the impulse which would stop the sliding). With strong coupling between normal and tangential
/// motion a given restitution could make energy; it is then lowered until energy is kept.
/// In the plane the normal's horizontal part is used; a vertical normal gives no impulse there.
/// Linear and angular momentum of two movable bodies are conserved to rounding.
/// Masses positive, restitution in [0, 1], friction >= 0 (infinite: never slides).
CRASHRANK_API ImpulseResult impulse(const RigidBody& a, const RigidBody& b,
                                    const Eigen::Vector3d& point_m, const Eigen::Vector3d& normal,
                                    const ImpulseOptions& options = {});

/// Kinetic energy, J; 0 for an immovable body.
CRASHRANK_API double kinetic_energy(const RigidBody& body);

/// PDOF of an impulse on a body with that x axis: see BodyImpulse.
CRASHRANK_API double pdof_deg(const Eigen::Vector3d& impulse_on_body,
                              const Eigen::Vector3d& forward);

/// Clock direction of a PDOF: 1 to 12 in steps of 30 degrees, each reaching 15 to either side, the
/// lower edge included.
CRASHRANK_API int clock_of(double pdof_deg);

}  // namespace crashrank
