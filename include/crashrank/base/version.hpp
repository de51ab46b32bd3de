#pragma once

/// The version of these headers; the compiled library answers `library_version()` with its own.
#define CRASHRANK_VERSION_MAJOR 0
#define CRASHRANK_VERSION_MINOR 1
#define CRASHRANK_VERSION_PATCH 0
#define CRASHRANK_VERSION_STRING "0.1.0"

// Exact answers rest on IEEE-754 arithmetic as written: a compiler allowed to reorder or
// approximate would silently break every error bound of the collider.
#if defined(__FAST_MATH__)
#error "crashrank needs IEEE-754 arithmetic: compile without -ffast-math (and -Ofast)"
#endif
