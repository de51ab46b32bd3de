#include "crashrank/tree/build.hpp"
#include "crashrank/model/make_model.hpp"

#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <string>
#include <vector>

namespace crashrank {
namespace {

std::string describe(const BuildOptions& options) {
  return "rule " + std::to_string(static_cast<int>(options.rule)) + ", frame " +
         std::to_string(static_cast<int>(options.frame)) + ", leaves of " +
         std::to_string(options.leaf_size) + (options.fill_leaves ? ", filled" : "");
}

std::vector<BuildOptions> all_options() {
  std::vector<BuildOptions> all;
  for (const SplitRule rule : test::all_rules) {
    for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
      for (const std::uint32_t leaf : {1U, 2U, 4U, 8U, 255U}) {
        for (const bool fill : {false, true}) {
          BuildOptions options;
          options.rule = rule;
          options.frame = frame;
          options.leaf_size = leaf;
          options.fill_leaves = fill;
          all.push_back(options);
        }
      }
    }
  }
  return all;
}

// Independent of validate(): goes by the node's own ranges and projects in long double.
void expect_boxes_enclose_tightly(const AabbTree& tree) {
  for (std::uint32_t node = 0; node < tree.nodes.size(); ++node) {
    const Range slots = slots_below(tree, node);
    for (int axis = 0; axis < 3; ++axis) {
      long double low = std::numeric_limits<long double>::infinity();
      long double high = -low;
      for (std::uint32_t slot = slots.first; slot < slots.first + slots.count; ++slot) {
        for (const Eigen::Vector3f& corner : tree.triangles[slot].corner) {
          long double p = 0;
          for (int k = 0; k < 3; ++k) {
            p += static_cast<long double>(tree.axes(k, axis)) * static_cast<long double>(corner[k]);
          }
          low = std::min(low, p);
          high = std::max(high, p);
        }
      }
      const Box& box = tree.nodes[node].box;
      ASSERT_LE(box.min[axis], low) << "node " << node;
      ASSERT_GE(box.max[axis], high) << "node " << node;
      const float steps = tree.axes_are_world ? 0.0F : 2.0F;
      const auto step = [](float x) { return std::nextafter(std::abs(x), 1e38F) - std::abs(x); };
      ASSERT_LE(low - box.min[axis], steps * step(box.min[axis])) << "node " << node;
      ASSERT_LE(box.max[axis] - high, steps * step(box.max[axis])) << "node " << node;
    }
  }
}

void expect_ranges_hold(const AabbTree& tree) {
  // What lies below each node, gathered leaf by leaf: a child's index is above its parent's.
  std::vector<std::vector<std::uint32_t>> nodes(tree.nodes.size());
  std::vector<std::vector<std::uint32_t>> slots(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const Node& node = tree.nodes[i];
    if (node.is_leaf()) {
      for (std::uint32_t k = 0; k < node.count; ++k) slots[i].push_back(node.first + k);
      continue;
    }
    ASSERT_EQ(node.first % 2, 1U);
    for (const std::uint32_t child : {node.first, node.first + 1}) {
      nodes[i].push_back(child);
      nodes[i].insert(nodes[i].end(), nodes[child].begin(), nodes[child].end());
      slots[i].insert(slots[i].end(), slots[child].begin(), slots[child].end());
    }
    std::sort(nodes[i].begin(), nodes[i].end());
  }
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const Range range = slots_below(tree, i);
    ASSERT_EQ(range.first, slots[i].front());
    ASSERT_EQ(range.count, slots[i].size());
    const Range below = descendants(tree, i);
    ASSERT_EQ(below.count, nodes[i].size());
    for (std::uint32_t k = 0; k < below.count; ++k) ASSERT_EQ(nodes[i][k], below.first + k);
  }
}

TEST(Build, EveryRuleFrameAndLeafSizeGivesAValidTree) {
  for (const std::size_t n : {1U, 2U, 3U, 5U, 17U, 64U, 300U}) {
    const TriangleMesh mesh = test::triangle_soup(n, 0.2F, n);
    for (const BuildOptions& options : all_options()) {
      SCOPED_TRACE(std::to_string(n) + " triangles, " + describe(options));
      const Result<AabbTree> tree = build_tree(mesh, options);
      ASSERT_TRUE(tree.ok()) << tree.error().message();
      const Status status = validate(*tree, mesh);
      ASSERT_TRUE(status.ok()) << status.error().message();
      expect_boxes_enclose_tightly(*tree);
      expect_ranges_hold(*tree);
      const std::uint32_t most = options.rule == SplitRule::paper ? 1 : options.leaf_size;
      for (const Node& node : tree->nodes) ASSERT_LE(node.count, most);
      Column<std::uint32_t> order = tree->order;
      std::sort(order.begin(), order.end());
      for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(order[i], i);
    }
  }
}

TEST(Build, FilledLeavesAreNeverSplitFurther) {
  const TriangleMesh mesh = test::triangle_soup(500, 0.05F, 5);
  for (const SplitRule rule : {SplitRule::min_relative_segment, SplitRule::sah}) {
    BuildOptions options;
    options.rule = rule;
    options.fill_leaves = true;
    const Result<AabbTree> filled = build_tree(mesh, options);
    ASSERT_TRUE(filled.ok());
    for (std::uint32_t i = 0; i < filled->nodes.size(); ++i) {
      if (!filled->nodes[i].is_leaf()) {
        EXPECT_GT(slots_below(*filled, i).count, options.leaf_size);
      }
    }
    options.fill_leaves = false;
    const Result<AabbTree> chosen = build_tree(mesh, options);
    ASSERT_TRUE(chosen.ok());
    EXPECT_GT(chosen->nodes.size(), filled->nodes.size());
  }
}

void expect_same_bits(const AabbTree& a, const AabbTree& b) {
  ASSERT_EQ(a.order, b.order);
  ASSERT_EQ(a.depth, b.depth);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  ASSERT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(Node)), 0);
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  ASSERT_EQ(
      std::memcmp(a.triangles.data(), b.triangles.data(), a.triangles.size() * sizeof(Triangle)),
      0);
}

TEST(Build, GivesTheSameBitsTwice) {
  const TriangleMesh mesh = test::triangle_soup(700, 0.1F, 21);
  for (const BuildOptions& options : all_options()) {
    SCOPED_TRACE(describe(options));
    const Result<AabbTree> a = build_tree(mesh, options);
    const Result<AabbTree> b = build_tree(mesh, options);
    ASSERT_TRUE(a.ok() && b.ok());
    expect_same_bits(*a, *b);
  }
}

TEST(Build, GivesTheSameBitsOnAnyNumberOfThreads) {
  TriangleMesh equal;
  for (int i = 0; i < 9000; ++i) test::add_triangle(equal, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const TriangleMesh& mesh : {test::triangle_soup(30000, 0.02F, 23), test::strip(20000), equal,
                                   test::triangle_soup(5, 0.1F, 24)}) {
    for (const SplitRule rule : test::all_rules) {
      if (rule == SplitRule::paper && mesh.size() > 10) continue;  // slow, and always serial
      BuildOptions options;
      options.rule = rule;
      SCOPED_TRACE(std::to_string(mesh.size()) + " triangles, " + describe(options));
      const Result<AabbTree> serial = build_tree(mesh, options);
      ASSERT_TRUE(serial.ok());
      ASSERT_TRUE(validate(*serial, mesh).ok());
      for (const std::uint32_t threads : {2U, 3U, 8U}) {
        options.threads = threads;
        const Result<AabbTree> parallel = build_tree(mesh, options);
        ASSERT_TRUE(parallel.ok());
        expect_same_bits(*serial, *parallel);
      }
    }
  }
}

TEST(Build, ThreadsPassOnWhatOneOfThemThrows) {
  const auto work = [](std::uint32_t index) {
    if (index == 0) throw std::bad_alloc();
  };
  EXPECT_THROW(detail::on_threads(3, work), std::bad_alloc);
}

// Sum of the surfaces of inner nodes, what reinsertion brings down.
double inner_surface(const AabbTree& tree) {
  double sum = 0.0;
  for (const Node& node : tree.nodes) {
    if (!node.is_leaf()) sum += static_cast<double>(half_area(node.box));
  }
  return sum;
}

TEST(Build, ReinsertionKeepsTheTreeValidAndMakesBoxesSmaller) {
  for (const std::size_t n : {1U, 2U, 3U, 4U, 9U, 600U}) {
    const TriangleMesh mesh = test::triangle_soup(n, 0.1F, 22);
    for (BuildOptions options : all_options()) {
      if (options.leaf_size > 4) continue;
      SCOPED_TRACE(std::to_string(n) + " triangles, " + describe(options));
      const Result<AabbTree> before = build_tree(mesh, options);
      options.reinsertion_passes = 3;
      const Result<AabbTree> after = build_tree(mesh, options);
      ASSERT_TRUE(before.ok() && after.ok());
      const Status status = validate(*after, mesh);
      ASSERT_TRUE(status.ok()) << status.error().message();
      ASSERT_EQ(after->nodes.size(), before->nodes.size());
      ASSERT_LE(inner_surface(*after), inner_surface(*before) * (1 + 1e-6));
      if (n == 600) {
        // The literal rule leaves much to be mended, the others a little.
        const double most = options.rule == SplitRule::paper ? 0.8 : 0.999;
        ASSERT_LT(inner_surface(*after), most * inner_surface(*before));
      }
    }
  }
}

TEST(Build, RefusesWhatHasNoTree) {
  const auto code = [](const TriangleMesh& mesh, std::uint32_t leaf = 4) {
    BuildOptions options;
    options.leaf_size = leaf;
    const Result<AabbTree> tree = build_tree(mesh, options);
    return tree.ok() ? ErrorCode::internal : tree.error().code;
  };
  const TriangleMesh good = test::triangle_soup(3, 0.1F, 1);
  EXPECT_EQ(code(TriangleMesh{}), ErrorCode::bad_input);
  EXPECT_EQ(code(good, 0), ErrorCode::usage);
  EXPECT_EQ(code(good, 256), ErrorCode::usage);
  BuildOptions threads;
  threads.threads = 0;
  EXPECT_EQ(build_tree(good, threads).error().code, ErrorCode::usage);
  threads.threads = 257;
  EXPECT_EQ(build_tree(good, threads).error().code, ErrorCode::usage);
  TriangleMesh mesh = good;
  mesh.triangles[1][2] = 9;
  EXPECT_EQ(code(mesh), ErrorCode::bad_input);
  mesh = good;
  mesh.vertices[4].y() = NAN;
  EXPECT_EQ(code(mesh), ErrorCode::bad_input);
  mesh.vertices[4].y() = INFINITY;
  EXPECT_EQ(code(mesh), ErrorCode::bad_input);
}

TEST(Build, NamesTheTriangleAndTheVertexItRefuses) {
  TriangleMesh mesh = test::triangle_soup(3, 0.1F, 1);
  mesh.triangles[2][0] = 77;
  EXPECT_EQ(build_tree(mesh).error().message(),
            "triangle 2: vertex 77 does not exist (the mesh has 9)");
  mesh.triangles[2][0] = 0;
  mesh.vertices[8].z() = NAN;
  EXPECT_EQ(build_tree(mesh).error().place, "vertex 8");
}

}  // namespace
}  // namespace crashrank
