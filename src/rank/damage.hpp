#pragma once

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "rank/scene.hpp"
#include "rank/swept_damage.hpp"
#include "rank/triangle_set.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Memory that reading damage reuses, one for each worker.
struct DamageScratch {
  std::vector<Pair> pairs;
  ModelWorkspace collide;
  TriangleSet a;
  TriangleSet b;
  SweptScratch passed;
  /// Poses at which surfaces intersect, and the bounds of what a intersects there.
  struct Overlap {
    Pose b_in_a;
    Box other;  ///< in its body coordinates; empty: those of the contact's damage
  };
  std::vector<Overlap> overlaps;
};

/// The way of a body past the contact's first one.
struct DamagePath {
  std::size_t actor = 0;
  std::vector<Pose> poses;  ///< of it in the first one's frame, in the order of time
};

/// A contact of which the damage is to be read. A is the ego or an actor.
struct DamageQuery {
  std::size_t a = ego_body;
  std::size_t b = 0;  ///< an actor
  ImpactState state = ImpactState::contact;
  double gap_m = 0.0;
  std::int32_t triangle_a = -1;  ///< that touched first; negative when none did
  std::int32_t triangle_b = -1;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< where they meet, world
};

/// Where the damage of a contact is read: along the motion that its simulation recorded.
struct DamagePlan {
  DamageQuery query;
  /// Of b, then of further bodies that a pressed on in the same contact.
  std::vector<DamagePath> paths;
  /// The first pose that is asked for intersecting triangles: bodies that were apart until first
  /// contact share no more than the first pair of triangles there.
  std::size_t first_pose = 0;
  Pose pose_a;           ///< body to world at first contact
  Pose pose_b;           ///< b's then
  double crush_s = 0.0;  ///< see Contact
  double crush_m = 0.0;

  /// Poses that are asked.
  std::size_t queries() const {
    std::size_t count = 0;
    for (const DamagePath& path : paths) count += path.poses.size() - first_pose;
    return count;
  }
};

/// Says where to look for the damage of a contact. `motion` is that of the nominal variant;
/// `pressed` are the actors that a pressed on in it, b may be among them.
DamagePlan plan_damage(const Scene& scene, const DamageQuery& query, const ContactMotion& motion,
                       View<const std::size_t> pressed);

/// Pairs found before, `queries[first + i]` at the plan's i-th pose; without lists each pose is
/// asked when it is needed.
struct PrecomputedPairs {
  const PairLists* lists = nullptr;
  std::size_t first = 0;
};

/// What a contact does to both bodies.
void find_damage(const Scene& scene, const DamagePlan& plan, const PrecomputedPairs& found,
                 BodyDamage& a, BodyDamage& b, DamageScratch& scratch, RankWork& work);

/// Fills in area and parts from the triangles.
void fill_area_and_parts(const TriangleMesh& mesh, BodyDamage& damage);

}  // namespace crashrank::detail
