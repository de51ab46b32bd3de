#include "crashrank/collide/pair.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace crashrank {
namespace {

// Expected values: Python's hashlib.sha256 over struct.pack('<ii', a, b) of each pair.
TEST(PairHash, KnownAnswers) {
  EXPECT_EQ(pairs_hash(View<const Pair>()), "e3b0c44298fc1c14");
  const std::vector<Pair> few{{0, 0}, {0, 7}, {3, 2}, {70000, 5}, {2147483647, 1}};
  EXPECT_EQ(pairs_hash(few), "6c76490533f5377d");
  std::vector<Pair> many;  // crosses the block that is hashed at once
  for (int i = 0; i < 1500; ++i) many.push_back({i, 2 * i});
  EXPECT_EQ(pairs_hash(many), "6f2a52d90fc62a0c");
}

}  // namespace
}  // namespace crashrank
