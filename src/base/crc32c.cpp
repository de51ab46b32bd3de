#include "base/crc32c.hpp"

#include <array>
#include <cstring>

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace crashrank::detail {
namespace {

constexpr std::uint32_t polynomial = 0x82f63b78;  // 0x1EDC6F41 with its bits turned round

using Table = std::array<std::uint32_t, 256>;

// by[k][b]: the remainder of byte b with k zero bytes behind it.
constexpr std::array<Table, 8> make_slices() {
  std::array<Table, 8> by{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t crc = b;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? polynomial : 0U);
    by[0][b] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t b = 0; b < 256; ++b) {
      by[k][b] = (by[k - 1][b] >> 8U) ^ by[0][by[k - 1][b] & 0xffU];
    }
  }
  return by;
}

constexpr std::array<Table, 8> slices = make_slices();

#if defined(__x86_64__)

// Product of two polynomials over GF(2) modulo the CRC's, bits turned round: bit 31 is x^0.
constexpr std::uint32_t multiply(std::uint32_t a, std::uint32_t b) {
  std::uint32_t product = 0;
  for (std::uint32_t bit = 1U << 31U; bit != 0; bit >>= 1U) {
    if ((a & bit) != 0) product ^= b;
    b = (b >> 1U) ^ ((b & 1U) != 0 ? polynomial : 0U);
  }
  return product;
}

constexpr std::uint32_t power_of_x(std::size_t exponent) {
  std::uint32_t result = 1U << 31U;
  std::uint32_t square = 1U << 30U;
  for (; exponent != 0; exponent >>= 1U) {
    if ((exponent & 1U) != 0) result = multiply(result, square);
    square = multiply(square, square);
  }
  return result;
}

// by[k][b]: what byte k of a remainder, being b, becomes when `bytes` zero bytes follow.
constexpr std::array<Table, 4> make_shift(std::size_t bytes) {
  const std::uint32_t factor = power_of_x(8 * bytes);
  std::array<Table, 4> by{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::uint32_t b = 0; b < 256; ++b) by[k][b] = multiply(factor, b << (8 * k));
  }
  return by;
}

// The instruction answers after three cycles and can be begun in each: three runs side by side.
constexpr std::size_t run_bytes = 2048;
constexpr std::array<Table, 4> over_one_run = make_shift(run_bytes);
constexpr std::array<Table, 4> over_two_runs = make_shift(2 * run_bytes);

std::uint32_t shifted(const std::array<Table, 4>& by, std::uint64_t crc) {
  return by[0][crc & 0xffU] ^ by[1][crc >> 8U & 0xffU] ^ by[2][crc >> 16U & 0xffU] ^
         by[3][crc >> 24U & 0xffU];
}

std::uint64_t load(const unsigned char* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

__attribute__((target("sse4.2"))) std::uint32_t crc32c_by_instruction(const unsigned char* at,
                                                                      std::size_t size,
                                                                      std::uint32_t crc) {
  std::uint64_t a = crc ^ 0xffffffffU;
  for (; size >= 3 * run_bytes; size -= 3 * run_bytes, at += 3 * run_bytes) {
    std::uint64_t b = 0;
    std::uint64_t c = 0;
    for (std::size_t i = 0; i < run_bytes; i += sizeof(std::uint64_t)) {
      a = _mm_crc32_u64(a, load(at + i));
      b = _mm_crc32_u64(b, load(at + run_bytes + i));
      c = _mm_crc32_u64(c, load(at + 2 * run_bytes + i));
    }
    a = shifted(over_two_runs, a) ^ shifted(over_one_run, b) ^ c;
  }
  for (; size >= sizeof(std::uint64_t); size -= sizeof(std::uint64_t)) {
    a = _mm_crc32_u64(a, load(at));
    at += sizeof(std::uint64_t);
  }
  auto rest = static_cast<std::uint32_t>(a);
  for (; size > 0; --size) rest = _mm_crc32_u8(rest, *at++);
  return rest ^ 0xffffffffU;
}

#endif

}  // namespace

std::uint32_t crc32c_by_tables(const void* bytes, std::size_t size, std::uint32_t crc) noexcept {
  const auto* at = static_cast<const unsigned char*>(bytes);
  crc ^= 0xffffffffU;
  for (; size >= 8; size -= 8, at += 8) {
    crc = slices[7][(crc ^ at[0]) & 0xffU] ^ slices[6][(crc >> 8U ^ at[1]) & 0xffU] ^
          slices[5][(crc >> 16U ^ at[2]) & 0xffU] ^ slices[4][crc >> 24U ^ at[3]] ^
          slices[3][at[4]] ^ slices[2][at[5]] ^ slices[1][at[6]] ^ slices[0][at[7]];
  }
  for (; size > 0; --size) crc = (crc >> 8U) ^ slices[0][(crc ^ *at++) & 0xffU];
  return crc ^ 0xffffffffU;
}

std::uint32_t crc32c(const void* bytes, std::size_t size, std::uint32_t crc) noexcept {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("sse4.2")) {
    return crc32c_by_instruction(static_cast<const unsigned char*>(bytes), size, crc);
  }
#endif
  return crc32c_by_tables(bytes, size, crc);
}

}  // namespace crashrank::detail
