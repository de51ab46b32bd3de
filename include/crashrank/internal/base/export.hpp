#pragma once

/// Marks what the compiled library offers; everything else stays hidden in it.
#if defined(__GNUC__)
#define CRASHRANK_API __attribute__((visibility("default")))
#else
#define CRASHRANK_API
#endif
