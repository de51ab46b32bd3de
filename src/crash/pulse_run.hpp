#pragma once

#include "crash/facets.hpp"
#include "crash/look.hpp"
#include "crash/material.hpp"

#include "crashrank/crash/depth_map.hpp"
#include "crashrank/crash/pulse.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A facet's law, all of it that does not change while its body is crushed.
struct FacetLaw {
  CrushPressure core;   ///< where it enters the body's core
  CrushPressure aside;  ///< and beside it
};

/// Facets that may touch, rising, by field: most are passed over at every step by few numbers of
/// theirs.
struct AwakeFacets {
  std::vector<std::uint32_t> facet;
  std::vector<double> x;  ///< of the facet's point
  std::vector<double> y;
  std::vector<double> normal_x;
  std::vector<double> normal_y;
  std::vector<double> front_m;  ///< greatest u of A in the facet's row
  // At the instant looked at.
  std::vector<double> at_x;  ///< the point
  std::vector<double> at_y;
  std::vector<double> in_a_x;  ///< where that is in A as it was
  std::vector<double> in_a_y;
  std::vector<double> clear_m;      ///< no nearer to A's surface
  std::vector<double> advance_mps;  ///< into A, along the normal

  std::size_t size() const noexcept { return facet.size(); }
  void reserve(std::size_t count);
  void resize(std::size_t count);
  /// Moves an entry to a place before it.
  void keep(std::size_t from, std::size_t to);
};

/// What pulses write to besides their answer; one for each thread. It grows to what the largest
/// bodies met need and allocates nothing afterwards.
struct PulseMemory {
  DepthMap map_a;
  DepthMap map_b;
  LookMemory look;
  std::vector<Facet> facets;  ///< of B
  std::vector<FacetLaw> laws;
  std::vector<double> row_front_m;  ///< greatest u of A by row
  std::vector<double> crushed_m;    ///< by cell of A: how deep it was pushed back
  std::vector<double> wakes_m;      ///< by facet: sleeps until this much was moved
  AwakeFacets awake;
  std::uint64_t looked_at = 0;  ///< cells and facets that the last look went over

  /// Room for pulses of a body A that is seen at most this long and high, trees at most this deep.
  void prepare(double longest_m, double highest_m, std::uint32_t deepest,
               const PulseOptions& options);
};

/// Whether there is anything to simulate: a horizontal direction, a body that moves, one that
/// yields.
bool can_press(const PulseBody& a, const PulseBody& b, const Eigen::Vector3d& along);

/// Looks at two bodies' surfaces in each other's way, once for any number of pulses between them.
/// No facets are left where they cannot meet, or where `memory.look` was stopped.
void look(const PulseBody& a, const PulseBody& b, const ViewFrame& frame,
          const PulseOptions& options, PulseMemory& memory);

/// A rigid body in the plane of the view.
struct PlanarBody {
  double inverse_mass = 0.0;
  double inverse_inertia = 0.0;
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< centre of mass when the pulse begins
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double spin = 0.0;
  double angle = 0.0;
  double cosine = 1.0;
  double sine = 0.0;

  Eigen::Vector2d velocity_at(const Eigen::Vector2d& p) const {
    return velocity + spin * Eigen::Vector2d(center.y() - p.y(), p.x() - center.x());
  }
  Eigen::Vector2d carried(const Eigen::Vector2d& p) const { return center + out(p - start); }
  Eigen::Vector2d taken_back(const Eigen::Vector2d& p) const { return start + in(p - center); }
  Eigen::Vector2d out(const Eigen::Vector2d& v) const {
    return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y()};
  }
  Eigen::Vector2d in(const Eigen::Vector2d& v) const {
    return {cosine * v.x() + sine * v.y(), cosine * v.y() - sine * v.x()};
  }
  void push(const Eigen::Vector2d& impulse, double moment);
  void move(double dt);
};

/// One pulse between two bodies that were looked at. It can be run a few steps at a time.
class PulseRun {
public:
  /// `memory` holds what `look` saw; it serves one run at a time. All have to outlive the run.
  PulseRun(const PulseBody& a, const PulseBody& b, const ViewFrame& frame,
           const PulseVariant& variant, const PulseOptions& options, PulseMemory& memory);

  /// Goes on by that many steps at most; false once the pulse is over.
  bool advance(int steps);
  /// The result as far as the pulse has come.
  PulseResult result() const;
  /// No more impulse can follow than this, N·s: kinetic energy of the two about their common centre
  /// of mass is never gained, and that is what further impulses live on.
  double most_left_ns() const;
  /// The whole impulse, from first contact to the end, is no smaller than this, N·s: how fast the
  /// centres of mass move against each other at the end is bounded by the energy that is left.
  double least_whole_ns() const;
  /// And no larger than this.
  double most_whole_ns() const;
  /// What rounding may move impulses by, N·s: they are differences of velocities that may be far
  /// larger.
  double rounding_ns() const;
  /// And energies, J.
  double rounding_j() const { return 1e-12 * energy_before_j_; }
  /// No more energy can be dissipated than this, J.
  double most_left_j() const;
  /// Kinetic energy that both have lost so far, J.
  double dissipated_j() const { return std::max(0.0, energy_before_j_ - moving_j()); }
  /// How much has acted so far, world axes, on A.
  Eigen::Vector3d impulse_ns() const { return in_world(impulse_); }
  /// Facets looked at so far.
  std::uint64_t work() const noexcept { return work_; }

private:
  /// Forces of one instant.
  struct Wrench {
    Eigen::Vector2d on_a = Eigen::Vector2d::Zero();
    double moment_a = 0.0;  ///< about A's centre of mass
    double moment_b = 0.0;  ///< of the opposite forces about B's
    double friction_w = 0.0;
    double pressing = 0.0;
    Eigen::Vector2d pressed_at = Eigen::Vector2d::Zero();  ///< times `pressing`
  };

  void put_to_sleep();
  void wake();
  void carry_awake();
  double clearance(const Eigen::Vector2d& in_a, std::size_t row) const;
  bool find(const Eigen::Vector2d& in_a, std::size_t row, std::size_t& cell, double& depth) const;
  Wrench feel();
  void remember();
  void apply(const Wrench& wrench);
  void move();
  Eigen::Vector3d in_world(const Eigen::Vector2d& v) const;
  void tell(const RigidBody& body, const PlanarBody& end, double sign, BodyImpulse& told) const;
  double moving_j() const;
  double most_speed_mps() const;

  const PulseOptions& options_;
  PulseVariant variant_;
  const ViewFrame& frame_;
  const PulseBody& body_a_;
  const PulseBody& body_b_;
  PulseMemory& memory_;
  PlanarBody a_;
  PlanarBody b_;
  PlanarBody end_a_;  ///< when the force last acted
  PlanarBody end_b_;
  Material material_a_;
  Material material_b_;
  int step_ = 0;
  bool over_ = false;
  double quiet_s_ = 0.0;
  double reach_b_m_ = 0.0;  ///< no facet is further from B's centre of mass
  double moved_m_ = 0.0;    ///< no facet has moved further in A's frame
  double next_wake_m_ = 0.0;
  std::uint64_t work_ = 0;
  double energy_before_j_ = 0.0;
  double speed_before_mps_ = 0.0;   ///< of the centres of mass against each other
  double speeds_before_mps_ = 0.0;  ///< of both, over ground, summed
  Eigen::Vector2d impulse_ = Eigen::Vector2d::Zero();
  double pressed_ = 0.0;
  Eigen::Vector2d pressed_at_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d last_at_ = Eigen::Vector2d::Zero();
  double first_slip_ = 0.0;
  PulseResult result_;
};

}  // namespace crashrank::detail
