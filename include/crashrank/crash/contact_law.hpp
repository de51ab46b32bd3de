#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace crashrank {

/// State of the wheels of a vehicle after its first contact.
enum class AfterContact {
  brakes,    ///< all undamaged wheels brake with one share of their grip, and steer as before
  releases,  ///< undamaged wheels roll freely, and steer as before
  locks,     ///< no wheel turns
};

/// The name in files: "brakes", "releases", "locks".
CRASHRANK_API const char* after_contact_name(AfterContact after) noexcept;
/// Parses a name; the error (usage) lists the valid names.
CRASHRANK_API Result<AfterContact> after_contact_from_name(const std::string& name);

/// The model was checked up to this closing speed, m/s: faster contacts are marked in reports.
inline constexpr double fastest_contact_mps = 140.0;

/// A body at first contact. The vehicle has to outlive the call.
struct ContactBody {
  const Vehicle* vehicle = nullptr;  ///< the body
  Pose pose;                         ///< body to world; only position and heading are read
  Velocity velocity;                 ///< velocity of its origin; ignored for fixed bodies
};

/// Factors on parameters that are not known exactly.
struct ContactVariant {
  double friction = 1.0;     ///< factor on the friction of the pair of surfaces
  double strength = 1.0;     ///< factor on the strength of both bodies
  double restitution = 1.0;  ///< factor on the restitution
};

/// How a contact is integrated. The defaults are what ranking and validation use.
struct ContactOptions {
  double travel_m = 0.06;      ///< relative travel per step, m
  double shortest_s = 0.0005;  ///< least step, s
  double longest_s = 0.008;    ///< greatest step, s
  double speed_change = 0.05;  ///< maximum change of the closing speed per step, as a share of it
  /// The bodies already overlap where the contact begins: what lies over 0.05 m inside then exerts
  /// no force. Bodies that only touch may overlap in their outlines, as a windscreen leans.
  bool overlapping = false;
};

/// Result of a contact for one body. World axes unless stated otherwise.
struct BodyContact {
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();   ///< on this body, N·s
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();  ///< of the centre of mass, m/s
  double delta_yaw_rate_radps = 0.0;                      ///< left positive, rad/s
  Velocity after;                                         ///< linear: of the centre of mass
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();      ///< displacement of the centre of mass, m
  double turned_rad = 0.0;                                ///< heading change, left positive
  double pdof_deg = 0.0;        ///< direction of force, degrees clockwise from ahead, [0, 360)
  double crush_depth_m = 0.0;   ///< greatest, m
  double crush_energy_j = 0.0;  ///< energy of its deformation, J
  /// Greatest intrusion into the passenger compartment, m; in a scene only what exceeds the
  /// intrusion by earlier contacts of the two bodies.
  double intrusion_m = 0.0;
  Box damaged;  ///< bounds of the deformed outline, body coordinates; may be empty
};

/// Poses of both bodies at a time of a contact.
struct ContactPoses {
  double time_s = 0.0;  ///< since first contact, s
  Pose a;               ///< body axes of A to world
  Pose b;               ///< body axes of B to world
};

/// Motion of both bodies during a contact, as poses of their origins in the order of time: at first
/// contact, after the first and the last step with a force, and after up to 13 steps with a force
/// in between, evenly spaced by number. One entry if no force acted. Height, pitch and roll stay
/// those at first contact.
struct ContactMotion {
  static constexpr std::size_t most = 16;  ///< entries
  std::array<ContactPoses, most> poses;    ///< the first `count` are valid
  std::size_t count = 0;                   ///< at least 1 in an outcome

  /// The valid entries.
  View<const ContactPoses> all() const noexcept { return {poses.data(), count}; }
};

/// Result of a contact for both bodies.
struct ContactOutcome {
  bool acts = false;  ///< a contact force acted
  /// The relative speed at the contact at the end of the force exceeded a fifth of its maximum.
  bool slides = false;
  double duration_s = 0.0;    ///< from first contact until the force ends, s
  double closing_mps = 0.0;   ///< greatest mean closing speed of the pressing surfaces, m/s
  double restitution = 0.0;   ///< share of the compression impulse that the rebound added
  double dissipated_j = 0.0;  ///< loss of kinetic energy of both bodies, >= 0
  double friction_j = 0.0;    ///< part of it dissipated by friction
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< mean point of the force, world, m
  /// Mean point of the force when it begins, world, m.
  Eigen::Vector3d begin_point_m = Eigen::Vector3d::Zero();
  BodyContact a;             ///< result for A
  BodyContact b;             ///< result for B
  ContactMotion motion;      ///< motion of both during the contact
  std::uint32_t steps = 0;   ///< steps of the integration
  std::uint64_t pieces = 0;  ///< outline pieces moved, summed over all steps: the amount of work
};

/// Working memory of simulations, one for each thread. Grows with its first uses; after `prepare`,
/// simulations allocate nothing.
class CRASHRANK_API ContactWorkspace {
public:
  ContactWorkspace();                                             ///< Empty.
  ~ContactWorkspace();                                            ///< Frees its memory.
  ContactWorkspace(ContactWorkspace&&) noexcept;                  ///< Moves.
  ContactWorkspace& operator=(ContactWorkspace&&) noexcept;       ///< Moves.
  ContactWorkspace(const ContactWorkspace&) = delete;             ///< One per thread.
  ContactWorkspace& operator=(const ContactWorkspace&) = delete;  ///< One per thread.

  /// Allocates room for contacts of bodies whose profiles have up to `pieces` pieces, with up to
  /// `fixed_bodies` fixed bodies besides the first.
  void prepare(std::size_t pieces, std::size_t fixed_bodies);

  struct State;  ///< Its contents, for the library.
  /// Its contents, for the library.
  State& state() noexcept { return *state_; }

private:
  std::unique_ptr<State> state_;
};

/// Friction between two surfaces: 0.5 where one is rubber; 0.1 where one is steel (sheet metal on
/// steel at high pressure and speed, 0.1 to 0.2); else 0.3 (what openPASS uses between cars).
CRASHRANK_API double friction_between(Surface a, Surface b) noexcept;

/// Restitution of uncrushed structure at a closing speed, m/s: 0.26 + 0.15/(1 + v/4). A contact
/// uses the share of it that corresponds to the unused crush length, so that results agree with SAE
/// 931842: 0.2 to 0.4 at a delta-v of 0.9 to 2.2 m/s, about 0.1 at medium and high speed.
CRASHRANK_API double restitution_at(double closing_mps) noexcept;

/// Simulates a contact in the plane, from the first touch to the end of its force. Both bodies move
/// as rigid bodies with horizontal velocity and yaw rate, and press on each other where outlines of
/// the same height band overlap.
///
/// Every outline piece of one body inside the other receives the pressure at which the crush depths
/// of both materials add up to its depth. The depth is measured in the axes of the body that is
/// pressed in, below its front or rear and below its flank, blended with the squares of the
/// components of the piece's normal; it does not depend on a line chosen at first contact. Pieces
/// of both bodies contribute, each weighted with the share of the crush that the other body takes,
/// so that exchanging the bodies changes no bit. A piece presses while it advances along its normal
/// beyond its greatest depth so far: crushed structure stays crushed. The structure of the core
/// hardens and is never used up; the mass of the material pushed aside adds 4·density·speed². At
/// greatest compression the bodies rebound once, by `restitution_at` times the impulse so far.
/// docs/guide/crash-model.md has the formulas and the limits of the model, docs/crash-parameters.md
/// the parameters with their reasons.
///
/// Momentum and angular momentum of movable bodies are conserved to rounding; energy never grows.
/// `fixed` lists further fixed bodies that press together with a fixed B; pieces inside another of
/// these bodies do not press, so that a wall cut into parts acts as one wall. The contact ends when
/// the bodies separate or come to relative rest. No force acts between two fixed bodies, between
/// two rigid bodies, or from pieces that overlap deeply at the start.
///
/// Cost: see docs/evidence/contact-times.md. Safe from any thread with its own workspace.
CRASHRANK_API ContactOutcome simulate_contact(const ContactBody& a, const ContactBody& b,
                                              View<const ContactBody> fixed,
                                              const Eigen::Vector3d& point_m,
                                              const ContactVariant& variant,
                                              ContactWorkspace& workspace,
                                              const ContactOptions& options = {});

/// Principal direction of force: direction that a horizontal impulse on a body comes from, seen
/// from above, degrees clockwise from the body's forward axis, [0, 360). 0 without a horizontal
/// impulse.
CRASHRANK_API double pdof_deg(const Eigen::Vector3d& impulse_on_body,
                              const Eigen::Vector3d& forward);

/// Clock direction of a PDOF: 1 to 12 in steps of 30 degrees, each reaching 15 to either side, the
/// lower edge included.
CRASHRANK_API int clock_of(double pdof_deg);

/// Crush depth as measured from outside, m: distance from a face of the body to the inner edge of
/// the damage, for the face where it is least relative to the body's size in that direction. 0
/// without damage.
CRASHRANK_API double damage_depth_m(const Box& region, const Box& body);

/// Inputs of `cdc_code`: place, direction and kind of a deformation; body coordinates, m.
struct Deformation {
  double pdof_deg = 0.0;   ///< degrees clockwise from ahead
  Box region;              ///< bounds of the deformed surface
  Box body;                ///< bounds of the body
  double depth_m = 0.0;    ///< m
  bool sideswipe = false;  ///< the force is along the side rather than into it
};

/// Seven characters after SAE J224: clock direction (01 to 12), area (F, B, L, R, T), place across
/// or along it (L, C, R or F, P, B, their unions Y and Z, D for all), place in height (A all, E
/// below the belt, H above the frame, M between, G above the belt, L below the frame), kind (W
/// wide, N narrower than 0.41 m, S sideswipe) and extent zone 1 to 9. Belt and frame stand at 0.62
/// and 0.35 of the height; extent zones are ninths of half the length (front, rear), of the width
/// (sides) or of the height, this project's reading of a standard whose zones follow each car's
/// windows. Empty without a region.
CRASHRANK_API std::string cdc_code(const Deformation& deformation);

}  // namespace crashrank
