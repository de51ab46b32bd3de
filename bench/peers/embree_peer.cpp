#include "crashrank/internal/collide/triangle_test.hpp"
#include "peer.hpp"

#include <embree3/rtcore.h>

#include <cmath>

namespace peers {
namespace {

using crashrank::TriangleD;

struct Scene {
  std::vector<TriangleD> triangles;
  RTCScene scene = nullptr;
  RTCGeometry geometry = nullptr;
};

void bounds_of(const RTCBoundsFunctionArguments* arguments) {
  const TriangleD& t =
      static_cast<const Scene*>(arguments->geometryUserPtr)->triangles[arguments->primID];
  const Eigen::Vector3d low = t.corner[0].cwiseMin(t.corner[1]).cwiseMin(t.corner[2]);
  const Eigen::Vector3d high = t.corner[0].cwiseMax(t.corner[1]).cwiseMax(t.corner[2]);
  const auto down = [](double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) > x ? std::nextafterf(f, -INFINITY) : f;
  };
  RTCBounds& box = *arguments->bounds_o;
  box.lower_x = down(low.x());
  box.lower_y = down(low.y());
  box.lower_z = down(low.z());
  box.upper_x = -down(-high.x());
  box.upper_y = -down(-high.y());
  box.upper_z = -down(-high.z());
}

/// Embree collides the boxes of user geometry whose vertices already are in one frame; the test of
/// two triangles is the caller's, here crashrank's scalar one on the carried corners. B has to be
/// carried, and its tree built, for every pose: that is timed, or left out as a bound.
class Embree final : public Peer {
public:
  explicit Embree(bool baked_beforehand) : baked_beforehand_(baked_beforehand) {}
  ~Embree() override {
    for (Scene* s : {&a_, &b_}) {
      if (s->geometry != nullptr) rtcReleaseGeometry(s->geometry);
      if (s->scene != nullptr) rtcReleaseScene(s->scene);
    }
    if (device_ != nullptr) rtcReleaseDevice(device_);
  }

  std::string name() const override {
    return baked_beforehand_ ? "Embree, query only" : "Embree with bake";
  }
  void prepare(const TriangleMesh& a, const TriangleMesh& b) override {
    device_ = rtcNewDevice("threads=1,set_affinity=0");
    mesh_b_ = &b;
    open(a_, a);
    open(b_, b);
    rtcCommitScene(a_.scene);
  }
  bool bakes() const override { return baked_beforehand_; }
  void bake(const Pose& b_in_a) override {
    if (baked_beforehand_) place(b_in_a);
  }
  std::size_t all(const Pose& b_in_a) override {
    if (!baked_beforehand_) place(b_in_a);
    pairs_.clear();
    rtcCollide(a_.scene, b_.scene, &Embree::found, this);
    return pairs_.size();
  }
  // rtcCollide cannot be stopped.
  bool any(const Pose& b_in_a) override { return all(b_in_a) > 0; }
  bool has_any() const override { return false; }
  void pairs(std::vector<Pair>& out) const override { out = pairs_; }

private:
  void open(Scene& s, const TriangleMesh& mesh) {
    for (std::size_t i = 0; i < mesh.size(); ++i)
      s.triangles.push_back(to_double(mesh.triangle(i)));
    s.scene = rtcNewScene(device_);
    s.geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(s.geometry, static_cast<unsigned>(mesh.size()));
    rtcSetGeometryUserData(s.geometry, &s);
    rtcSetGeometryBoundsFunction(
        s.geometry, [](const RTCBoundsFunctionArguments* arguments) { bounds_of(arguments); },
        nullptr);
    rtcCommitGeometry(s.geometry);
    rtcAttachGeometry(s.scene, s.geometry);
  }

  void place(const Pose& b_in_a) {
    for (std::size_t i = 0; i < mesh_b_->size(); ++i) {
      b_.triangles[i] = carry(b_in_a, mesh_b_->triangle(i));
    }
    rtcCommitGeometry(b_.geometry);
    rtcCommitScene(b_.scene);
  }

  static void found(void* self, RTCCollision* collisions, unsigned count) {
    auto& peer = *static_cast<Embree*>(self);
    for (unsigned i = 0; i < count; ++i) {
      const unsigned a = collisions[i].primID0;
      const unsigned b = collisions[i].primID1;
      if (triangles_intersect(peer.a_.triangles[a], peer.b_.triangles[b])) {
        peer.pairs_.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
      }
    }
  }

  bool baked_beforehand_;
  RTCDevice device_ = nullptr;
  const TriangleMesh* mesh_b_ = nullptr;
  Scene a_;
  Scene b_;
  std::vector<Pair> pairs_;
};

}  // namespace

std::unique_ptr<Peer> make_embree(bool baked_beforehand) {
  return std::make_unique<Embree>(baked_beforehand);
}

}  // namespace peers
