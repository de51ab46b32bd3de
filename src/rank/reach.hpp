#pragma once

#include "rank/crash_setup.hpp"
#include "rank/scene.hpp"
#include "rank/tally.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Where the ego can get from a contact on, and how fast, whatever the crash does to it.
///
/// Of the two bodies' velocities the common one stays, and that between them never grows but by
/// what was turning: so the ego's centre of mass ends within a ball around the common velocity, and
/// from then on is only slowed.
struct Reach {
  double from_s = 0.0;                               ///< of the contact
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();  ///< its centre of mass at that
  Eigen::Vector3d common_mps = Eigen::Vector3d::Zero();
  double around_mps = 0.0;  ///< radius of the ball
  double speed_mps = 0.0;   ///< it is never faster
  double turning_j2 = 0.0;  ///< I·w², twice its energy of rotation, is never larger
  double energy_mps = 0.0;  ///< moving at this without turning it would have no less energy
  double furthest_m = 0.0;  ///< its centre of mass gets no further before it meets somebody else
};

Reach reach_after(const Scene& scene, const Candidate& candidate, const CrashSetup& crash,
                  const Contact& contact);

/// What bounding contacts in reach writes to, one for each worker.
struct ReachMemory {
  std::vector<std::uint32_t> in_reach_from;  ///< by actor: contacts until it is in reach; 0: never
  std::vector<double> last_term;             ///< by actor: the most that meeting it last adds

  void prepare(std::size_t actors) {
    in_reach_from.reserve(actors);
    last_term.reserve(actors);
  }
};

/// What contacts from there on add at most to the score, of measures that pulses decide: none of
/// `met` again, `left` in number at most. Adds its tests of boxes to `box_tests`.
Later most_in_reach(const Scene& scene, const Reach& reach, View<const std::size_t> met,
                    std::size_t left, ReachMemory& memory, std::uint64_t& box_tests);

}  // namespace crashrank::detail
