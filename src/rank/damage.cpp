#include "rank/damage.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

constexpr double sample_length_m = 0.5;
constexpr double max_samples = 8.0;

Box bounds_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  Box box;
  for (const std::uint32_t index : triangles) {
    for (const std::uint32_t vertex : mesh.triangles[index]) box.grow(mesh.vertices[vertex]);
  }
  return box;
}

Box carried(const Pose& pose, const Box& box) {
  Box result;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f point((corner & 1) != 0 ? box.max.x() : box.min.x(),
                                (corner & 2) != 0 ? box.max.y() : box.min.y(),
                                (corner & 4) != 0 ? box.max.z() : box.min.z());
    result.grow(Eigen::Vector3f(carry(pose, point).cast<float>()));
  }
  return result;
}

Box common(const Box& a, const Box& b) {
  Box box;
  box.min = a.min.cwiseMax(b.min);
  box.max = a.max.cwiseMin(b.max);
  return box.empty() ? Box{} : box;
}

Box wider(const Box& box, float by) {
  Box result = box;
  result.min.array() -= by;
  result.max.array() += by;
  return result;
}

// Where along the crush the bodies are, from first contact (0) to the end of it (1).
class CrushPath {
public:
  CrushPath(const Scene& scene, const Motion& ego, const Contact& contact)
      : ego_(ego), other_(scene.actors[contact.actor].motion), contact_(contact) {
    Velocity ego_velocity;
    Velocity other_velocity;
    ego_.state_at(contact.time_of_impact_s, ego_start_, ego_velocity);
    other_.state_at(contact.time_of_impact_s, other_start_, other_velocity);
    if (scene.crush.depth_m) {
      const Eigen::Vector3d relative_velocity =
          velocity_of_point(ego_velocity, ego_start_.translation, contact.point_m) -
          velocity_of_point(other_velocity, other_start_.translation, contact.point_m);
      const double speed = relative_velocity.norm();
      if (speed > 0.0) shift_m_ = relative_velocity * (*scene.crush.depth_m / speed);
      length_m_ = shift_m_.norm();
      return;
    }
    seconds_ = scene.crush.time_s;
    const Pose before = relative(other_start_, ego_start_);
    const Pose after = relative(other_at(1.0), ego_at(1.0));
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                 (corner & 4) != 0 ? 1.0 : -1.0);
      const Eigen::Vector3d point = scene.ego.center_m + scene.ego.half_axes_m * sign;
      const Eigen::Vector3d way = after.rotation * point + after.translation -
                                  (before.rotation * point + before.translation);
      length_m_ = std::max(length_m_, way.norm());
    }
  }

  double seconds() const { return seconds_; }
  /// How far the corners of the ego's box get in the frame of the other, the one that gets
  /// furthest.
  double length_m() const { return length_m_; }

  Pose ego_at(double share) const {
    if (seconds_ > 0.0) return ego_.pose_at(contact_.time_of_impact_s + share * seconds_);
    Pose pose = ego_start_;
    pose.translation += share * shift_m_;
    return pose;
  }
  Pose other_at(double share) const {
    return seconds_ > 0.0 ? other_.pose_at(contact_.time_of_impact_s + share * seconds_)
                          : other_start_;
  }

private:
  const Motion& ego_;
  const Motion& other_;
  const Contact& contact_;
  Pose ego_start_;
  Pose other_start_;
  Eigen::Vector3d shift_m_ = Eigen::Vector3d::Zero();
  double seconds_ = 0.0;
  double length_m_ = 0.0;
};

// How far a point that is fixed to the ego moves in the frame of the other.
double way_of_point(const Pose& ego_first, const Pose& other_first, const Pose& ego_last,
                    const Pose& other_last, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d in_ego = ego_first.rotation.transpose() * (point_m - ego_first.translation);
  const Eigen::Vector3d before =
      other_first.rotation.transpose() * (point_m - other_first.translation);
  const Eigen::Vector3d after =
      other_last.rotation.transpose() *
      (ego_last.rotation * in_ego + ego_last.translation - other_last.translation);
  return (after - before).norm();
}

void add_all(const TriangleMesh& mesh, TriangleSet& set) {
  for (std::size_t i = 0; i < mesh.size(); ++i) set.add(static_cast<std::uint32_t>(i));
}

void finish(const TriangleMesh& mesh, TriangleSet& set, const Pose& pose, BodyDamage& damage) {
  damage.triangles = set.sorted();
  damage.pose = pose;
  sum_up(mesh, damage);
}

}  // namespace

void sum_up(const TriangleMesh& mesh, BodyDamage& damage) {
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

DamagePlan plan_damage(const Scene& scene, const Motion& ego_motion, const Contact& contact,
                       std::int32_t triangle_ego, std::int32_t triangle_other) {
  const CrushPath path(scene, ego_motion, contact);
  DamagePlan plan;
  plan.triangle_ego = triangle_ego;
  plan.triangle_other = triangle_other;
  const auto samples =
      static_cast<int>(std::clamp(std::ceil(path.length_m() / sample_length_m), 1.0, max_samples));
  // Bodies that were apart until now have met with the first pair alone.
  const int first_sample = contact.state == ImpactState::contact ? 1 : 0;
  for (int k = first_sample; k <= samples; ++k) {
    const double share = static_cast<double>(k) / samples;
    plan.poses.push_back(relative(path.ego_at(share), path.other_at(share)));
  }
  return plan;
}

void read_damage(const Scene& scene, const Motion& ego_motion, const DamagePlan& plan,
                 const FoundDamage& found, Contact& contact, DamageScratch& scratch,
                 RankWork& work) {
  const Body& other = scene.actors[contact.actor];
  const Model& ego_model = *scene.ego.model;
  const Model& other_model = *other.model;
  const CrushPath path(scene, ego_motion, contact);
  scratch.ego.clear(ego_model.mesh.size());
  scratch.other.clear(other_model.mesh.size());
  scratch.met.clear();

  const Pose ego_first = path.ego_at(0.0);
  const Pose other_first = path.other_at(0.0);
  if (plan.triangle_ego >= 0 && plan.triangle_other >= 0) {
    scratch.ego.add(static_cast<std::uint32_t>(plan.triangle_ego));
    scratch.other.add(static_cast<std::uint32_t>(plan.triangle_other));
    scratch.met.push_back(relative(ego_first, other_first));
  }
  if (contact.state == ImpactState::contained) {
    const bool ego_is_inside = scene.ego.radius_m < other.radius_m;
    add_all(ego_is_inside ? ego_model.mesh : other_model.mesh,
            ego_is_inside ? scratch.ego : scratch.other);
  }
  const auto add = [&scratch](View<const Pair> pairs) {
    for (const Pair& pair : pairs) {
      scratch.ego.add(static_cast<std::uint32_t>(pair.a));
      scratch.other.add(static_cast<std::uint32_t>(pair.b));
    }
  };
  for (std::size_t i = 0; i < plan.poses.size(); ++i) {
    ++work.damage_queries;
    if (found.lists != nullptr) {
      if (found.lists->count(found.first + i) == 0) continue;
      found.lists->for_each_run(found.first + i, add);
    } else {
      const CollideResult result =
          collide(ego_model, other_model, plan.poses[i], scratch.pairs, scratch.collide);
      work.damage += result.work;
      if (!result.intersecting) continue;
      add(scratch.pairs);
    }
    scratch.met.push_back(plan.poses[i]);
  }
  const Pose b_in_a_first = relative(ego_first, other_first);
  const Pose b_in_a_last = relative(path.ego_at(1.0), path.other_at(1.0));
  work.paths += add_passed(scene.ego, inverse(b_in_a_first), inverse(b_in_a_last), other,
                           scratch.ego, scratch.passed);
  work.paths +=
      add_passed(other, b_in_a_first, b_in_a_last, scene.ego, scratch.other, scratch.passed);
  finish(ego_model.mesh, scratch.ego, ego_first, contact.ego);
  finish(other_model.mesh, scratch.other, other_first, contact.other);
  contact.crush_s = path.seconds();
  contact.crush_m =
      way_of_point(ego_first, other_first, path.ego_at(1.0), path.other_at(1.0), contact.point_m);

  const Box ego_box = bounds_of(ego_model.mesh, contact.ego.triangles);
  const Box other_box = bounds_of(other_model.mesh, contact.other.triangles);
  if (ego_box.empty() || other_box.empty()) return;
  const auto reach = static_cast<float>(contact.gap_m) + 1e-5F;
  for (const Pose& b_in_a : scratch.met) {
    contact.ego.region.grow(common(ego_box, wider(carried(b_in_a, other_box), reach)));
    contact.other.region.grow(common(other_box, wider(carried(inverse(b_in_a), ego_box), reach)));
  }
}

}  // namespace crashrank::detail
