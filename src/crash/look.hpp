#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/crash/depth_map.hpp"
#include "crashrank/crash/pulse.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// A body's coordinates carried into a view.
struct ViewOfBody {
  Eigen::Matrix3d turn;
  Eigen::Vector3d shift;

  ViewOfBody(const Pose& body_in_world, const ViewFrame& frame)
      : turn(frame.axes * body_in_world.rotation), shift(frame.into(body_in_world.translation)) {}

  /// The one order of operations for every vertex, however it is come by.
  Eigen::Vector3d operator()(const Eigen::Vector3f& vertex) const {
    return rotate(turn, vertex.cast<double>()) + shift;
  }
};

/// A node of a tree, and where it is seen.
struct SeenNode {
  std::uint32_t node = 0;
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

/// Memory of the looks at a body's tree, and who may end them early.
struct LookMemory {
  std::vector<std::uint32_t> stack;
  std::vector<SeenNode> waiting;
  /// Asked every few dozen boxes; once it says true what is looked at stays incomplete.
  bool (*stop)(void* stop_context) = nullptr;
  void* stop_context = nullptr;
  bool stopped = false;
  std::uint32_t boxes = 0;

  bool goes_on() {
    constexpr std::uint32_t between_looks = 64;
    if (stop != nullptr && ++boxes % between_looks == 0 && stop(stop_context)) stopped = true;
    return !stopped;
  }
};

/// As `view_bounds` of the tree's mesh, to the bit, without looking at vertices inside the bounds
/// known already.
void view_bounds(const AabbTree& tree, const ViewOfBody& view, Eigen::Vector3d& low,
                 Eigen::Vector3d& high, LookMemory& memory);

/// As `depth_map` of the tree's mesh into `map.grid`, to the bit, without looking at triangles
/// between the middles of cells or behind what is seen already.
void depth_map(const AabbTree& tree, const ViewOfBody& view, DepthMap& map, LookMemory& memory);

/// Lists the triangles of a tree's mesh, rising, whose boxes (and those around them) `wanted` says
/// yes to: bounds in the view, a little larger than they are.
void triangles_where(const AabbTree& tree, const ViewOfBody& view,
                     bool (*wanted)(const void* context, const Eigen::Vector3d& low,
                                    const Eigen::Vector3d& high),
                     const void* context, std::vector<std::uint32_t>& triangles,
                     LookMemory& memory);

/// The body's tree is looked at where it has one, its mesh otherwise.
void view_bounds(const PulseBody& body, const ViewFrame& frame, Eigen::Vector3d& low,
                 Eigen::Vector3d& high, LookMemory& memory);
void depth_map(const PulseBody& body, const ViewFrame& frame, const ViewGrid& grid, DepthMap& map,
               LookMemory& memory);

}  // namespace crashrank::detail
