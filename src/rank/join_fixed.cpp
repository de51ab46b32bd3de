#include "rank/join_fixed.hpp"

#include "rank/adjoin.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace crashrank::detail {
namespace {

/// All triangles of the members, in the body coordinates of the first one.
TriangleMesh common_mesh(const Scene& scene, const std::vector<std::size_t>& members) {
  TriangleMesh mesh;
  const Pose first = scene.actors[members.front()].fixed_pose;
  for (const std::size_t i : members) {
    const TriangleMesh& part = scene.actors[i].model->mesh;
    const Pose to = relative(first, scene.actors[i].fixed_pose);
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

/// Sets of certain fixed bodies that adjoin each other directly or through others and give way
/// alike, found by union-find.
std::vector<std::vector<std::size_t>> adjoining_sets(const Scene& scene,
                                                     const std::vector<Rectangle>& boxes,
                                                     const std::vector<std::size_t>& certain) {
  std::vector<std::size_t> parent(certain.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  for (std::size_t i = 0; i < certain.size(); ++i) {
    for (std::size_t j = i + 1; j < certain.size(); ++j) {
      const std::size_t p = root_of(parent, i);
      const std::size_t q = root_of(parent, j);
      if (p == q ||
          scene.actors[certain[i]].vehicle->deflection !=
              scene.actors[certain[j]].vehicle->deflection ||
          !adjoin(scene.actors[certain[i]], boxes[certain[i]], scene.actors[certain[j]],
                  boxes[certain[j]])) {
        continue;
      }
      parent[std::max(p, q)] = std::min(p, q);
    }
  }
  std::vector<std::vector<std::size_t>> sets(certain.size());
  for (std::size_t i = 0; i < certain.size(); ++i) sets[root_of(parent, i)].push_back(certain[i]);
  return sets;
}

/// Fills `Scene::adjoining`. `fixed` lists all fixed bodies.
void list_adjoining(Scene& scene, const std::vector<Rectangle>& boxes,
                    const std::vector<std::size_t>& fixed) {
  const auto contact_body = [&scene](std::size_t actor) {
    const std::size_t joined = scene.joined_of[actor];
    return joined == Scene::not_joined ? actor : scene.joined[joined].members.front();
  };
  const auto add = [&scene](std::size_t to, std::size_t other) {
    std::vector<std::uint32_t>& list = scene.adjoining[to];
    const auto number = static_cast<std::uint32_t>(other);
    if (std::find(list.begin(), list.end(), number) == list.end()) list.push_back(number);
  };
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    for (std::size_t j = i + 1; j < fixed.size(); ++j) {
      const std::size_t p = fixed[i];
      const std::size_t q = fixed[j];
      if (scene.futures.is_certain(p) && scene.futures.is_certain(q)) continue;
      if (!adjoin(scene.actors[p], boxes[p], scene.actors[q], boxes[q])) continue;
      add(contact_body(p), contact_body(q));
      add(contact_body(q), contact_body(p));
    }
  }
}

}  // namespace

Status join_fixed(Scene& scene) {
  const std::size_t count = scene.actors.size();
  scene.joined.clear();
  scene.joined_of.assign(count, Scene::not_joined);
  scene.adjoining.assign(count, {});
  std::vector<std::size_t> fixed;
  std::vector<std::size_t> certain;
  std::vector<Rectangle> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (scene.actors[i].vehicle->movable()) continue;
    fixed.push_back(i);
    if (scene.futures.is_certain(i)) certain.push_back(i);
    boxes[i] = rectangle_of(scene.actors[i]);
  }
  for (std::vector<std::size_t>& members : adjoining_sets(scene, boxes, certain)) {
    if (members.size() < 2) continue;
    const Vehicle& first = *scene.actors[members.front()].vehicle;
    VehicleFacts facts;
    facts.kind = first.kind;
    facts.surface = first.surface;
    facts.deflection = first.deflection;
    Result<Vehicle> vehicle = describe_vehicle(common_mesh(scene, members), facts);
    if (!vehicle) return vehicle.error();
    vehicle->in_joint = pieces_in_joints(*vehicle->profile);
    for (const std::size_t i : members) scene.joined_of[i] = scene.joined.size();
    scene.joined.push_back({std::move(members), std::move(*vehicle)});
  }
  list_adjoining(scene, boxes, fixed);
  return Success{};
}

}  // namespace crashrank::detail
