#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/base/export.hpp"

#include <string>

namespace crashrank {

/// Fingerprint of an answer: the first 16 hex digits of SHA-256 over the pairs, sorted by the
/// caller, each as its two indices in little-endian int32. The same for every tree, split rule,
/// policy, worker count, compiler and machine. Cost: about 3 ns a byte; allocates the string only.
CRASHRANK_API std::string pairs_hash(View<const Pair> sorted);

}  // namespace crashrank
