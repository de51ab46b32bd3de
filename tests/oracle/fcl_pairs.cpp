#include "oracle/fcl_pairs.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <limits>

namespace oracle {

struct FclMesh::Model : fcl::BVHModel<fcl::OBBRSSd> {};

FclMesh::FclMesh(const crashrank::TriangleMesh& mesh) : model_(std::make_unique<Model>()) {
  std::vector<fcl::Vector3d> vertices;
  for (const Eigen::Vector3f& v : mesh.vertices) vertices.emplace_back(v.cast<double>());
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model_->beginModel();
  model_->addSubModel(vertices, triangles);
  model_->endModel();
}

FclMesh::~FclMesh() = default;

std::vector<crashrank::Pair> FclMesh::pairs(const FclMesh& other,
                                            const crashrank::Pose& pose) const {
  fcl::Transform3d b_in_a = fcl::Transform3d::Identity();
  b_in_a.linear() = pose.rotation;
  b_in_a.translation() = pose.translation;
  const fcl::CollisionRequestd request(std::numeric_limits<std::size_t>::max(), false);
  fcl::CollisionResultd result;
  fcl::collide<double>(model_.get(), fcl::Transform3d::Identity(), other.model_.get(), b_in_a,
                       request, result);
  std::vector<crashrank::Pair> pairs;
  pairs.reserve(result.numContacts());
  for (std::size_t i = 0; i < result.numContacts(); ++i) {
    const fcl::Contactd& contact = result.getContact(i);
    pairs.push_back({static_cast<std::int32_t>(contact.b1), static_cast<std::int32_t>(contact.b2)});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace oracle
