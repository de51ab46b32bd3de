#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace crashrank::detail {

/// Signed integer of at most `Capacity` 64-bit limbs, little-endian, without leading zero limbs.
/// Only what the exact predicates need. No allocation; cost follows the limbs in use.
template <std::size_t Capacity> struct ExactInteger {
  int sign = 0;  ///< -1, 0, 1
  std::size_t size = 0;
  std::array<std::uint64_t, Capacity> limb;  // only limb[0, size) is ever read
};

/// Limbs of a double seen as an integer multiple of another double's last bit: doubles span bit
/// weights 2^-1074 to 2^1023, 2098 bits, one more for a difference: 33 limbs.
inline constexpr std::size_t coordinate_limbs = 33;
using ExactCoordinate = ExactInteger<coordinate_limbs>;

template <std::size_t N, std::size_t M>
int compare_magnitude(const ExactInteger<N>& a, const ExactInteger<M>& b) {
  if (a.size != b.size) return a.size < b.size ? -1 : 1;
  for (std::size_t i = a.size; i-- > 0;) {
    if (a.limb[i] != b.limb[i]) return a.limb[i] < b.limb[i] ? -1 : 1;
  }
  return 0;
}

template <std::size_t N> void trim(ExactInteger<N>& a) {
  while (a.size > 0 && a.limb[a.size - 1] == 0) --a.size;
  if (a.size == 0) a.sign = 0;
}

/// a + b, or a − b when `negate_b`. The result has at most max(size) + 1 limbs, and R has to have
/// room for them.
template <std::size_t R, std::size_t N, std::size_t M>
ExactInteger<R> add(const ExactInteger<N>& a, const ExactInteger<M>& b, bool negate_b = false) {
  const int b_sign = negate_b ? -b.sign : b.sign;
  ExactInteger<R> out;
  if (a.sign == 0 || b_sign == 0) {
    out.sign = a.sign != 0 ? a.sign : b_sign;
    out.size = a.sign != 0 ? a.size : b.size;
    assert(out.size <= R);
    const std::uint64_t* from = a.sign != 0 ? a.limb.data() : b.limb.data();
    for (std::size_t i = 0; i < out.size; ++i) out.limb[i] = from[i];
    if (out.sign == 0) out.size = 0;
    return out;
  }
  if (a.sign == b_sign) {
    const std::size_t longest = a.size > b.size ? a.size : b.size;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < longest; ++i) {
      const std::uint64_t x = i < a.size ? a.limb[i] : 0;
      const std::uint64_t y = i < b.size ? b.limb[i] : 0;
      const std::uint64_t sum = x + y;
      const std::uint64_t total = sum + carry;
      carry = static_cast<std::uint64_t>(sum < x) | static_cast<std::uint64_t>(total < sum);
      out.limb[i] = total;
    }
    out.size = longest;
    if (carry != 0) {
      assert(out.size < R);
      out.limb[out.size++] = carry;
    }
    out.sign = a.sign;
    return out;
  }
  const int order = compare_magnitude(a, b);
  if (order == 0) return out;
  const std::uint64_t* large = order > 0 ? a.limb.data() : b.limb.data();
  const std::uint64_t* small = order > 0 ? b.limb.data() : a.limb.data();
  out.size = order > 0 ? a.size : b.size;
  const std::size_t small_size = order > 0 ? b.size : a.size;
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < out.size; ++i) {
    const std::uint64_t y = i < small_size ? small[i] : 0;
    const std::uint64_t difference = large[i] - y;
    out.limb[i] = difference - borrow;
    borrow =
        static_cast<std::uint64_t>(large[i] < y) | static_cast<std::uint64_t>(difference < borrow);
  }
  out.sign = order > 0 ? a.sign : b_sign;
  trim(out);
  return out;
}

/// a · b, exactly; schoolbook, sizes are one to three limbs for coordinates of like magnitude.
template <std::size_t N, std::size_t M>
ExactInteger<N + M> multiply(const ExactInteger<N>& a, const ExactInteger<M>& b) {
  ExactInteger<N + M> out;
  if (a.sign == 0 || b.sign == 0) return out;
  out.size = a.size + b.size;
  for (std::size_t i = 0; i < out.size; ++i) out.limb[i] = 0;
  for (std::size_t i = 0; i < a.size; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.size; ++j) {
      __extension__ using Wide = unsigned __int128;
      // (2^64-1)² + 2·(2^64-1) = 2^128 - 1: never overflows.
      const Wide total = static_cast<Wide>(a.limb[i]) * b.limb[j] + out.limb[i + j] + carry;
      out.limb[i + j] = static_cast<std::uint64_t>(total);
      carry = static_cast<std::uint64_t>(total >> 64U);
    }
    out.limb[i + b.size] = carry;
  }
  out.sign = a.sign * b.sign;
  trim(out);
  return out;
}

/// A finite double taken apart: value = (negative ? -1 : 1) · significand · 2^exponent, with an odd
/// significand, or 0.
struct DoubleParts {
  bool negative = false;
  std::uint64_t significand = 0;
  int exponent = 0;

  explicit DoubleParts(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    negative = (bits >> 63U) != 0;
    const int biased = static_cast<int>((bits >> 52U) & 0x7ffU);
    assert(biased != 0x7ff);
    significand = bits & ((std::uint64_t{1} << 52U) - 1);
    exponent = biased == 0 ? -1074 : biased - 1075;
    if (biased != 0) significand |= std::uint64_t{1} << 52U;
    if (significand == 0) return;
    while ((significand & 1U) == 0) {
      significand >>= 1U;
      ++exponent;
    }
  }
};

/// The integer value · 2^-unit_exponent. `unit_exponent` must not exceed the value's own last bit.
inline ExactCoordinate to_integer(const DoubleParts& parts, int unit_exponent) {
  ExactCoordinate out;
  if (parts.significand == 0) return out;
  const auto shift = static_cast<unsigned>(parts.exponent - unit_exponent);
  const std::size_t word = shift / 64;
  const unsigned bit = shift % 64;
  // 53 significant bits below 2^2098 / unit: word + 1 < coordinate_limbs.
  for (std::size_t i = 0; i < word; ++i) out.limb[i] = 0;
  out.limb[word] = parts.significand << bit;
  out.size = word + 1;
  const std::uint64_t high = bit == 0 ? 0 : parts.significand >> (64U - bit);
  if (high != 0) out.limb[out.size++] = high;
  assert(out.size <= coordinate_limbs);
  out.sign = parts.negative ? -1 : 1;
  return out;
}

/// Writes each double as an integer in one common unit, the smallest last bit among them. Signs of
/// homogeneous polynomials are then those of the integers.
template <std::size_t Count>
std::array<ExactCoordinate, Count> common_integers(const std::array<double, Count>& values) {
  int unit = 1024;
  for (const double value : values) {
    const DoubleParts parts(value);
    if (parts.significand != 0 && parts.exponent < unit) unit = parts.exponent;
  }
  std::array<ExactCoordinate, Count> out;
  for (std::size_t i = 0; i < Count; ++i) out[i] = to_integer(DoubleParts(values[i]), unit);
  return out;
}

}  // namespace crashrank::detail
