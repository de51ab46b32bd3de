#pragma once

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "crashrank/dispatch/pair_lists.hpp"
#include "rank/passed.hpp"
#include "rank/scene.hpp"
#include "rank/triangle_set.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Memory that reading damage reuses, one for each worker.
struct DamageScratch {
  std::vector<Pair> pairs;
  ModelWorkspace collide;
  TriangleSet ego;
  TriangleSet other;
  PassedScratch passed;
  /// Poses at which surfaces intersect, and the bounds of what the ego intersects there.
  struct Overlap {
    Pose other_in_ego;
    Box other;  ///< in its body coordinates; empty: those of the contact's damage
  };
  std::vector<Overlap> overlaps;
};

/// The way of a body past the ego during a contact.
struct DamagePath {
  std::size_t actor = 0;
  std::vector<Pose> poses;  ///< of it in the ego's frame, in the order of time
};

/// Where the damage of a contact is read: along the motion that its simulation recorded.
struct DamagePlan {
  std::int32_t triangle_ego = -1;  ///< that touched first; negative when none did
  std::int32_t triangle_other = -1;
  /// Of the contact's actor, then of further bodies that the ego pressed on in the same contact.
  std::vector<DamagePath> paths;
  /// The first pose that is asked for intersecting triangles: bodies that were apart until first
  /// contact share no more than the first pair of triangles there.
  std::size_t first_pose = 0;
  Pose ego;              ///< body to world at first contact
  Pose other;            ///< the contact's actor then
  double crush_s = 0.0;  ///< see Contact
  double crush_m = 0.0;

  /// Poses that are asked.
  std::size_t queries() const {
    std::size_t count = 0;
    for (const DamagePath& path : paths) count += path.poses.size() - first_pose;
    return count;
  }
};

/// Says where to look for the damage of a contact that begins with the ego at `ego`. `motion` is
/// that of the plain variant, A the ego; `pressed` are the actors that the ego pressed on in it,
/// the contact's own may be among them.
DamagePlan plan_damage(const Scene& scene, const Pose& ego, const Contact& contact,
                       const Impact& impact, const ContactMotion& motion,
                       View<const std::size_t> pressed);

/// Pairs found before, `queries[first + i]` at the plan's i-th pose; without lists each pose is
/// asked when it is needed.
struct FoundDamage {
  const PairLists* lists = nullptr;
  std::size_t first = 0;
};

/// Fills in what a contact does to both bodies, `contact.ego`, `contact.other`, and how far and how
/// long they moved.
void read_damage(const Scene& scene, const DamagePlan& plan, const FoundDamage& found,
                 Contact& contact, DamageScratch& scratch, RankWork& work);

/// Fills in area and parts from the triangles.
void sum_up(const TriangleMesh& mesh, BodyDamage& damage);

}  // namespace crashrank::detail
