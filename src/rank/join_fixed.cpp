#include "rank/join_fixed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

constexpr double adjoining_m = 0.05;

/// A body's box seen from above, world axes.
struct Rectangle {
  Vector2d center;
  std::array<Vector2d, 2> axis;  ///< unit
  std::array<double, 2> half;    ///< m
};

Rectangle rectangle_of(const Body& body) {
  const Box box = body.model->mesh.bounds();
  const Pose pose = body.standing;
  const Eigen::Vector3d center = pose.rotation * box.center().cast<double>() + pose.translation;
  const Eigen::Vector3d size = box.extent().cast<double>();
  return {
      center.head<2>(),
      {pose.rotation.col(0).head<2>().normalized(), pose.rotation.col(1).head<2>().normalized()},
      {0.5 * size.x(), 0.5 * size.y()}};
}

double reach_along(const Rectangle& r, const Vector2d& direction) {
  return r.half[0] * std::abs(r.axis[0].dot(direction)) +
         r.half[1] * std::abs(r.axis[1].dot(direction));
}

/// Separating axes of two rectangles.
bool adjoin(const Rectangle& p, const Rectangle& q) {
  for (const Rectangle* r : {&p, &q}) {
    for (const Vector2d& axis : r->axis) {
      const double gap =
          std::abs((q.center - p.center).dot(axis)) - reach_along(p, axis) - reach_along(q, axis);
      if (gap > adjoining_m) return false;
    }
  }
  return true;
}

/// All triangles of the members, in the body coordinates of the first.
TriangleMesh common_mesh(const Scene& scene, const std::vector<std::size_t>& members) {
  TriangleMesh mesh;
  const Pose first = scene.actors[members.front()].standing;
  for (const std::size_t i : members) {
    const TriangleMesh& part = scene.actors[i].model->mesh;
    const Pose to = relative(first, scene.actors[i].standing);
    const auto begin = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3f& vertex : part.vertices) {
      mesh.vertices.push_back(carry(to, vertex).cast<float>());
    }
    for (const auto& [a, b, c] : part.triangles) {
      mesh.triangles.push_back({begin + a, begin + b, begin + c});
    }
  }
  return mesh;
}

std::size_t root_of(std::vector<std::size_t>& parent, std::size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

Status join_fixed(Scene& scene) {
  const std::size_t count = scene.actors.size();
  scene.joined.clear();
  scene.joined_of.assign(count, Scene::alone);
  std::vector<std::size_t> fixed;
  std::vector<Rectangle> rectangles;
  for (std::size_t i = 0; i < count; ++i) {
    if (scene.actors[i].vehicle.movable() || !scene.futures.is_certain(i)) continue;
    fixed.push_back(i);
    rectangles.push_back(rectangle_of(scene.actors[i]));
  }
  std::vector<std::size_t> parent(fixed.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    for (std::size_t j = i + 1; j < fixed.size(); ++j) {
      if (!adjoin(rectangles[i], rectangles[j])) continue;
      const std::size_t p = root_of(parent, i);
      const std::size_t q = root_of(parent, j);
      parent[std::max(p, q)] = std::min(p, q);
    }
  }
  std::vector<std::vector<std::size_t>> sets(fixed.size());
  for (std::size_t i = 0; i < fixed.size(); ++i) sets[root_of(parent, i)].push_back(fixed[i]);
  for (std::vector<std::size_t>& members : sets) {
    if (members.size() < 2) continue;
    const Vehicle& first = scene.actors[members.front()].vehicle;
    VehicleFacts facts;
    facts.kind = first.kind;
    facts.surface = first.surface;
    Result<Vehicle> vehicle = describe_vehicle(common_mesh(scene, members), facts);
    if (!vehicle) return vehicle.error();
    for (const std::size_t i : members) scene.joined_of[i] = scene.joined.size();
    scene.joined.push_back({std::move(members), std::move(*vehicle)});
  }
  return Success{};
}

}  // namespace crashrank::detail
