#include "crashrank/tree/literal_split.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace crashrank {
namespace {

TEST(LiteralSplit, SkipsAnAxisWithoutLength) {
  const std::vector<detail::AxisEntry> flat{{1, 1, 0}, {1, 1, 1}, {1, 1, 2}};
  std::vector<float> room(3);
  detail::LiteralCut cut;
  detail::consider_axis(0, flat, room, cut);
  EXPECT_EQ(cut.axis, -1);
}

}  // namespace
}  // namespace crashrank
