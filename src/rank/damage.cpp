#include "rank/damage.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace crashrank::detail {
namespace {

/// Largest displacement of body a between two selected poses, m, unless consecutive poses of the
/// record are further apart. Triangles that are passed between two poses are found by following
/// corners.
constexpr double pose_spacing_m = 0.1;

Box bounds_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  Box box;
  for (const std::uint32_t index : triangles) {
    for (const std::uint32_t vertex : mesh.triangles[index]) box.grow(mesh.vertices[vertex]);
  }
  return box;
}

Box transform_box(const Pose& pose, const Box& box) {
  Box result;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f point((corner & 1) != 0 ? box.max.x() : box.min.x(),
                                (corner & 2) != 0 ? box.max.y() : box.min.y(),
                                (corner & 4) != 0 ? box.max.z() : box.min.z());
    result.grow(Eigen::Vector3f(carry(pose, point).cast<float>()));
  }
  return result;
}

Box intersection(const Box& a, const Box& b) {
  Box box;
  box.min = a.min.cwiseMax(b.min);
  box.max = a.max.cwiseMin(b.max);
  return box.empty() ? Box{} : box;
}

Box expanded(const Box& box, float by) {
  Box result = box;
  result.min.array() -= by;
  result.max.array() += by;
  return result;
}

// Displacement of a point of a, given in the coordinates of a, in the frame of b, m.
double displacement_of_point_m(const ContactPoses& from, const ContactPoses& to,
                               const Eigen::Vector3d& in_a_m) {
  const Pose before = relative(from.b, from.a);
  const Pose after = relative(to.b, to.a);
  return (after.rotation * in_a_m + after.translation -
          (before.rotation * in_a_m + before.translation))
      .norm();
}

// Largest displacement of any corner of the box of a in the frame of b, m.
double displacement_of_box_m(const Body& a, const ContactPoses& from, const ContactPoses& to) {
  double moved_m = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                               (corner & 4) != 0 ? 1.0 : -1.0);
    const Eigen::Vector3d point = a.center_m + a.half_axes_m * sign;
    moved_m = std::max(moved_m, displacement_of_point_m(from, to, point));
  }
  return moved_m;
}

// Selects poses of a record: the first, the one at which the contact point has moved furthest, the
// last, and enough others to keep the displacement between neighbours small.
std::vector<std::size_t> select_poses(const Body& a, View<const ContactPoses> record,
                                      std::size_t furthest) {
  std::vector<std::size_t> chosen{0};
  for (std::size_t i = 1; i < record.size(); ++i) {
    if (i == furthest || i + 1 == record.size() ||
        displacement_of_box_m(a, record[chosen.back()], record[i + 1]) > pose_spacing_m) {
      chosen.push_back(i);
    }
  }
  return chosen;
}

// Returns true if the bounding spheres of the bodies overlap at one of the poses.
bool comes_near(const Body& first, const Body& other, const std::vector<Pose>& poses) {
  const double reach_m = first.radius_m + other.radius_m;
  return std::any_of(poses.begin(), poses.end(),
                     [reach_m](const Pose& pose) { return pose.translation.norm() <= reach_m; });
}

void add_all(const TriangleMesh& mesh, TriangleSet& set) {
  for (std::size_t i = 0; i < mesh.size(); ++i) set.add(static_cast<std::uint32_t>(i));
}

void store_damage(const TriangleMesh& mesh, TriangleSet& set, const Pose& pose,
                  BodyDamage& damage) {
  damage.triangles = set.sorted();
  damage.pose = pose;
  fill_area_and_parts(mesh, damage);
}

}  // namespace

void fill_area_and_parts(const TriangleMesh& mesh, BodyDamage& damage) {
  damage.area_m2 = 0.0;
  damage.parts.clear();
  std::size_t part = 0;
  for (const std::uint32_t index : damage.triangles) {
    const Triangle triangle = mesh.triangle(index);
    const Eigen::Vector3d a = triangle.corner[0].cast<double>();
    const Eigen::Vector3d b = triangle.corner[1].cast<double>();
    const Eigen::Vector3d c = triangle.corner[2].cast<double>();
    damage.area_m2 += 0.5 * (b - a).cross(c - a).norm();
    while (part < mesh.parts.size() &&
           index >= mesh.parts[part].first_triangle + mesh.parts[part].triangle_count) {
      ++part;
    }
    const bool known = part < mesh.parts.size() && index >= mesh.parts[part].first_triangle;
    if (known && (damage.parts.empty() || damage.parts.back() != part)) {
      damage.parts.push_back(static_cast<std::uint32_t>(part));
    }
  }
}

DamagePlan plan_damage(const Scene& scene, const DamageQuery& query, const ContactMotion& motion,
                       View<const std::size_t> pressed) {
  const View<const ContactPoses> record = motion.all();
  const Body& a = body_of(scene, query.a);
  DamagePlan plan;
  plan.query = query;
  plan.first_pose = query.state == ImpactState::contact && query.triangle_a >= 0 ? 1 : 0;
  plan.crush_s = record[record.size() - 1].time_s;
  plan.pose_a = record[0].a;
  const Eigen::Vector3d point_m =
      plan.pose_a.rotation.transpose() * (query.point_m - plan.pose_a.translation);
  std::size_t furthest = 0;
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double moved_m = displacement_of_point_m(record[0], record[i], point_m);
    if (!(moved_m > plan.travel_m)) continue;
    plan.travel_m = moved_m;
    furthest = i;
  }
  const std::vector<std::size_t> chosen = select_poses(a, record, furthest);
  const auto add_path = [&](std::size_t actor) {
    const Body& body = scene.actors[actor];
    // For joined bodies the record holds their common pose; each member needs its own.
    const bool is_fixed = !body.vehicle->movable();
    const Pose fixed_pose = body.fixed_pose;
    DamagePath path;
    path.actor = actor;
    for (const std::size_t i : chosen) {
      path.poses.push_back(relative(record[i].a, is_fixed ? fixed_pose : record[i].b));
    }
    if (actor == query.b || comes_near(a, body, path.poses)) plan.paths.push_back(std::move(path));
  };
  add_path(query.b);
  for (const std::size_t actor : pressed) {
    if (actor != query.b) add_path(actor);
  }
  const Body& b = scene.actors[query.b];
  plan.pose_b = b.vehicle->movable() ? record[0].b : b.fixed_pose;
  return plan;
}

void find_damage(const Scene& scene, const DamagePlan& plan, const PrecomputedPairs& found,
                 BodyDamage& damage_a, BodyDamage& damage_b, DamageScratch& scratch,
                 RankWork& work) {
  const DamageQuery& contact = plan.query;
  const Body& a = body_of(scene, contact.a);
  const Body& b = scene.actors[contact.b];
  scratch.a.clear(a.model->mesh.size(), a.model->tree.nodes.size());
  scratch.b.clear(b.model->mesh.size(), b.model->tree.nodes.size());
  scratch.overlaps.clear();

  if (contact.triangle_a >= 0 && contact.triangle_b >= 0) {
    scratch.a.add(static_cast<std::uint32_t>(contact.triangle_a));
    scratch.b.add(static_cast<std::uint32_t>(contact.triangle_b));
    scratch.overlaps.push_back({relative(plan.pose_a, plan.pose_b), {}});
  }
  if (contact.state == ImpactState::contained) {
    const bool a_is_inside = a.radius_m < b.radius_m;
    add_all(a_is_inside ? a.model->mesh : b.model->mesh, a_is_inside ? scratch.a : scratch.b);
  }
  std::size_t query = found.first;
  for (const DamagePath& path : plan.paths) {
    const bool own = path.actor == contact.b;
    const Body& body = scene.actors[path.actor];
    const auto add = [&scratch, own](View<const Pair> pairs) {
      for (const Pair& pair : pairs) {
        scratch.a.add(static_cast<std::uint32_t>(pair.a));
        if (own) scratch.b.add(static_cast<std::uint32_t>(pair.b));
      }
    };
    for (std::size_t i = plan.first_pose; i < path.poses.size(); ++i, ++query) {
      ++work.damage_queries;
      if (found.lists != nullptr) {
        if (found.lists->count(query) == 0) continue;
        found.lists->for_each_run(query, add);
      } else {
        const CollideResult result =
            collide(*a.model, *body.model, path.poses[i], scratch.pairs, scratch.collide);
        work.damage += result.work;
        if (!result.intersecting) continue;
        add(scratch.pairs);
      }
      scratch.overlaps.push_back({path.poses[i], own ? Box{} : body.model->mesh.bounds()});
    }
  }
  for (const DamagePath& path : plan.paths) {
    const Body& body = scene.actors[path.actor];
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      const Pose& from = path.poses[i - 1];
      const Pose& to = path.poses[i];
      work.paths +=
          add_swept_triangles(a, inverse(from), inverse(to), body, scratch.a, scratch.passed);
      if (path.actor != contact.b) continue;
      work.paths += add_swept_triangles(body, from, to, a, scratch.b, scratch.passed);
    }
  }
  store_damage(a.model->mesh, scratch.a, plan.pose_a, damage_a);
  store_damage(b.model->mesh, scratch.b, plan.pose_b, damage_b);

  const Box box_a = bounds_of(a.model->mesh, damage_a.triangles);
  const Box box_b = bounds_of(b.model->mesh, damage_b.triangles);
  if (box_a.empty() || box_b.empty()) return;
  const auto reach = static_cast<float>(contact.gap_m) + 1e-5F;
  for (const DamageScratch::Overlap& overlap : scratch.overlaps) {
    const bool own = overlap.other.empty();
    damage_a.region.grow(intersection(
        box_a, expanded(transform_box(overlap.b_in_a, own ? box_b : overlap.other), reach)));
    if (!own) continue;
    damage_b.region.grow(
        intersection(box_b, expanded(transform_box(inverse(overlap.b_in_a), box_a), reach)));
  }
}

}  // namespace crashrank::detail
