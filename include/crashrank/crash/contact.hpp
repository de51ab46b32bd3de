#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/export.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/crash/motion.hpp"
#include "crashrank/crash/time_of_impact.hpp"
#include "crashrank/tree/model.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace crashrank {

/// How a contact is measured.
struct ContactOptions {
  /// How deep the bodies are moved into each other, along the closing velocity at first contact,
  /// before the region is looked at; doubled up to three times while no surfaces meet. m. The
  /// normal leans towards the sides of the bodies by about depth over width.
  double depth_m = 0.02;
  double longest_s = 0.1;  ///< but no longer after first contact than this
};

/// What the normal of a contact was taken from, the surest first.
enum class NormalSource {
  region,   ///< area vector of the curve in which the surfaces cut each other
  plane,    ///< plane through that curve; used where faces do not all point outward
  witness,  ///< the line between the first points of contact
  motion,   ///< the closing velocity
};

/// A contact as the impulse and the report need it. World coordinates at `time_s`.
struct ContactFacts {
  double time_s = 0.0;  ///< of first contact plus the time it took to reach the depth
  /// Middle of the curve in which the surfaces cut each other; without one, of the points of first
  /// contact; of the inner body's root box where one lies inside the other.
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit, from A to B
  NormalSource normal_source = NormalSource::motion;  ///< where the normal comes from
  Eigen::Vector3d relative_velocity_mps =
      Eigen::Vector3d::Zero();      ///< of A against B, at the point
  double normal_speed_mps = 0.0;    ///< its part along the normal, positive when approaching
  double relative_speed_mps = 0.0;  ///< its length

  /// The region in which the surfaces overlap, seen along the normal: how wide horizontally, how
  /// high across that, and the projected area within the curve (0 where faces do not all point
  /// outward). All 0 where no surfaces meet.
  double overlap_width_m = 0.0;
  double overlap_height_m = 0.0;  ///< m
  double overlap_area_m2 = 0.0;   ///< m²
  double lowest_m = 0.0;          ///< world z of the region: what is under and what over it
  double highest_m = 0.0;         ///< and its upper end
  Box region_a;           ///< bounds of the curve in A's body coordinates, empty without one
  Box region_b;           ///< in B's
  std::size_t pairs = 0;  ///< intersecting triangles at `time_s`
};

/// Memory that `contact_facts` reuses, one for each thread.
struct ContactWorkspace {
  /// A piece of the curve along which the surfaces meet, m.
  struct Segment {
    Eigen::Vector3d from;  ///< its beginning
    Eigen::Vector3d to;    ///< its end
  };
  CollideWorkspace collide;    ///< for the pairs
  std::vector<Pair> pairs;     ///< triangles that intersect
  std::vector<Segment> curve;  ///< where they do
};

/// Looks at the contact that `impact` found (one that `hit()`s; for others the witness points
/// stand). Costs one to four queries of all intersecting pairs. Models non-empty. Safe from any
/// thread with its own workspace.
CRASHRANK_API ContactFacts contact_facts(const Model& a, const Motion& motion_a, const Model& b,
                                         const Motion& motion_b, const Impact& impact,
                                         ContactWorkspace& workspace,
                                         const ContactOptions& options = {});

/// The segment in which two triangles cut each other, for triangles that intersect; false for
/// coplanar ones and those that only touch. Within rounding.
CRASHRANK_API bool cut_of(const TriangleD& a, const TriangleD& b,
                          std::array<Eigen::Vector3d, 2>& ends);

}  // namespace crashrank
