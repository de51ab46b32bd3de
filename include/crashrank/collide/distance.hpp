#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <vector>

namespace crashrank {

/// What a distance query looks for.
struct DistanceOptions {
  /// Bodies further apart than this are not looked at closely: the answer is then `beyond_cutoff`.
  double cutoff_m = std::numeric_limits<double>::infinity();
};

/// Points in A's frame, m.
struct DistanceResult {
  /// Never above the true distance of the surfaces; 0 exactly when `collide` finds a pair. When
  /// `beyond_cutoff`, some number above the cutoff.
  double distance_m = 0.0;
  double upper_m = 0.0;          ///< distance of the two points, never below the true distance
  bool beyond_cutoff = false;    ///< nothing is nearer than the cutoff
  std::int32_t triangle_a = -1;  ///< in mesh order, -1 beyond the cutoff
  std::int32_t triangle_b = -1;  ///< its partner on B
  Eigen::Vector3d point_a_m = Eigen::Vector3d::Zero();  ///< nearest point of A, m, A's frame
  Eigen::Vector3d point_b_m = Eigen::Vector3d::Zero();  ///< nearest point of B, m, A's frame
  CollideWork work;                                     ///< tests done
};

/// Memory that distance queries reuse, one for each thread. A query needs one entry for each level
/// of either tree (`traversal_stack_size`); it allocates only to grow beyond an earlier one.
struct DistanceWorkspace {
  /// A node pair that waits.
  struct Entry {
    std::uint32_t a = 0;   ///< node of A
    std::uint32_t b = 0;   ///< node of B
    double lower_m = 0.0;  ///< bound on the distance below them
  };
  std::vector<Entry> stack;  ///< what waits
};

/// Smallest distance of the surfaces of A and of B, which stands at `b_in_a` in A's frame. A body
/// inside another is as far as its surface is. Descends into the nearer pair of boxes first and
/// leaves out boxes further apart than the best pair of points known. Both trees non-empty, the
/// pose finite and rigid within `max_rigidity_error`. Safe from any thread with its own workspace.
CRASHRANK_API DistanceResult distance(const AabbTree& a, const AabbTree& b, const Pose& b_in_a,
                                      DistanceWorkspace& workspace,
                                      const DistanceOptions& options = {});

}  // namespace crashrank
