#include "crashrank/internal/vehicle/silhouettes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank {
namespace {

/// Coordinates along the axis that is sampled over and across it, of a piece's two ends.
struct Ends {
  float from = 0.0F;
  float to = 0.0F;
  float value_from = 0.0F;
  float value_to = 0.0F;
};

Ends ends_of(const OutlinePiece& piece, bool over_x) {
  const float half_x = -0.5F * piece.length_m * piece.normal_y;
  const float half_y = 0.5F * piece.length_m * piece.normal_x;
  Ends ends = over_x ? Ends{piece.x - half_x, piece.x + half_x, piece.y - half_y, piece.y + half_y}
                     : Ends{piece.y - half_y, piece.y + half_y, piece.x - half_x, piece.x + half_x};
  if (ends.from > ends.to) {
    std::swap(ends.from, ends.to);
    std::swap(ends.value_from, ends.value_to);
  }
  return ends;
}

Silhouette sample(const Profile& profile, std::size_t band, bool over_x, float low, float high,
                  float step, std::vector<SilhouetteNode>& nodes) {
  constexpr float rim = 2.5F;  // steps beside the outline, so that no edge falls on the last node
  Silhouette s;
  if (profile.first[band] == profile.first[band + 1]) return s;
  s.nodes_per_m = 1.0F / step;
  s.first = static_cast<std::uint32_t>(nodes.size());
  s.count = static_cast<std::uint32_t>((high - low) / step + 2.0F * rim) + 2;
  // About the middle, so that a mirrored body has mirrored nodes.
  s.low_m = 0.5F * (low + high) - 0.5F * step * static_cast<float>(s.count - 1);
  nodes.resize(nodes.size() + s.count);
  SilhouetteNode* const at = nodes.data() + s.first;
  const auto last = static_cast<int>(s.count) - 1;
  for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
    const Ends e = ends_of(profile.pieces[i], over_x);
    const int from = std::max(0, static_cast<int>(std::ceil((e.from - s.low_m) / step - 1e-3F)));
    const int to = std::min(last, static_cast<int>(std::floor((e.to - s.low_m) / step + 1e-3F)));
    for (int k = from; k <= to; ++k) {
      const float place = s.low_m + step * static_cast<float>(k);
      const float share =
          e.to > e.from ? std::clamp((place - e.from) / (e.to - e.from), 0.0F, 1.0F) : 0.5F;
      const float value = e.value_from + share * (e.value_to - e.value_from);
      at[k].greatest_m = std::max(at[k].greatest_m, value);
      at[k].least_m = std::min(at[k].least_m, value);
    }
  }
  // One node beyond each edge repeats the edge, so that interpolation reaches up to it.
  const std::vector<SilhouetteNode> sampled(at, at + s.count);
  for (int k = 0; k <= last; ++k) {
    const auto covered = [&](int j) {
      return j >= 0 && j <= last && sampled[static_cast<std::size_t>(j)].greatest_m > -1e8F;
    };
    if (covered(k)) continue;
    if (covered(k - 1))
      at[k] = sampled[static_cast<std::size_t>(k) - 1];
    else if (covered(k + 1))
      at[k] = sampled[static_cast<std::size_t>(k) + 1];
  }
  return s;
}

/// Puts a block into a place of its group.
void add_to_group(const Profile& profile, const PieceBlock& block, std::size_t lane,
                  BlockGroup& group) {
  float low_x = std::numeric_limits<float>::max();
  float low_y = low_x;
  float high_x = -low_x;
  float high_y = -low_x;
  const OutlinePiece* const first = profile.pieces.data() + block.first;
  const OutlinePiece* const last = first + block.count;
  for (const OutlinePiece* piece = first; piece != last; ++piece) {
    low_x = std::min(low_x, piece->x);
    high_x = std::max(high_x, piece->x);
    low_y = std::min(low_y, piece->y);
    high_y = std::max(high_y, piece->y);
  }
  group.x[lane] = 0.5F * (low_x + high_x);
  group.y[lane] = 0.5F * (low_y + high_y);
  group.half_x[lane] = 0.5F * (high_x - low_x);
  group.half_y[lane] = 0.5F * (high_y - low_y);
}

/// Groups of a band's blocks, which are the last.
void add_groups(const Profile& profile, std::size_t first_block, Silhouettes& s) {
  constexpr std::size_t lanes = 8;
  for (std::size_t i = first_block; i < s.blocks.size(); i += lanes) {
    BlockGroup group;
    group.first = static_cast<std::uint32_t>(i);
    group.band = s.blocks[i].band;
    group.half_x.fill(BlockGroup::empty);
    group.half_y.fill(BlockGroup::empty);
    const std::size_t count = std::min(lanes, s.blocks.size() - i);
    for (std::size_t k = 0; k < count; ++k) add_to_group(profile, s.blocks[i + k], k, group);
    s.groups.push_back(group);
  }
}

BandBounds bounds_of(const Silhouettes& s, std::size_t band) {
  BandBounds bounds;
  const auto grow = [&](const Silhouette& of, float& least, float& greatest) {
    for (std::uint32_t i = of.first; i < of.first + of.count; ++i) {
      least = std::min(least, s.nodes[i].least_m);
      greatest = std::max(greatest, s.nodes[i].greatest_m);
    }
  };
  grow(s.along_x[band], bounds.min_x, bounds.max_x);
  grow(s.along_y[band], bounds.min_y, bounds.max_y);
  return bounds;
}

/// Greatest less least value at a coordinate; 0 beside the outline.
float chord(const Silhouettes& s, const Silhouette& of, float at) {
  const float place = (at - of.low_m) * of.nodes_per_m;
  const auto i = static_cast<std::uint32_t>(std::max(place, 0.0F));
  if (i + 1 >= of.count) return 0.0F;
  const SilhouetteNode* const node = s.nodes.data() + of.first + i;
  const float share = place - static_cast<float>(i);
  const float first = node[0].greatest_m - node[0].least_m;
  return std::max(0.0F, first + share * (node[1].greatest_m - node[1].least_m - first));
}

/// See `PieceRows::thickness_m`.
float thickness(const Silhouettes& s, std::size_t band, const OutlinePiece& p) {
  constexpr float least_m = 0.02F;
  return std::max(least_m,
                  p.normal_x * p.normal_x * chord(s, s.along_x[band], p.y) +
                      flank_share * p.normal_y * p.normal_y * chord(s, s.along_y[band], p.x));
}

PieceRows make_rows(const Profile& profile, const Silhouettes& s, const PieceBlock& block) {
  PieceRows rows;
  for (std::size_t k = 0; k < block_pieces; ++k) {
    const std::size_t in_block = std::min<std::size_t>(k, block.count - 1U);
    const OutlinePiece& piece = profile.pieces[block.first + in_block];
    rows.x[k] = piece.x;
    rows.y[k] = piece.y;
    rows.normal_x[k] = piece.normal_x;
    rows.normal_y[k] = piece.normal_y;
    rows.length_m[k] = piece.length_m;
    rows.thickness_m[k] = thickness(s, block.band, piece);
  }
  return rows;
}

}  // namespace

Silhouettes make_silhouettes(const Profile& profile) {
  constexpr float coarsest_m = 0.05F;
  constexpr float finest_m = 0.005F;
  constexpr float nodes_across = 20.0F;
  constexpr float most_nodes = 4096.0F;
  Silhouettes s;
  if (profile.pieces.empty()) return s;
  s.min_x = s.min_y = std::numeric_limits<float>::max();
  s.max_x = s.max_y = -s.min_x;
  for (const OutlinePiece& piece : profile.pieces) {
    s.min_x = std::min(s.min_x, piece.x);
    s.max_x = std::max(s.max_x, piece.x);
    s.min_y = std::min(s.min_y, piece.y);
    s.max_y = std::max(s.max_y, piece.y);
  }
  const float width = std::min(s.max_x - s.min_x, s.max_y - s.min_y);
  const float longest = std::max(s.max_x - s.min_x, s.max_y - s.min_y);
  const float step =
      std::max(std::clamp(width / nodes_across, finest_m, coarsest_m), longest / most_nodes);
  for (std::size_t band = 0; band < profile_bands; ++band) {
    s.along_x[band] = sample(profile, band, false, s.min_y, s.max_y, step, s.nodes);
    s.along_y[band] = sample(profile, band, true, s.min_x, s.max_x, step, s.nodes);
    s.bands[band] = bounds_of(s, band);
    constexpr auto most = static_cast<std::uint32_t>(block_pieces);
    const std::size_t first_block = s.blocks.size();
    for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; i += most) {
      const std::uint32_t count = std::min(most, profile.first[band + 1] - i);
      s.blocks.push_back({i, static_cast<std::uint16_t>(count), static_cast<std::uint16_t>(band)});
      s.rows.push_back(make_rows(profile, s, s.blocks.back()));
    }
    add_groups(profile, first_block, s);
  }
  return s;
}

}  // namespace crashrank
