#pragma once

#include "crash/motion_record.hpp"
#include "crash/surface_pass.hpp"

#include "crashrank/crash/contact_law.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank {
namespace detail {

/// What is remembered of two bodies' outlines in each other, and what they do to each other.
struct BodyPair {
  std::uint32_t first = 0;   ///< index of a body
  std::uint32_t second = 0;  ///< and of the other
  NearPieces of_first;       ///< pieces of the first body in the second
  NearPieces of_second;      ///< and of the second in the first
  PassRecord in_first;       ///< of the second's pieces
  PassRecord in_second;
  PlanarForce on_second;           ///< in this step, about its centre of mass
  PlanarForce since_rebound;       ///< impulse on the second, about the origin
  PlanarForce impulse_on_second;   ///< in the whole contact, about its centre of mass
  bool pressed = false;            ///< it bore a force
  double reached_first_m = 0.0;    ///< into the first's compartment in their earlier contacts
  double reached_second_m = 0.0;   ///< and into the second's
  std::uint64_t left_at_step = 0;  ///< of the scene, when their last contact was over
  double faded_until_s = -1e9;     ///< of the scene: see SceneContact::goes_on

  /// Forgets everything but its room.
  void begin(std::size_t a, std::size_t b);
  /// A further contact begins in a scene's step: what was crushed stays crushed.
  void meet_again(std::uint64_t step);
  /// Greatest reach into the first's or the second's compartment in this contact, m.
  double reach_m(bool of_first_body) const;
};

}  // namespace detail

/// Memory of simulations.
struct ContactWorkspace::State {
  std::vector<detail::PressedBody> bodies;
  std::vector<detail::BodyPair> pairs;  ///< the first `pairs_in_use`; the others are room
  std::size_t pairs_in_use = 0;

  /// Forgets bodies and pairs.
  void begin();
  /// Adds a body as it moves now, coordinates from `origin_m`.
  void add_body(const ContactBody& body, const Eigen::Vector3d& origin_m,
                const ContactVariant& variant);
  /// A pair with nothing remembered and room for the outlines of both bodies; its index.
  std::uint32_t take_pair(std::size_t first, std::size_t second);
};

namespace detail {

/// No contact goes on for longer than this and a step, s.
inline constexpr double longest_contact_s = 1.5;

/// A contact of a body with another, or with several that nothing moves, while it goes on. Who owns
/// the bodies moves them: by half a step before `feel` and by the other half after `press`.
class ContactRun {
public:
  /// Most bodies that press on the first at the same time.
  static constexpr std::size_t most_others = 65;

  /// Begins with what moves now; `first` and `second` in the order of `goes_second`, indices into
  /// the workspace's bodies, `pair` what is remembered of them. `given` are the two with their
  /// poses as they are now. Workspace and vehicles outlive the run.
  void begin(ContactWorkspace::State& state, std::size_t first, std::uint32_t pair,
             const ContactBody& given_first, const ContactBody& given_second,
             const Eigen::Vector3d& origin_m, const ContactVariant& variant,
             const ContactOptions& options);
  /// A further body that nothing moves, beside a second that nothing moves. False: there is no
  /// room.
  bool add(std::uint32_t pair);

  /// What was near only comes into contact: it begins here, in the middle of a step.
  void begin_here(const ContactBody& given_first, const ContactBody& given_second);

  /// The step that the contact asks for, s.
  double next_step_s() const;
  /// The forces at the middle of a step.
  void feel(double step_s);
  /// Whether they press.
  bool presses() const noexcept { return totals_.pressing > 0.0; }
  /// Changes the bodies' velocities by them, and by the rebound where it is due.
  void press();
  /// What the step's force gave the first or the second body, m/s.
  Eigen::Vector2d step_change_mps(bool of_first) const;
  /// It continues an earlier contact's push: no impact begins with it.
  void continue_push() noexcept { strong_s_ = -std::numeric_limits<double>::infinity(); }
  /// Decides after `press` how much of the step's force counts as change of velocity: all but that
  /// of long pushes and scrapes.
  void weigh_step();
  /// The share in [0, 1] of what counts of the step's force that something else took at the same
  /// time: it counts no more.
  void take_back(bool from_first, double share);
  /// All contacts together changed the first or the second body's velocity so in this step, m/s;
  /// `shared`: others pressed on it, too.
  void undergo(bool first, const Eigen::Vector2d& change_mps, bool shared);
  /// Once the bodies have moved to the end of the step.
  void end_step();
  bool over() const noexcept { return over_; }
  /// It is over though the bodies may still rub against each other.
  bool faded() const noexcept { return faded_; }

  std::size_t first() const noexcept { return first_; }
  /// Index of the body that it began with.
  std::size_t second() const noexcept { return state_->pairs[pairs_[0]].second; }
  /// Index of the body besides the first that took most impulse.
  std::size_t most_pressed() const;
  /// Both as they were when it began.
  const ContactBody& given_first() const noexcept { return given_first_; }
  const ContactBody& given_second() const noexcept { return given_second_; }
  View<const std::uint32_t> pairs() const noexcept { return {pairs_.data(), pair_count_}; }
  bool acts() const noexcept { return acts_; }
  /// Since its begin, s: now, and when a force last acted.
  double time_s() const noexcept { return time_s_; }
  double duration_s() const noexcept { return duration_s_; }
  /// The outcome as far as the contact has come; `swapped`: the first is B.
  ContactOutcome outcome(bool swapped) const;

  // Bounds that hold whatever follows, for two bodies that nothing else pushes. They rest on what
  // every step keeps: momentum, no gain of energy but by one rebound, which restores at most
  // `most_restored` of what was lost before it.

  /// Impulse on the first so far, world axes, N·s.
  Eigen::Vector3d impulse_ns() const;
  /// No more impulse can follow than this, N·s.
  double most_left_ns() const;
  /// The whole impulse is no smaller than this, N·s,
  double least_whole_ns() const;
  /// and no larger than this.
  double most_whole_ns() const;
  /// Rounding of impulses, N·s, and of energies, J: both are differences of far larger numbers.
  double rounding_ns() const;
  double rounding_j() const { return 1e-12 * energy_before_j_; }
  /// Kinetic energy lost so far, J.
  double dissipated_j() const { return std::max(0.0, dissipated_j_); }
  /// The whole loss is no smaller than this, J,
  double least_whole_j() const;
  /// and no larger than this.
  double most_whole_j() const;
  /// Pieces moved so far.
  std::uint64_t work() const noexcept { return pieces_; }

private:
  struct Totals {
    bool approaching = false;
    double pressing = 0.0;
    double closing = 0.0;
    double passing = 0.0;
    double fresh = 0.0;
    double weight = 0.0;
    double point_x = 0.0;
    double point_y = 0.0;
  };
  /// Change of kinetic energy along a set of forces or impulses.
  struct EnergyChange {
    double slope = 0.0;
    double bend = 0.0;
    void add(const PlanarBody& body, const PlanarForce& f);
  };
  /// Change of a body's velocity by all contacts, m/s.
  struct Undergone {
    Eigen::Vector2d now_mps = Eigen::Vector2d::Zero();
    double most_mps = 0.0;  ///< greatest after a step with a force
    /// What counts may be more: others pressed on it at the same time, or not all steps count.
    bool partial = false;
  };
  /// Relative velocity where the force of a step acts.
  struct AtForce {
    double closing_mps = 0.0;  ///< against the force, positive while the bodies approach
    double passing_mps = 0.0;  ///< its length
  };
  const PlanarBody& motion_of(std::size_t body) const { return state_->bodies[body].motion; }
  PlanarBody& motion_of(std::size_t body) { return state_->bodies[body].motion; }
  void feel_pair(BodyPair& pair, std::size_t place, PassSettings& settings);
  void add_sums(const PassSums& sums, bool own_is_first);
  void push();
  AtForce at_force() const;
  void rebound(double passing_mps);
  void add_taken(bool from_first, double share);
  double moving_j() const;
  double speed_at_rims() const;
  double relative_speed() const;
  double most_speed_mps() const;
  BodyContact describe(bool is_first) const;
  static void limit(const Undergone& undergone, double inverse_mass, BodyContact& contact);

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
  PlanarBody end_first_;  ///< when the force last acted
  PlanarBody end_second_;
  MotionRecord record_;
  double rim_m_ = 0.0;  ///< no outline is further from its body's centre of mass

  bool over_ = false;
  bool faded_ = false;
  bool acts_ = false;
  Totals totals_;                 ///< of this step
  PlanarForce on_first_;          ///< in this step, about its centre of mass
  PlanarForce since_rebound_;     ///< impulse on the first, about the origin
  PlanarForce impulse_on_first_;  ///< in the whole contact, about its centre of mass
  double pushed_s_ = 0.0;         ///< how long it acted in this step
  double counted_ = 1.0;          ///< share of this step's force that counts, see `weigh_step`
  double strong_s_ = 0.0;         ///< since the begin: last force that counts whole, s
  PlanarForce taken_first_;       ///< impulses on both, see `take_back`
  PlanarForce taken_second_;
  Undergone of_first_;
  Undergone of_second_;
  double time_s_ = 0.0;
  double duration_s_ = 0.0;
  double step_s_ = 0.0;
  double since_s_ = 0.0;            ///< from the last pass until this one
  double speed_mps_ = 0.0;          ///< of points against each other, at most
  double acceleration_mps2_ = 0.0;  ///< that the force of the last step caused
  double moved_m_ = 0.0;            ///< in the last step
  double energy_before_j_ = 0.0;
  double speed_before_mps_ = 0.0;
  double momentum_before_ns_ = 0.0;  ///< of the bodies against each other
  double speeds_before_mps_ = 0.0;
  double dissipated_j_ = 0.0;
  double lost_j_ = 0.0;  ///< since the last rebound
  double most_pressing_ = 0.0;
  double most_closing_mps_ = 0.0;
  double most_passing_mps_ = 0.0;
  double last_passing_mps_ = 0.0;
  double fastest_passing_mps_ = 0.0;
  double closing_mps_ = 0.0;
  double restitution_ = 0.0;
  double impulse_ns_ = 0.0;  ///< sum of lengths
  double late_ns_ = 0.0;
  double late_from_s_ = 0.0;
  double late_m_ = 0.0;  ///< travel since then
  double quiet_m_ = 0.0;
  double friction_j_ = 0.0;
  double crush_first_j_ = 0.0;
  double crush_second_j_ = 0.0;
  float depth_first_m_ = 0.0F;
  float depth_second_m_ = 0.0F;
  double point_x_ = 0.0;
  double point_y_ = 0.0;
  double point_weight_ = 0.0;
  std::uint32_t steps_ = 0;
  std::uint64_t pieces_ = 0;
};

/// Whether there is anything to simulate: a body that moves, and one that gives way.
bool can_press(const Vehicle& a, const Vehicle& b);

}  // namespace detail
}  // namespace crashrank
