#include "peer.hpp"

#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

namespace peers {
namespace {

/// A mesh in a GImpact shape: 16-bit quantised box tree, single precision, margin 0.
struct Shape {
  std::vector<btScalar> vertices;
  std::vector<int> indices;
  std::unique_ptr<btTriangleIndexVertexArray> array;
  std::unique_ptr<btGImpactMeshShape> shape;

  explicit Shape(const TriangleMesh& mesh) {
    for (const Eigen::Vector3f& v : mesh.vertices) {
      vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
    }
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t index : t) indices.push_back(static_cast<int>(index));
    }
    array = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.size()), indices.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh.vertices.size()), vertices.data(),
        static_cast<int>(3 * sizeof(btScalar)));
    shape = std::make_unique<btGImpactMeshShape>(array.get());
    shape->setMargin(0);
    shape->updateBound();
  }
  const btGImpactMeshShapePart& part() const { return *shape->getMeshPart(0); }
};

/// GImpact's own way: pairs of leaf boxes from two trees, then its triangle clipping on each.
class Bullet final : public Peer {
public:
  std::string name() const override { return "Bullet GImpact"; }
  void prepare(const TriangleMesh& a, const TriangleMesh& b) override {
    a_ = std::make_unique<Shape>(a);
    b_ = std::make_unique<Shape>(b);
    a_->part().lockChildShapes();
    b_->part().lockChildShapes();
  }
  ~Bullet() override {
    if (a_) a_->part().unlockChildShapes();
    if (b_) b_->part().unlockChildShapes();
  }
  std::size_t all(const Pose& b_in_a) override {
    find(b_in_a, false);
    return pairs_.size();
  }
  bool any(const Pose& b_in_a) override {
    find(b_in_a, true);
    return !pairs_.empty();
  }
  void pairs(std::vector<Pair>& out) const override { out = pairs_; }

private:
  void find(const Pose& b_in_a, bool first_only) {
    const Eigen::Matrix3f r = b_in_a.rotation.cast<float>();
    const Eigen::Vector3f t = b_in_a.translation.cast<float>();
    const btTransform at_a = btTransform::getIdentity();
    const btTransform at_b(btMatrix3x3(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2),
                                       r(2, 0), r(2, 1), r(2, 2)),
                           btVector3(t.x(), t.y(), t.z()));
    boxes_.clear();
    btGImpactBoxSet::find_collision(a_->part().getBoxSet(), at_a, b_->part().getBoxSet(), at_b,
                                    boxes_);
    pairs_.clear();
    for (int i = 0; i < boxes_.size(); ++i) {
      const GIM_PAIR& pair = boxes_[i];
      btPrimitiveTriangle ta;
      btPrimitiveTriangle tb;
      a_->part().getPrimitiveTriangle(pair.m_index1, ta);
      b_->part().getPrimitiveTriangle(pair.m_index2, tb);
      ta.applyTransform(at_a);
      tb.applyTransform(at_b);
      ta.buildTriPlane();
      tb.buildTriPlane();
      if (!ta.overlap_test_conservative(tb)) continue;
      GIM_TRIANGLE_CONTACT contact;
      if (!ta.find_triangle_collision_clip_method(tb, contact)) continue;
      pairs_.push_back({pair.m_index1, pair.m_index2});
      if (first_only) return;
    }
  }

  std::unique_ptr<Shape> a_;
  std::unique_ptr<Shape> b_;
  btPairSet boxes_;
  std::vector<Pair> pairs_;
};

}  // namespace

std::unique_ptr<Peer> make_bullet() { return std::make_unique<Bullet>(); }

}  // namespace peers
