#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"
#include "crashrank/tree/projection.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace crashrank {

namespace detail {

/// The axes of a tree are orthonormal to this, entrywise in axesᵀ·axes − 1.
inline constexpr double axes_tolerance = 1e-12;

inline Error broken_tree(std::string place, std::string reason) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), "build the tree again");
  error.place = std::move(place);
  return error;
}

inline Error broken_node(std::size_t node, std::string reason) {
  return broken_tree("node " + std::to_string(node), std::move(reason));
}

inline bool encloses(const AabbTree& tree, const Box& box, const Eigen::Vector3f& point) {
  if (tree.axes_are_world) {
    return (box.min.array() <= point.array()).all() && (point.array() <= box.max.array()).all();
  }
  for (int axis = 0; axis < 3; ++axis) {
    const FloatInterval p = project(tree.axes, axis, point);
    if (!(box.min[axis] <= p.low && p.high <= box.max[axis])) return false;
  }
  return true;
}

inline Status validate_sizes(const AabbTree& tree, const TriangleMesh& mesh) {
  const std::size_t n = mesh.triangles.size();
  if (n == 0 || n > max_triangles) return broken_tree("mesh", "no triangles, or too many");
  if (tree.order.size() != n || tree.triangles.size() != n) {
    return broken_tree("slots", "the tree holds another number of triangles than the mesh");
  }
  if (tree.nodes.empty() || tree.nodes.size() > 2 * n - 1) {
    return broken_tree("nodes", "their number fits no tree over these triangles");
  }
  if (!tree.axes.allFinite() ||
      !((tree.axes.transpose() * tree.axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <=
        axes_tolerance)) {
    return broken_tree("axes", "they are not orthonormal");
  }
  if (tree.axes_are_world != (tree.axes == Eigen::Matrix3d::Identity())) {
    return broken_tree("axes", "the mark for world axes does not fit them");
  }
  return Success{};
}

inline Status validate_slots(const AabbTree& tree, const TriangleMesh& mesh) {
  std::vector<bool> seen(mesh.triangles.size(), false);
  for (std::size_t slot = 0; slot < tree.order.size(); ++slot) {
    const std::uint32_t triangle = tree.order[slot];
    const std::string place = "slot " + std::to_string(slot);
    if (triangle >= mesh.triangles.size()) {
      return broken_tree(place, "names a triangle that does not exist");
    }
    if (seen[triangle]) {
      return broken_tree(place, "names a triangle for the second time");
    }
    seen[triangle] = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[triangle][k];
      if (vertex >= mesh.vertices.size()) {
        return broken_tree(place, "names a triangle whose vertex does not exist");
      }
      // Bytes, so that a zero of the other sign is another coordinate.
      if (std::memcmp(tree.triangles[slot].corner[k].data(), mesh.vertices[vertex].data(),
                      3 * sizeof(float)) != 0) {
        return broken_tree(place, "its corners are not those of its triangle");
      }
    }
  }
  return Success{};
}

}  // namespace detail

/// Checks every invariant of a tree over its mesh and says what is broken first: sizes, axes, each
/// triangle in one slot with its own corners, nodes laid out as documented, slots handed out in
/// order without gap, each box finite and inside its parent's, each triangle inside its leaf's box.
/// Believes nothing: any content is safe to pass. O(n), memory O(n), no recursion. Errors:
/// bad_input.
inline Status validate(const AabbTree& tree, const TriangleMesh& mesh) {
  if (Status status = detail::validate_sizes(tree, mesh); !status) return status;
  if (Status status = detail::validate_slots(tree, mesh); !status) return status;

  // Walks the tree in the order of its layout: every inner node has to name the next unused pair
  // and every leaf the next unused slot. That leaves no room for cycles, gaps or sharing.
  std::size_t next_node = 1;
  std::size_t next_slot = 0;
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const std::size_t index = open.back();
    open.pop_back();
    const Node& node = tree.nodes[index];
    if (!node.box.min.allFinite() || !node.box.max.allFinite() || node.box.empty()) {
      return detail::broken_node(index, "its box is empty or not finite");
    }
    if (!node.is_leaf()) {
      if (node.first != next_node || tree.nodes.size() - next_node < 2) {
        return detail::broken_node(index, "its children are not where the layout puts them");
      }
      for (std::size_t child = next_node; child < next_node + 2; ++child) {
        if (!node.box.contains(tree.nodes[child].box)) {
          return detail::broken_node(child, "its box reaches out of its parent's");
        }
      }
      open.push_back(node.first + 1);
      open.push_back(node.first);
      next_node += 2;
      continue;
    }
    if (node.first != next_slot || node.count > tree.order.size() - next_slot) {
      return detail::broken_node(index, "its triangles are not where the layout puts them");
    }
    for (std::size_t slot = node.first; slot < node.first + std::size_t{node.count}; ++slot) {
      for (const Eigen::Vector3f& corner : tree.triangles[slot].corner) {
        if (!detail::encloses(tree, node.box, corner)) {
          return detail::broken_node(index, "a triangle reaches out of its box");
        }
      }
    }
    next_slot += node.count;
  }
  if (next_node != tree.nodes.size()) {
    return detail::broken_node(next_node, "no node leads to it");
  }
  if (tree.depth != measure_depth(tree.nodes)) {
    return detail::broken_tree("depth", "it is not that of the deepest leaf");
  }
  if (next_slot != tree.order.size()) {
    return detail::broken_tree("slot " + std::to_string(next_slot), "no leaf holds it");
  }
  return Success{};
}

}  // namespace crashrank
