#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "oracle/random.hpp"

#include <cstddef>

namespace oracle {

/// Two small meshes full of adversarial pairs, and the pose at which they meet.
struct Soup {
  crashrank::TriangleMesh a;
  crashrank::TriangleMesh b;
  crashrank::Pose b_in_a;
};

/// `count` pairs of a PairGenerator, brought to about one size in one place and rounded to float,
/// so that every triangle of A is near every one of B. Half of the soups meet where nothing has to
/// be rounded further, contacts of the last bit included; in the others B is turned away first and
/// carried back by its pose, so that contacts are off by about the last bit of a float: where a
/// single-precision filter has to give up, and no later.
Soup make_soup(Random& random, std::size_t count);

}  // namespace oracle
