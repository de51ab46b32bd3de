// The vector units that the library is built for.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

#include "crashrank/collide/wide_collide.hpp"

#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/internal/tree/wide_tree.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/tree/build.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace crashrank {
namespace {

class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }
  Eigen::Vector3f point(double size) {
    return {static_cast<float>(uniform(-size, size)), static_cast<float>(uniform(-size, size)),
            static_cast<float>(uniform(-size, size))};
  }
  Pose pose(double reach) {
    return pose_from_angles(
        {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}, uniform(-3, 3),
        uniform(-1, 1), uniform(-1, 1));
  }

private:
  std::mt19937_64 engine_;
};

// Triangles of all sizes around each other, some of them segments, points or copies.
TriangleMesh soup(Random& random, std::size_t count, double size) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const double edge = size * (random.below(20) == 0 ? 0.5 : 0.16);
    const Eigen::Vector3f center = random.point(size);
    std::array<Eigen::Vector3f, 3> corner{center + random.point(edge), center + random.point(edge),
                                          center + random.point(edge)};
    const std::uint64_t kind = random.below(16);
    if (kind == 0) corner[2] = corner[1];
    if (kind == 1) corner[1] = corner[2] = corner[0];
    if (kind == 2) corner[2] = 0.5F * (corner[0] + corner[1]);
    if (kind == 3 && i > 0) corner[0] = mesh.vertices.back();
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3f& point : corner) mesh.vertices.push_back(point);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.parts.push_back({"soup", 0, static_cast<std::uint32_t>(count)});
  return mesh;
}

std::vector<Pair> sorted_pairs(const Model& a, const Model& b, const Pose& pose) {
  std::vector<Pair> pairs;
  ModelWorkspace workspace;
  const CollideResult result = collide(a, b, pose, pairs, workspace);
  EXPECT_EQ(result.pairs, pairs.size());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Every pair of triangles, without any tree.
std::vector<Pair> brute_force(const TriangleMesh& a, const TriangleMesh& b, const Pose& pose) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (triangles_intersect(to_double(a.triangle(i)), carry(pose, b.triangle(j)))) {
        pairs.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
      }
    }
  }
  return pairs;
}

Model model(const TriangleMesh& mesh, const BuildOptions& options = {}) {
  Result<Model> made = make_model(mesh, options);
  EXPECT_TRUE(made.ok());
  return std::move(*made);
}

TEST(WideCollide, EqualsBruteForce) {
  constexpr std::uint64_t seed = 20260110;
  Random random(seed);
  std::size_t found = 0;
  for (int n = 0; n < 150; ++n) {
    const double size = std::ldexp(1.0, static_cast<int>(random.below(40)) - 20);
    const TriangleMesh ma = soup(random, 1 + random.below(300), size);
    const TriangleMesh mb = soup(random, 1 + random.below(300), size);
    const Pose pose = random.below(8) == 0 ? Pose{} : random.pose(size);
    BuildOptions options;
    options.rule = static_cast<SplitRule>(random.below(4));
    options.frame = static_cast<BoxFrame>(random.below(2));
    options.leaf_size = 1 + static_cast<std::uint32_t>(random.below(8));
    const std::vector<Pair> expected = brute_force(ma, mb, pose);
    found += expected.size();
    ASSERT_EQ(sorted_pairs(model(ma, options), model(mb, options), pose), expected)
        << "seed " << seed << " case " << n;
  }
  EXPECT_GT(found, 1000U);
}

TEST(WideCollide, MeetsItselfInTheSamePlace) {
  constexpr std::uint64_t seed = 20260111;
  Random random(seed);
  const TriangleMesh mesh = soup(random, 400, 2.0);  // every triangle coplanar with its own copy
  const Model m = model(mesh);
  EXPECT_EQ(sorted_pairs(m, m, Pose{}), brute_force(mesh, mesh, Pose{}));
}

TEST(WideCollide, FarFromTheOriginAndOutOfFloatRange) {
  constexpr std::uint64_t seed = 20260112;
  Random random(seed);
  for (const double offset : {1e3, 1e6, 1e12}) {
    TriangleMesh ma = soup(random, 200, 1.0);
    const TriangleMesh mb = soup(random, 200, 1.0);
    for (Eigen::Vector3f& v : ma.vertices) v.x() += static_cast<float>(offset);
    Pose pose = random.pose(0.3);
    pose.translation.x() += offset;
    EXPECT_EQ(sorted_pairs(model(ma), model(mb), pose), brute_force(ma, mb, pose)) << offset;
  }
}

// Tiny triangles nearly in one plane, far away along another axis: there boxes are widened by more
// than the triangles measure, and triangles that are apart by as much are tested.
TEST(WideCollide, TinyTrianglesFarAlongOneAxis) {
  constexpr std::uint64_t seed = 20261121;
  Random random(seed);
  std::size_t found = 0;
  for (int n = 0; n < 400; ++n) {
    const auto far = static_cast<float>(std::pow(10.0, random.uniform(3.0, 6.0)));
    const double size = std::pow(10.0, random.uniform(-6.0, -2.0));
    const bool own_coordinates = random.below(2) == 0;
    const auto flat = [&](float x) {
      TriangleMesh mesh;
      for (std::uint32_t i = 0; i < 90; ++i) {
        Eigen::Vector3f corner = random.point(size);
        corner.x() = x;
        if (random.below(4) == 0) corner.x() = std::nextafter(x, 2.0F * far);
        mesh.vertices.push_back(corner);
        if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
      }
      mesh.parts.push_back({"flat", 0, 30});
      return mesh;
    };
    const TriangleMesh ma = flat(far);
    const TriangleMesh mb = flat(own_coordinates ? far : 0.0F);
    Pose pose;
    if (!own_coordinates) pose.translation.x() = far;
    const double slack = 0x1p-23 * far;
    pose.translation.y() = random.uniform(-1.0, 1.0) * (random.below(2) == 0 ? slack : size);
    if (random.below(2) == 0) pose.translation.x() += random.uniform(-1.0, 1.0) * size;
    const std::vector<Pair> expected = brute_force(ma, mb, pose);
    found += expected.size();
    ASSERT_EQ(sorted_pairs(model(ma), model(mb), pose), expected)
        << "seed " << seed << " case " << n;
  }
  EXPECT_GT(found, 1000U);
}

TEST(WideCollide, AnyFindsAPairWhereThereIsOne) {
  constexpr std::uint64_t seed = 20260113;
  Random random(seed);
  int meeting = 0;
  for (int n = 0; n < 200; ++n) {
    const TriangleMesh ma = soup(random, 30, 1.0);
    const TriangleMesh mb = soup(random, 30, 1.0);
    const Pose pose = random.pose(1.0);
    const std::vector<Pair> all = brute_force(ma, mb, pose);
    std::vector<Pair> pairs;
    ModelWorkspace workspace;
    const CollideResult result =
        collide(model(ma), model(mb), pose, pairs, workspace, CollideOptions{true});
    ASSERT_EQ(result.intersecting, !all.empty()) << "seed " << seed << " case " << n;
    ASSERT_EQ(pairs.size(), all.empty() ? 0U : 1U);
    if (!all.empty()) {
      ++meeting;
      EXPECT_TRUE(std::binary_search(all.begin(), all.end(), pairs[0]));
    }
  }
  EXPECT_GT(meeting, 20);
  EXPECT_LT(meeting, 180);
}

// The pairs below all node pairs of one depth are those of the whole, each found once.
TEST(WideCollide, SubtreesAddUp) {
  constexpr std::uint64_t seed = 20260114;
  Random random(seed);
  const Model a = model(soup(random, 700, 1.0));
  const Model b = model(soup(random, 500, 1.0));
  const Pose pose = random.pose(0.2);
  const std::vector<Pair> whole = sorted_pairs(a, b, pose);
  ASSERT_GT(whole.size(), 100U);
  const auto nodes_at = [](const AabbTree& tree, int depth) {
    std::vector<std::uint32_t> level{0};
    for (int d = 0; d < depth; ++d) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t node : level) {
        if (tree.nodes[node].is_leaf()) {
          next.push_back(node);
        } else {
          next.push_back(tree.nodes[node].first);
          next.push_back(tree.nodes[node].first + 1);
        }
      }
      level = next;
    }
    return level;
  };
  ModelWorkspace workspace;
  for (const int depth : {1, 2, 3, 5, 8, 12}) {
    std::vector<Pair> together;
    std::vector<Pair> pairs;
    for (const std::uint32_t na : nodes_at(a.tree, depth)) {
      for (const std::uint32_t nb : nodes_at(b.tree, depth)) {
        collide(a, na, b, nb, pose, pairs, workspace);
        together.insert(together.end(), pairs.begin(), pairs.end());
      }
    }
    std::sort(together.begin(), together.end());
    EXPECT_EQ(together, whole) << "depth " << depth;
  }
}

// The same pairs on every vector unit of this machine and in the scalar engine.
TEST(WideCollide, OneAnswerOnEveryVectorUnit) {
  constexpr std::uint64_t seed = 20260115;
  Random random(seed);
  const Model a = model(soup(random, 900, 1.0));
  const Model b = model(soup(random, 900, 1.0));
  const Pose pose = random.pose(0.2);
  std::vector<Pair> expected;
  collide(a.tree, b.tree, pose, expected);
  std::sort(expected.begin(), expected.end());
  ASSERT_GT(expected.size(), 100U);
  int units = 0;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & (~left + 1));
    hwy::GetChosenTarget().DeInit();
    SCOPED_TRACE(std::string("vector unit ") + vector_unit());
    EXPECT_EQ(sorted_pairs(a, b, pose), expected);
    ++units;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  EXPECT_GE(units, 1);
}

TEST(WideTree, HoldsEveryTriangleOnceAndEnclosesIt) {
  constexpr std::uint64_t seed = 20260116;
  Random random(seed);
  for (const std::size_t count : {1U, 2U, 8U, 9U, 64U, 65U, 1000U}) {
    const TriangleMesh mesh = soup(random, count, 1.0);
    const Model m = model(mesh);
    std::vector<int> seen(count, 0);
    for (const WideNode& node : m.wide.nodes) {
      for (std::size_t lane = 0; lane < wide_lanes; ++lane) {
        if ((node.leaf_lanes >> lane & 1U) == 0) continue;
        const TriangleCluster& cluster = m.wide.clusters[cluster_index(node.child[lane])];
        for (std::size_t i = 0; i < cluster_size(node.child[lane]); ++i) {
          ++seen[cluster.index[i]];
          const Triangle triangle = mesh.triangle(cluster.index[i]);
          for (std::size_t k = 0; k < 9; ++k) {
            const float x = cluster.corner[k][i];
            EXPECT_EQ(x, triangle.corner[k / 3][static_cast<int>(k % 3)]);
            EXPECT_LE(std::abs(static_cast<double>(x) - node.center[k % 3][lane]),
                      static_cast<double>(node.half[k % 3][lane]));
          }
        }
      }
    }
    EXPECT_EQ(seen, std::vector<int>(count, 1));
  }
}

TEST(WideTree, IsLeftOutForTreesThatAreTooDeep) {
  TriangleMesh
      mesh;  // nested triangles, each twice as large: the literal rule peels them one by one
  for (int i = 0; i < 100; ++i) {
    const float s = std::ldexp(1.0F, i);
    mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 0}, {s, 0, 0}, {0, s, 0}});
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.parts.push_back({"nest", 0, 100});
  const Model m = model(mesh, BuildOptions{SplitRule::paper});
  EXPECT_EQ(sorted_pairs(m, m, Pose{}).size(), 100U * 100U);
}

}  // namespace
}  // namespace crashrank
