#include "peer.hpp"

#include <ode/ode.h>

#include <cstdarg>

namespace peers {
namespace {

struct Geometry {
  std::vector<float> vertices;
  std::vector<dTriIndex> indices;
  dTriMeshDataID data = nullptr;
  dGeomID geometry = nullptr;

  explicit Geometry(const TriangleMesh& mesh) {
    for (const Eigen::Vector3f& v : mesh.vertices) {
      vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
    }
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t index : t) indices.push_back(static_cast<dTriIndex>(index));
    }
    data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data, vertices.data(), static_cast<int>(3 * sizeof(float)),
                                static_cast<int>(mesh.vertices.size()), indices.data(),
                                static_cast<int>(indices.size()),
                                static_cast<int>(3 * sizeof(dTriIndex)));
    geometry = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
  }
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;
  ~Geometry() {
    dGeomDestroy(geometry);
    dGeomTriMeshDataDestroy(data);
  }
};

// ODE says for every query that its table of contacts is crowded; printing would be timed with it.
void keep_quiet(int /*number*/, const char* /*message*/, va_list /*arguments*/) {}

/// OPCODE through dCollide: contact points, each with the triangles it came from.
class Ode final : public Peer {
public:
  Ode() : contacts_(most_contacts) {
    dInitODE2(0);
    dSetMessageHandler(keep_quiet);
    dAllocateODEDataForThread(dAllocateMaskAll);
  }
  ~Ode() override {
    a_.reset();
    b_.reset();
    dCloseODE();
  }

  std::string name() const override { return "ODE OPCODE"; }
  void prepare(const TriangleMesh& a, const TriangleMesh& b) override {
    a_ = std::make_unique<Geometry>(a);
    b_ = std::make_unique<Geometry>(b);
  }
  std::size_t all(const Pose& b_in_a) override {
    count_ = run(b_in_a, most_contacts);
    return static_cast<std::size_t>(count_);
  }
  bool any(const Pose& b_in_a) override {
    return run(b_in_a, static_cast<int>(1U | CONTACTS_UNIMPORTANT)) > 0;
  }
  void pairs(std::vector<Pair>& out) const override {
    out.clear();
    for (int i = 0; i < count_; ++i) {
      const dContactGeom& contact = contacts_[static_cast<std::size_t>(i)];
      const bool swapped = contact.g1 == b_->geometry;
      out.push_back(
          {swapped ? contact.side2 : contact.side1, swapped ? contact.side1 : contact.side2});
    }
  }

private:
  static constexpr int most_contacts = 0xffff;

  int run(const Pose& b_in_a, int flags) {
    const Eigen::Matrix3d& r = b_in_a.rotation;
    const Eigen::Vector3d& t = b_in_a.translation;
    dMatrix3 rotation{};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) rotation[4 * i + j] = static_cast<dReal>(r(i, j));
    }
    dGeomSetRotation(b_->geometry, rotation);
    dGeomSetPosition(b_->geometry, static_cast<dReal>(t.x()), static_cast<dReal>(t.y()),
                     static_cast<dReal>(t.z()));
    return dCollide(a_->geometry, b_->geometry, flags, contacts_.data(),
                    static_cast<int>(sizeof(dContactGeom)));
  }

  std::unique_ptr<Geometry> a_;
  std::unique_ptr<Geometry> b_;
  std::vector<dContactGeom> contacts_;
  int count_ = 0;
};

}  // namespace

std::unique_ptr<Peer> make_ode() { return std::make_unique<Ode>(); }

}  // namespace peers
