#pragma once

#include "crashrank/collide/wide_collide.hpp"
#include "rank/passed.hpp"
#include "rank/scene.hpp"
#include "rank/triangle_set.hpp"

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

/// Moves the two bodies on from a contact by the scene's crush and fills in what it does to both,
/// `contact.ego`, `contact.other` and how far they moved. `triangle_ego` and `triangle_other` met
/// first; negative when none did.
void read_damage(const Scene& scene, const Motion& ego_motion, Contact& contact,
                 std::int32_t triangle_ego, std::int32_t triangle_other, DamageScratch& scratch,
                 RankWork& work);

/// Fills in area and parts from the triangles.
void sum_up(const TriangleMesh& mesh, BodyDamage& damage);

}  // namespace crashrank::detail
