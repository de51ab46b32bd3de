#pragma once

#include "peer.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>

#include <limits>
#include <utility>

namespace peers {

/// FCL's OBBRSS trees in double, contact limit out of the way. Compiled twice: against Debian's
/// library, and in a shared object of its own with every template instantiated for this processor.
/// Goes through the traversal that fcl::collide chooses for two OBBRSS models, so that both builds
/// run the same code.
class FclPeer final : public Peer {
public:
  explicit FclPeer(std::string name) : name_(std::move(name)) {}

  std::string name() const override { return name_; }
  void prepare(const TriangleMesh& a, const TriangleMesh& b) override {
    a_ = model_of(a);
    b_ = &a == &b ? a_ : model_of(b);
  }
  std::size_t all(const Pose& b_in_a) override {
    run(b_in_a, std::numeric_limits<std::size_t>::max());
    return result_.numContacts();
  }
  bool any(const Pose& b_in_a) override {
    run(b_in_a, 1);
    return result_.isCollision();
  }
  void pairs(std::vector<Pair>& out) const override {
    out.clear();
    for (std::size_t i = 0; i < result_.numContacts(); ++i) {
      const fcl::Contactd& contact = result_.getContact(i);
      out.push_back({static_cast<std::int32_t>(contact.b1), static_cast<std::int32_t>(contact.b2)});
    }
  }

private:
  using Model = fcl::BVHModel<fcl::OBBRSSd>;

  static std::shared_ptr<Model> model_of(const TriangleMesh& mesh) {
    std::vector<fcl::Vector3d> vertices;
    for (const Eigen::Vector3f& v : mesh.vertices) vertices.emplace_back(v.cast<double>());
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    auto model = std::make_shared<Model>();
    model->beginModel();
    model->addSubModel(vertices, triangles);
    model->endModel();
    return model;
  }

  void run(const Pose& b_in_a, std::size_t limit) {
    fcl::Transform3d placed = fcl::Transform3d::Identity();
    placed.linear() = b_in_a.rotation;
    placed.translation() = b_in_a.translation;
    const fcl::CollisionRequestd request(limit, false);
    result_.clear();
    fcl::detail::MeshCollisionTraversalNodeOBBRSSd node;
    initialize(node, *a_, fcl::Transform3d::Identity(), *b_, placed, request, result_);
    fcl::detail::collide(&node);
  }

  std::string name_;
  std::shared_ptr<Model> a_;
  std::shared_ptr<Model> b_;
  fcl::CollisionResultd result_;
};

}  // namespace peers
