#pragma once

#include "crashrank/crash/pulse.hpp"
#include "crashrank/crash/severity.hpp"
#include "rank/contact_severity.hpp"
#include "rank/scene.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// Two bodies as the simulation of their crash begins.
struct CrashSetup {
  PulseBody a;  ///< the ego
  PulseBody b;
  Eigen::Vector3d along;  ///< in which the surfaces are looked at
};

CrashSetup set_up_crash(const Scene& scene, const EgoAtContact& ego, const Contact& contact);

/// Cells and steps with which a ranking simulates crashes.
SeverityOptions coarse(double friction);

/// The speed at which people outside cars are struck, from the delta-v of a pulse.
double struck(const Scene& scene, const Body& body, const Body& striker, const Contact& contact,
              double delta_v_mps);

/// What harm is told of one of the two bodies.
HarmExposure exposure_of(const Scene& scene, const Body& body, const Body& striker, bool ego,
                         const Contact& contact, const BodyOutcome& outcome);

/// How a pulse leaves the ego.
EgoAfterContact after_pulse(const CrashSetup& crash, const PulseResult& pulse);

}  // namespace crashrank::detail
