#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace crashrank::detail {

/// Smallest float that is not below x.
inline float round_up(double x) {
  const auto f = static_cast<float>(x);
  if (static_cast<double>(f) >= x) return f;
  if (!(f >= 0.0F)) return std::nextafter(f, std::numeric_limits<float>::infinity());
  // Positive floats are in the order of their bits.
  std::uint32_t bits = 0;
  std::memcpy(&bits, &f, sizeof bits);
  ++bits;
  float next = 0.0F;
  std::memcpy(&next, &bits, sizeof next);
  return next;
}

/// Centre and half extent that enclose [min, max]. Both differences are exact or rounded by 2^-53
/// relative; the factor covers that before rounding up to float.
inline void center_half(float min, float max, float& center, float& half) {
  const double lo = min;
  const double hi = max;
  center = static_cast<float>(0.5 * lo + 0.5 * hi);
  const double reach = std::max(hi - center, center - lo);
  half = round_up(reach * (1.0 + 0x1p-50));
}

}  // namespace crashrank::detail
