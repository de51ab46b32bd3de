// Depths of eight places inside an outline. Included once per vector target.
#if defined(CRASHRANK_SILHOUETTE_DEPTHS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CRASHRANK_SILHOUETTE_DEPTHS_INL
#undef CRASHRANK_SILHOUETTE_DEPTHS_INL
#else
#define CRASHRANK_SILHOUETTE_DEPTHS_INL
#endif

#include "collide/lanes-inl.hpp"
#include "crashrank/internal/vehicle/silhouettes.hpp"

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace crashrank::detail::HWY_NAMESPACE {

/// Depths of places below the four sides of a height band's silhouettes.
struct Depths {
  F8 front, rear, left, right;
  M8 known;      ///< the place lies within the nodes of all silhouettes
  I8 row;        ///< node over y before the place
  F8 row_share;  ///< share of the way to the next one
  I8 column;     ///< node over x
  F8 column_share;

  HWY_INLINE F8 least() const {
    return select(known, minimum(minimum(front, rear), minimum(left, right)), all(-1.0F));
  }
};

/// Index of the node before a place and the fraction of the distance to the next node; outside the
/// nodes some valid index.
struct NodePlace {
  I8 node;
  F8 share;
  M8 known;
};

HWY_INLINE NodePlace node_place(const Silhouette& s, F8 at) {
  const F8 row = (at - all(s.low_m)) * all(s.nodes_per_m);
  const auto last = static_cast<float>(s.count - 1);
  // In this order the bounds also limit NaN.
  const I8 node = truncate(maximum(minimum(row, all(last - 1.0F)), all(0.0F)));
  return {node, row - to_floats(node), both(at_most(all(0.0F), row), less(row, all(last)))};
}

/// Greatest and least coordinate of a silhouette, interpolated between the neighbouring nodes.
struct Edges {
  F8 greatest, least;
};

/// Edges of the interval that holds a value; of several, none of which does, of the one nearest.
HWY_INLINE Edges edges_at(const Silhouettes& s, const Silhouette& of, const NodePlace& place,
                          F8 value) {
  static_assert(sizeof(SilhouetteNode) == 2 * sizeof(float));
  alignas(32) std::int32_t at[8];
  store(place.node + place.node, at);
  // Values of a node and the next one: greatest, least, greatest, least.
  F8 node[4];
  gather_rows(&s.nodes[of.first].greatest_m, at, node);
  const auto inside = [&](const F8(&of_nodes)[4], std::size_t k) {
    return minimum(of_nodes[k] - value, value - of_nodes[k + 1]);
  };
  for (std::uint32_t layer = 1; layer < of.layers; ++layer) {
    // The first layer has the longest intervals, which hold most values.
    if (bits(less(minimum(inside(node, 0), inside(node, 2)), all(0.0F))) == 0) break;
    F8 other[4];
    gather_rows(&s.nodes[of.first + layer * of.count].greatest_m, at, other);
    for (std::size_t k = 0; k < 4; k += 2) {
      const M8 nearer = less(inside(node, k), inside(other, k));
      node[k] = select(nearer, other[k], node[k]);
      node[k + 1] = select(nearer, other[k + 1], node[k + 1]);
    }
  }
  return {node[0] + place.share * (node[2] - node[0]), node[1] + place.share * (node[3] - node[1])};
}

HWY_INLINE Depths depths_at(const Silhouettes& s, std::size_t band, F8 x, F8 y) {
  const NodePlace row = node_place(s.along_x[band], y);
  const NodePlace column = node_place(s.along_y[band], x);
  const Edges ends = edges_at(s, s.along_x[band], row, x);
  const Edges flanks = edges_at(s, s.along_y[band], column, y);
  return {ends.greatest - x,
          x - ends.least,
          flanks.greatest - y,
          y - flanks.least,
          both(row.known, column.known),
          row.node,
          row.share,
          column.node,
          column.share};
}

/// Heights that the body takes up at places whose depths are known, m over its ground.
HWY_INLINE Edges heights_at(const Silhouettes& s, std::size_t band, const Depths& place) {
  static_assert(sizeof(HeightRange) == 2 * sizeof(float));
  const auto along = [&](std::uint32_t first, I8 node_before, F8 share) {
    alignas(32) std::int32_t at[8];
    store(node_before + node_before, at);
    // Values of a node and the next one: low, high, low, high.
    F8 node[4];
    gather_rows(&s.heights[first].low_m, at, node);
    return Edges{node[1] + share * (node[3] - node[1]), node[0] + share * (node[2] - node[0])};
  };
  const Edges row = along(s.first_height_x[band], place.row, place.row_share);
  const Edges column = along(s.first_height_y[band], place.column, place.column_share);
  return {minimum(row.greatest, column.greatest), maximum(row.least, column.least)};
}

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
