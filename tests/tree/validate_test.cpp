#include "crashrank/model/make_model.hpp"
#include "crashrank/tree/build.hpp"

#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

std::uint32_t some_inner(const AabbTree& tree) {
  std::uint32_t node = 1;
  while (tree.nodes[node].is_leaf()) ++node;
  return node;
}

std::uint32_t some_leaf(const AabbTree& tree) {
  std::uint32_t node = 1;
  while (!tree.nodes[node].is_leaf() || tree.nodes[node].count < 2) ++node;
  return node;
}

using Corruption = std::function<void(AabbTree&)>;

std::vector<std::pair<std::string, Corruption>> corruptions() {
  const float inf = std::numeric_limits<float>::infinity();
  return {
      {"no nodes", [](AabbTree& t) { t.nodes.clear(); }},
      {"too many nodes", [](AabbTree& t) { t.nodes.resize(2 * t.order.size(), t.nodes.back()); }},
      {"a node too few", [](AabbTree& t) { t.nodes.pop_back(); }},
      {"a pair no node leads to",
       [](AabbTree& t) {
         t.nodes.push_back(t.nodes.back());
         t.nodes.push_back(t.nodes.back());
       }},
      {"a cycle", [](AabbTree& t) { t.nodes[some_inner(t)].first = 1; }},
      {"a child out of range", [](AabbTree& t) { t.nodes[some_inner(t)].first = 0xffffffff; }},
      {"children swapped for a cousin's",
       [](AabbTree& t) {
         const std::uint32_t a = t.nodes[0].first;
         std::swap(t.nodes[a].first, t.nodes[a + 1].first);
       }},
      {"a leaf that begins late", [](AabbTree& t) { ++t.nodes[some_leaf(t)].first; }},
      {"a leaf a triangle short", [](AabbTree& t) { --t.nodes[some_leaf(t)].count; }},
      {"a leaf beyond the slots", [](AabbTree& t) { t.nodes[some_leaf(t)].count = 0xffffffff; }},
      {"the last leaf a triangle long", [](AabbTree& t) { ++t.nodes.back().count; }},
      {"a leaf that claims to be inner", [](AabbTree& t) { t.nodes[some_leaf(t)].count = 0; }},
      {"a box pulled in by one step",
       [](AabbTree& t) {
         float& side = t.nodes[some_leaf(t)].box.max.x();
         side = std::nextafter(side, -1e30F);
       }},
      {"a box out of its parent's",
       [](AabbTree& t) { t.nodes[some_inner(t)].box.min.z() -= 9.0F; }},
      {"a box without a number", [](AabbTree& t) { t.nodes[some_leaf(t)].box.min.y() = NAN; }},
      {"an infinite root", [inf](AabbTree& t) { t.nodes[0].box.max.x() = inf; }},
      {"an empty box", [](AabbTree& t) { t.nodes[some_leaf(t)].box = Box{}; }},
      {"a triangle twice", [](AabbTree& t) { t.order[3] = t.order[4]; }},
      {"a triangle that does not exist",
       [](AabbTree& t) { t.order[3] = static_cast<std::uint32_t>(t.order.size()); }},
      {"order too short", [](AabbTree& t) { t.order.pop_back(); }},
      {"triangles too long", [](AabbTree& t) { t.triangles.push_back(t.triangles[0]); }},
      {"a corner moved by one step",
       [](AabbTree& t) {
         float& x = t.triangles[5].corner[1].x();
         x = std::nextafter(x, 0.5F);
       }},
      {"two triangles swapped in one leaf's slots",
       [](AabbTree& t) {
         const std::uint32_t slot = t.nodes[some_leaf(t)].first;
         std::swap(t.triangles[slot], t.triangles[slot + 1]);
       }},
      {"a depth too small", [](AabbTree& t) { --t.depth; }},
      {"a depth too large", [](AabbTree& t) { ++t.depth; }},
      {"axes that stretch", [](AabbTree& t) { t.axes(0, 0) += 1e-6; }},
      {"axes without a number", [](AabbTree& t) { t.axes(1, 2) = NAN; }},
      {"a wrong mark for world axes", [](AabbTree& t) { t.axes_are_world = !t.axes_are_world; }},
  };
}

TEST(Validate, CatchesEveryPlantedCorruption) {
  const TriangleMesh mesh = test::triangle_soup(100, 0.2F, 11);
  for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
    BuildOptions options;
    options.frame = frame;
    options.fill_leaves = true;
    const Result<AabbTree> tree = build_tree(mesh, options);
    ASSERT_TRUE(tree.ok());
    ASSERT_TRUE(validate(*tree, mesh).ok());
    for (const auto& [name, corrupt] : corruptions()) {
      AabbTree broken = *tree;
      corrupt(broken);
      const Status status = validate(broken, mesh);
      EXPECT_FALSE(status.ok()) << name;
      if (!status.ok()) {
        EXPECT_EQ(status.error().code, ErrorCode::bad_input);
      }
    }
  }
}

TEST(Validate, CatchesATreeOfAnotherMesh) {
  const TriangleMesh mesh = test::triangle_soup(50, 0.2F, 12);
  const Result<AabbTree> tree = build_tree(mesh);
  ASSERT_TRUE(tree.ok());
  TriangleMesh moved = mesh;
  moved.vertices[7].z() += 0.25F;
  EXPECT_FALSE(validate(*tree, moved).ok());
  moved = mesh;
  moved.triangles[9][0] = 1000;
  EXPECT_FALSE(validate(*tree, moved).ok());
  EXPECT_FALSE(validate(*tree, test::triangle_soup(49, 0.2F, 12)).ok());
  EXPECT_FALSE(validate(AabbTree{}, mesh).ok());
  EXPECT_FALSE(validate(*tree, TriangleMesh{}).ok());
}

// Content from a stranger's file: whatever bits the nodes hold, the walk ends and says no.
TEST(Validate, IsSafeOnRandomBits) {
  const TriangleMesh mesh = test::triangle_soup(60, 0.2F, 13);
  const Result<AabbTree> tree = build_tree(mesh);
  ASSERT_TRUE(tree.ok());
  std::mt19937_64 random(14);
  for (int round = 0; round < 2000; ++round) {
    AabbTree broken = *tree;
    Node& node = broken.nodes[random() % broken.nodes.size()];
    const auto small = static_cast<std::uint32_t>(random() % 70);
    const auto wild = static_cast<std::uint32_t>(random());
    const std::uint32_t value = random() % 2 == 0 ? small : wild;
    std::uint32_t& field = random() % 2 == 0 ? node.first : node.count;
    if (field == value) continue;
    field = value;
    ASSERT_FALSE(validate(broken, mesh).ok()) << "round " << round;
  }
}

}  // namespace
}  // namespace crashrank
