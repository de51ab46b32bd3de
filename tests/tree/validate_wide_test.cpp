#include "crashrank/tree/build.hpp"

#include "crashrank/model/make_model.hpp"

#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using WideCorruption = std::function<void(WideTree&)>;

WideNode& root(WideTree& wide) { return wide.nodes[0]; }

// A lane of the root that leads to a node, or to a cluster.
std::size_t lane(const WideTree& wide, bool leaf) {
  const WideNode& node = wide.nodes[0];
  std::size_t i = 0;
  while (((node.child[i] & wide_leaf_bit) != 0) != leaf) ++i;
  return i;
}

std::size_t inner(WideTree& wide) { return lane(wide, false); }

WideNode& with_empty_lane(WideTree& wide) {
  for (WideNode& node : wide.nodes) {
    if (node.used_lanes != 0xff) return node;
  }
  throw std::logic_error("every lane is used: take another sample");
}

std::size_t binary_with_lanes(const WideTree& wide, bool several) {
  std::size_t i = 1;
  const auto has_several = [](std::uint32_t lanes) { return (lanes & (lanes - 1)) != 0; };
  while (wide.lanes_of[i].lanes == 0 || has_several(wide.lanes_of[i].lanes) != several) ++i;
  return i;
}

std::vector<std::pair<std::string, WideCorruption>> wide_corruptions() {
  return {
      {"no nodes", [](WideTree& w) { w.nodes.clear(); }},
      {"no clusters", [](WideTree& w) { w.clusters.clear(); }},
      {"no table of lanes", [](WideTree& w) { w.lanes_of.clear(); }},
      {"a node too many", [](WideTree& w) { w.nodes.push_back(WideNode(root(w))); }},
      {"a cluster too many",
       [](WideTree& w) { w.clusters.push_back(TriangleCluster(w.clusters[0])); }},
      {"a node too few", [](WideTree& w) { w.nodes.pop_back(); }},
      {"a cluster too few", [](WideTree& w) { w.clusters.pop_back(); }},
      {"a cycle", [](WideTree& w) { root(w).child[inner(w)] = 0; }},
      {"a child out of range", [](WideTree& w) { root(w).child[inner(w)] = 0x7fffffff; }},
      {"a cluster out of range",
       [](WideTree& w) {
         WideNode& last = w.nodes.back();
         last.child[0] |= max_clusters - 1;
       }},
      {"a smaller cluster",
       [](WideTree& w) {
         for (std::uint32_t& child : w.nodes.back().child) {
           if (cluster_size(child) > 1 && (child & wide_leaf_bit) != 0) {
             child -= 1U << 28U;
             return;
           }
         }
       }},
      {"a leaf that is none", [](WideTree& w) { root(w).leaf_lanes ^= 1U << inner(w); }},
      {"a lane that is not used", [](WideTree& w) { root(w).used_lanes &= ~1U; }},
      {"a lane too many",
       [](WideTree& w) { with_empty_lane(w).used_lanes |= with_empty_lane(w).used_lanes + 1; }},
      {"an empty lane with a box", [](WideTree& w) { with_empty_lane(w).half[1][7] = 1.0F; }},
      {"an empty lane without a number",
       [](WideTree& w) { with_empty_lane(w).center[2][7] = NAN; }},
      {"an empty lane with a child", [](WideTree& w) { with_empty_lane(w).child[7] = 1; }},
      {"a box pulled in by one step",
       [](WideTree& w) {
         float& half = root(w).half[0][inner(w)];
         half = std::nextafter(half, 0.0F);
       }},
      {"a box moved by one step",
       [](WideTree& w) {
         float& center = w.nodes.back().center[1][0];
         center = std::nextafter(center, 1e30F);
       }},
      {"a box without a number", [](WideTree& w) { root(w).half[2][0] = NAN; }},
      {"a centre without a number", [](WideTree& w) { root(w).center[2][0] = NAN; }},
      {"an infinite box", [](WideTree& w) { root(w).half[2][0] = INFINITY; }},
      {"a box that overflows", [](WideTree& w) { root(w).half[2][0] = 3e38F; }},
      {"a box turned inside out", [](WideTree& w) { root(w).half[2][0] *= -1.0F; }},
      {"the box around all pulled in", [](WideTree& w) { root(w).own_half[0] *= 0.999F; }},
      {"the box around a node pulled in",
       [](WideTree& w) { w.nodes.back().own_half[1] *= 0.999F; }},
      {"a corner moved by one step",
       [](WideTree& w) {
         float& x = w.clusters[1].corner[4][0];
         x = std::nextafter(x, 9.0F);
       }},
      {"a corner behind a cluster's end moved",
       [](WideTree& w) {
         float& x = w.clusters[0].corner[3][7];
         x = std::nextafter(x, 9.0F);
       }},
      {"another triangle's number", [](WideTree& w) { w.clusters[0].index[0] ^= 1U; }},
      {"two clusters exchanged",
       [](WideTree& w) {
         TriangleCluster* const clusters = w.clusters.data();
         std::swap(clusters[0], clusters[1]);
       }},
      {"two lanes exchanged",
       [](WideTree& w) {
         WideNode& node = root(w);
         std::swap(node.child[0], node.child[1]);
         for (std::size_t d = 0; d < 3; ++d) {
           std::swap(node.center[d][0], node.center[d][1]);
           std::swap(node.half[d][0], node.half[d][1]);
         }
       }},
      {"lanes of another node",
       [](WideTree& w) { w.lanes_of[binary_with_lanes(w, true)].node ^= 1U; }},
      {"a lane left out",
       [](WideTree& w) {
         std::uint32_t& lanes = w.lanes_of[binary_with_lanes(w, true)].lanes;
         lanes &= lanes - 1;
       }},
      {"a lane that does not exist",
       [](WideTree& w) { w.lanes_of[binary_with_lanes(w, false)].lanes = 1U << 9U; }},
      {"a node that does not exist",
       [](WideTree& w) { w.lanes_of[binary_with_lanes(w, false)].node = 0xffffffff; }},
      {"a lane whose node says nothing",
       [](WideTree& w) { w.lanes_of[binary_with_lanes(w, false)] = {}; }},
      {"a depth too small", [](WideTree& w) { --w.depth; }},
      {"a depth too large", [](WideTree& w) { ++w.depth; }},
  };
}

TEST(ValidateWide, CatchesEveryPlantedCorruption) {
  const TriangleMesh mesh = test::triangle_soup(300, 0.2F, 21);
  for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
    BuildOptions options;
    options.frame = frame;
    const Result<Model> model = make_model(mesh, options);
    ASSERT_TRUE(model.ok());
    ASSERT_GT(model->wide.nodes.size(), 9U);
    const Status sound = validate(*model);
    ASSERT_TRUE(sound.ok()) << sound.error().message();
    for (const auto& [name, corrupt] : wide_corruptions()) {
      Model broken = *model;
      corrupt(broken.wide);
      EXPECT_FALSE(validate(broken).ok()) << name;
    }
  }
}

TEST(ValidateWide, TakesWhatCollapsingMakes) {
  const std::vector<std::size_t> counts{1, 2, 8, 9, 10, 64, 65, 500, 3000};
  for (const SplitRule rule :
       {SplitRule::min_relative_segment, SplitRule::paper, SplitRule::sah, SplitRule::median}) {
    for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
      for (const std::size_t count : counts) {
        BuildOptions options;
        options.rule = rule;
        options.frame = frame;
        options.reinsertion_passes = count % 2 == 0 ? 2 : 0;
        const Result<Model> model = make_model(test::triangle_soup(count, 0.1F, count), options);
        ASSERT_TRUE(model.ok());
        const Status sound = validate(*model);
        EXPECT_TRUE(sound.ok()) << count << " triangles: " << sound.error().message();
      }
    }
  }
  EXPECT_FALSE(validate(Model{}).ok());
}

TEST(ValidateWide, CatchesTheWideTreeOfAnotherBinaryTree) {
  const TriangleMesh mesh = test::triangle_soup(200, 0.2F, 5);
  BuildOptions other;
  other.rule = SplitRule::median;
  Result<Model> model = make_model(mesh);
  const Result<Model> median = make_model(mesh, other);
  ASSERT_TRUE(model.ok() && median.ok());
  model->wide = median->wide;
  EXPECT_FALSE(validate(*model).ok());
  model->wide = {};
  EXPECT_TRUE(validate(*model).ok()) << "no wide tree is no fault";
}

}  // namespace
}  // namespace crashrank
