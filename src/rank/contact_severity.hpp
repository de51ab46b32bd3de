#pragma once

#include "rank/scene.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// The ego at a contact. A body that is met while an earlier contact still goes on is met at the
/// speed of that moment; what is left for the second contact is what the first one leaves.
struct EgoAtContact {
  Pose pose;
  Velocity met;   ///< of its origin: what people outside cars are hit with
  Velocity left;  ///< of its origin: what the simulation begins with
};

/// The ego when the contact with one body is over.
struct EgoAfterContact {
  double duration_s = 0.0;
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();  ///< its centre of mass, in that time
  double turned_rad = 0.0;
  Velocity velocity;  ///< linear: of its centre of mass
};

struct ContactEffect;
struct FixedGroup;

/// Memory of simulating contacts, one for each thread.
struct CrashScratch;

/// Simulates a contact in the plain variant and in those of the scene's samples; fills in
/// `contact.severity`. `effects` gets the plain effect, then one for each variant in the order of
/// the samples; `met` the further bodies that pressed, `scratch.motion` how both moved.
EgoAfterContact simulate_variants(const Scene& scene, const EgoAtContact& ego, Contact& contact,
                                  std::vector<std::size_t>& met, CrashScratch& scratch,
                                  std::vector<ContactEffect>& effects);

/// The place among a contact's effects of each sample's: samples that differ in risk alone share
/// their simulation.
std::vector<std::size_t> effect_of_sample(const Scene& scene);

}  // namespace crashrank::detail
