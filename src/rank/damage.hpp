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

/// Working memory of the damage search, one for each worker.
struct DamageScratch {
  std::vector<Pair> pairs;
  ModelWorkspace collide;
  TriangleSet a;
  TriangleSet b;
  SweptScratch passed;
  /// Poses at which the surfaces intersect, with the bounds of the body that a intersects there.
  struct Overlap {
    Pose b_in_a;
    Box other;  ///< in the coordinates of that body; empty: use the bounds of the damage of b
  };
  std::vector<Overlap> overlaps;
};

/// Trajectory of another body relative to body a of the contact.
struct DamagePath {
  std::size_t actor = 0;
  std::vector<Pose> poses;  ///< poses of the body in the frame of a, in order of time
};

/// A contact whose damage is to be found. Body a is the ego or an actor.
struct DamageQuery {
  std::size_t a = ego_body;
  std::size_t b = 0;  ///< index of an actor
  ImpactState state = ImpactState::contact;
  double gap_m = 0.0;
  std::int32_t triangle_a = -1;  ///< triangles that touched first; negative if there are none
  std::int32_t triangle_b = -1;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< point of contact, world
};

/// Poses at which the damage of a contact is evaluated, along the motion that its simulation
/// recorded.
struct DamagePlan {
  DamageQuery query;
  /// Trajectory of b, followed by those of other bodies that a pressed on in the same contact.
  std::vector<DamagePath> paths;
  /// Index of the first pose to be tested for intersecting triangles. It is 1 if the bodies were
  /// apart until first contact, because at pose 0 they share only the first pair of triangles.
  std::size_t first_pose = 0;
  Pose pose_a;            ///< body to world at first contact
  Pose pose_b;            ///< body to world of b at first contact
  double crush_s = 0.0;   ///< duration, see Contact::crush_s
  double travel_m = 0.0;  ///< see Contact::travel_m

  /// Number of poses to be tested.
  std::size_t queries() const {
    std::size_t count = 0;
    for (const DamagePath& path : paths) count += path.poses.size() - first_pose;
    return count;
  }
};

/// Selects the poses at which the damage of a contact is evaluated. `motion` is that of the nominal
/// sample; `pressed` lists the actors that a pressed on in it and may contain b.
DamagePlan plan_damage(const Scene& scene, const DamageQuery& query, const ContactMotion& motion,
                       View<const std::size_t> pressed);

/// Intersecting pairs that were computed before: `lists` holds those of the i-th pose of the plan
/// at query `first + i`. Without lists each pose is tested on demand.
struct PrecomputedPairs {
  const PairLists* lists = nullptr;
  std::size_t first = 0;
};

/// Finds the damaged triangles of both bodies of a contact.
void find_damage(const Scene& scene, const DamagePlan& plan, const PrecomputedPairs& found,
                 BodyDamage& a, BodyDamage& b, DamageScratch& scratch, RankWork& work);

/// Computes the area and the parts of the damaged triangles.
void fill_area_and_parts(const TriangleMesh& mesh, BodyDamage& damage);

}  // namespace crashrank::detail
