#pragma once

#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/profile.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Intervals in which the body lies along one body axis, sampled on nodes along the other: one
/// where it is convex, several where a bay at least 1.2 m wide and 0.4 m over the ground parts
/// them. They are stored in layers by falling length: layer k of a node is its interval number k.
/// Nodes with fewer intervals than layers hold -1e9 and 1e9 in the others.
struct Silhouette {
  static constexpr std::size_t most_layers = 4;  ///< the narrowest gaps beyond are closed
  float low_m = 0.0F;                            ///< coordinate of the first node, m
  float nodes_per_m = 0.0F;                      ///< 1 over their distance, 1/m
  std::uint32_t first = 0;   ///< of its nodes in `Silhouettes::nodes`, layer by layer
  std::uint32_t count = 0;   ///< nodes of a layer; 0: no outline in the band
  std::uint32_t layers = 0;  ///< number of layers
};

/// An interval of a silhouette.
struct SilhouetteNode {
  float greatest_m = -1e9F;  ///< m
  float least_m = 1e9F;      ///< m
};

/// Most pieces of a block.
inline constexpr std::size_t block_pieces = 16;

/// Up to `block_pieces` consecutive pieces of an outline, some of which press.
struct PieceBlock {
  std::uint32_t first = 0;  ///< piece
  std::uint16_t count = 0;  ///< pieces
  std::uint16_t presses =
      0;                   ///< bit k: the piece `first` + k faces none of the body's own, see below
  std::uint16_t band = 0;  ///< height band
};

/// Pieces of a body that face each other across at most this, m, do not press: between them the
/// body folds up, and nothing hooks on there, as behind an arm or in a wheel arch.
inline constexpr float folding_gap_m = 0.3F;

/// Up to eight consecutive blocks of one band by field, for vector units: boxes around them.
/// Those beyond the group's count are empty.
struct alignas(64) BlockGroup {
  static constexpr float empty = -1e9F;  ///< extent of those beyond the count
  std::array<float, 8> x{};              ///< centre of the box, m
  std::array<float, 8> y{};              ///< m
  std::array<float, 8> half_x{};         ///< half its length, m
  std::array<float, 8> half_y{};         ///< and width, m
  std::uint32_t first = 0;               ///< block
  std::uint16_t band = 0;                ///< height band
};

/// The pieces of a block by field, for vector units: rows of `OutlinePiece`s. Places beyond the
/// block's count repeat its last piece.
struct alignas(64) PieceRows {
  std::array<float, block_pieces> x{};         ///< m
  std::array<float, block_pieces> y{};         ///< m
  std::array<float, block_pieces> normal_x{};  ///< unit, outward
  std::array<float, block_pieces> normal_y{};  ///< unit, outward
  std::array<float, block_pieces> length_m{};  ///< m
  /// The body's chords through the piece along x and across, blended as depths are by the squares
  /// of its normal, those across times `flank_share`, m.
  std::array<float, block_pieces> thickness_m{};
  std::array<float, block_pieces> edge_low_m{};     ///< see `OutlinePiece::at_edge`
  std::array<float, block_pieces> edge_high_m{};    ///< m
  std::array<float, block_pieces> behind_low_m{};   ///< see `OutlinePiece::behind`
  std::array<float, block_pieces> behind_high_m{};  ///< m
};

/// Share in which flanks count their depth below the body's side: what is swept aside has less
/// behind it than what is pressed from the front.
inline constexpr float flank_share = 0.65F;

/// Box around the silhouettes of a band, m; empty where the band has none.
struct BandBounds {
  float min_x = 1e9F;   ///< rear end
  float max_x = -1e9F;  ///< front end
  float min_y = 1e9F;   ///< right side
  float max_y = -1e9F;  ///< left side
};

/// What contacts read of a profile besides its pieces: the depth of a point below the front, rear
/// and flanks of the body, by height band, and blocks of pieces. Bands that do not press are empty.
struct Silhouettes {
  std::array<Silhouette, profile_bands> along_x{};  ///< x of front and rear over y
  std::array<Silhouette, profile_bands> along_y{};  ///< y of left and right over x
  /// First of the heights of each band in `heights`, one for every node of `along_x` and `along_y`.
  std::array<std::uint32_t, profile_bands> first_height_x{};
  std::array<std::uint32_t, profile_bands> first_height_y{};
  /// Heights that the body takes up along the line of a node, m over its ground; they go on beyond
  /// the edge of a band where the body does.
  std::vector<HeightRange> heights;
  HeightRange all_heights;                        ///< of all bands that press, m over the ground
  std::array<BandBounds, profile_bands> bands{};  ///< around both
  std::vector<SilhouetteNode> nodes;              ///< of all
  std::vector<PieceBlock> blocks;                 ///< by rising band
  std::vector<PieceRows> rows;                    ///< of the blocks
  std::vector<BlockGroup> groups;                 ///< of the blocks
  float min_x = 0.0F;                             ///< bounds of all outlines, m
  float max_x = 0.0F;                             ///< m
  float min_y = 0.0F;                             ///< m
  float max_y = 0.0F;                             ///< m

  /// Larger side of the bounds, m.
  double longest_m() const { return static_cast<double>(std::max(max_x - min_x, max_y - min_y)); }
  /// Smaller side of the bounds, m.
  double width_m() const { return static_cast<double>(std::min(max_x - min_x, max_y - min_y)); }
};

/// Samples a profile: nodes every 18 mm, every twentieth of the width of narrow bodies. O(pieces
/// log pieces).
CRASHRANK_API Silhouettes make_silhouettes(const Profile& profile);

}  // namespace crashrank
