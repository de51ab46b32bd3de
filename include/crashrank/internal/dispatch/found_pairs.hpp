#pragma once

#include "crashrank/collide/pair.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Consecutive pairs of one query in one worker's buffer.
struct PairRun {
  std::uint32_t query = 0;
  std::uint32_t worker = 0;
  std::size_t first = 0;
  std::size_t count = 0;
};

/// What one worker found. A cache line apart from the next, which another thread writes.
struct alignas(64) FoundPairs {
  std::vector<Pair> pairs;
  std::vector<PairRun> runs;
};

}  // namespace crashrank
