#include "crashrank/internal/tree/wide_tree.hpp"

#include "crashrank/internal/tree/wide_build.hpp"
#include "crashrank/tree/build.hpp"
#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

namespace crashrank {
namespace {

using Cut = std::vector<std::uint32_t>;

bool is_cluster(const AabbTree& tree, std::uint32_t node) {
  return slots_below(tree, node).count <= wide_lanes;
}

// Every set of at most eight nodes that together hold what is below a node.
std::vector<Cut> cuts(const AabbTree& tree, std::uint32_t node) {
  std::vector<Cut> all{{node}};
  if (is_cluster(tree, node)) return all;
  const std::uint32_t child = tree.nodes[node].first;
  const std::vector<Cut> right = cuts(tree, child + 1);
  for (const Cut& left : cuts(tree, child)) {
    for (const Cut& more : right) {
      if (left.size() + more.size() > wide_lanes) continue;
      all.push_back(left);
      all.back().insert(all.back().end(), more.begin(), more.end());
    }
  }
  return all;
}

// The least sum of surfaces over all ways to collapse what is below a node, found by trying them.
double least_surfaces(const AabbTree& tree, std::uint32_t node) {
  double least = std::numeric_limits<double>::infinity();
  for (const Cut& cut : cuts(tree, node)) {
    if (cut.size() == 1) continue;
    double sum = 0.0;
    for (const std::uint32_t lane : cut) {
      if (!is_cluster(tree, lane)) sum += least_surfaces(tree, lane);
    }
    least = std::min(least, sum);
  }
  return half_area(tree.nodes[node].box) + least;
}

TEST(WideTree, HasTheLeastSurfacesOfAllCollapses) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TriangleMesh mesh = test::triangle_soup(70, 0.2F, seed);
    const AabbTree tree = *build_tree(mesh);
    const WideTree wide = widen(tree);
    double surfaces = 0.0;
    for (const WideNode& node : wide.nodes) {
      const double x = 2.0 * node.own_half[0];
      const double y = 2.0 * node.own_half[1];
      const double z = 2.0 * node.own_half[2];
      surfaces += x * y + y * z + z * x;
    }
    const double least = least_surfaces(tree, 0);
    EXPECT_NEAR(surfaces, least, 1e-5 * least) << "seed " << seed;
  }
}

// A binary node that is not inside a cluster is a run of lanes of one wide node, and those lanes
// hold its triangles and no others.
TEST(WideTree, KeepsEveryBinarySubtreeAddressable) {
  const AabbTree tree = *build_tree(test::triangle_soup(700, 0.1F, 5));
  const WideTree wide = widen(tree);
  std::size_t addressed = 0;
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const WideLanes& lanes = wide.lanes_of[i];
    if (lanes.lanes == 0) continue;
    ++addressed;
    std::vector<std::uint32_t> held;
    std::vector<WideLanes> open{lanes};
    while (!open.empty()) {
      const WideLanes at = open.back();
      open.pop_back();
      const WideNode& node = wide.nodes[at.node];
      ASSERT_EQ(at.lanes & ~node.used_lanes, 0U);
      for (std::size_t lane = 0; lane < wide_lanes; ++lane) {
        if ((at.lanes >> lane & 1U) == 0) continue;
        const std::uint32_t child = node.child[lane];
        if ((node.leaf_lanes >> lane & 1U) == 0) {
          open.push_back({child, wide.nodes[child].used_lanes});
          continue;
        }
        const TriangleCluster& cluster = wide.clusters[cluster_index(child)];
        held.insert(held.end(), cluster.index.begin(), cluster.index.begin() + cluster_size(child));
      }
    }
    const Range slots = slots_below(tree, i);
    std::vector<std::uint32_t> expected(tree.order.begin() + slots.first,
                                        tree.order.begin() + slots.first + slots.count);
    std::sort(held.begin(), held.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(held, expected) << "node " << i;
  }
  EXPECT_GE(addressed, 2 * wide.clusters.size() - 1);
}

template <class T> bool same_bits(const Column<T>& a, const Column<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(WideTree, HasTheSameBitsOnAnyNumberOfThreads) {
  const AabbTree tree = *build_tree(test::triangle_soup(9000, 0.05F, 8));
  const WideTree serial = widen(tree);
  for (const std::uint32_t threads : {2U, 3U, 8U}) {
    const WideTree parallel = widen(tree, threads);
    EXPECT_TRUE(same_bits(serial.nodes, parallel.nodes)) << threads;
    EXPECT_TRUE(same_bits(serial.clusters, parallel.clusters)) << threads;
    EXPECT_TRUE(same_bits(serial.lanes_of, parallel.lanes_of)) << threads;
    EXPECT_EQ(serial.depth, parallel.depth);
  }
}

// Lanes that stay empty are tested all the same.
TEST(WideTree, FillsItsNodes) {
  const WideTree wide = widen(*build_tree(test::triangle_soup(12000, 0.03F, 6)));
  const double lanes = static_cast<double>(wide.nodes.size() - 1 + wide.clusters.size());
  EXPECT_GT(lanes / static_cast<double>(wide.nodes.size()), 5.0);
}

}  // namespace
}  // namespace crashrank
