#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <vector>

namespace oracle {

/// All pairs of triangles that share a point, B's vertices carried by `pose`, every pair tested, in
/// exact arithmetic. Sorted.
std::vector<crashrank::Pair> brute_force(const crashrank::TriangleMesh& a,
                                         const crashrank::TriangleMesh& b,
                                         const crashrank::Pose& pose);

/// The exact answer for one pair.
bool shares_point(const crashrank::TriangleMesh& a, const crashrank::TriangleMesh& b,
                  const crashrank::Pose& pose, crashrank::Pair pair);

}  // namespace oracle
