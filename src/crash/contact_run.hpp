#pragma once

#include "crash/exposure.hpp"
#include "crash/motion_record.hpp"
#include "crash/surface_pass.hpp"

#include "crashrank/crash/contact_law.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {
namespace detail {

/// Two bodies of a contact: the pieces of each outline near the other body, what they have crushed
/// so far, and the forces between the bodies. It outlives single contacts, because crushed
/// structure stays crushed.
struct BodyPair {
  std::uint32_t first = 0;   ///< index of the first body
  std::uint32_t second = 0;  ///< index of the second body
  NearPieces of_first;       ///< outline pieces of the first body near the second
  NearPieces of_second;      ///< outline pieces of the second body near the first
  PassRecord in_first;       ///< second body pressing into the first
  PassRecord in_second;      ///< first body pressing into the second
  PlanarForce on_second;     ///< force in this step, moment about its centre of mass
  /// Impulse on the second body since the last rebound, moment about the origin.
  PlanarForce since_rebound;
  PlanarForce impulse_on_second;  ///< impulse of the contact, moment about its centre of mass
  bool pressed = false;           ///< a force acted in this contact
  bool struck = false;            ///< a force acted in this or an earlier contact
  double earlier_first_m = 0.0;   ///< greatest intrusion into the first in earlier contacts
  double earlier_second_m = 0.0;  ///< greatest intrusion into the second in earlier contacts
  // A rail as second body gives way at this contact; elsewhere it stays where it is.
  double deflected_x_m = 0.0;  ///< displacement so far
  double deflected_y_m = 0.0;
  double deflects_x_mps = 0.0;  ///< velocity
  double deflects_y_mps = 0.0;
  std::uint64_t last_end_step = 0;  ///< scene step in which their last contact ended

  /// Clears the pair; keeps allocated memory.
  void begin(std::size_t a, std::size_t b, PiecePool& pool);
  /// Starts a further contact of the pair at scene step `step`: clears forces and records, keeps
  /// what is crushed.
  void begin_further_contact(std::uint64_t step);
  /// Greatest intrusion into the compartment of the first or the second body in this contact, m.
  double intrusion_m(bool of_first_body) const;
  /// Middle of the heights at which the bodies have pressed on each other, over the ground, m.
  double height_m() const;
  /// Moves a rail by its velocity for a time, at most by its deflection in all.
  void move_rail(const Deflection& rail, double seconds);
  /// Slows a rail down with what presses on it, to rest at most.
  void slow_rail(double by_mps);
};

/// Horizontal load of contact forces on the foot of a post.
struct FootLoad {
  double x_n = 0.0;   ///< sum of the forces, world axes, N
  double y_n = 0.0;   ///< N
  double x_nm = 0.0;  ///< sum of the forces times their heights, N·m
  double y_nm = 0.0;  ///< N·m

  /// Over what the foot bears.
  double over(const Breakaway& foot) const {
    return std::max(plane_length(x_n, y_n) / foot.force_n,
                    plane_length(x_nm, y_nm) / foot.moment_nm);
  }
};

}  // namespace detail

/// Working memory of contact simulations.
struct ContactWorkspace::State {
  std::vector<detail::PressedBody> bodies;
  std::vector<detail::BodyPair> pairs;  ///< the first `pairs_in_use` are valid
  std::size_t pairs_in_use = 0;
  detail::PiecePool pool;  ///< of the pairs
  /// Room that the pool has at most, and that it needs for the pairs in use if all of their
  /// outlines come near, blocks.
  std::size_t most_pooled = static_cast<std::size_t>(-1);
  std::size_t could_be_near = 0;

  /// Removes all bodies and pairs; keeps allocated memory.
  void begin();
  /// Adds a body with its present pose and velocity; coordinates are relative to `origin_m`.
  void add_body(const ContactBody& body, const Eigen::Vector3d& origin_m,
                const ContactVariant& variant);
  /// Takes a cleared pair with room for the outlines of both bodies; returns its index.
  std::uint32_t take_pair(std::size_t first, std::size_t second);
  /// Puts a load on a post for a step; returns true if it breaks away in it. Its foot bears until
  /// the load, taken as linear since the step before, exceeds what it can: that share of the
  /// impulse goes into the ground, so that results are continuous in the time of the break.
  bool load_post(std::size_t body, const detail::FootLoad& load);
};

namespace detail {

/// A contact lasts at most this long plus one step, s.
inline constexpr double longest_contact_s = 1.5;

/// Simulates one contact step by step: of two bodies, or of one body with several adjoining fixed
/// bodies. The caller moves the bodies: by half a step before `compute_forces` and by the other
/// half after `apply_forces`.
class ContactRun {
public:
  /// Maximum number of bodies that press on the first one at the same time.
  static constexpr std::size_t most_others = 65;

  /// Starts the contact with the present state of the bodies. `first` and `second` (in the order
  /// that `goes_second` defines) are indices into the bodies of `state`; `pair` is the index of
  /// their `BodyPair`. `given_first` and `given_second` describe both bodies with their present
  /// poses. Workspace and vehicles have to outlive the run.
  void begin(ContactWorkspace::State& state, std::size_t first, std::uint32_t pair,
             const ContactBody& given_first, const ContactBody& given_second,
             const Eigen::Vector3d& origin_m, const ContactVariant& variant,
             const ContactOptions& options);
  /// Adds a further fixed body to a contact whose second body is fixed. Returns false if there is
  /// no room.
  bool add(std::uint32_t pair);

  /// Restarts the clock and the records at the first force, in the middle of a step: until then the
  /// bodies were near each other without contact.
  void begin_at_first_force(const ContactBody& given_first, const ContactBody& given_second);

  /// Returns the longest step that resolves the contact, s.
  double next_step_s() const;
  /// Computes the contact forces at the middle of a step.
  void compute_forces(double step_s);
  /// Adds the forces of this step on a body, if it takes part in the contact, to the load of its
  /// foot.
  void add_load(std::size_t body, FootLoad& load) const;
  /// Call when a body was released: what it took before went into the ground, so that it neither
  /// rebounds nor counts as a change of the body's velocity.
  void forget_held(std::size_t body);
  /// Returns true if a contact force acts in this step.
  bool presses() const noexcept { return totals_.pressing > 0.0; }
  /// Applies the forces of the step, and the rebound at greatest compression, to the velocities.
  void apply_forces();
  /// Action of the step on the first or the second body, without what several
  /// contacts of the body cancel and how its deepest intrusion grows.
  ContactAction step_action(bool of_first) const;
  /// Greatest intrusion into the body by the other so far, m.
  double deepest_m(bool of_first) const;

  /// Completes the step, after the bodies have moved to its end, and decides whether the contact is
  /// over.
  void end_step();
  bool over() const noexcept { return over_; }

  std::size_t first() const noexcept { return first_; }
  /// Index of the body that the contact began with, besides the first.
  std::size_t second() const noexcept { return state_->pairs[pairs_[0]].second; }
  /// Index of the body, besides the first, that received the largest impulse.
  std::size_t most_pressed() const;
  /// Both bodies at the beginning of the contact.
  const ContactBody& given_first() const noexcept { return given_first_; }
  const ContactBody& given_second() const noexcept { return given_second_; }
  View<const std::uint32_t> pairs() const noexcept { return {pairs_.data(), pair_count_}; }
  bool acts() const noexcept { return acts_; }
  /// Time since the beginning of the contact, s: now, and when a force last acted.
  double time_s() const noexcept { return time_s_; }
  double duration_s() const noexcept { return duration_s_; }
  /// The outcome up to now; `swapped`: the first body is B.
  ContactOutcome outcome(bool swapped) const;

  /// Kinetic energy lost so far, J.
  double dissipated_j() const { return std::max(0.0, dissipated_j_); }
  /// Number of outline pieces moved so far: the amount of work done.
  std::uint64_t work() const noexcept { return pieces_; }

private:
  /// Sums of a step over all pairs; see `PassSums`.
  struct Totals {
    bool approaching = false;
    double pressing = 0.0;
    double closing = 0.0;
    double speed = 0.0;
    double unused_crush = 0.0;
    double weight = 0.0;
    double point_x = 0.0;
    double point_y = 0.0;
    double crush_first_w = 0.0;
    double crush_second_w = 0.0;
    double intruded_first_m3 = 0.0;
    double intruded_second_m3 = 0.0;
    double deflection_w = 0.0;  ///< power that bends rails
  };
  /// Impulses of a step on one body, N s.
  struct StepImpulse {
    PlanarForce whole;
    PlanarForce rebound;  ///< part of it by restitution
  };
  /// Change of kinetic energy when a share k of a set of forces (or impulses) is applied: slope·k +
  /// curvature·k²/2.
  struct EnergyChange {
    double slope = 0.0;
    double curvature = 0.0;
    void add(const PlanarBody& body, const PlanarForce& f);
  };
  /// Relative velocity of both bodies at the point where the force of the step acts.
  struct ForceVelocity {
    double closing_mps = 0.0;  ///< component against the force, positive while the bodies approach
    double speed_mps = 0.0;    ///< magnitude
  };
  const PlanarBody& motion_of(std::size_t body) const { return state_->bodies[body].motion; }
  PlanarBody& motion_of(std::size_t body) { return state_->bodies[body].motion; }
  void compute_pair_forces(BodyPair& pair, std::size_t place, PassSettings& settings);
  void deflect(const Deflection& rail, BodyPair& pair, PassSums& into_first, PassSums& into_other);
  void measure();
  void begin_compression();
  void add_sums(const PassSums& sums, bool own_is_first);
  void apply_impulses();
  ForceVelocity velocity_at_force() const;
  void rebound(double speed_mps);
  double light_share(bool of_first) const;
  double struck_mps(bool of_first) const;
  void strike();
  double kinetic_energy_j() const;
  double relative_speed_bound() const;
  double relative_speed() const;
  BodyContact body_result(bool is_first) const;

  ContactWorkspace::State* state_ = nullptr;
  ContactOptions options_;
  ContactVariant variant_;
  ContactBody given_first_;
  ContactBody given_second_;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::size_t first_ = 0;
  std::size_t pair_count_ = 0;
  std::array<std::uint32_t, most_others> pairs_{};
  std::array<const PressedBody*, most_others> others_{};
  PlanarBody start_first_;
  PlanarBody start_second_;
  PlanarBody end_first_;  ///< state when a force last acted
  PlanarBody end_second_;
  MotionRecord record_;
  double radius_m_ = 0.0;  ///< no outline point is further from its centre of mass

  bool over_ = false;
  bool acts_ = false;
  Totals totals_;         ///< sums of this step
  PlanarForce on_first_;  ///< force in this step, moment about its centre of mass
  /// Impulse on the first body since the last rebound, moment about the origin.
  PlanarForce since_rebound_;
  PlanarForce impulse_on_first_;  ///< impulse of the contact, moment about its centre of mass
  double applied_s_ = 0.0;        ///< time for which the force of this step was applied
  StepImpulse step_first_;        ///< of this step
  StepImpulse step_second_;
  /// In the step of the first force between the bodies, see `ContactAction::struck_mps`.
  double struck_first_mps_ = 0.0;
  double struck_second_mps_ = 0.0;
  double time_s_ = 0.0;
  double duration_s_ = 0.0;
  double step_s_ = 0.0;
  double pass_interval_s_ = 0.0;     ///< time from the last evaluation of the forces to this one
  double speed_mps_ = 0.0;           ///< upper bound of the relative speed of any two points
  double acceleration_mps2_ = 0.0;   ///< relative acceleration by the force of the last step
  double travel_bound_m_ = 0.0;      ///< upper bound of the relative travel in the last step
  double momentum_before_ns_ = 0.0;  ///< momentum of the relative motion at first contact
  double dissipated_j_ = 0.0;        ///< kinetic energy lost so far
  double lost_since_rebound_j_ = 0.0;
  double max_pressing_since_rebound_ = 0.0;
  double max_closing_since_rebound_mps_ = 0.0;
  double max_speed_since_rebound_mps_ = 0.0;
  double last_speed_mps_ = 0.0;   ///< relative speed at the last force
  double max_speed_mps_ = 0.0;    ///< greatest relative speed at the contact
  double max_closing_mps_ = 0.0;  ///< greatest closing speed of the contact
  double restitution_ = 0.0;
  double impulse_ns_ = 0.0;          ///< sum of the magnitudes
  double window_impulse_ns_ = 0.0;   ///< impulse in the time window that detects the end
  double window_start_s_ = 0.0;      ///< beginning of that window
  double window_travel_m_ = 0.0;     ///< relative travel in that window
  double forceless_travel_m_ = 0.0;  ///< relative travel since a force last acted
  double friction_j_ = 0.0;
  double crush_first_j_ = 0.0;
  double crush_second_j_ = 0.0;
  double deflection_j_ = 0.0;
  double intruded_first_m3_ = 0.0;
  double intruded_second_m3_ = 0.0;
  float depth_first_m_ = 0.0F;
  float depth_second_m_ = 0.0F;
  double point_x_ = 0.0;
  double point_y_ = 0.0;
  double point_weight_ = 0.0;
  Eigen::Vector2d begin_point_m_ = Eigen::Vector2d::Zero();  ///< from the origin
  std::uint32_t steps_ = 0;
  std::uint64_t pieces_ = 0;
};

/// Returns true if at least one body is movable, at least one is deformable and both have outlines
/// that press.
bool can_press(const Vehicle& a, const Vehicle& b);

}  // namespace detail
}  // namespace crashrank
