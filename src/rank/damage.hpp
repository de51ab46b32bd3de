#pragma once

#include "crashrank/collide/wide_collide.hpp"
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
  std::vector<Pose> met;  ///< poses of the other in the ego's frame at which surfaces met
};

/// How two bodies first touched, and at which poses of the other in the ego's frame their
/// intersecting triangles tell the damage.
struct DamagePlan {
  std::int32_t triangle_ego = -1;  ///< that met first; negative when none did
  std::int32_t triangle_other = -1;
  std::vector<Pose> poses;  ///< along the crush, in order
};

/// Says where to look for the damage of a contact.
DamagePlan plan_damage(const Scene& scene, const Motion& ego_motion, const Contact& contact,
                       std::int32_t triangle_ego, std::int32_t triangle_other);

/// Pairs found before, `queries[first + i]` at the plan's pose i; without lists each pose is asked
/// when it is needed.
struct FoundDamage {
  const PairLists* lists = nullptr;
  std::size_t first = 0;
};

/// Moves the two bodies on from a contact by the scene's crush and fills in what it does to both,
/// `contact.ego`, `contact.other` and how far they moved.
void read_damage(const Scene& scene, const Motion& ego_motion, const DamagePlan& plan,
                 const FoundDamage& found, Contact& contact, DamageScratch& scratch,
                 RankWork& work);

/// Fills in area and parts from the triangles.
void sum_up(const TriangleMesh& mesh, BodyDamage& damage);

}  // namespace crashrank::detail
