#pragma once

#include "rank/scene.hpp"

#include <Eigen/Core>

namespace crashrank::detail {

/// The ego when it meets something. A body that is met while an earlier crash still goes on is met
/// at the speed of that moment; what is left for the second crash is what the first one leaves.
struct EgoAtContact {
  Pose pose;
  Velocity met;   ///< of its origin: what people outside cars are hit with
  Velocity left;  ///< of its origin: what the impulse begins with
};

/// The ego when the crash with one body is over.
struct EgoAfterContact {
  double duration_s = 0.0;
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();  ///< its centre of mass, in that time
  double turned_rad = 0.0;
  Velocity velocity;  ///< linear: of its centre of mass
};

/// Fills in `contact.severity` from both bodies at first contact: the pulse, and with
/// `scene.pulses` the crush and the harm that follow from it.
EgoAfterContact tell_severity(const Scene& scene, const EgoAtContact& ego, Contact& contact);

/// What the search and the scores need of a body beside its shape.
void prepare_body(const ScenarioModel& model, Body& body);

}  // namespace crashrank::detail
