#pragma once

#include "crashrank/internal/base/export.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <memory>

namespace crashrank {

/// Relation of two moving bodies within an interval of time.
enum class ImpactState {
  none,         ///< never closer than the tolerance
  grazing,      ///< closer than the tolerance, never touching
  contact,      ///< apart at the start, then touching
  overlapping,  ///< surfaces intersect at the start
  contained,    ///< at the start one lies inside the other, or a part of it does; no surfaces touch
  undecided,    ///< the step limit was reached first; no contact before `time_s`
};

/// How first contact is searched.
struct ImpactOptions {
  double tolerance_m = 1e-4;  ///< surfaces at most this far apart count as in contact
  /// Number of box pairs and triangle pairs tested before the answer is `undecided`.
  std::uint64_t max_steps = 5'000'000;
  /// The caller knows that the bodies are apart at the start (it asked `initial_state` before, for
  /// instance once for all candidates of one scene): the start is not tested again.
  bool start_is_apart = false;
  /// Called every few dozen steps, about 10 µs, with `stop_context`; once it returns true the
  /// answer is `undecided`. May be null.
  bool (*stop)(void* stop_context) = nullptr;
  void* stop_context = nullptr;  ///< argument of `stop`
};

/// Work done by a query.
struct ImpactWork {
  std::uint64_t bv_tests = 0;         ///< pairs of boxes
  std::uint64_t primitive_tests = 0;  ///< pairs of triangles brought together in time
  std::uint64_t poses = 0;            ///< times at which both motions were evaluated

  /// Adds up.
  ImpactWork& operator+=(const ImpactWork& other) {
    bv_tests += other.bv_tests;
    primitive_tests += other.primitive_tests;
    poses += other.poses;
    return *this;
  }
};

/// The answer. Points and normal in world coordinates at `time_s`.
struct Impact {
  ImpactState state = ImpactState::none;  ///< relation of the bodies

  /// contact: the first time at which the surfaces are within the tolerance, touching follows while
  ///   they stay so (when they came that close and parted once or more before, see `grazed`, it is
  ///   the first time at which they touch); grazing: the first time within the tolerance;
  /// overlapping, contained: the start; none: the end; undecided: proved apart until here.
  double time_s = 0.0;
  double gap_m = 0.0;  ///< distance of the two points below, 0 when the surfaces intersect

  std::int32_t triangle_a = -1;  ///< in mesh order, -1 when no pair was found
  std::int32_t triangle_b = -1;  ///< its partner on B
  Eigen::Vector3d point_a_m = Eigen::Vector3d::Zero();  ///< on the surface of A
  Eigen::Vector3d point_b_m = Eigen::Vector3d::Zero();  ///< on the surface of B
  /// Unit, from A towards B; zero when no pair was found.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();

  bool grazed = false;        ///< contact that followed an earlier pass within the tolerance
  double graze_time_s = 0.0;  ///< when that pass began

  ImpactWork work;  ///< done for it

  /// True if the bodies touch or overlap, false for a grazing pass.
  bool hit() const noexcept {
    return state == ImpactState::contact || state == ImpactState::overlapping ||
           state == ImpactState::contained;
  }
};

/// Memory that queries reuse: one for each thread. It grows to the size that the deepest trees need
/// (a stack of one entry a level of either tree, and poses at a few hundred times); after that no
/// query allocates.
class CRASHRANK_API ImpactWorkspace {
public:
  /// Empty; grows with its first uses.
  ImpactWorkspace();
  /// Frees its memory.
  ~ImpactWorkspace();
  /// Moves.
  ImpactWorkspace(ImpactWorkspace&&) noexcept;
  ImpactWorkspace& operator=(ImpactWorkspace&&) noexcept;       ///< Moves.
  ImpactWorkspace(const ImpactWorkspace&) = delete;             ///< One per thread: not copied.
  ImpactWorkspace& operator=(const ImpactWorkspace&) = delete;  ///< One per thread: not copied.

  /// Room for all queries between two trees of such depths.
  void prepare(std::uint32_t depth_a, std::uint32_t depth_b);

  struct State;  ///< Its contents, for the library.
  /// Its contents, for the library.
  State& state() noexcept { return *state_; }

private:
  std::unique_ptr<State> state_;
};

/// First contact of two moving bodies within [from, until], found without stepping over any: an
/// interval that is reported as free of contact is proved so at every instant, not sampled. Each
/// pair of boxes is advanced in time for as long as its distance, its closing speed along a
/// separating direction and a bound on the accelerations prove it apart; pairs that may touch are
/// opened, earliest first, and pairs proved apart until the best contact known are dropped, so that
/// one descent through both trees covers the whole interval (in place of the repeated distance
/// queries of conservative advancement; Mirtich 1996; Tang, Kim, Manocha 2009 "C2A"). Rounding is
/// covered by margins as long as coordinates stay below 1e6 m. Empty trees touch nothing. Times in
/// s, from <= until, both >= 0.
CRASHRANK_API Impact time_of_impact(const AabbTree& a, const Motion& motion_a, const AabbTree& b,
                                    const Motion& motion_b, double from_s, double until_s,
                                    ImpactWorkspace& workspace, const ImpactOptions& options = {});

/// Relation of two bodies at rest: `overlapping`, `contained`, `grazing` (closer than
/// the tolerance) or `none`. Points and normal in the frame of the two poses.
CRASHRANK_API Impact initial_state(const AabbTree& a, const Pose& a_in_world, const AabbTree& b,
                                   const Pose& b_in_world, ImpactWorkspace& workspace,
                                   const ImpactOptions& options = {});

}  // namespace crashrank
