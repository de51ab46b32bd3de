#pragma once

#include <cstddef>
#include <cstdint>

namespace crashrank {

/// Two triangles that share a point: indices into the meshes of A and of B, in file order.
struct Pair {
  std::int32_t a = 0;
  std::int32_t b = 0;

  friend bool operator==(const Pair& p, const Pair& q) { return p.a == q.a && p.b == q.b; }
  friend bool operator<(const Pair& p, const Pair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; }
};

/// Work done by a query, in the paper's terms: T_total = Nb·Cb + Np·Cp.
struct CollideWork {
  std::uint64_t bv_tests = 0;         ///< Nb: pairs of boxes tested
  std::uint64_t primitive_tests = 0;  ///< Np: pairs of triangles tested
  std::uint64_t exact_tests = 0;      ///< of those, decided by exact arithmetic

  CollideWork& operator+=(const CollideWork& other) {
    bv_tests += other.bv_tests;
    primitive_tests += other.primitive_tests;
    exact_tests += other.exact_tests;
    return *this;
  }
};

struct CollideOptions {
  bool any = false;  ///< stop at the first pair found
};

struct CollideResult {
  bool intersecting = false;
  std::size_t pairs = 0;  ///< pairs written to the caller's buffer
  CollideWork work;
};

}  // namespace crashrank
