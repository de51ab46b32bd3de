#include "crashrank/tree/build.hpp"

#include "crashrank/tree/validate.hpp"
#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace crashrank {
namespace {

constexpr SplitRule all_rules[] = {SplitRule::min_relative_segment, SplitRule::paper,
                                   SplitRule::sah, SplitRule::median};

void expect_valid(const TriangleMesh& mesh, const BuildOptions& options) {
  SCOPED_TRACE("rule " + std::to_string(static_cast<int>(options.rule)) + ", frame " +
               std::to_string(static_cast<int>(options.frame)) + ", leaves of " +
               std::to_string(options.leaf_size));
  const Result<AabbTree> tree = build_tree(mesh, options);
  ASSERT_TRUE(tree.ok()) << tree.error().message();
  const Status status = validate(*tree, mesh);
  EXPECT_TRUE(status.ok()) << status.error().message();
}

TEST(Build, EveryRuleFrameAndLeafSizeGivesAValidTree) {
  for (const std::size_t n : {1U, 2U, 3U, 5U, 17U, 300U}) {
    const TriangleMesh mesh = test::triangle_soup(n, 0.2F, n);
    for (const SplitRule rule : all_rules) {
      for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
        for (const std::uint32_t leaf : {1U, 2U, 4U, 8U, 255U}) {
          expect_valid(mesh, {rule, frame, leaf});
        }
      }
    }
  }
}

TEST(Build, RefusesWhatHasNoTree) {
  const auto code = [](const TriangleMesh& mesh, std::uint32_t leaf = 4) {
    const Result<AabbTree> tree = build_tree(mesh, {SplitRule::sah, BoxFrame::world, leaf});
    return tree.ok() ? ErrorCode::internal : tree.error().code;
  };
  const TriangleMesh good = test::triangle_soup(3, 0.1F, 1);
  EXPECT_EQ(code(TriangleMesh{}), ErrorCode::bad_input);
  EXPECT_EQ(code(good, 0), ErrorCode::usage);
  EXPECT_EQ(code(good, 256), ErrorCode::usage);
  TriangleMesh mesh = good;
  mesh.triangles[1][2] = 9;
  EXPECT_EQ(code(mesh), ErrorCode::bad_input);
  mesh = good;
  mesh.vertices[4].y() = NAN;
  EXPECT_EQ(code(mesh), ErrorCode::bad_input);
  mesh.vertices[4].y() = INFINITY;
  EXPECT_EQ(code(mesh), ErrorCode::bad_input);
}

}  // namespace
}  // namespace crashrank
