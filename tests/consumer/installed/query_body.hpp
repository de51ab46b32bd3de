// The body of query.hpp's functions, included by a translation unit for each set of flags. No
// include guard and no inline: the names come from the macros ASK and LAYOUT.
#include "query.hpp"

#include <crashrank/collide/collide.hpp>
#include <crashrank/tree/build.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

std::string ASK() {
  using namespace crashrank;
  const TriangleMesh sheet = bumpy_sheet(40);
  std::string answer;
  for (const SplitRule rule : {SplitRule::min_relative_segment, SplitRule::sah}) {
    BuildOptions options;
    options.rule = rule;
    const Result<AabbTree> tree = build_tree(sheet, options);
    if (!tree) return tree.error().message();
    // Exact rationals and a rotation about (1, 1, 1) by 3-4-5: rigid, with long mantissas.
    const double third = 1.0 / 3.0;
    const std::vector<std::vector<double>> matrices{
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
        {0.6, -0.8, 0, 0.3, 0.8, 0.6, 0, -0.1, 0, 0, 1, 0.05, 0, 0, 0, 1},
        {2 * third, -third, 2 * third, 1, 2 * third, 2 * third, -third, 1, -third, 2 * third,
         2 * third, 0.2, 0, 0, 0, 1},
        {1, 0, 0, 0.7, 0, 0, -1, 0.1, 0, 1, 0, -1.3, 0, 0, 0, 1}};
    std::vector<Pair> pairs;
    CollideWorkspace workspace;
    for (const std::vector<double>& matrix : matrices) {
      const Result<Pose> pose = pose_from_matrix(matrix);
      if (!pose) return pose.error().message();
      const CollideResult result = collide(*tree, *tree, *pose, pairs, workspace);
      std::sort(pairs.begin(), pairs.end());
      std::uint64_t hash = 1469598103934665603U;  // FNV-1a
      for (const Pair& pair : pairs) {
        for (const std::int32_t index : {pair.a, pair.b}) {
          hash = (hash ^ static_cast<std::uint32_t>(index)) * 1099511628211U;
        }
      }
      answer += std::to_string(result.pairs) + " pairs, " + std::to_string(hash) + "\n";
    }
  }
  return answer;
}

std::vector<std::size_t> LAYOUT() {
  using namespace crashrank;
  return {sizeof(Pose),         alignof(Pose),         offsetof(Pose, translation),
          sizeof(Box),          alignof(Box),          offsetof(Box, max),
          sizeof(Triangle),     alignof(Triangle),     sizeof(TriangleMesh),
          sizeof(Node),         alignof(Node),         offsetof(Node, count),
          sizeof(AabbTree),     alignof(AabbTree),     offsetof(AabbTree, triangles),
          sizeof(Pair),         sizeof(CollideResult), alignof(CollideResult),
          sizeof(CollideWork),  sizeof(BuildOptions),  sizeof(CollideOptions),
          sizeof(Result<Pose>), alignof(Result<Pose>), sizeof(View<const Pair>)};
}
