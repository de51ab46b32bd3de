#pragma once

#include "crashrank/internal/vehicle/silhouettes.hpp"
#include "crashrank/mesh/profile.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// State of a block's outline pieces while they are near the other body, m.
struct alignas(64) PieceStates {
  std::array<float, block_pieces> s{};         ///< advance along the normal inside the other body
  std::array<float, block_pieces> furthest{};  ///< greatest `s` so far
  std::array<float, block_pieces> path{};      ///< path length inside the other body
  std::array<float, block_pieces> path_x{};    ///< part of the path along the other body's x axis
};

/// Force-deflection curves of a block's pieces for their own body's material: see CrushCurves.
struct alignas(64) PieceCurves {
  std::array<float, block_pieces> yield{};
  std::array<float, block_pieces> slope{};
  std::array<float, block_pieces> length{};
  std::array<float, block_pieces> hardening{};
  std::array<float, block_pieces> hardening_length{};
  std::array<float, block_pieces> rigid{};
};

/// Memory for the blocks that come near another body, shared by the outlines of a scene. A block
/// keeps its slot from the first time that it is near on, so that memory grows with what is near,
/// not with the bodies.
struct PiecePool {
  static constexpr std::uint32_t none = static_cast<std::uint32_t>(-1);

  std::vector<PieceStates> states;
  std::vector<PieceCurves> curves;
  std::size_t used = 0;
  bool exceeded = false;  ///< a block found no slot, and does not press

  /// Has room for so many blocks; allocates only beyond the room that there is.
  void reserve(std::size_t blocks);
  /// Gives all slots back.
  void clear() noexcept {
    used = 0;
    exceeded = false;
  }
  /// Takes a slot; `none` if there is no more.
  std::uint32_t take() noexcept {
    if (used < states.size()) return static_cast<std::uint32_t>(used++);
    exceeded = true;
    return none;
  }
};

/// Blocks of an outline of that many pieces at most: the last of each height band may be partly
/// filled.
constexpr std::size_t most_blocks(std::size_t pieces) {
  return pieces / block_pieces + profile_bands;
}

/// No band of the other body lies at the height.
inline constexpr std::uint8_t no_band = 255;

/// A group of eight blocks with a bit for each block that is in the list.
struct NearGroup {
  std::uint32_t group = 0;
  std::uint8_t listed = 0;
};

/// The pieces of one outline (see `OutlinePiece`) that may press into another body, as a list of
/// blocks.
struct NearPieces {
  std::vector<NearGroup> groups;       ///< current list: the first `count`
  PiecePool* pool = nullptr;           ///< states and curves of the blocks
  std::vector<std::uint32_t> slot;     ///< by block: in the pool; valid for listed blocks
  std::vector<std::uint32_t> listed;   ///< by block: number of the last list that contained it
  std::vector<std::uint16_t> tracked;  ///< by block: a bit for each piece in that list
  std::vector<std::uint8_t> entered;   ///< by block: 1 once a piece may have been inside the body
  std::size_t count = 0;               ///< groups in the current list
  std::size_t pieces = 0;              ///< pieces moved by the last pass
  std::uint32_t list = 0;              ///< number of the current list
  std::uint32_t first_list = 0;        ///< number of the first list of this pair of bodies
  double valid_for_m = -1e9;           ///< relative travel until a new list is needed
  /// By band of these pieces: the band of the other body at the same height when the list was made,
  /// or `no_band`.
  std::array<std::uint8_t, profile_bands> target_band{};

  /// Allocates room for outlines with up to `most_pieces` pieces.
  void resize(std::size_t most_pieces);
  /// Clears all states for a new pair of bodies; keeps states in `pool_of_scene`. O(1).
  void begin(PiecePool& pool_of_scene);
  /// Starts a further contact of the same bodies; what the pieces have crushed is kept. O(1).
  void begin_further_contact();
  /// Returns true if no list has been made since `begin`.
  bool is_new() const noexcept { return valid_for_m < -1e6; }
};

}  // namespace crashrank::detail
