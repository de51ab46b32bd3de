#include "crash/near_pieces.hpp"

#include "crashrank/mesh/profile.hpp"

#include <algorithm>

namespace crashrank::detail {

void NearPieces::resize(std::size_t most_pieces) {
  // Every band may end in a block that is not full.
  const std::size_t most_blocks = most_pieces / block_pieces + profile_bands;
  if (listed.size() >= most_blocks) return;
  groups.resize(most_blocks / 8 + profile_bands);
  states.resize(most_blocks);
  curves.resize(most_blocks);
  listed.resize(most_blocks, 0);
  followed.resize(most_blocks, 0);
}

void NearPieces::begin() {
  // One number is left out, so that the first list continues none. Numbers that come round would
  // take blocks for listed that were not.
  constexpr std::uint32_t nearly_round = 0xf0000000U;
  if (list > nearly_round) {
    std::fill(listed.begin(), listed.end(), 0U);
    list = 0;
  }
  list += 2;
  begun = list;
  count = 0;
  pieces = 0;
  valid_for_m = -1e9;
}

void NearPieces::resume() {
  ++list;
  count = 0;
  pieces = 0;
  // The next list follows at once, but not as the first of two bodies that begin inside each other.
  valid_for_m = 0.0;
}

}  // namespace crashrank::detail
