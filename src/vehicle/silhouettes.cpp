#include "crashrank/internal/vehicle/silhouettes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

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

/// Calls back for every node that a piece passes, with the value there.
template <class Visit>
void visit_nodes(const OutlinePiece& piece, bool over_x, const Silhouette& s, Visit&& visit) {
  const float step = 1.0F / s.nodes_per_m;
  const Ends e = ends_of(piece, over_x);
  const auto last = static_cast<int>(s.count) - 1;
  const int from = std::max(0, static_cast<int>(std::ceil((e.from - s.low_m) / step - 1e-3F)));
  const int to = std::min(last, static_cast<int>(std::floor((e.to - s.low_m) / step + 1e-3F)));
  for (int k = from; k <= to; ++k) {
    const float place = s.low_m + step * static_cast<float>(k);
    const float share =
        e.to > e.from ? std::clamp((place - e.from) / (e.to - e.from), 0.0F, 1.0F) : 0.5F;
    visit(static_cast<std::size_t>(k), e.value_from + share * (e.value_to - e.value_from));
  }
}

/// An outline on a line of nodes: the body begins, ends (`out` above 0) or runs along the line.
struct Crossing {
  float value = 0.0F;
  float out = 0.0F;
};

/// Narrower bays fold up with the structure beside them, m; so do those below the floor of a
/// vehicle, in bands below `lowest_bay_band`.
constexpr float least_bay_m = 1.2F;
constexpr std::size_t lowest_bay_band = 3;
static_assert(profile_edges_m[lowest_bay_band] == 0.4);

/// Intervals of a line that belong to the body. What lies between two crossings is free where the
/// body ends at the first and begins at the second, at least `least_gap_m` further on.
std::vector<SilhouetteNode> intervals_of(std::vector<Crossing>& crossings, float least_gap_m) {
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.value != b.value ? a.value < b.value : a.out < b.out;
  });
  std::vector<SilhouetteNode> intervals;
  float out = -1.0F;
  for (const Crossing& c : crossings) {
    const bool begins = intervals.empty() || (out > 0.0F && c.out < 0.0F &&
                                              c.value - intervals.back().greatest_m >= least_gap_m);
    if (begins) intervals.push_back({c.value, c.value});
    intervals.back().greatest_m = std::max(intervals.back().greatest_m, c.value);
    if (c.out != 0.0F) out = c.out;
  }
  while (intervals.size() > Silhouette::most_layers) {
    std::size_t narrowest = 1;
    const auto gap = [&](std::size_t k) {
      return intervals[k].least_m - intervals[k - 1].greatest_m;
    };
    for (std::size_t k = 2; k < intervals.size(); ++k) {
      if (gap(k) < gap(narrowest)) narrowest = k;
    }
    intervals[narrowest - 1].greatest_m = intervals[narrowest].greatest_m;
    intervals.erase(intervals.begin() + static_cast<std::ptrdiff_t>(narrowest));
  }
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const SilhouetteNode& a, const SilhouetteNode& b) {
                     return a.greatest_m - a.least_m > b.greatest_m - b.least_m;
                   });
  return intervals;
}

/// One node beyond each edge repeats the edge, so that interpolation reaches up to it.
template <class Row, class Covered>
void repeat_edges(std::vector<Row>& rows, Covered&& is_covered) {
  const std::vector<Row> sampled = rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (is_covered(sampled[k])) continue;
    if (k > 0 && is_covered(sampled[k - 1])) {
      rows[k] = sampled[k - 1];
    } else if (k + 1 < rows.size() && is_covered(sampled[k + 1])) {
      rows[k] = sampled[k + 1];
    }
  }
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
  std::vector<std::vector<Crossing>> crossings(s.count);
  for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
    const OutlinePiece& piece = profile.pieces[i];
    visit_nodes(piece, over_x, s, [&](std::size_t k, float value) {
      crossings[k].push_back({value, over_x ? piece.normal_y : piece.normal_x});
    });
  }
  std::vector<std::vector<SilhouetteNode>> intervals;
  intervals.reserve(crossings.size());
  const float least_gap_m =
      band < lowest_bay_band ? std::numeric_limits<float>::infinity() : least_bay_m;
  for (std::vector<Crossing>& of_node : crossings) {
    intervals.push_back(intervals_of(of_node, least_gap_m));
  }
  repeat_edges(intervals, [](const auto& of_node) { return !of_node.empty(); });
  s.layers = 1;
  for (const auto& of_node : intervals) {
    s.layers = std::max(s.layers, static_cast<std::uint32_t>(of_node.size()));
  }
  nodes.resize(nodes.size() + std::size_t{s.layers} * s.count);
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    for (std::size_t layer = 0; layer < intervals[k].size(); ++layer) {
      nodes[s.first + layer * s.count + k] = intervals[k][layer];
    }
  }
  return s;
}

/// Heights that the body takes up in a band along the line of each node of a silhouette. Where they
/// reach an edge of the band beyond which the body goes on, so do they. Returns the first of them.
std::uint32_t sample_heights(const Profile& profile, std::size_t band, bool over_x,
                             Silhouettes& s) {
  constexpr float at_edge_m = 0.01F;
  constexpr float far_m = 1e3F;
  const Silhouette& over = over_x ? s.along_y[band] : s.along_x[band];
  const auto first = static_cast<std::uint32_t>(s.heights.size());
  std::vector<HeightRange> heights(over.count);
  for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
    const OutlinePiece& piece = profile.pieces[i];
    const HeightRange& on_line = over_x ? piece.along_y : piece.along_x;
    visit_nodes(piece, over_x, over, [&](std::size_t k, float) { heights[k].grow(on_line); });
    s.all_heights.grow(on_line);
  }
  repeat_edges(heights, [](const HeightRange& range) { return !range.empty(); });
  const auto goes_on = [&](std::size_t next) {
    return next < profile_bands && profile.first[next] < profile.first[next + 1];
  };
  for (HeightRange& range : heights) {
    if (range.empty()) continue;
    if (range.low_m < static_cast<float>(profile_edges_m[band]) + at_edge_m && goes_on(band - 1)) {
      range.low_m = -far_m;
    }
    if (range.high_m > static_cast<float>(profile_edges_m[band + 1]) - at_edge_m &&
        goes_on(band + 1)) {
      range.high_m = far_m;
    }
  }
  s.heights.insert(s.heights.end(), heights.begin(), heights.end());
  return first;
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
    for (std::uint32_t i = of.first; i < of.first + of.layers * of.count; ++i) {
      least = std::min(least, s.nodes[i].least_m);
      greatest = std::max(greatest, s.nodes[i].greatest_m);
    }
  };
  grow(s.along_x[band], bounds.min_x, bounds.max_x);
  grow(s.along_y[band], bounds.min_y, bounds.max_y);
  return bounds;
}

/// Length of the interval of a node that a value lies in or nearest to; 0 without one.
float chord_at(const Silhouettes& s, const Silhouette& of, std::uint32_t node, float value) {
  float best = -1e9F;
  float length = 0.0F;
  for (std::uint32_t layer = 0; layer < of.layers; ++layer) {
    const SilhouetteNode& n = s.nodes[of.first + layer * of.count + node];
    const float inside = std::min(n.greatest_m - value, value - n.least_m);
    if (inside <= best) continue;
    best = inside;
    length = n.greatest_m - n.least_m;
  }
  return length;
}

/// Chord of the body through a value at a coordinate; 0 beside the outline.
float chord(const Silhouettes& s, const Silhouette& of, float at, float value) {
  const float place = (at - of.low_m) * of.nodes_per_m;
  const auto i = static_cast<std::uint32_t>(std::max(place, 0.0F));
  if (i + 1 >= of.count) return 0.0F;
  const float share = place - static_cast<float>(i);
  const float first = chord_at(s, of, i, value);
  return std::max(0.0F, first + share * (chord_at(s, of, i + 1, value) - first));
}

/// See `PieceRows::thickness_m`.
float thickness(const Silhouettes& s, std::size_t band, const OutlinePiece& p) {
  constexpr float least_m = 0.02F;
  return std::max(least_m,
                  p.normal_x * p.normal_x * chord(s, s.along_x[band], p.y, p.x) +
                      flank_share * p.normal_y * p.normal_y * chord(s, s.along_y[band], p.x, p.y));
}

/// True if two pieces face each other across at most `folding_gap_m`.
bool face(const OutlinePiece& a, const OutlinePiece& b) {
  constexpr float opposed = -0.3F;  // cosine of the angle between the normals, at most
  if (a.normal_x * b.normal_x + a.normal_y * b.normal_y > opposed) return false;
  const float x = b.x - a.x;
  const float y = b.y - a.y;
  const float from_a = x * a.normal_x + y * a.normal_y;
  const float from_b = -(x * b.normal_x + y * b.normal_y);
  if (!(std::min(from_a, from_b) > 0.0F && std::max(from_a, from_b) <= folding_gap_m)) return false;
  const float beside_a = std::abs(y * a.normal_x - x * a.normal_y);
  const float beside_b = std::abs(y * b.normal_x - x * b.normal_y);
  return std::min(beside_a, beside_b) <= 0.5F * (a.length_m + b.length_m);
}

/// By piece: 1 if it faces none of its band. O(pieces log pieces) for outlines along a line.
std::vector<char> pressing_pieces(const Profile& profile) {
  const std::vector<OutlinePiece>& pieces = profile.pieces;
  std::vector<char> presses(pieces.size(), 1);
  std::vector<std::uint32_t> by_x;
  for (std::size_t band = lowest_pressing_band; band < profile_bands; ++band) {
    by_x.resize(profile.first[band + 1] - profile.first[band]);
    std::iota(by_x.begin(), by_x.end(), profile.first[band]);
    std::sort(by_x.begin(), by_x.end(), [&](std::uint32_t i, std::uint32_t k) {
      return std::pair(pieces[i].x, i) < std::pair(pieces[k].x, k);
    });
    for (auto a = by_x.begin(); a != by_x.end(); ++a) {
      for (auto b = a + 1; b != by_x.end() && pieces[*b].x - pieces[*a].x <= folding_gap_m; ++b) {
        if (face(pieces[*a], pieces[*b])) presses[*a] = presses[*b] = 0;
      }
    }
  }
  return presses;
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
    rows.edge_low_m[k] = piece.at_edge.low_m;
    rows.edge_high_m[k] = piece.at_edge.high_m;
    rows.behind_low_m[k] = piece.behind.low_m;
    rows.behind_high_m[k] = piece.behind.high_m;
  }
  return rows;
}

}  // namespace

Silhouettes make_silhouettes(const Profile& profile) {
  constexpr float coarsest_m = 0.018F;
  constexpr float finest_m = 0.005F;
  constexpr float nodes_across = 20.0F;
  constexpr float most_nodes = 4096.0F;
  Silhouettes s;
  if (!profile.presses()) return s;
  s.min_x = s.min_y = std::numeric_limits<float>::max();
  s.max_x = s.max_y = -s.min_x;
  for (std::size_t i = profile.first[lowest_pressing_band]; i < profile.pieces.size(); ++i) {
    const OutlinePiece& piece = profile.pieces[i];
    s.min_x = std::min(s.min_x, piece.x);
    s.max_x = std::max(s.max_x, piece.x);
    s.min_y = std::min(s.min_y, piece.y);
    s.max_y = std::max(s.max_y, piece.y);
  }
  const float width = std::min(s.max_x - s.min_x, s.max_y - s.min_y);
  const float longest = std::max(s.max_x - s.min_x, s.max_y - s.min_y);
  const float step =
      std::max(std::clamp(width / nodes_across, finest_m, coarsest_m), longest / most_nodes);
  const std::vector<char> presses = pressing_pieces(profile);
  for (std::size_t band = lowest_pressing_band; band < profile_bands; ++band) {
    s.along_x[band] = sample(profile, band, false, s.min_y, s.max_y, step, s.nodes);
    s.along_y[band] = sample(profile, band, true, s.min_x, s.max_x, step, s.nodes);
    s.bands[band] = bounds_of(s, band);
    s.first_height_x[band] = sample_heights(profile, band, false, s);
    s.first_height_y[band] = sample_heights(profile, band, true, s);
    constexpr auto most = static_cast<std::uint32_t>(block_pieces);
    const std::size_t first_block = s.blocks.size();
    const std::uint32_t end = profile.first[band + 1];
    std::uint32_t next = profile.first[band];
    while (next < end) {
      if (presses[next] == 0) {
        ++next;
        continue;
      }
      PieceBlock block;
      block.first = next;
      block.count = static_cast<std::uint16_t>(std::min(most, end - next));
      block.band = static_cast<std::uint16_t>(band);
      for (std::uint32_t k = 0; k < block.count; ++k) {
        block.presses |= static_cast<std::uint16_t>(presses[next + k] << k);
      }
      s.blocks.push_back(block);
      s.rows.push_back(make_rows(profile, s, block));
      next += block.count;
    }
    add_groups(profile, first_block, s);
  }
  const auto fit = [](auto&... vectors) { (vectors.shrink_to_fit(), ...); };
  fit(s.heights, s.nodes, s.blocks, s.rows, s.groups);
  return s;
}

}  // namespace crashrank
