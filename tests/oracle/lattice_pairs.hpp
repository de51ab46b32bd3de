#pragma once

#include "oracle/random.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace oracle {

// Exact contacts are made on an integer lattice, where barycentric combinations with weights of
// a fixed sum stay integers, and are then scaled by a power of two. All coordinates stay far below
// 2^53, so doubles hold exactly what was constructed.
using Lattice = std::array<std::int64_t, 3>;
using LatticeTriangle = std::array<Lattice, 3>;

struct LatticePair {
  LatticeTriangle a;
  LatticeTriangle b;
};

// The families of the same names.
LatticePair coplanar(Random& random);
LatticePair contained(Random& random);
LatticePair shared_corners(Random& random, std::size_t shared);
LatticePair vertex_on_face(Random& random);
LatticePair edge_on_edge(Random& random);
LatticePair sliver(Random& random);
LatticePair zero_area(Random& random);

/// One of those that touch exactly, whichever.
LatticePair exact_contact(Random& random);

}  // namespace oracle
