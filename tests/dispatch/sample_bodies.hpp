#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace crashrank::test {

/// Uniform in [0, 1), the same with every standard library.
inline double unit(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;
}

inline PoolOptions with_workers(std::uint32_t workers) {
  PoolOptions options;
  options.workers = workers;
  return options;
}

/// A closed, dented hull of about a car's size: 2·rings·segments triangles.
inline TriangleMesh hull(std::uint32_t rings, std::uint32_t segments, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  TriangleMesh mesh;
  const double pi = 3.14159265358979323846;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    const double polar = pi * i / rings;
    for (std::uint32_t j = 0; j < segments; ++j) {
      const double around = 2.0 * pi * j / segments;
      const double dent = 1.0 + 0.05 * unit(random);
      mesh.vertices.emplace_back(
          static_cast<float>(2.2 * dent * std::cos(polar)),
          static_cast<float>(0.9 * dent * std::sin(polar) * std::cos(around)),
          static_cast<float>(0.7 * dent * std::sin(polar) * std::sin(around)));
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      const std::uint32_t here = i * segments + j;
      const std::uint32_t beside = i * segments + (j + 1) % segments;
      mesh.triangles.push_back({here, here + segments, beside});
      mesh.triangles.push_back({beside, here + segments, beside + segments});
    }
  }
  return mesh;
}

/// Front into side, up to `depth_m` deep, at changing places and angles.
inline std::vector<Pose> crash_poses(std::size_t count, double depth_m, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double yaw = 1.2 + 0.7 * unit(random);
    const double x = 2.0 + 0.6 * unit(random);
    const double y = 2.4 - depth_m * unit(random);
    poses.push_back(pose_from_angles({x - 2.0, y, 0.1 * unit(random)}, yaw, 0.05 * unit(random),
                                     0.05 * unit(random)));
  }
  return poses;
}

/// A model and its part indices for the scalar and the fast kernel, which stay where they are.
struct Body {
  explicit Body(const TriangleMesh& mesh)
      : model(std::move(make_model(mesh).value())),
        tree(model.tree),
        index(std::move(PartIndex::make(tree).value())),
        fast_index(std::move(PartIndex::make(model).value())) {}
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() = default;

  Model model;
  const AabbTree& tree;
  PartIndex index;
  PartIndex fast_index;
};

/// The answer that every dispatch has to give.
inline std::vector<Pair> expected_pairs(const Body& a, const Body& b, const Pose& pose) {
  std::vector<Pair> pairs;
  collide(a.tree, b.tree, pose, pairs);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

inline std::vector<DispatchQuery> queries_for(const Body& a, const Body& b,
                                              const std::vector<Pose>& poses,
                                              Kernel kernel = Kernel::scalar) {
  std::vector<DispatchQuery> queries;
  for (const Pose& pose : poses) {
    queries.push_back(kernel == Kernel::fast ? DispatchQuery{&a.fast_index, &b.fast_index, pose}
                                             : DispatchQuery{&a.index, &b.index, pose});
  }
  return queries;
}

}  // namespace crashrank::test
