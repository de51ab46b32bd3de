#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/crash/impulse.hpp"
#include "crashrank/crash/strength.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <vector>

namespace crashrank {

/// Above this closing speed pulses do not hold, m/s: the bodies' structure is used up, they pass
/// through each other, and what the crash does falls as speed rises (docs/guide/crash-model.md).
inline constexpr double fastest_pulse_mps = 100.0;

/// A body at first contact, as the pulse needs it. Mesh and tree have to outlive the call.
struct PulseBody {
  const TriangleMesh* mesh = nullptr;  ///< its surface; has to outlive the call
  /// Over that mesh, or none: spares looking at every triangle and changes no bit of the answer.
  const AabbTree* tree = nullptr;
  Pose pose;               ///< body to world
  RigidBody rigid;         ///< in the world, at the same instant
  CrushStrength strength;  ///< what it takes to crush it
};

/// How the crush phase is simulated.
struct PulseOptions {
  /// Coulomb friction between the surfaces; 0.3 is what openPASS uses for cars against each other.
  double friction = 0.3;
  double cell_w_m = 0.025;  ///< width and height of the cells in which the surfaces are sampled
  double cell_h_m = 0.1;    ///< height of a cell, m
  double step_s = 0.0005;   ///< of the simulation, s
  double longest_s = 0.25;  ///< of the pulse, s
};

/// What a pulse does to two bodies. World coordinates.
struct PulseResult {
  bool acts = false;  ///< the surfaces pressed against each other at all
  /// The contact kept more than a fifth of its speed when the force ended: it slid off.
  bool slides = false;
  double duration_s = 0.0;  ///< from first contact until the force ends
  BodyImpulse a;            ///< what it did to A
  BodyImpulse b;            ///< what it did to B
  /// How far the centres of mass moved and the bodies turned (left positive) in that time.
  Eigen::Vector3d moved_a_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d moved_b_m = Eigen::Vector3d::Zero();  ///< way of B's centre of mass, m
  double turned_a_rad = 0.0;                            ///< rad
  double turned_b_rad = 0.0;                            ///< rad
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();    ///< middle of the pressing, weighted by it
  double dissipated_j = 0.0;  ///< kinetic energy of both before less after, never negative
  double friction_j = 0.0;    ///< what sliding took of that, as integrated
  double deepest_m = 0.0;     ///< how far the undeformed surfaces came to lie in each other
};

/// The crush phase, from first contact on, as a chain of small impulses in the plane.
///
/// Both bodies move on as rigid bodies on wheels (horizontal velocity and yaw). Body B's surface,
/// as seen along `along` (horizontal, from A towards B), is cut into facets. Where a facet moves
/// into A's undeformed surface it meets the pressure that both bodies' laws give for the depth,
/// and friction along it. The depth counts along the view as far as the facet's advance is along
/// it: sideways it opens fresh material, which resists with its yield alone. Material once pushed
/// away stays away, so there is no rebound. So a contact that is wedged off a rounded corner leaves
/// it, and one that is caught turns the car about it: the impulse's place and direction come from
/// the surfaces at every depth, not from first touch.
/// Equal and opposite impulses act at one point, so momentum is conserved to rounding; each step is
/// at most the one that takes the most energy out, so energy is never gained.
///
/// Cost: facets that may touch × steps, some milliseconds with the default cells. Allocates. Safe
/// from any thread.
/// Where it fails: vertical motion, rolling, parts that break off; what A is made of is told by its
/// strength, not by the mesh. Facets are B's, so exchanging the bodies changes the answer a little.
CRASHRANK_API PulseResult simulate_pulse(const PulseBody& a, const PulseBody& b,
                                         const Eigen::Vector3d& point_m,
                                         const Eigen::Vector3d& along,
                                         const PulseOptions& options = {});

/// What may be varied while bodies and their surfaces stay as they are.
struct PulseVariant {
  double friction = 0.3;  ///< between the bodies
  double strength = 1.0;  ///< times what both bodies' laws say
};

/// The pulse once for each variant, in their order, for the price of looking at the surfaces once.
CRASHRANK_API std::vector<PulseResult> simulate_pulses(const PulseBody& a, const PulseBody& b,
                                                       const Eigen::Vector3d& point_m,
                                                       const Eigen::Vector3d& along,
                                                       View<const PulseVariant> variants,
                                                       const PulseOptions& options = {});

}  // namespace crashrank
