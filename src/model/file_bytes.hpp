#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"

#include <memory>
#include <string>

namespace crashrank::detail {

/// The bytes of a file, at a multiple of 64, and what keeps them there.
struct FileBytes {
  View<const unsigned char> bytes;
  std::shared_ptr<const void> keeper;
};

/// Reads or maps a regular file. Errors: not_found, bad_input for what is no file,
/// limit_exceeded, internal. Throws std::bad_alloc.
Result<FileBytes> file_bytes(const std::string& path, const LoadModelOptions& options);

/// Whether a regular file begins with these bytes, 64 at most. Never waits for a pipe.
bool begins_with(const std::string& path, View<const unsigned char> head) noexcept;

/// Writes a file beside its place, brings it to the disk and gives it its name.
/// Errors: usage when something has that name and `overwrite` is not set, or is no regular file;
/// not_found, internal.
Status write_whole(const std::string& path, View<const unsigned char> bytes, bool overwrite);

}  // namespace crashrank::detail
