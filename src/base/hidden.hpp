#pragma once

/// Marks what a class keeps to itself: nested in a class that the library exports, it would be
/// exported with it, and become part of the binary interface.
#if defined(__GNUC__)
#define CRASHRANK_HIDDEN __attribute__((visibility("hidden")))
#else
#define CRASHRANK_HIDDEN
#endif
