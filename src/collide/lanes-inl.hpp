// Eight float lanes on any vector unit of four or eight lanes. Included once per target.
#if defined(CRASHRANK_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CRASHRANK_LANES_INL
#undef CRASHRANK_LANES_INL
#else
#define CRASHRANK_LANES_INL
#endif

#include "collide/lane_lists.hpp"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace crashrank::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 8>;
using IntTag = hn::RebindToSigned<FloatTag>;
inline constexpr std::size_t tag_lanes = hn::MaxLanes(FloatTag());
inline constexpr std::size_t vectors = 8 / tag_lanes;

struct M8 {
  hn::Mask<FloatTag> m[vectors];
};
struct F8 {
  hn::Vec<FloatTag> v[vectors];
};
/// Whole numbers.
struct I8 {
  hn::Vec<IntTag> v[vectors];
};

// The target without vectors, which highway always builds and no processor in use needs, would be
// eight times as many instructions: calls keep the compiler's time short.
#undef CRASHRANK_LANES_INLINE
#if HWY_TARGET == HWY_SCALAR
#define CRASHRANK_LANES_INLINE inline HWY_NOINLINE
#else
#define CRASHRANK_LANES_INLINE HWY_INLINE
#endif

#define CRASHRANK_EACH for (std::size_t k = 0; k < vectors; ++k)

CRASHRANK_LANES_INLINE F8 load(const float* p) {
  F8 r;
  CRASHRANK_EACH r.v[k] = hn::Load(FloatTag(), p + k * tag_lanes);
  return r;
}
CRASHRANK_LANES_INLINE void store(F8 x, float* p) {
  CRASHRANK_EACH hn::Store(x.v[k], FloatTag(), p + k * tag_lanes);
}
CRASHRANK_LANES_INLINE F8 all(float x) {
  F8 r;
  CRASHRANK_EACH r.v[k] = hn::Set(FloatTag(), x);
  return r;
}
CRASHRANK_LANES_INLINE F8 operator+(F8 a, F8 b) {
  CRASHRANK_EACH a.v[k] = hn::Add(a.v[k], b.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE F8 operator-(F8 a, F8 b) {
  CRASHRANK_EACH a.v[k] = hn::Sub(a.v[k], b.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE F8 operator*(F8 a, F8 b) {
  CRASHRANK_EACH a.v[k] = hn::Mul(a.v[k], b.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE F8 operator/(F8 a, F8 b) {
  CRASHRANK_EACH a.v[k] = hn::Div(a.v[k], b.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE I8 operator+(I8 a, I8 b) {
  CRASHRANK_EACH a.v[k] = hn::Add(a.v[k], b.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE F8 operator-(F8 a) {
  CRASHRANK_EACH a.v[k] = hn::Neg(a.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE F8 square_root(F8 a) {
  CRASHRANK_EACH a.v[k] = hn::Sqrt(a.v[k]);
  return a;
}
/// Towards zero, of numbers that an int holds.
CRASHRANK_LANES_INLINE I8 truncate(F8 a) {
  I8 r;
  CRASHRANK_EACH r.v[k] = hn::ConvertTo(IntTag(), a.v[k]);
  return r;
}
CRASHRANK_LANES_INLINE F8 to_floats(I8 a) {
  F8 r;
  CRASHRANK_EACH r.v[k] = hn::ConvertTo(FloatTag(), a.v[k]);
  return r;
}
CRASHRANK_LANES_INLINE void store(I8 x, std::int32_t* p) {
  CRASHRANK_EACH hn::Store(x.v[k], IntTag(), p + k * tag_lanes);
}
/// Four floats at each of eight places of a table, as four columns: four rows that lie together are
/// read at once, which takes a quarter of the loads of single floats. `at`: aligned to 32 bytes.
CRASHRANK_LANES_INLINE void gather_rows(const float* table, const std::int32_t* at,
                                        F8 (&column)[4]) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t c = 0; c < 4; ++c) {
    CRASHRANK_EACH column[c].v[k] = hn::Set(FloatTag(), table[at[k] + static_cast<int>(c)]);
  }
#else
  const FloatTag tag;
  const hn::CappedTag<float, 4> four;
  const hn::Repartition<std::uint64_t, FloatTag> two;
  CRASHRANK_EACH {
    // Rows r and, in wide vectors, r + 4, then transposed within each half.
    const auto row = [&](std::size_t r) {
      const std::int32_t* place = at + k * tag_lanes + r;
      const auto low = hn::LoadU(four, table + place[0]);
#if HWY_TARGET <= HWY_AVX2
      return hn::Combine(tag, hn::LoadU(four, table + place[4]), low);
#else
      return low;
#endif
    };
    const auto pairs = [&](auto a, auto b) { return hn::BitCast(two, a(tag, row(b), row(b + 1))); };
    const auto lower = [](auto d, auto x, auto y) { return hn::InterleaveLower(d, x, y); };
    const auto upper = [](auto d, auto x, auto y) { return hn::InterleaveUpper(d, x, y); };
    const auto a = pairs(lower, std::size_t{0});
    const auto b = pairs(lower, std::size_t{2});
    const auto c = pairs(upper, std::size_t{0});
    const auto d = pairs(upper, std::size_t{2});
    column[0].v[k] = hn::BitCast(tag, hn::InterleaveLower(two, a, b));
    column[1].v[k] = hn::BitCast(tag, hn::InterleaveUpper(two, a, b));
    column[2].v[k] = hn::BitCast(tag, hn::InterleaveLower(two, c, d));
    column[3].v[k] = hn::BitCast(tag, hn::InterleaveUpper(two, c, d));
  }
#endif
}
/// a·b + c, fused where the target can: every bound in this folder
/// holds either way.
CRASHRANK_LANES_INLINE F8 mul_add(F8 a, F8 b, F8 c) {
  CRASHRANK_EACH a.v[k] = hn::MulAdd(a.v[k], b.v[k], c.v[k]);
  return a;
}
/// a·b + c, fused where the target can or, for the same bits on all, rounded twice.
template <bool fused> CRASHRANK_LANES_INLINE F8 mul_add(F8 a, F8 b, F8 c) {
  return fused ? mul_add(a, b, c) : a * b + c;
}
/// a·b − c
CRASHRANK_LANES_INLINE F8 mul_sub(F8 a, F8 b, F8 c) {
  CRASHRANK_EACH a.v[k] = hn::MulSub(a.v[k], b.v[k], c.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE F8 minimum(F8 a, F8 b) {
  CRASHRANK_EACH a.v[k] = hn::Min(a.v[k], b.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE F8 maximum(F8 a, F8 b) {
  CRASHRANK_EACH a.v[k] = hn::Max(a.v[k], b.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE F8 absolute(F8 a) {
  CRASHRANK_EACH a.v[k] = hn::Abs(a.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE M8 less(F8 a, F8 b) {
  M8 r;
  CRASHRANK_EACH r.m[k] = hn::Lt(a.v[k], b.v[k]);
  return r;
}
CRASHRANK_LANES_INLINE M8 at_most(F8 a, F8 b) {
  M8 r;
  CRASHRANK_EACH r.m[k] = hn::Le(a.v[k], b.v[k]);
  return r;
}
CRASHRANK_LANES_INLINE M8 both(M8 a, M8 b) {
  CRASHRANK_EACH a.m[k] = hn::And(a.m[k], b.m[k]);
  return a;
}
CRASHRANK_LANES_INLINE M8 either(M8 a, M8 b) {
  CRASHRANK_EACH a.m[k] = hn::Or(a.m[k], b.m[k]);
  return a;
}
CRASHRANK_LANES_INLINE M8 differ(M8 a, M8 b) {
  CRASHRANK_EACH a.m[k] = hn::Xor(a.m[k], b.m[k]);
  return a;
}
/// yes where the mask is set, no elsewhere
CRASHRANK_LANES_INLINE F8 select(M8 mask, F8 yes, F8 no) {
  CRASHRANK_EACH no.v[k] = hn::IfThenElse(mask.m[k], yes.v[k], no.v[k]);
  return no;
}
CRASHRANK_LANES_INLINE F8 negate_where(M8 mask, F8 a) {
  CRASHRANK_EACH a.v[k] = hn::IfThenElse(mask.m[k], hn::Neg(a.v[k]), a.v[k]);
  return a;
}
CRASHRANK_LANES_INLINE std::uint32_t bits(M8 mask) {
  std::uint32_t out = 0;
  CRASHRANK_EACH {
    std::uint8_t byte[8] = {};
    hn::StoreMaskBits(FloatTag(), mask.m[k], byte);
    out |= static_cast<std::uint32_t>(byte[0]) << (k * tag_lanes);
  }
  return out;
}

/// Reads table[lane[i]] for eight numbers i; the lane numbers are loaded once for many tables.
struct Picker {
#if HWY_TARGET <= HWY_AVX2
  hn::Indices256<float> index;
  CRASHRANK_LANES_INLINE explicit Picker(const std::int32_t* lanes)
      : index(hn::IndicesFromVec(FloatTag(), hn::Load(IntTag(), lanes))) {}
  CRASHRANK_LANES_INLINE F8 operator()(const float* table) const {
    return {{hn::TableLookupLanes(hn::Load(FloatTag(), table), index)}};
  }
#else
  const std::int32_t* lanes;
  CRASHRANK_LANES_INLINE explicit Picker(const std::int32_t* lanes_in) : lanes(lanes_in) {}
  CRASHRANK_LANES_INLINE F8 operator()(const float* table) const {
    alignas(32) float out[8];
    for (std::size_t i = 0; i < 8; ++i) out[i] = table[lanes[i]];
    return load(out);
  }
#endif
};

/// Writes the set bits of a byte as eight numbers, lowest first, then zeros.
CRASHRANK_LANES_INLINE void append_lanes(std::uint32_t byte, std::int32_t* out) {
  using ByteTag = hn::Rebind<std::uint8_t, IntTag>;
  const std::uint8_t* list = lane_lists.of[byte].data();
  CRASHRANK_EACH {
    hn::StoreU(hn::PromoteTo(IntTag(), hn::Load(ByteTag(), list + k * tag_lanes)), IntTag(),
               out + k * tag_lanes);
  }
}
CRASHRANK_LANES_INLINE void append_same(std::int32_t value, std::int32_t* out) {
  CRASHRANK_EACH hn::StoreU(hn::Set(IntTag(), value), IntTag(), out + k * tag_lanes);
}

/// Writes (a[ia[k]], b[ib[k]]) for every set bit k of `which`, one after the other; eight pairs of
/// room are used whatever is set.
CRASHRANK_LANES_INLINE void write_pairs(const std::uint32_t* a, const std::int32_t* ia,
                                        const std::uint32_t* b, const std::int32_t* ib,
                                        std::uint32_t which, std::int32_t* out) {
#if HWY_TARGET <= HWY_AVX2
  alignas(32) std::int32_t set[8];
  append_lanes(which, set);
  const auto chosen = hn::IndicesFromVec(IntTag(), hn::Load(IntTag(), set));
  const auto pick = [&](const std::uint32_t* table, const std::int32_t* lanes) {
    const auto index = hn::IndicesFromVec(IntTag(), hn::Load(IntTag(), lanes));
    const auto all_eight = hn::BitCast(IntTag(), hn::Load(hn::RebindToUnsigned<IntTag>(), table));
    return hn::TableLookupLanes(hn::TableLookupLanes(all_eight, index), chosen);
  };
  hn::StoreInterleaved2(pick(a, ia), pick(b, ib), IntTag(), out);
#else
  for (std::uint32_t left = which; left != 0; left &= left - 1) {
    const int k = __builtin_ctz(left);
    *out++ = static_cast<std::int32_t>(a[ia[k]]);
    *out++ = static_cast<std::int32_t>(b[ib[k]]);
  }
#endif
}

/// Three coordinates of eight points or directions; in memory three rows of eight.
struct V8 {
  F8 x, y, z;
};
CRASHRANK_LANES_INLINE V8 operator+(V8 a, V8 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
CRASHRANK_LANES_INLINE V8 operator-(V8 a, V8 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
CRASHRANK_LANES_INLINE F8 dot(V8 a, V8 b) {
  return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
CRASHRANK_LANES_INLINE V8 cross(V8 a, V8 b) {
  return {mul_sub(a.y, b.z, a.z * b.y), mul_sub(a.z, b.x, a.x * b.z), mul_sub(a.x, b.y, a.y * b.x)};
}
CRASHRANK_LANES_INLINE V8 minimum(V8 a, V8 b) {
  return {minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)};
}
CRASHRANK_LANES_INLINE V8 maximum(V8 a, V8 b) {
  return {maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z)};
}
CRASHRANK_LANES_INLINE V8 select(M8 mask, V8 yes, V8 no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
CRASHRANK_LANES_INLINE V8 absolute(V8 a) { return {absolute(a.x), absolute(a.y), absolute(a.z)}; }
CRASHRANK_LANES_INLINE F8 sum_abs(V8 a) { return absolute(a.x) + absolute(a.y) + absolute(a.z); }
CRASHRANK_LANES_INLINE F8 max_abs(V8 a) {
  return maximum(absolute(a.x), maximum(absolute(a.y), absolute(a.z)));
}
CRASHRANK_LANES_INLINE V8 all3(const float* p) { return {all(p[0]), all(p[1]), all(p[2])}; }
CRASHRANK_LANES_INLINE V8 load3(const float* rows) {
  return {load(rows), load(rows + 8), load(rows + 16)};
}
CRASHRANK_LANES_INLINE void store3(V8 v, float* rows) {
  store(v.x, rows);
  store(v.y, rows + 8);
  store(v.z, rows + 16);
}
CRASHRANK_LANES_INLINE V8 pick3(const Picker& pick, const float* rows) {
  return {pick(rows), pick(rows + 8), pick(rows + 16)};
}
/// Folds each coordinate's eight lanes into one, of three floats and one to spare. `fold`: the
/// least or the greatest of two vectors, lane by lane.
template <class Fold> CRASHRANK_LANES_INLINE void store_folded(V8 v, const Fold& fold, float* out) {
  const FloatTag tag;
  const auto one = [&](F8 x) {
    auto folded = x.v[0];
    for (std::size_t k = 1; k < vectors; ++k) folded = fold(folded, x.v[k]);
    return folded;
  };
  const auto x = one(v.x);
  const auto y = one(v.y);
  const auto z = one(v.z);
#if HWY_TARGET == HWY_SCALAR
  hn::Store(x, tag, out);
  hn::Store(y, tag, out + 1);
  hn::Store(z, tag, out + 2);
#else
  // Lanes of x and y in turn and of z beside itself, then all three in turn.
  const hn::Repartition<std::uint64_t, FloatTag> two;
  const auto xy =
      hn::BitCast(two, fold(hn::InterleaveLower(tag, x, y), hn::InterleaveUpper(tag, x, y)));
  const auto zz =
      hn::BitCast(two, fold(hn::InterleaveLower(tag, z, z), hn::InterleaveUpper(tag, z, z)));
  const auto xyz = fold(hn::BitCast(tag, hn::InterleaveLower(two, xy, zz)),
                        hn::BitCast(tag, hn::InterleaveUpper(two, xy, zz)));
  const hn::CappedTag<float, 4> four;
  if constexpr (tag_lanes == 8) {
    hn::Store(fold(hn::LowerHalf(four, xyz), hn::UpperHalf(four, xyz)), four, out);
  } else {
    hn::Store(xyz, four, out);
  }
#endif
}
/// The least, or the greatest, of each coordinate into the first three of four floats at a multiple
/// of 16 bytes.
CRASHRANK_LANES_INLINE void store_least(V8 v, float* out) {
  store_folded(
      v, [](auto a, auto b) { return hn::Min(a, b); }, out);
}
CRASHRANK_LANES_INLINE void store_greatest(V8 v, float* out) {
  store_folded(
      v, [](auto a, auto b) { return hn::Max(a, b); }, out);
}
/// One entry of three rows in all lanes.
CRASHRANK_LANES_INLINE V8 spread3(const float* rows, std::size_t lane) {
  return {all(rows[lane]), all(rows[8 + lane]), all(rows[16 + lane])};
}

#undef CRASHRANK_EACH

}  // namespace crashrank::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
