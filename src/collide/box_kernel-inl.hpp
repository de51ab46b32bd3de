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
HWY_INLINE Boxes turn_boxes(const Boxes& boxes, const float* r, const float* s, const float* t,
                            float margin) {
  const V8& c = boxes.center;
  const V8& h = boxes.half;
  const F8 m = all(margin);
  Boxes out;
  out.center.x =
      mul_add(all(r[0]), c.x, mul_add(all(r[1]), c.y, mul_add(all(r[2]), c.z, all(t[0]))));
  out.center.y =
      mul_add(all(r[3]), c.x, mul_add(all(r[4]), c.y, mul_add(all(r[5]), c.z, all(t[1]))));
  out.center.z =
      mul_add(all(r[6]), c.x, mul_add(all(r[7]), c.y, mul_add(all(r[8]), c.z, all(t[2]))));
  out.half.x = mul_add(all(s[0]), h.x, mul_add(all(s[1]), h.y, mul_add(all(s[2]), h.z, m)));
  out.half.y = mul_add(all(s[3]), h.x, mul_add(all(s[4]), h.y, mul_add(all(s[5]), h.z, m)));
  out.half.z = mul_add(all(s[6]), h.x, mul_add(all(s[7]), h.y, mul_add(all(s[8]), h.z, m)));
  return out;
}
/// The same with the transposed rotation.
HWY_INLINE Boxes turn_boxes_back(const Boxes& boxes, const float* r, const float* s, const float* t,
                                 float margin) {
  const float rt[9] = {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
  const float st[9] = {s[0], s[3], s[6], s[1], s[4], s[7], s[2], s[5], s[8]};
  return turn_boxes(boxes, rt, st, t, margin);
}

HWY_INLINE M8 overlap(const Boxes& p, const Boxes& q) {
  const V8 apart = absolute(p.center - q.center);
  const V8 reach = p.half + q.half;
  return both(both(at_most(apart.x, reach.x), at_most(apart.y, reach.y)),
              at_most(apart.z, reach.z));
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

/// One step: lanes of a node of A against lanes of a node of B.
class Step {
public:
  Step(const WideQuery& query, WideSink& sink) : query_(query), sink_(sink) {
    std::fill_n(a_kept_, prepared_kept, max_clusters);
    std::fill_n(b_kept_, prepared_kept, max_clusters);
  }

  /// Returns false to stop.
  bool run(const WideTask& task, std::size_t& waiting) {
    const WideNode& na = query_.a_nodes[task.a_node];
    const WideNode& nb = query_.b_nodes[task.b_node];
    const Boxes a = load_boxes(na);
    const Boxes b = load_boxes(nb);
    const Boxes b_in_a =
        turn_boxes(b, query_.rotation, query_.abs_rotation, query_.a_from_b, query_.margin_a);
    std::uint32_t a_lanes = task.a_lanes;
    std::uint32_t b_lanes = task.b_lanes;
    if ((a_lanes & (a_lanes - 1)) != 0) {  // more than one: the box around all may reject some of B
      sink_.work.bv_tests += 8;
      const Boxes own{all3(na.own_center.data()), all3(na.own_half.data())};
      b_lanes &= bits(overlap(own, b_in_a));
      if (b_lanes == 0) return true;
    }
    const Boxes a_in_b =
        turn_boxes_back(a, query_.rotation, query_.abs_rotation, query_.b_from_a, query_.margin_b);
    if ((b_lanes & (b_lanes - 1)) != 0) {
      sink_.work.bv_tests += 8;
      const Boxes own{all3(nb.own_center.data()), all3(nb.own_half.data())};
      a_lanes &= bits(overlap(own, a_in_b));
      if (a_lanes == 0) return true;
    }
    store_boxes(b_in_a, b_in_a_);
    std::uint32_t partners[8];  // of each lane of A
    if (__builtin_popcount(a_lanes) <= __builtin_popcount(b_lanes)) {
      store_boxes(a_in_b, a_in_b_);
      for (std::uint32_t left = a_lanes; left != 0; left &= left - 1) {
        const auto i = lowest(left);
        sink_.work.bv_tests += 8;
        const Boxes one = spread_box(na.center[0].data(), na.half[0].data(), i);
        const Boxes turned = spread_box(a_in_b_.center[0], a_in_b_.half[0], i);
        partners[i] = bits(both(overlap(one, b_in_a), overlap(turned, b))) & b_lanes;
      }
    } else {
      for (std::uint32_t left = a_lanes; left != 0; left &= left - 1) {
        partners[lowest(left)] = 0;
      }
      for (std::uint32_t left = b_lanes; left != 0; left &= left - 1) {
        const auto j = lowest(left);
        sink_.work.bv_tests += 8;
        const Boxes one = spread_box(nb.center[0].data(), nb.half[0].data(), j);
        const Boxes turned = spread_box(b_in_a_.center[0], b_in_a_.half[0], j);
        std::uint32_t found = bits(both(overlap(one, a_in_b), overlap(turned, a))) & a_lanes;
        for (; found != 0; found &= found - 1) partners[lowest(found)] |= 1U << j;
      }
    }
    return descend(task, na, a_lanes, nb, partners, a_in_b, waiting);
  }

private:
  bool descend(const WideTask& task, const WideNode& na, std::uint32_t a_lanes, const WideNode& nb,
               const std::uint32_t* partners, const Boxes& a_in_b, std::size_t& waiting) {
    std::uint32_t leaf_rows = 0;
    for (std::uint32_t left = a_lanes; left != 0; left &= left - 1) {
      const auto i = lowest(left);
      const std::uint32_t found = partners[i];
      const std::uint32_t leaves = found & nb.leaf_lanes;
      const std::uint32_t inner = found & ~nb.leaf_lanes;
      if ((na.leaf_lanes >> i & 1U) != 0) {
        if (leaves != 0) {
          leaf_rows |= 1U << i;
          __builtin_prefetch(&query_.a_clusters[cluster_index(na.child[i])]);
        }
        for (std::uint32_t j = inner; j != 0; j &= j - 1) {
          const std::uint32_t child = nb.child[lowest(j)];
          push({task.a_node, child, 1U << i, query_.b_nodes[child].used_lanes}, waiting);
        }
      } else {
        const std::uint32_t child = na.child[i];
        const std::uint32_t used = query_.a_nodes[child].used_lanes;
        if (leaves != 0) push({child, task.b_node, used, leaves}, waiting);
        for (std::uint32_t j = inner; j != 0; j &= j - 1) {
          const std::uint32_t other = nb.child[lowest(j)];
          push({child, other, used, query_.b_nodes[other].used_lanes}, waiting);
        }
      }
    }
    if (leaf_rows == 0) return true;
    return leaves(na, leaf_rows, nb, partners, a_in_b);
  }

  bool leaves(const WideNode& na, std::uint32_t rows, const WideNode& nb,
              const std::uint32_t* partners, const Boxes&) {
    for (; rows != 0; rows &= rows - 1) {
      const auto i = static_cast<std::size_t>(lowest(rows));
      const Prepared& a = prepared_a(na, i);
      for (std::uint32_t left = partners[i] & nb.leaf_lanes; left != 0; left &= left - 1) {
        const auto j = lowest(left);
        const Prepared& b = prepared_b(nb, j);
        std::uint32_t ta = (1U << a.size) - 1U;
        std::uint32_t tb = (1U << b.size) - 1U;
        if (query_.body_boxes) {
          // Triangles outside the other cluster's box take no part.
          ta &= inside(a, spread_box(b_in_a_.center[0], b_in_a_.half[0], j));
          if (ta == 0) continue;
          tb &= inside(b, spread_box(na.center[0].data(), na.half[0].data(), i));
          if (tb == 0) continue;
        }
        if (!collide_clusters(query_, a, ta, b, tb, sink_)) return false;
      }
    }
    return true;
  }

  HWY_INLINE const Prepared& prepared_a(const WideNode& node, std::size_t lane) {
    const std::uint32_t cluster = cluster_index(node.child[lane]);
    const std::size_t slot = cluster % prepared_kept;
    if (a_kept_[slot] != cluster) {
      prepare_a(query_, node, lane, a_prepared_[slot]);
      a_kept_[slot] = cluster;
    }
    return a_prepared_[slot];
  }
  HWY_INLINE const Prepared& prepared_b(const WideNode& node, std::size_t lane) {
    const std::uint32_t cluster = cluster_index(node.child[lane]);
    const std::size_t slot = cluster % prepared_kept;
    if (b_kept_[slot] != cluster) {
      prepare_b(query_, node, lane, b_prepared_[slot]);
      b_kept_[slot] = cluster;
    }
    return b_prepared_[slot];
  }

  static HWY_INLINE std::uint32_t inside(const Prepared& p, const Boxes& box) {
    const V8 low = box.center - box.half;
    const V8 high = box.center + box.half;
    const V8 lo = load3(p.low[0]);
    const V8 hi = load3(p.high[0]);
    return bits(both(both(both(at_most(lo.x, high.x), at_most(low.x, hi.x)),
                          both(at_most(lo.y, high.y), at_most(low.y, hi.y))),
                     both(at_most(lo.z, high.z), at_most(low.z, hi.z))));
  }

  void push(const WideTask& task, std::size_t& waiting) {
    assert(waiting < sink_.stack_size);
    sink_.stack[waiting++] = task;
  }

  const WideQuery& query_;
  WideSink& sink_;
  StoredBoxes a_in_b_;
  StoredBoxes b_in_a_;
  // Clusters made ready, by the last bits of their index: neighbours in the tree, which meet the
  // same clusters of the other body, have neighbouring indices.
  std::uint32_t a_kept_[prepared_kept];
  std::uint32_t b_kept_[prepared_kept];
  Prepared a_prepared_[prepared_kept];
  Prepared b_prepared_[prepared_kept];
};

/// Works off all lane pairs below `start`.
inline void wide_traverse(const WideQuery& query, const WideTask& start, WideSink& sink) {
  Step step(query, sink);
  std::size_t waiting = 0;
  sink.stack[waiting++] = start;
  while (waiting != 0) {
    const WideTask task = sink.stack[--waiting];
    if (!step.run(task, waiting)) return;
  }
}

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
