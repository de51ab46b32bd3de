#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

// What crashrank-import writes to its standard output. Both ends are of one build and run on one
// machine: numbers are in its byte order.
//
//   Header
//   status ok:     warnings, each Text
//                  parts, each u32 triangle count and Text name
//                  vertices, each 3 x f32
//                  triangles, each 3 x u32
//   status failed: place, reason, remedy, each Text
//   u64 import_trailer
//
// Text is u32 length and that many bytes.
namespace crashrank::detail {

inline constexpr std::array<char, 8> import_magic{'c', 'r', 'm', 'e', 's', 'h', '\r', '\n'};
inline constexpr std::uint32_t import_version = 1;
inline constexpr std::uint64_t import_trailer = 0x6873656d646e6521U;
inline constexpr std::size_t max_import_text = 4096;
inline constexpr std::size_t max_import_warnings = 32;

enum class ImportStatus : std::uint32_t { ok = 0, bad_input = 1, limit_exceeded = 2, internal = 3 };

struct ImportHeader {
  std::array<char, 8> magic = import_magic;
  std::uint32_t version = import_version;
  ImportStatus status = ImportStatus::ok;
  std::uint64_t warnings = 0;
  std::uint64_t parts = 0;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t dropped_triangles = 0;
};
static_assert(std::is_trivially_copyable_v<ImportHeader> && sizeof(ImportHeader) == 56);

}  // namespace crashrank::detail
