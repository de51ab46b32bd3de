#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace crashrank {

/// Whether a point lies inside a body's surface.
///
/// A ray leaves the point along each of the six directions of the tree's axes; a ray that crosses
/// the surface an odd number of times votes "inside". On a watertight mesh all six agree, and which
/// way its triangles face does not matter; crossings are counted so that a ray through an edge or a
/// corner counts once. Where the rays disagree the mesh has holes: then the point is inside when
/// the surface fills more than half of its view, counted with the triangles' orientation (|winding
/// number| > 1/2; Jacobson, Kavan, Sorkine-Hornung 2013), so a car without an underbody still has
/// an inside, and a sheet has none. Points on the surface may count either way.
/// O(nodes), with a solid angle for each triangle where the rays disagree. Allocates nothing.
CRASHRANK_API bool contains_point(const AabbTree& tree, const Eigen::Vector3d& point_m);

/// Which body holds the other.
enum class Containment {
  apart,   ///< neither has a part of its surface inside the other
  a_in_b,  ///< A, or a connected part of it, lies inside B
  b_in_a,  ///< B lies inside A
};

/// For two bodies whose surfaces do not touch: returns whether one lies inside the other. Up to 16
/// triangles spread over each mesh, and within the other's root box, are tested by one corner; as
/// surfaces do not meet, a connected mesh needs one. Both trees non-empty.
CRASHRANK_API Containment containment(const AabbTree& a, const AabbTree& b, const Pose& b_in_a);

}  // namespace crashrank
