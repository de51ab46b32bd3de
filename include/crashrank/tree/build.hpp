#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <cstdint>

namespace crashrank {

struct BuildOptions {
  SplitRule rule = SplitRule::min_relative_segment;
  BoxFrame frame = BoxFrame::world;
  std::uint32_t leaf_size = 4;  ///< most triangles a leaf may hold, 1 to 255; `paper` means 1
};

}  // namespace crashrank
