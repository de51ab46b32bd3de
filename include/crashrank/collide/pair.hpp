#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace crashrank {

/// Two triangles that share a point: indices into the meshes of A and of B, in file order.
struct Pair {
  std::int32_t a = 0;  ///< triangle of A, by its place in the mesh
  std::int32_t b = 0;  ///< triangle of B

  /// The same triangles.
  friend bool operator==(const Pair& p, const Pair& q) { return p.a == q.a && p.b == q.b; }
  /// By a, then b.
  friend bool operator<(const Pair& p, const Pair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; }
};

/// Work done by a query, in the paper's terms: T_total = Nb·Cb + Np·Cp.
struct CollideWork {
  std::uint64_t bv_tests = 0;         ///< Nb: pairs of boxes tested
  std::uint64_t primitive_tests = 0;  ///< Np: pairs of triangles tested
  std::uint64_t exact_tests = 0;      ///< of those, decided by exact arithmetic

  /// Adds up.
  CollideWork& operator+=(const CollideWork& other) {
    bv_tests += other.bv_tests;
    primitive_tests += other.primitive_tests;
    exact_tests += other.exact_tests;
    return *this;
  }
};

/// Options of a query.
struct CollideOptions {
  bool any = false;  ///< stop at the first pair found
};

/// Result of a query.
struct CollideResult {
  bool intersecting = false;  ///< at least one pair
  std::size_t pairs = 0;      ///< pairs written to the caller's buffer
  CollideWork work;           ///< tests done
};

/// Fingerprint of an answer: the first 16 hex digits of SHA-256 over the pairs, sorted by the
/// caller, each as its two indices in little-endian int32. The same for every tree, split rule,
/// policy, worker count, compiler and machine. Cost: about 3 ns a byte; allocates the string only.
CRASHRANK_API std::string pairs_hash(View<const Pair> sorted);

}  // namespace crashrank
