// No query allocates once its workspace and buffer have grown: every operator new is counted.

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/make_model.hpp"

#include "counted_allocations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace crashrank {
namespace {

using test::allocations;

// A closed bumpy surface.
TriangleMesh pebble(std::uint32_t across, std::uint32_t along) {
  TriangleMesh mesh;
  constexpr double pi = 3.14159265358979;
  for (std::uint32_t i = 0; i <= across; ++i) {
    for (std::uint32_t j = 0; j < along; ++j) {
      const double polar = pi * i / across;
      const double turn = 2.0 * pi * j / along;
      const double r = 1.0 + 0.05 * std::sin(9.0 * turn) * std::sin(7.0 * polar);
      mesh.vertices.push_back(Eigen::Vector3d(2.0 * r * std::cos(polar),
                                              r * std::sin(polar) * std::cos(turn),
                                              r * std::sin(polar) * std::sin(turn))
                                  .cast<float>());
    }
  }
  for (std::uint32_t i = 0; i < across; ++i) {
    for (std::uint32_t j = 0; j < along; ++j) {
      const std::uint32_t a = i * along + j;
      const std::uint32_t b = i * along + (j + 1) % along;
      mesh.triangles.push_back({a, a + along, b});
      mesh.triangles.push_back({b, a + along, b + along});
    }
  }
  return mesh;
}

struct Counted {
  long allocations = 0;
  std::size_t pairs = 0;
};

template <class Query> Counted count(const Query& query) {
  Counted counted;
  query();  // grows what has to grow
  const long before = allocations.load();
  for (int i = 0; i < 3; ++i) counted.pairs = query();
  counted.allocations = allocations.load() - before;
  return counted;
}

TEST(Allocation, TheCounterCounts) {
  const long before = allocations.load();
  std::vector<int> filled(100);
  ASSERT_EQ(filled.size(), 100U);
  EXPECT_GT(allocations.load(), before);
}

TEST(Allocation, NoWarmQueryAllocates) {
  const Model a = *make_model(pebble(60, 80));
  const Model b = *make_model(pebble(40, 50));
  struct Case {
    const char* name;
    double x_m;
    bool any;
    bool pairs;
  };
  for (const Case& c : {Case{"deep", 3.5, false, true}, Case{"deep, any", 3.5, true, true},
                        Case{"near", 4.2, false, false}, Case{"near, any", 4.2, true, false},
                        Case{"far", 30.0, false, false}, Case{"inside", 0.1, false, true}}) {
    SCOPED_TRACE(c.name);
    const Pose pose = pose_from_angles({c.x_m, 0.1, 0.05}, 0.02, 0.01, 0.03);
    ModelWorkspace workspace;
    std::vector<Pair> pairs;
    const Counted wide =
        count([&] { return collide(a, b, pose, pairs, workspace, {c.any}).pairs; });
    EXPECT_EQ(wide.allocations, 0);
    EXPECT_EQ(wide.pairs != 0, c.pairs);
    const Counted scalar = count(
        [&] { return collide(a.tree, b.tree, pose, pairs, workspace.scalar, {c.any}).pairs; });
    EXPECT_EQ(scalar.allocations, 0);
    EXPECT_EQ(scalar.pairs, wide.pairs);
  }
}

// A workspace prepared for two models serves every query between them.
TEST(Allocation, APreparedWorkspaceAndBufferServeTheFirstQuery) {
  const Model a = *make_model(pebble(60, 80));
  const Model b = *make_model(pebble(40, 50));
  ModelWorkspace workspace;
  workspace.prepare(a, b);
  std::vector<Pair> pairs;
  pairs.reserve(100'000);
  const long before = allocations.load();
  std::size_t found = 0;
  for (int i = 0; i < 50; ++i) {
    const Pose pose = pose_from_angles({0.1 * i, 0.02 * i, 0.01}, 0.05 * i, 0.01 * i, 0.3);
    found += collide(a, b, pose, pairs, workspace).pairs;
    found += collide(b, a, pose, pairs, workspace, {true}).pairs;
  }
  EXPECT_EQ(allocations.load() - before, 0);
  EXPECT_GT(found, 1000U);
}

}  // namespace
}  // namespace crashrank
