#pragma once

#include "oracle/random.hpp"
#include "oracle/triangle_oracle.hpp"

#include <cstddef>
#include <cstdint>

namespace oracle {

/// How a pair was made. Everything but `random` is adversarial. The construction says what makes a
/// pair hard, not whether it touches: that is for the oracles to say.
enum class Family {
  random,
  coplanar,        ///< one common plane, exactly
  contained,       ///< B inside A, in A's plane
  shared_vertex,   ///< a corner of both
  shared_edge,     ///< two corners of both
  vertex_on_face,  ///< a corner of B in A: inside, on an edge or on a corner
  edge_on_edge,    ///< an edge of B crosses an edge of A in exactly one point
  ulp_touching,    ///< one of the exact contacts above, coordinates moved by up to 4 ulp
  rounded_touch,   ///< contact computed in double, so right up to rounding only
  sliver,          ///< very long and thin
  zero_area,       ///< segments and points, often placed on the other triangle
  along_axis,      ///< almost coplanar, with an edge along a coordinate axis
  mixed_sizes,     ///< 1e-6 m against up to 1e6 m
};
inline constexpr std::size_t family_count = 13;

const char* name(Family family);

struct TrianglePair {
  Triangle a;
  Triangle b;
  Family family = Family::random;
};

/// An endless, reproducible stream of triangle pairs.
class PairGenerator {
public:
  /// `adversarial` is the share of pairs that are not plainly random, spread evenly over the
  /// families.
  PairGenerator(std::uint64_t seed, double adversarial)
      : random_(seed), adversarial_(adversarial) {}

  TrianglePair next();
  TrianglePair next(Family family);

private:
  Random random_;
  double adversarial_;
};

}  // namespace oracle
