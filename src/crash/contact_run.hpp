#pragma once

#include "crash/motion_record.hpp"
#include "crash/surface_pass.hpp"

#include "crashrank/crash/contact_law.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Memory of simulations.
struct ContactWorkspace::State {
  std::vector<detail::PressedBody> bodies;    ///< the first, then those it meets
  std::vector<detail::NearPieces> near;       ///< of each other in the first; then of the first
  std::vector<detail::PassRecord> records;    ///< in the order of `near`
  std::vector<detail::PlanarForce> forces;    ///< on each body, of a step
  std::vector<detail::PlanarForce> impulses;  ///< on each body since the last rebound
  std::vector<char> pressed;                  ///< by body: it bore a force
};

namespace detail {

/// No simulation of a contact goes on for longer than this and a step, s.
inline constexpr double longest_contact_s = 1.5;

/// One contact, simulated some steps at a time.
class ContactRun {
public:
  /// `workspace` serves one run at a time; vehicles and workspace outlive the run. `fixed` as in
  /// `simulate_contact`.
  ContactRun(const ContactBody& a, const ContactBody& b, View<const ContactBody> fixed,
             const Eigen::Vector3d& point_m, const ContactVariant& variant,
             const ContactOptions& options, ContactWorkspace& workspace);

  /// Takes at most so many steps; false once the contact is over.
  bool advance(int steps);
  /// The outcome as far as the contact has come.
  ContactOutcome outcome() const;

  // Bounds that hold whatever follows. They rest on what every step keeps: momentum, no gain of
  // energy but by one rebound, which restores at most `most_restored` of what was lost before it.

  /// Impulse on A so far, world axes, N·s.
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
  double dissipated_j() const;
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
  };
  /// Relative velocity where the force of a step acts.
  struct AtForce {
    double closing_mps = 0.0;  ///< against the force, positive while the bodies approach
    double passing_mps = 0.0;  ///< its length
  };
  void step();
  Totals feel();
  EnergyChange energy_along(const std::vector<PlanarForce>& on) const;
  void push();
  AtForce at_force(const Totals& totals) const;
  void rebound(const Totals& totals, double passing_mps);
  void move(double seconds);
  double moving_j() const;
  double speed_at_rims() const;
  double relative_speed() const;
  double most_speed_mps() const;
  BodyContact describe(std::size_t body, const ContactBody& given, bool is_first) const;

  ContactOptions options_;
  ContactVariant variant_;
  ContactBody given_first_;
  ContactBody given_second_;
  bool swapped_ = false;  ///< the first is B
  Eigen::Vector3d origin_m_;
  ContactWorkspace::State& state_;
  PlanarBody start_first_;
  PlanarBody start_second_;
  PlanarBody end_first_;  ///< when the force last acted
  PlanarBody end_second_;
  MotionRecord record_;
  double friction_ = 0.3;
  double rim_m_ = 0.0;  ///< no outline is further from its body's centre of mass

  bool over_ = false;
  bool acts_ = false;
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
  double lost_j_ = 0.0;      ///< since the last rebound
  double restored_j_ = 0.0;  ///< by rebounds
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
bool can_press(const ContactBody& a, const ContactBody& b);

}  // namespace detail
}  // namespace crashrank
