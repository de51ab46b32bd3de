#include "crash_test_prism.hpp"

namespace crashrank::cli {

using Eigen::Vector2d;
using Eigen::Vector3d;

TriangleMesh prism(const Outline& outline, double low, double high) {
  TriangleMesh mesh;
  const auto count = static_cast<std::uint32_t>(outline.size());
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : outline) middle += p / static_cast<double>(count);
  for (const double z : {low, high}) {
    for (const Vector2d& p : outline) {
      mesh.vertices.emplace_back(Vector3d(p.x(), p.y(), z).cast<float>());
    }
  }
  for (const double z : {low, high}) {
    mesh.vertices.emplace_back(Vector3d(middle.x(), middle.y(), z).cast<float>());
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = (i + 1) % count;
    mesh.triangles.push_back({i, j, count + j});
    mesh.triangles.push_back({i, count + j, count + i});
    mesh.triangles.push_back({2 * count, j, i});
    mesh.triangles.push_back({2 * count + 1, count + i, count + j});
  }
  return mesh;
}

TriangleMesh box_prism(const Vector3d& least, const Vector3d& greatest) {
  return prism({{greatest.x(), least.y()},
                {greatest.x(), greatest.y()},
                {least.x(), greatest.y()},
                {least.x(), least.y()}},
               least.z(), greatest.z());
}

}  // namespace crashrank::cli
