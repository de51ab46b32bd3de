#pragma once

#include "crashrank/base/result.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>

// Structs that begin with `size`, as the caller was compiled with them. A member added later has to
// begin at or after sizeof the struct before: what was padding at its end holds no defined bytes.

namespace crashrank::c {

/// Larger structs are taken for a `size` that was never set.
inline constexpr std::size_t most_struct_bytes = 1024;

/// Whether `size` can be that of a version of the struct. `type` is its name. Errors: usage.
template <class Struct> Status check_size(const char* type, const Struct& given) {
  static_assert(offsetof(Struct, size) == 0 && std::is_trivially_copyable_v<Struct>);
  static_assert(sizeof(Struct) <= most_struct_bytes);
  const std::size_t size = given.size;
  if (size >= sizeof(std::size_t) && size <= most_struct_bytes && size % alignof(Struct) == 0) {
    return Success{};
  }
  Error error = make_error(ErrorCode::usage,
                           "is " + std::to_string(size) + ", which no version of the struct has",
                           std::string("set it to sizeof(") + type + ") before the call");
  error.place = std::string(type) + ".size";
  return error;
}

/// What the caller passes in. Members that the caller's struct lacks are those of `defaults`.
/// Errors: usage for a size that none has, or where members set are unknown here.
template <class Struct>
Result<Struct> read_sized(const char* type, const Struct& given, Struct defaults = {}) {
  if (const Status known = check_size(type, given); !known) return known.error();
  const std::size_t size = given.size;
  const char* bytes = reinterpret_cast<const char*>(&given);
  if (size > sizeof(Struct) &&
      std::any_of(bytes + sizeof(Struct), bytes + size, [](char byte) { return byte != 0; })) {
    Error error = make_error(ErrorCode::usage, "sets members that this version does not know",
                             "leave them 0, or link the version of the header");
    error.place = type;
    return error;
  }
  std::memcpy(&defaults, bytes, std::min(size, sizeof(Struct)));
  defaults.size = sizeof(Struct);
  return defaults;
}

/// Writes what the caller's struct has of `answer`, whose size `check_size` has accepted; `size`
/// stays, members unknown here become 0.
template <class Struct> void write_sized(const Struct& answer, Struct& out) {
  const std::size_t size = out.size;
  char* bytes = reinterpret_cast<char*>(&out);
  std::memset(bytes, 0, size);
  std::memcpy(bytes, &answer, std::min(size, sizeof(Struct)));
  std::memcpy(bytes, &size, sizeof size);
}

}  // namespace crashrank::c
