// Eight boxes against eight, and the descent of two wide trees. Included once per target.
#if defined(CRASHRANK_BOX_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CRASHRANK_BOX_KERNEL_INL
#undef CRASHRANK_BOX_KERNEL_INL
#else
#define CRASHRANK_BOX_KERNEL_INL
#endif

#include "collide/lanes-inl.hpp"
#include "collide/triangle_kernel-inl.hpp"
#include "collide/wide_query.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace crashrank::detail::HWY_NAMESPACE {

/// Eight boxes as centres and half extents.
struct Boxes {
  V8 center, half;
};

HWY_INLINE Boxes load_boxes(const WideNode& node) {
  return {load3(node.center[0].data()), load3(node.half[0].data())};
}

/// Boxes of one frame enclosed in boxes of the other. `r` row-major, `s` its absolute values.
template <bool fused>
HWY_INLINE Boxes turn_boxes(const Boxes& boxes, const float* r, const float* s, const float* t,
                            float margin) {
  const V8& c = boxes.center;
  const V8& h = boxes.half;
  const F8 m = all(margin);
  const auto sum = [](const float* row, const V8& v, F8 last) {
    return mul_add<fused>(all(row[0]), v.x,
                          mul_add<fused>(all(row[1]), v.y, mul_add<fused>(all(row[2]), v.z, last)));
  };
  return {{sum(r, c, all(t[0])), sum(r + 3, c, all(t[1])), sum(r + 6, c, all(t[2]))},
          {sum(s, h, m), sum(s + 3, h, m), sum(s + 6, h, m)}};
}
/// The same with the transposed rotation.
template <bool fused>
HWY_INLINE Boxes turn_boxes_back(const Boxes& boxes, const float* r, const float* s, const float* t,
                                 float margin) {
  const float rt[9] = {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
  const float st[9] = {s[0], s[3], s[6], s[1], s[4], s[7], s[2], s[5], s[8]};
  return turn_boxes<fused>(boxes, rt, st, t, margin);
}

HWY_INLINE M8 overlap(const Boxes& p, const Boxes& q) {
  const V8 apart = absolute(p.center - q.center);
  const V8 reach = p.half + q.half;
  return both(both(at_most(apart.x, reach.x), at_most(apart.y, reach.y)),
              at_most(apart.z, reach.z));
}

/// How far overlapping boxes reach into each other, along the axis where they do so least.
HWY_INLINE F8 penetration(const Boxes& p, const Boxes& q) {
  const V8 depth = (p.half + q.half) - absolute(p.center - q.center);
  return minimum(depth.x, minimum(depth.y, depth.z));
}

HWY_INLINE std::size_t lowest(std::uint32_t mask) {
  return static_cast<std::size_t>(__builtin_ctz(mask));
}

/// Boxes in memory, for reading one at a time.
struct alignas(64) StoredBoxes {
  float center[3][8];
  float half[3][8];
};
HWY_INLINE void store_boxes(const Boxes& boxes, StoredBoxes& out) {
  store3(boxes.center, out.center[0]);
  store3(boxes.half, out.half[0]);
}
HWY_INLINE Boxes spread_box(const float* center, const float* half, std::size_t lane) {
  return {spread3(center, lane), spread3(half, lane)};
}

/// Clusters of each body that are kept ready. Twice as many are found ready a little more often and
/// crowd everything else out of the first cache.
inline constexpr std::size_t prepared_kept = 16;

/// Pairs of clusters that wait while their corners come from memory. A step adds at most 64.
inline constexpr std::size_t cluster_pairs_wait = 32;
inline constexpr std::size_t max_cluster_pairs = cluster_pairs_wait + 64;

/// Two clusters whose boxes overlap, by their entries in `WideNode::child`.
struct ClusterPair {
  std::uint32_t a;
  std::uint32_t b;
  float b_diagonal;  // m, bounds the distance of any two corners of B's
};

template <class T> HWY_INLINE void prefetch(const T& value) {
  const char* line = reinterpret_cast<const char*>(&value);
  for (std::size_t at = 0; at < sizeof(T); at += 64) __builtin_prefetch(line + at);
}

/// Bit r of the result: whether row r of an 8 by 8 matrix of bits has column c.
HWY_INLINE std::uint32_t column(std::uint64_t rows, std::size_t c) {
  return static_cast<std::uint32_t>(((rows >> c) & 0x0101010101010101U) * 0x0102040810204080U >>
                                    56U);
}

/// The descent of two wide trees.
class Descent {
public:
  Descent(const WideQuery& query, WideSink& sink) : query_(query), hits_(sink), work_(sink.work) {
    stack_ = sink.stack;
    stack_size_ = sink.stack_size;
    std::fill_n(a_kept_, prepared_kept, no_cluster);
    std::fill_n(b_kept_, prepared_kept, no_cluster);
  }

  /// Works off all lane pairs below `start`.
  void run(const WideTask& start) {
    push(start);
    while (waiting_ != 0) {
      const WideTask task = stack_[--waiting_];
      // Which pair is found first is the same on every target: boxes by which the order of tasks is
      // chosen are rounded alike, and `collide_clusters` lists triangles in an order of its own.
      if (query_.any) {
        step<true>(task);
      } else {
        step<false>(task);
      }
      // Where one pair is enough the clusters at hand come first.
      if (pairs_ < (query_.any ? 1 : cluster_pairs_wait)) continue;
      if (!collide_waiting()) return;
    }
    collide_waiting();
  }
  /// Hands over what is left.
  void finish(WideSink& sink) {
    hits_.flush();
    sink.work = work_;
  }

private:
  static constexpr std::uint32_t no_cluster = 0;  // no entry of a cluster is 0
  static constexpr float no_penetration = -1e30F;

  /// Lanes of a node of A against lanes of a node of B. `any`: one pair is enough.
  template <bool any> void step(const WideTask& task) {
    const WideNode& na = query_.a_nodes[task.a_node];
    const WideNode& nb = query_.b_nodes[task.b_node];
    const Boxes a = load_boxes(na);
    const Boxes b = load_boxes(nb);
    const Boxes b_in_a =
        turn_boxes<!any>(b, query_.rotation, query_.abs_rotation, query_.a_from_b, query_.margin_a);
    std::uint32_t a_lanes = task.a_lanes & na.used_lanes;
    std::uint32_t b_lanes = task.b_lanes & nb.used_lanes;
    if ((a_lanes & (a_lanes - 1)) != 0) {  // more than one: the box around all may reject some of B
      work_.bv_tests += 8;
      const Boxes own{all3(na.own_center.data()), all3(na.own_half.data())};
      b_lanes &= bits(overlap(own, b_in_a));
      if (b_lanes == 0) return;
    }
    const Boxes a_in_b = turn_boxes_back<!any>(a, query_.rotation, query_.abs_rotation,
                                               query_.b_from_a, query_.margin_b);
    if ((b_lanes & (b_lanes - 1)) != 0) {
      work_.bv_tests += 8;
      const Boxes own{all3(nb.own_center.data()), all3(nb.own_half.data())};
      a_lanes &= bits(overlap(own, a_in_b));
      if (a_lanes == 0) return;
    }
    if (__builtin_popcount(a_lanes) <= __builtin_popcount(b_lanes)) {
      descend<any, true>(task, na, nb,
                         overlaps_of<any>(na, a_in_b, a_lanes, b, b_in_a, b_lanes, nb.leaf_lanes));
    } else {
      descend<any, false>(task, nb, na,
                          overlaps_of<any>(nb, b_in_a, b_lanes, a, a_in_b, a_lanes, na.leaf_lanes));
    }
  }

  /// Which lanes of one node, the rows, overlap which of the other, the columns, by what they are.
  struct Overlaps {
    std::uint64_t clusters = 0;  ///< two clusters
    std::uint64_t nodes = 0;     ///< two inner nodes
    std::uint64_t cluster_node = 0;
    std::uint64_t node_cluster = 0;
  };

  /// `one_turned`: boxes of the rows in the other frame. `other`, `other_turned`: boxes of the
  /// columns.
  template <bool any>
  HWY_INLINE Overlaps overlaps_of(const WideNode& one, const Boxes& one_turned,
                                  std::uint32_t one_lanes, const Boxes& other,
                                  const Boxes& other_turned, std::uint32_t other_lanes,
                                  std::uint32_t other_leaves) {
    store_boxes(one_turned, turned_);
    Overlaps overlaps;
    for (std::uint32_t left = one_lanes; left != 0; left &= left - 1) {
      const auto i = lowest(left);
      work_.bv_tests += 8;
      const Boxes own = spread_box(one.center[0].data(), one.half[0].data(), i);
      const Boxes turned = spread_box(turned_.center[0], turned_.half[0], i);
      const std::uint32_t found =
          bits(both(overlap(own, other_turned), overlap(turned, other))) & other_lanes;
      if (any) {
        store(minimum(penetration(own, other_turned), penetration(turned, other)), penetration_[i]);
      }
      const std::uint32_t is_leaf = 0U - (one.leaf_lanes >> i & 1U);
      const std::uint64_t leaves = found & other_leaves;
      const std::uint64_t inner = found & ~other_leaves;
      overlaps.clusters |= (leaves & is_leaf) << 8 * i;
      overlaps.cluster_node |= (inner & is_leaf) << 8 * i;
      overlaps.node_cluster |= (leaves & ~is_leaf) << 8 * i;
      overlaps.nodes |= (inner & ~is_leaf) << 8 * i;
    }
    return overlaps;
  }

  template <bool any, bool a_rows>
  HWY_INLINE void descend(const WideTask& task, const WideNode& one, const WideNode& other,
                          const Overlaps& overlaps) {
    const std::uint32_t row_node = a_rows ? task.a_node : task.b_node;
    const std::uint32_t column_node = a_rows ? task.b_node : task.a_node;
    const auto put = [this](std::uint32_t row, std::uint32_t row_lanes, std::uint32_t col,
                            std::uint32_t col_lanes) {
      push(a_rows ? WideTask{row, col, row_lanes, col_lanes}
                  : WideTask{col, row, col_lanes, row_lanes});
    };
    // A cluster's box is not tested again: all clusters that overlap one inner node go with it.
    for (std::uint64_t left = overlaps.cluster_node; left != 0;) {
      const std::size_t c = static_cast<std::size_t>(__builtin_ctzll(left)) & 7U;
      const std::uint32_t child = other.child[c];
      prefetch((a_rows ? query_.b_nodes : query_.a_nodes)[child]);
      put(row_node, column(left, c), child, 0xffU);
      left &= ~(0x0101010101010101U << c);
    }
    for (std::uint64_t left = overlaps.node_cluster; left != 0;) {
      const std::size_t r = static_cast<std::size_t>(__builtin_ctzll(left)) >> 3U;
      const std::uint32_t child = one.child[r];
      prefetch((a_rows ? query_.a_nodes : query_.b_nodes)[child]);
      put(child, 0xffU, column_node, static_cast<std::uint32_t>(left >> 8 * r) & 0xffU);
      left &= ~(std::uint64_t{0xff} << 8 * r);
    }
    std::size_t first = waiting_;
    float deepest = no_penetration;
    for (std::uint64_t left = overlaps.nodes; left != 0; left &= left - 1) {
      const auto at = static_cast<std::size_t>(__builtin_ctzll(left));
      const std::uint32_t row = one.child[at >> 3U];
      const std::uint32_t col = other.child[at & 7U];
      prefetch(query_.a_nodes[a_rows ? row : col]);
      prefetch(query_.b_nodes[a_rows ? col : row]);
      if (any && penetration_[at >> 3U][at & 7U] > deepest) {
        deepest = penetration_[at >> 3U][at & 7U];
        first = waiting_;
      }
      put(row, 0xffU, col, 0xffU);
    }
    // Where one pair is enough, what reaches deepest into the other comes first.
    if (any && overlaps.nodes != 0) std::swap(stack_[first], stack_[waiting_ - 1]);
    const std::size_t before = pairs_;
    first = pairs_;
    deepest = no_penetration;
    for (std::uint64_t left = overlaps.clusters; left != 0; left &= left - 1) {
      const auto at = static_cast<std::size_t>(__builtin_ctzll(left));
      const std::uint32_t row = one.child[at >> 3U];
      const std::uint32_t col = other.child[at & 7U];
      const WideNode& nb = a_rows ? other : one;
      const std::size_t lane = a_rows ? at & 7U : at >> 3U;
      const ClusterPair pair{a_rows ? row : col, a_rows ? col : row,
                             2.001F * (nb.half[0][lane] + nb.half[1][lane] + nb.half[2][lane])};
      prefetch(query_.a_clusters[cluster_index(pair.a)]);
      prefetch(query_.b_clusters[cluster_index(pair.b)]);
      if (any && penetration_[at >> 3U][at & 7U] > deepest) {
        deepest = penetration_[at >> 3U][at & 7U];
        first = pairs_;
      }
      cluster_pairs_[pairs_++] = pair;
    }
    if (any && overlaps.clusters != 0) std::swap(cluster_pairs_[first], cluster_pairs_[before]);
  }

  /// Returns false to stop.
  bool collide_waiting() {
    const std::size_t count = pairs_;
    pairs_ = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const ClusterPair& pair = cluster_pairs_[k];
      const Prepared& a = prepared_a(pair.a);
      const Prepared& b = prepared_b(pair);
      // Triangles outside the other cluster's box take no part.
      const std::uint32_t a_lanes = inside(a, b) & ((1U << a.size) - 1U);
      const std::uint32_t b_lanes = inside(b, a) & ((1U << b.size) - 1U);
      if (a_lanes == 0 || b_lanes == 0) continue;
      if (!collide_clusters(query_, a, a_lanes, b, b_lanes, hits_, work_)) return false;
    }
    return true;
  }

  HWY_INLINE const Prepared& prepared_a(std::uint32_t child) {
    const std::size_t slot = child % prepared_kept;
    if (a_kept_[slot] != child) {
      prepare_a(query_, child, a_prepared_[slot]);
      a_kept_[slot] = child;
    }
    return a_prepared_[slot];
  }
  HWY_INLINE const Prepared& prepared_b(const ClusterPair& pair) {
    const std::size_t slot = pair.b % prepared_kept;
    if (b_kept_[slot] != pair.b) {
      prepare_b(query_, pair.b, pair.b_diagonal, b_prepared_[slot]);
      b_kept_[slot] = pair.b;
    }
    return b_prepared_[slot];
  }

  /// Which triangles of one cluster are inside the box around the other.
  static HWY_INLINE std::uint32_t inside(const Prepared& p, const Prepared& other) {
    const V8 low = all3(other.own_low);
    const V8 high = all3(other.own_high);
    const V8 lo = load3(p.low[0]);
    const V8 hi = load3(p.high[0]);
    return bits(both(both(both(at_most(lo.x, high.x), at_most(low.x, hi.x)),
                          both(at_most(lo.y, high.y), at_most(low.y, hi.y))),
                     both(at_most(lo.z, high.z), at_most(low.z, hi.z))));
  }

  HWY_INLINE void push(const WideTask& task) {
    assert(waiting_ < stack_size_);
    stack_[waiting_++] = task;
  }

  const WideQuery& query_;
  HitBuffer hits_;
  CollideWork work_;
  WideTask* stack_;
  std::size_t stack_size_;
  std::size_t waiting_ = 0;
  std::size_t pairs_ = 0;
  StoredBoxes turned_;
  alignas(64) float penetration_[8][8];  // of rows and columns, where one pair is enough
  ClusterPair cluster_pairs_[max_cluster_pairs];
  // Clusters made ready, by the last bits of their index: neighbours in the tree, which meet the
  // same clusters of the other body, have neighbouring indices.
  std::uint32_t a_kept_[prepared_kept];
  std::uint32_t b_kept_[prepared_kept];
  Prepared a_prepared_[prepared_kept];
  Prepared b_prepared_[prepared_kept];
};

inline void wide_traverse(const WideQuery& query, const WideTask& start, WideSink& sink) {
  Descent descent(query, sink);
  descent.run(start);
  descent.finish(sink);
}

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
