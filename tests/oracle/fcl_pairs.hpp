#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <memory>
#include <vector>

namespace oracle {

/// A mesh in FCL's OBBRSS tree, double precision, the same float vertices.
class FclMesh {
public:
  explicit FclMesh(const crashrank::TriangleMesh& mesh);
  ~FclMesh();
  FclMesh(const FclMesh&) = delete;
  FclMesh& operator=(const FclMesh&) = delete;

  /// Pairs that FCL finds with `other` at a pose in this mesh's frame: contact limit out of the
  /// way, each pair once, sorted. FCL decides in floating point: right but for near-touching pairs.
  std::vector<crashrank::Pair> pairs(const FclMesh& other, const crashrank::Pose& pose) const;

private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace oracle
