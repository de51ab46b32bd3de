#pragma once

#include "crashrank/internal/base/export.hpp"

namespace crashrank {

/// Version of the compiled library, "major.minor.patch"; compare with CRASHRANK_VERSION_STRING of
/// the headers to find a mixed installation.
CRASHRANK_API const char* library_version() noexcept;

}  // namespace crashrank
