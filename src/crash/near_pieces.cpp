#include "crash/near_pieces.hpp"

#include <algorithm>

namespace crashrank::detail {

void PiecePool::reserve(std::size_t blocks) {
  if (states.size() >= blocks) return;
  states.resize(blocks);
  curves.resize(blocks);
}

void NearPieces::resize(std::size_t most_pieces) {
  const std::size_t blocks = most_blocks(most_pieces);
  if (listed.size() >= blocks) return;
  groups.resize(blocks / 8 + profile_bands);
  slot.resize(blocks, 0);
  listed.resize(blocks, 0);
  tracked.resize(blocks, 0);
  entered.resize(blocks, 0);
}

void NearPieces::begin(PiecePool& pool_of_scene) {
  pool = &pool_of_scene;
  // Skip one list number, so that the first list of a new pair does not continue the last list of
  // the previous pair. Reset before the numbers wrap around: an old number could otherwise equal a
  // new one.
  constexpr std::uint32_t nearly_round = 0xf0000000U;
  if (list > nearly_round) {
    std::fill(listed.begin(), listed.end(), 0U);
    list = 0;
  }
  list += 2;
  first_list = list;
  count = 0;
  pieces = 0;
  valid_for_m = -1e9;
}

void NearPieces::begin_further_contact() {
  ++list;
  count = 0;
  pieces = 0;
  // A new list is due at once. Unlike the first list of a pair, it allows no initial overlap.
  valid_for_m = 0.0;
}

}  // namespace crashrank::detail
