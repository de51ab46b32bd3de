#pragma once

#include "crashrank/internal/base/export.hpp"

/// The version of these headers; `library_version()` returns that of the compiled library.
#define CRASHRANK_VERSION_MAJOR 0
#define CRASHRANK_VERSION_MINOR 1
#define CRASHRANK_VERSION_PATCH 0
#define CRASHRANK_VERSION_STRING "0.1.0"

// Exact answers rest on IEEE-754 arithmetic as written: a compiler allowed to reorder or
// approximate would silently break every error bound of the collider.
#if defined(__FAST_MATH__)
#error "crashrank needs IEEE-754 arithmetic: compile without -ffast-math (and -Ofast)"
#endif

namespace crashrank {

/// Version of the compiled library, "major.minor.patch"; compare with CRASHRANK_VERSION_STRING of
/// the headers to find a mixed installation.
CRASHRANK_API const char* library_version() noexcept;

}  // namespace crashrank
