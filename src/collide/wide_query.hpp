#pragma once

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/internal/collide/box_test.hpp"

#include <cstddef>
#include <cstdint>

namespace crashrank::detail {

/// Constants of one vector query, by value so that the kernel of every target reads the same.
struct WideQuery {
  // Box axes of B in those of A, row-major, and back.
  float rotation[9];
  float abs_rotation[9];
  float a_from_b[3];  // translation, B's box frame to A's
  float b_from_a[3];
  float margin_a;  // m, along A's box axes
  float margin_b;
  // Body frames, for triangles.
  float body_rotation[9];
  const Pose* pose;
  float carry_error;      // m: how far `carry` may be from the real motion
  float per_reach;        // error of a distance from a plane, per normal and metre between corners
  float reach_per_error;  // metres between corners that stand for a metre of error of a corner
  bool body_boxes;        // both trees' boxes stand along A's and B's body axes

  const WideNode* a_nodes;
  const WideNode* b_nodes;
  const TriangleCluster* a_clusters;
  const TriangleCluster* b_clusters;
  bool any;
};

/// Sizes beyond this (sum of coordinates and translation, m) are left to the scalar engine, so that
/// no product of three of them overflows a float.
inline constexpr double max_wide_size = 1e10;

struct WideSink {
  std::vector<Pair>* pairs;
  WideTask* stack;
  std::size_t stack_size;
  CollideWork work;
};

}  // namespace crashrank::detail
