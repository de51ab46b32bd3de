// Meshes made to break a builder: no stack may overflow, no build may run away, every tree is
// valid.

#include "crashrank/model/make_model.hpp"
#include "crashrank/tree/build.hpp"
#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace crashrank {
namespace {

AabbTree expect_valid(const TriangleMesh& mesh, SplitRule rule, BoxFrame frame = BoxFrame::world) {
  SCOPED_TRACE("rule " + std::to_string(static_cast<int>(rule)));
  BuildOptions options;
  options.rule = rule;
  options.frame = frame;
  const Result<AabbTree> tree = build_tree(mesh, options);
  EXPECT_TRUE(tree.ok());
  if (!tree.ok()) return {};
  const Status status = validate(*tree, mesh);
  EXPECT_TRUE(status.ok()) << status.error().message();
  if (rule != SplitRule::paper) {
    EXPECT_LE(tree->depth, detail::balanced_depth + 31);
  }
  return *tree;
}

TEST(Adversarial, EqualTriangles) {
  TriangleMesh mesh;
  for (int i = 0; i < 20000; ++i) test::add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const SplitRule rule :
       {SplitRule::min_relative_segment, SplitRule::sah, SplitRule::median}) {
    EXPECT_LE(expect_valid(mesh, rule).depth, 32U);
  }
}

TEST(Adversarial, OnePoint) {
  TriangleMesh mesh;
  for (int i = 0; i < 5000; ++i) test::add_triangle(mesh, {1, 2, 3}, {1, 2, 3}, {1, 2, 3});
  for (const SplitRule rule : test::all_rules) {
    EXPECT_LE(expect_valid(mesh, rule).depth, 32U);
    expect_valid(mesh, rule, BoxFrame::gaussian);
  }
}

TEST(Adversarial, DistancesThatDouble) {
  TriangleMesh mesh;
  for (int exponent = -149; exponent < 120; ++exponent) {
    for (const float sign : {-1.0F, 1.0F}) {
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3f at = Eigen::Vector3f::Zero();
        at[axis] = sign * std::ldexp(1.0F, exponent);
        test::add_triangle(mesh, at, 1.5F * at, at);
      }
    }
  }
  for (const SplitRule rule : test::all_rules) {
    expect_valid(mesh, rule);
    expect_valid(mesh, rule, BoxFrame::gaussian);
  }
}

TEST(Adversarial, TheEndsOfTheFloatRange) {
  const float most = std::numeric_limits<float>::max();
  const float least = std::numeric_limits<float>::denorm_min();
  std::mt19937_64 random(31);
  TriangleMesh huge;
  TriangleMesh tiny;
  for (int i = 0; i < 400; ++i) {
    Eigen::Vector3f a[3];
    Eigen::Vector3f b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = most * (2.0F * test::unit_point(random) - Eigen::Vector3f::Ones());
      b[k] = (100.0F * least) * (8.0F * test::unit_point(random)).array().floor();
    }
    test::add_triangle(huge, a[0], a[1], a[2]);
    test::add_triangle(tiny, b[0], b[1], b[2]);
  }
  for (const SplitRule rule : test::all_rules) {
    expect_valid(huge, rule);
    expect_valid(tiny, rule);
    expect_valid(tiny, rule, BoxFrame::gaussian);
  }
  // Turned, the corners of the cube leave the float range: refused, not overflowed.
  TriangleMesh corner;
  test::add_triangle(corner, {most, most, most}, {-most, -most, -most}, {most, most, 0});
  BuildOptions options;
  options.frame = BoxFrame::gaussian;
  const Result<AabbTree> tree = build_tree(corner, options);
  ASSERT_FALSE(tree.ok());
  EXPECT_EQ(tree.error().code, ErrorCode::bad_input);
}

TEST(Adversarial, OneTriangleOverAllOthers) {
  TriangleMesh mesh = test::triangle_soup(3000, 0.001F, 32);
  for (int i = 0; i < 50; ++i) test::add_triangle(mesh, {-9, -9, -9}, {9, 9, -9}, {0, 0, 9});
  for (const SplitRule rule : test::all_rules) expect_valid(mesh, rule);
}

TEST(Adversarial, TheLiteralRulePeelsAStripOneByOne) {
  const TriangleMesh mesh = test::strip(12000);
  const AabbTree tree = expect_valid(mesh, SplitRule::paper);
  EXPECT_EQ(tree.depth, 11999U);
  EXPECT_EQ(slots_below(tree, 0).count, 12000U);
  EXPECT_EQ(descendants(tree, 0).count, 23998U);
}

TEST(Adversarial, TheLiteralRuleStopsAtItsWorkLimit) {
  const TriangleMesh mesh = test::strip(2000);
  std::vector<detail::BuildRecord> records(mesh.size());
  detail::write_world_records(mesh, 0, mesh.size(), records);
  std::vector<Node> nodes;
  detail::TreeWriter writer(nodes);
  writer.open_root(detail::to_box(detail::bounds(records)), 0, 2000, 0);
  detail::LiteralBuilder(records).build(writer, records, 100000);
  // The sets looked at have 2000, 1999, ... triangles: 51 of them use the limit up, and the other
  // 1949 triangles are halved to the end.
  EXPECT_EQ(measure_depth(nodes), 51U + 11U);
}

TEST(Adversarial, AMillionTriangleStripUnderEveryRule) {
  constexpr std::uint32_t triangles = 1'000'000;
  const TriangleMesh mesh = test::strip(triangles);
  for (const SplitRule rule :
       {SplitRule::min_relative_segment, SplitRule::sah, SplitRule::median}) {
    expect_valid(mesh, rule);
  }
  // The literal rule with a twentieth of its work limit, to keep the test short.
  AabbTree tree;
  std::vector<Node> nodes;
  std::vector<detail::BuildRecord> records(mesh.size());
  detail::write_world_records(mesh, 0, mesh.size(), records);
  detail::TreeWriter writer(nodes);
  writer.open_root(detail::to_box(detail::bounds(records)), 0, triangles, 0);
  detail::LiteralBuilder(records).build(writer, records, detail::literal_work_limit / 20);
  tree.nodes = std::move(nodes);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    tree.order.push_back(records[i].index);
    tree.triangles.push_back(mesh.triangle(records[i].index));
  }
  tree.depth = measure_depth(tree.nodes);
  EXPECT_GT(tree.depth, 50U);
  const Status status = validate(tree, mesh);
  EXPECT_TRUE(status.ok()) << status.error().message();
}

}  // namespace
}  // namespace crashrank
