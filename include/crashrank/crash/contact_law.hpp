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

/// What the wheels of a vehicle do after its first contact.
enum class AfterContact {
  brakes,    ///< all undamaged wheels brake with one share of their grip, and steer as before
  releases,  ///< undamaged wheels roll freely, and steer as before
  locks,     ///< no wheel turns
};

/// The name in files: "brakes", "releases", "locks".
CRASHRANK_API const char* after_contact_name(AfterContact after) noexcept;
/// Reads a name; the error (usage) lists those there are.
CRASHRANK_API Result<AfterContact> after_contact_from_name(const std::string& name);

/// The model was checked up to this closing speed, m/s: faster contacts are marked in reports.
inline constexpr double fastest_contact_mps = 140.0;

/// A body at first contact. The vehicle has to outlive the call.
struct ContactBody {
  const Vehicle* vehicle = nullptr;  ///< what it is
  Pose pose;                         ///< body to world; only position and heading are read
  Velocity velocity;                 ///< of its origin; a body that nothing moves stands
};

/// Factors on parameters that are not known exactly.
struct ContactVariant {
  double friction = 1.0;     ///< times the friction of the pair of surfaces
  double strength = 1.0;     ///< times the resistance of both bodies
  double restitution = 1.0;  ///< times the restitution
};

/// How a contact is integrated. The defaults are what ranking and validation use.
struct ContactOptions {
  double travel_m = 0.06;      ///< relative travel of a step, m
  double shortest_s = 0.0005;  ///< least step, s
  double longest_s = 0.008;    ///< greatest step, s
  double speed_change = 0.05;  ///< share of the closing speed that a step may take
};

/// Result of a contact for one body. World axes unless stated otherwise.
struct BodyContact {
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();   ///< on this body, N·s
  Eigen::Vector3d delta_v_mps = Eigen::Vector3d::Zero();  ///< of the centre of mass, m/s
  double delta_yaw_rate_radps = 0.0;                      ///< left positive, rad/s
  Velocity after;                                         ///< linear: of the centre of mass
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();      ///< of the centre of mass in the contact
  double turned_rad = 0.0;                                ///< left positive
  double pdof_deg = 0.0;        ///< where the force comes from, clockwise from ahead, [0, 360)
  double crush_depth_m = 0.0;   ///< greatest, m
  double crush_energy_j = 0.0;  ///< taken by its deformation, J
  /// Greatest reach into the passenger compartment, m; in a scene what it exceeds that of earlier
  /// contacts of the two by.
  double intrusion_m = 0.0;
  Box damaged;  ///< bounds of the pressed outline, body coordinates; may be empty
};

/// Where both bodies are at a time of a contact.
struct ContactPoses {
  double time_s = 0.0;  ///< since first contact, s
  Pose a;               ///< A's body axes to world
  Pose b;               ///< B's
};

/// How both bodies move during a contact, as poses of their origins in the order of time: at first
/// contact, after the first and the last step of the integration that had a force, and after up to
/// 13 steps with a force in between, evenly by number. One entry where no force acted. Height,
/// pitch and roll stay those at first contact.
struct ContactMotion {
  static constexpr std::size_t most = 16;  ///< entries
  std::array<ContactPoses, most> poses;    ///< the first `count` of them hold
  std::size_t count = 0;                   ///< at least 1 in an outcome

  /// Those that hold.
  View<const ContactPoses> all() const noexcept { return {poses.data(), count}; }
};

/// Result of a contact for both bodies.
struct ContactOutcome {
  bool acts = false;  ///< the surfaces pressed against each other
  /// The surfaces still moved past each other with more than a fifth of the greatest speed at the
  /// contact when the force ended.
  bool slides = false;
  double duration_s = 0.0;    ///< from first contact until the force ends, s
  double closing_mps = 0.0;   ///< greatest mean closing speed of the pressing surfaces, m/s
  double restitution = 0.0;   ///< of the rebound, share of the impulse before it
  double dissipated_j = 0.0;  ///< kinetic energy of all before less after, never negative
  double friction_j = 0.0;    ///< part of it that sliding took
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< mean point of the force, world, m
  BodyContact a;                                      ///< result for A
  BodyContact b;                                      ///< result for B
  ContactMotion motion;                               ///< of both while they pressed
  std::uint32_t steps = 0;                            ///< of the integration
  std::uint64_t pieces = 0;  ///< pieces of outlines moved, over all steps: the work done
};

/// Memory of simulations, one for each thread. Grows with its first uses; a prepared one allocates
/// nothing.
class CRASHRANK_API ContactWorkspace {
public:
  ContactWorkspace();                                             ///< Empty.
  ~ContactWorkspace();                                            ///< Frees its memory.
  ContactWorkspace(ContactWorkspace&&) noexcept;                  ///< Moves.
  ContactWorkspace& operator=(ContactWorkspace&&) noexcept;       ///< Moves.
  ContactWorkspace(const ContactWorkspace&) = delete;             ///< One per thread.
  ContactWorkspace& operator=(const ContactWorkspace&) = delete;  ///< One per thread.

  /// Room for contacts of bodies whose profiles have at most so many pieces, with at most so many
  /// fixed bodies besides the first.
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

/// Restitution of fresh structure at a closing speed, m/s: 0.26 + 0.15/(1 + v/4). A contact takes
/// the share of it that its free crush length has left, so that it ends within what SAE 931842
/// states: 0.2 to 0.4 at a delta-v of 0.9 to 2.2 m/s, about 0.1 at medium and high speed.
CRASHRANK_API double restitution_at(double closing_mps) noexcept;

/// Simulates a contact from its first touch to the end of its force, in the plane: both bodies move
/// on as rigid bodies with horizontal velocity and yaw, and press on each other where the outlines
/// of the same height overlap.
///
/// Every short piece of one body's outline inside the other meets the pressure at which both
/// materials together give way by its depth. Depth is counted in the axes of the body that is
/// pressed in, below its front or rear and below its flank, blended with the squares of the
/// piece's normal: neither depends on a line chosen at first contact. Pieces of both bodies count,
/// each in the share in which the other body is the one crushed, so that exchanging the bodies
/// changes no bit. A piece presses while it advances along its normal further than it has been:
/// what is crushed stays crushed. Structure of the core hardens and is never used up; the mass of
/// what is pushed aside adds 4·density·speed². At greatest compression the bodies rebound once, by
/// `restitution_at` times the impulse until then. docs/guide/crash-model.md has the formulas, the
/// parameters with their reasons, and what the model leaves out.
///
/// Momentum and moment of momentum of movable bodies are conserved to rounding, energy is never
/// gained. `fixed` are further bodies that nothing moves, which press at the same time as a B that
/// nothing moves: pieces inside another of them do not press, so a wall cut in parts acts as a
/// whole. Ends when the bodies part or rest. Two bodies that nothing moves, or that do not give
/// way, do not act. Deep overlap at the start presses nowhere.
///
/// Cost: half a millisecond in the median, several in long slides; docs/guide/crash-model.md has
/// measured figures. Safe from any thread with its own workspace.
CRASHRANK_API ContactOutcome simulate_contact(const ContactBody& a, const ContactBody& b,
                                              View<const ContactBody> fixed,
                                              const Eigen::Vector3d& point_m,
                                              const ContactVariant& variant,
                                              ContactWorkspace& workspace,
                                              const ContactOptions& options = {});

/// Principal direction of force: where a horizontal impulse on a body comes from, seen from above,
/// degrees clockwise from the body's forward axis, [0, 360). 0 without a horizontal impulse.
CRASHRANK_API double pdof_deg(const Eigen::Vector3d& impulse_on_body,
                              const Eigen::Vector3d& forward);

/// Clock direction of a PDOF: 1 to 12 in steps of 30 degrees, each reaching 15 to either side, the
/// lower edge included.
CRASHRANK_API int clock_of(double pdof_deg);

/// How far damage reaches in from the face of the body that it is nearest to, counted in the body's
/// size that way: crush depth as it is measured from outside, m. 0 without damage.
CRASHRANK_API double damage_depth_m(const Box& region, const Box& body);

/// Where and how a body is deformed, for `cdc_code`; body coordinates, m.
struct Deformation {
  double pdof_deg = 0.0;   ///< degrees clockwise from ahead
  Box region;              ///< of the moved surface
  Box body;                ///< bounds of the body
  double depth_m = 0.0;    ///< m
  bool sideswipe = false;  ///< along the side rather than into it
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
