#pragma once

#include "motion/relative_motion.hpp"

#include "collide/triangle_distance.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/motion/time_of_impact.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// A state at one of the times that box pairs are looked at, with what boxes need of it.
struct Knot {
  static constexpr auto unmade = static_cast<std::size_t>(-1);
  std::size_t index = unmade;  ///< of its time
  RelativeState state;
  BoxTransform to;
  double shrink_b = 1.0;
  Eigen::Vector3d v;  ///< velocities of the state along the axes of A's boxes
  Eigen::Vector3d omega_a;
  Eigen::Vector3d omega_b;
  double spin_a = 0.0;  ///< their lengths
  double spin_b = 0.0;
};

/// Two slots that touch at a time.
struct PairContact {
  double time = std::numeric_limits<double>::infinity();
  std::uint32_t slot_a = 0;
  std::uint32_t slot_b = 0;
  TriangleGap gap;  ///< in A's frame at that time
};

/// When two surfaces count as in contact, and what has to be proved of all times before.
struct Thresholds {
  double stop_m = 0.0;   ///< in contact at this distance, m
  double prove_m = 0.0;  ///< proved apart by more than this; below `stop_m`
};

/// Most times at which a search looks at both motions by and by.
inline constexpr std::size_t most_even_times = 512;
/// And with the kinks of both among them.
inline constexpr std::size_t most_search_times = most_even_times + 4096;
/// Knots kept at once: one that is asked for takes the place of those this many before and after.
/// More than there are without kinks.
inline constexpr std::size_t kept_knots = 1024;

/// Buffers of a search, kept between searches.
struct SearchMemory {
  struct Entry {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double free_until = 0.0;
    double guess = 0.0;  ///< when they may touch: for the order of the search only
  };
  std::vector<Entry> stack;
  std::vector<double> times;
  std::vector<Knot> knots;  ///< that of index i at i modulo `kept_knots`
};

/// Finds the first time in [from, until] at which two moving surfaces are close. One object serves
/// any number of searches over parts of the stretch of time it was made for.
class ImpactSearch {
public:
  ImpactSearch(const AabbTree& a, const Motion& motion_a, const AabbTree& b, const Motion& motion_b,
               double from, double until, const ImpactOptions& options, SearchMemory& memory);

  /// The first contact in [from, until], `time` infinite when there is none. `known` is a contact
  /// that the caller has already: nothing later is looked for. When the steps run out, `exhausted`
  /// is set and no surfaces touch before `proved_until`.
  PairContact first(double from, const Thresholds& thresholds, const PairContact& known = {});

  /// The first contact of one pair of slots in [from, before); gives up once the pair is seen
  /// further apart than `give_up_m`.
  PairContact follow(std::uint32_t slot_a, std::uint32_t slot_b, double from, double before,
                     const Thresholds& thresholds, double give_up_m);

  RelativeState state_at(double t);

  bool exhausted() const noexcept { return exhausted_; }
  double proved_until() const noexcept { return proved_until_; }
  const ImpactWork& work() const noexcept { return work_; }

private:
  using Entry = SearchMemory::Entry;

  void place_knots(double from);
  std::size_t knot_index(double t) const;
  const Knot& knot(std::size_t index);
  double open_until(const Node& na, const Node& nb, const Knot& k, double limit,
                    double& guess) const;
  double open_until(const TriangleD& ta, const TriangleD& tb, const Knot& k, double limit) const;
  Entry pair(std::uint32_t a, std::uint32_t b, double free_until);
  void leaves(const Node& na, const Node& nb, double free_until);
  double limit() const noexcept;
  bool spend(std::uint64_t& counter);

  const AabbTree& a_;
  const Motion& motion_a_;
  const AabbTree& b_;
  const Motion& motion_b_;
  Radii radii_;
  double until_;
  std::uint64_t steps_left_;
  bool (*stop_)(void*) = nullptr;
  void* stop_context_ = nullptr;
  SearchMemory& memory_;
  Thresholds thresholds_;
  PairContact best_;
  RelativeState last_;  ///< the state asked for last: leaves ask for one time often
  bool last_ready_ = false;
  bool exhausted_ = false;
  double proved_until_ = 0.0;
  ImpactWork work_;
};

}  // namespace crashrank::detail
