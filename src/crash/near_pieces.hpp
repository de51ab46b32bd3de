#pragma once

#include "crashrank/internal/vehicle/silhouettes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// What is kept of a block's pieces while they are near the other body, m.
struct alignas(64) PieceStates {
  std::array<float, block_pieces> s{};         ///< advance along the normal through the other body
  std::array<float, block_pieces> furthest{};  ///< the greatest s so far
  std::array<float, block_pieces> way{};       ///< distance travelled inside the other body
  std::array<float, block_pieces> ahead{};     ///< of it, along the other body's x
};

/// How a block's pieces give way where they press themselves: see CrushCurves.
struct alignas(64) PieceCurves {
  std::array<float, block_pieces> yield{};
  std::array<float, block_pieces> slope{};
  std::array<float, block_pieces> length{};
  std::array<float, block_pieces> hardening{};
  std::array<float, block_pieces> hardening_length{};
  std::array<float, block_pieces> rigid{};
};

/// Blocks of a group that are in a list, a bit for each.
struct NearGroup {
  std::uint32_t group = 0;
  std::uint8_t listed = 0;
};

/// Blocks of one body's outline whose pieces may press into another body.
struct NearPieces {
  std::vector<NearGroup> groups;        ///< of the present list: the first `count`
  std::vector<PieceStates> states;      ///< by block; of those that are listed
  std::vector<PieceCurves> curves;      ///< likewise
  std::vector<std::uint32_t> listed;    ///< by block: number of the last list that it was in
  std::vector<std::uint16_t> followed;  ///< by block: its pieces in that list, a bit for each
  std::size_t count = 0;                ///< groups in the present list
  std::size_t pieces = 0;               ///< moved by the last pass
  std::uint32_t list = 0;               ///< number of the present list
  std::uint32_t begun = 0;              ///< lists since this number are of the same two bodies
  double valid_for_m = -1e9;            ///< relative travel until the list has to be made anew

  /// Room for the blocks of so many pieces.
  void resize(std::size_t most_pieces);
  /// Forgets everything. O(1).
  void begin();
  /// The two meet again: what pieces had crushed by then stays crushed. O(1).
  void resume();
  /// No list has been made since `begin`.
  bool begins() const noexcept { return valid_for_m < -1e6; }
};

}  // namespace crashrank::detail
