// Clusters of eight triangles against each other. Included once per target.
#if defined(CRASHRANK_TRIANGLE_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CRASHRANK_TRIANGLE_KERNEL_INL
#undef CRASHRANK_TRIANGLE_KERNEL_INL
#else
#define CRASHRANK_TRIANGLE_KERNEL_INL
#endif

#include "collide/lanes-inl.hpp"
#include "collide/wide_query.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace crashrank::detail::HWY_NAMESPACE {

/// A prepared cluster. A's keeps its coordinates; B's is transformed to A's frame and is given
/// relative to `place`, so that the rounding of its corners follows its own size and not its
/// distance from A's origin.
struct alignas(64) Prepared {
  float corner[9][8];    // of B, relative to place
  float normal[3][8];    // (c1 − c0) × (c2 − c0)
  float plane_error[8];  // of a distance from the triangle's plane times its normal, per reach, m
  float edge[8];         // largest extent of the triangle, within its corners' errors
  float low[3][8];       // box, widened by what rounding may have moved it, in A's frame
  float high[3][8];
  float own_low[4];  // the box around all of them, and one lane to spare
  float own_high[4];
  float place[3];
  float error;  // m, a relative corner of B against the coordinates that `carry` gives
  // How far apart corners of touching boxes may be beyond their triangles' sizes, and what stands
  // for `error` in errors of distances: m.
  float around;
  std::uint32_t size;
  const TriangleCluster* source;
};
static_assert(offsetof(Prepared, own_low) % 16 == 0 && offsetof(Prepared, own_high) % 16 == 0);

/// Sum over the components of u × v of the sizes of their two products: what their rounding is
/// relative to. For slivers it is far below the squared length of the longest edge.
HWY_INLINE F8 products(V8 u, V8 v) {
  const V8 p = absolute(u);
  const V8 q = absolute(v);
  return mul_add(p.x, q.y + q.z, mul_add(p.y, q.z + q.x, p.z * (q.x + q.y)));
}

/// `normal_error`: what the normal's own rounding adds to a distance, per metre of reach.
HWY_INLINE void store_shape(Prepared& p, const WideQuery& query, V8 normal, F8 normal_error, V8 low,
                            V8 high) {
  store3(normal, p.normal[0]);
  store(mul_add(sum_abs(normal), all(query.per_reach), normal_error), p.plane_error);
  const V8 extent = high - low;
  store(maximum(extent.x, maximum(extent.y, extent.z)), p.edge);
}

HWY_INLINE void store_boxes(Prepared& p, V8 low, V8 high) {
  store3(low, p.low[0]);
  store3(high, p.high[0]);
  store_least(low, p.own_low);
  store_greatest(high, p.own_high);
}

/// `child`: the cluster's entry in its node.
HWY_INLINE void prepare_a(const WideQuery& query, std::uint32_t child, Prepared& p) {
  const TriangleCluster& cluster = query.a_clusters[cluster_index(child)];
  p.size = cluster_size(child);
  p.source = &cluster;
  const float* rows = cluster.corner[0].data();
  const V8 c0 = load3(rows);
  const V8 c1 = load3(rows + 24);
  const V8 c2 = load3(rows + 48);
  const V8 low = minimum(c0, minimum(c1, c2));
  const V8 high = maximum(c0, maximum(c1, c2));
  store_boxes(p, low, high);
  const V8 e1 = c1 - c0;
  const V8 e2 = c2 - c0;
  store_shape(p, query, cross(e1, e2), all(0x1p-24F * 10.0F) * products(e1, e2), low, high);
}

/// `child`: the cluster's entry in its node; `diagonal`: twice the sum of its box's half extents.
/// Carries a cluster of B into A's frame in float, relative to the place of its first corner, which
/// is computed in double and rounded; what the rounding took away is given back to the corners.
/// With u = 2^-24 and s twice the sum of the box's half extents, which bounds the distance of any
/// two corners: x − ref is off by u·s; the rotated sum of three terms (|row| ≤ 1 + 1e-6, so its
/// absolute terms sum to at most s by Cauchy-Schwarz) by at most 7·u·s from the rounding of
/// factors, products and sums; adding the remainder, below u·|place|, by u·s more. `carry` is off
/// the real motion by its own error, and the reference place by as much. Together
/// 9·u·s + 2·carry_error; 12 is used, which leaves room for the rounding of the bound and for the
/// remainder's own rounding, u²·|place|, since carry_error holds 2^-50 of every coordinate.
HWY_INLINE void prepare_b(const WideQuery& query, std::uint32_t child, float diagonal,
                          Prepared& p) {
  const TriangleCluster& cluster = query.b_clusters[cluster_index(child)];
  p.size = cluster_size(child);
  p.source = &cluster;
  const float reference[3] = {cluster.corner[0][0], cluster.corner[1][0], cluster.corner[2][0]};
  const double x = reference[0];
  const double y = reference[1];
  const double z = reference[2];
  float remainder[3];
  float farthest = 0.0F;
  for (int i = 0; i < 3; ++i) {
    const double sum = query.pose->rotation(i, 0) * x + query.pose->rotation(i, 1) * y +
                       query.pose->rotation(i, 2) * z + query.pose->translation[i];
    p.place[i] = static_cast<float>(sum);
    remainder[i] = static_cast<float>(sum - p.place[i]);
    farthest = farthest > std::abs(p.place[i]) ? farthest : std::abs(p.place[i]);
  }
  p.error = 0x1p-24F * 12.0F * diagonal + 2.0F * query.carry_error;
  const float* r = query.body_rotation;
  const V8 r0 = all3(r);
  const V8 r1 = all3(r + 3);
  const V8 r2 = all3(r + 6);
  const V8 ref = all3(reference);
  const V8 rest = all3(remainder);
  V8 relative[3];
  V8 corner[3];
  for (std::size_t k = 0; k < 3; ++k) {
    relative[k] = load3(cluster.corner[3 * k].data()) - ref;
    corner[k] = V8{dot(r0, relative[k]), dot(r1, relative[k]), dot(r2, relative[k])} + rest;
    store3(corner[k], p.corner[3 * k]);
  }
  // Adding the place back rounds once more, and widening once.
  const F8 slack = all(p.error + 0x1p-23F * (farthest + diagonal));
  const V8 widen{slack, slack, slack};
  p.around = 0x1p-22F * (farthest + diagonal) + 4.0F * p.error + query.reach_per_error * p.error;
  const V8 to = all3(p.place);
  const V8 low = minimum(corner[0], minimum(corner[1], corner[2]));
  const V8 high = maximum(corner[0], maximum(corner[1], corner[2]));
  store_boxes(p, low + to - widen, high + to + widen);
  // The normal is made of the exact corners and turned as a whole: its error then follows the
  // triangle and not the cluster.
  const V8 e1 = load3(cluster.corner[3].data()) - load3(cluster.corner[0].data());
  const V8 e2 = load3(cluster.corner[6].data()) - load3(cluster.corner[0].data());
  const V8 n = cross(e1, e2);
  const F8 lb = maximum(max_abs(e1), max_abs(e2));
  const F8 moved = all(50.0F * query.carry_error) * (lb + all(query.carry_error));
  store_shape(p, query, V8{dot(r0, n), dot(r1, n), dot(r2, n)},
              mul_add(all(0x1p-24F * 16.0F), products(e1, e2), moved), low, high);
}

/// The corner that stands alone among three sides of a plane, none of them in it, with the other
/// two in cyclic order.
struct Turned {
  V8 c0, c1, c2;
  M8 negative;  // the lone corner is on the negative side
};
HWY_INLINE Turned turn(V8 v0, V8 v1, V8 v2, F8 d0, F8 d1, F8 d2) {
  const F8 zero = all(0.0F);
  const M8 s0 = less(d0, zero);
  const M8 s1 = less(d1, zero);
  const M8 s2 = less(d2, zero);
  const M8 not_last = differ(s0, s1);    // corners 0 and 1 differ: the lone one is 0 or 1
  const M8 not_middle = differ(s0, s2);  // 0 and 2 differ: 0 or 2
  Turned t;
  t.c0 = select(not_last, select(not_middle, v0, v1), v2);
  t.c1 = select(not_last, select(not_middle, v1, v2), v0);
  t.c2 = select(not_last, select(not_middle, v2, v0), v1);
  // The lone corner's sign is opposite to the majority's.
  const M8 majority = either(both(s0, s1), both(s2, either(s0, s1)));
  t.negative = differ(majority, less(zero, all(1.0F)));
  return t;
}

/// Calls the exact test for one pair; the corners are read where `carry` reads them.
inline bool decide(const WideQuery& query, const TriangleCluster& a, std::size_t i,
                   const TriangleCluster& b, std::size_t j, CollideWork& work) {
  ++work.exact_tests;
  Triangle ta;
  Triangle tb;
  for (std::size_t k = 0; k < 3; ++k) {
    ta.corner[k] = {a.corner[3 * k][i], a.corner[3 * k + 1][i], a.corner[3 * k + 2][i]};
    tb.corner[k] = {b.corner[3 * k][j], b.corner[3 * k + 1][j], b.corner[3 * k + 2][j]};
  }
  std::uint64_t integer_calls = 0;
  return triangles_intersect(to_double(ta), carry(*query.pose, tb), integer_calls);
}

/// Tests up to eight pairs of triangles; returns the bits of those that certainly intersect and, in
/// `unsure`, of those that floats cannot decide.
///
/// Bounds. u = 2^-24; e the error of B's relative corners, at least 12·u·s with s its cluster's
/// diagonal; la, lb the triangles' extents; Q = la + lb + what `around` holds but for its
/// last term bounds every coordinate of a difference of their corners, because their boxes overlap:
/// A's box is exact, B's is widened by its slack, which far from A's origin may be larger than the
/// triangles, and its corners and its extent are off by e each; N the normals; P the sum of the
/// sizes of the six products that a normal is made of; c what `carry` may be off the real motion; k
/// the pose's skew, the largest row sum of |RᵀR − 1|.
/// - A relative to B's place is rounded once: u·(s + Q). A corner difference w = b − a is then off
///   by e + u·(s + Q) + u·Q ≤ 1.1·e + 2·u·Q. Its product with a normal is off by |N|₁ times that
///   and, from three roundings a term, by 3.1·u·|N|₁·Q: |N|₁·(1.1·e + 5.1·u·Q).
/// - A normal made of exact corners: edges are rounded by u of themselves, their products and the
///   difference of these once more, so that all components together are off by 4.1·u·P. With w:
///   4.1·u·P·Q, of which 10 is kept for A.
/// - B's normal is turned, with four roundings a term: 4.1·u·|N|₂ a component, with w
///   12.3·u·|N|₁·Q. Turning mixes the components of its error: √3·4.1·u·P·Q ≤ 7.2·u·P·Q, of which
///   16 is kept. The normal that R gives to a turned triangle is its cofactor matrix times N, which
///   is R·N for a rotation and otherwise R·(1 − E + ½·tr E)·N to first order with |E| ≤ k: off by
///   2.6·k·|N|₂, with w 4.6·k·|N|₁·Q. Corners that `carry` moves by c a coordinate change a
///   component of the normal by at most 8.1·c·(lb + c), with w 24.3·c·(lb + c)·Q; 50 is kept.
/// - det[ea, w, eb]: six monomials of at most la·Q·lb, factors off by u·la, by 1.1·e + 2·u·Q and by
///   2·e + u·lb, and four roundings: 6·la·(lb·(1.1·e + 8·u·Q) + 2·Q·e).
/// Each is used with a factor of two to spare, which also covers the rounding of the bounds
/// themselves, plus a floor for products that vanish below the smallest float. `reach` is Q with
/// 2.2·e/k' added, the last term of `around`, k' being the query's `per_reach`, which every |N|₁ is
/// multiplied by: it then holds the 2.2·e that |N|₁ would have to be multiplied by as well.
HWY_INLINE std::uint32_t test_pairs(const Prepared& a, const Prepared& b, const std::int32_t* ia,
                                    const std::int32_t* ib, std::uint32_t valid,
                                    std::uint32_t& unsure) {
  constexpr float u = 0x1p-24F;
  const F8 floor = all(1e-30F);
  const F8 zero = all(0.0F);
  const Picker pa(ia);
  const Picker pb(ib);
  const float* rows = a.source->corner[0].data();
  const V8 to = all3(b.place);
  const V8 corner_a0 = pick3(pa, rows);
  const V8 a0 = corner_a0 - to;
  const V8 b0 = pick3(pb, b.corner[0]);
  const V8 b1 = pick3(pb, b.corner[3]);
  const V8 b2 = pick3(pb, b.corner[6]);
  const F8 la = pa(a.edge);
  const F8 lb = pb(b.edge);
  const F8 reach = la + lb + all(b.around);

  const V8 na = pick3(pa, a.normal[0]);
  const V8 w = b0 - a0;
  const F8 p0 = dot(na, w);
  const F8 p1 = dot(na, b1 - a0);
  const F8 p2 = dot(na, b2 - a0);
  const F8 plane_a = mul_add(pa(a.plane_error), reach, floor);
  // All on one side: the least above the bound, or the greatest below its negative.
  const M8 apart_a = either(less(plane_a, minimum(p0, minimum(p1, p2))),
                            less(maximum(p0, maximum(p1, p2)), zero - plane_a));
  const V8 corner_a1 = pick3(pa, rows + 24);
  const V8 corner_a2 = pick3(pa, rows + 48);
  const V8 nb = pick3(pb, b.normal[0]);
  const F8 q0 = zero - dot(nb, w);
  const F8 q1 = dot(nb, (corner_a1 - to) - b0);
  const F8 q2 = dot(nb, (corner_a2 - to) - b0);
  const F8 plane_b = mul_add(pb(b.plane_error), reach, floor);
  const M8 apart_b = either(less(plane_b, minimum(q0, minimum(q1, q2))),
                            less(maximum(q0, maximum(q1, q2)), zero - plane_b));
  const std::uint32_t crossing = valid & ~bits(either(apart_a, apart_b));
  unsure = 0;
  if (crossing == 0) return 0;
  const M8 sided = both(less(plane_a, minimum(absolute(p0), minimum(absolute(p1), absolute(p2)))),
                        less(plane_b, minimum(absolute(q0), minimum(absolute(q1), absolute(q2)))));

  const Turned ta = turn(corner_a0, corner_a1, corner_a2, q0, q1, q2);
  const Turned tb = turn(b0, b1, b2, p0, p1, p2);
  const V8 ea1 = ta.c1 - ta.c0;
  const V8 ea2 = ta.c2 - ta.c0;
  const V8 eb1 = tb.c1 - tb.c0;
  const V8 eb2 = tb.c2 - tb.c0;
  // As in triangles_intersect, with one turn for both triangles: when just one of the lone corners
  // is on a negative side the edges of B change places, and the signs follow B's.
  const M8 odd = differ(ta.negative, tb.negative);
  const V8 f1 = select(odd, eb2, eb1);
  const V8 f2 = select(odd, eb1, eb2);
  const V8 v = tb.c0 - (ta.c0 - to);
  const F8 d1 = negate_where(tb.negative, dot(ea1, cross(v, f1)));
  const F8 d2 = negate_where(tb.negative, dot(ea2, cross(v, f2)));
  const F8 bound = mul_add(la,
                           mul_add(lb, mul_add(all(96.0F * u), reach, all(14.0F * b.error)),
                                   reach * all(24.0F * b.error)),
                           floor);
  const F8 hit = minimum(zero - d1, d2);
  const std::uint32_t hits = bits(both(sided, less(bound, hit)));
  const std::uint32_t misses = bits(both(sided, less(hit, zero - bound)));
  unsure = crossing & ~(hits | misses);
  return crossing & hits;
}

/// Pairs found, gathered before they go to the caller's vector: written without a branch for every
/// single one.
class HitBuffer {
public:
  explicit HitBuffer(const WideSink& sink) : out_(sink.pairs) {}

  void add(const TriangleCluster& a, const std::int32_t* ia, const TriangleCluster& b,
           const std::int32_t* ib, std::uint32_t hits) {
    if (count_ > room - wide_lanes) flush();
    write_pairs(a.index.data(), ia, b.index.data(), ib, hits, &pairs_[count_].a);
    count_ += static_cast<std::size_t>(__builtin_popcount(hits));
  }
  void flush() {
    out_->insert(out_->end(), pairs_, pairs_ + count_);
    count_ = 0;
  }

private:
  static constexpr std::size_t room = 128;
  std::vector<Pair>* out_;
  std::size_t count_ = 0;
  Pair pairs_[room];
};

/// All pairs of two prepared clusters whose boxes overlap, eight at a time. `a_lanes` and `b_lanes`
/// are the triangles that take part, at least one each. Returns false to stop.
HWY_INLINE bool collide_clusters(const WideQuery& query, const Prepared& a, std::uint32_t a_lanes,
                                 const Prepared& b, std::uint32_t b_lanes, HitBuffer& found_pairs,
                                 CollideWork& work) {
  // At most 64 pairs; each append writes eight entries from the current end.
  alignas(32) std::int32_t ia[72];
  alignas(32) std::int32_t ib[72];
  std::size_t count = 0;
  // Where one pair is enough the order must not hang on lanes, which rounding decides at the border
  // of a box: it is another on another vector unit.
  const bool over_a =
      query.any ? a.size <= b.size : __builtin_popcount(a_lanes) <= __builtin_popcount(b_lanes);
  const Prepared& one = over_a ? a : b;
  const Prepared& eight = over_a ? b : a;
  const std::uint32_t lanes = over_a ? b_lanes : a_lanes;
  std::int32_t* ione = over_a ? ia : ib;
  std::int32_t* ieight = over_a ? ib : ia;
  const V8 low = load3(eight.low[0]);
  const V8 high = load3(eight.high[0]);
  for (std::uint32_t left = over_a ? a_lanes : b_lanes; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(__builtin_ctz(left));
    const V8 lo = spread3(one.low[0], i);
    const V8 hi = spread3(one.high[0], i);
    const M8 overlap = both(both(both(at_most(lo.x, high.x), at_most(low.x, hi.x)),
                                 both(at_most(lo.y, high.y), at_most(low.y, hi.y))),
                            both(at_most(lo.z, high.z), at_most(low.z, hi.z)));
    const std::uint32_t found = bits(overlap) & lanes;
    append_lanes(found, ieight + count);
    append_same(static_cast<std::int32_t>(i), ione + count);
    count += static_cast<std::size_t>(__builtin_popcount(found));
  }
  work.primitive_tests += count;
  if (count == 0) return true;
  append_same(0, ia + count);
  append_same(0, ib + count);
  for (std::size_t at = 0; at < count; at += 8) {
    const std::uint32_t valid = count - at >= 8 ? 0xffU : (1U << (count - at)) - 1U;
    std::uint32_t unsure = 0;
    std::uint32_t hits = test_pairs(a, b, ia + at, ib + at, valid, unsure);
    for (std::uint32_t left = unsure; left != 0; left &= left - 1) {
      const auto k = at + static_cast<std::size_t>(__builtin_ctz(left));
      if (decide(query, *a.source, static_cast<std::size_t>(ia[k]), *b.source,
                 static_cast<std::size_t>(ib[k]), work)) {
        hits |= left & (~left + 1U);
      }
    }
    if (query.any) hits &= ~hits + 1U;
    found_pairs.add(*a.source, ia + at, *b.source, ib + at, hits);
    if (query.any && hits != 0) return false;
  }
  return true;
}

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
