#pragma once

#include <cstddef>
#include <cstdint>

namespace crashrank::detail {

/// CRC-32C (Castagnoli) of some bytes, as in RFC 3720, section 12.1: reflected, polynomial
/// 0x1EDC6F41, begun with and ended by inverting all bits. `crc` is that of the bytes before, so
/// that pieces can be added one after the other. Finds every burst of up to 32 wrong bits. Uses the
/// processor's instruction where there is one; the value is the same.
std::uint32_t crc32c(const void* bytes, std::size_t size, std::uint32_t crc = 0) noexcept;

/// The same without the processor's instruction.
std::uint32_t crc32c_by_tables(const void* bytes, std::size_t size, std::uint32_t crc = 0) noexcept;

}  // namespace crashrank::detail
