#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"
#include "crashrank/tree/lanes.hpp"
#include "crashrank/tree/projection.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
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

inline Lanes load_lanes(const float* three_and_one_more) {
  Lanes lanes;
  std::memcpy(&lanes, three_and_one_more, sizeof lanes);
  return lanes;
}

/// The box of a node; the fourth lanes hold what lies beside it.
inline LaneBox lanes(const Node& node) {
  return {load_lanes(node.box.min.data()), load_lanes(node.box.max.data())};
}

/// All ones in each of three lanes where the answer is yes. A number that is none lies nowhere.
inline IntLanes encloses(const LaneBox& outer, const LaneBox& inner) {
  return (outer.min <= inner.min) & (inner.max <= outer.max);
}
inline IntLanes encloses(const LaneBox& box, Lanes point) {
  return (box.min <= point) & (point <= box.max);
}
inline bool all_three(IntLanes answer) { return (answer[0] & answer[1] & answer[2]) != 0; }

/// Whether a leaf's box encloses its triangles, in the frame of the tree.
inline IntLanes leaf_encloses(const AabbTree& tree, const Node& leaf, const LaneBox& box) {
  IntLanes inside = {-1, -1, -1, -1};
  const Triangle* const triangles = tree.triangles.data() + leaf.first;
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const std::array<Eigen::Vector3f, 3>& corner = triangles[i].corner;
    if (tree.axes_are_world) {
      // The last corner is not read together with what lies behind it: nothing may.
      const Lanes last{corner[2][0], corner[2][1], corner[2][2], 0.0F};
      inside &= encloses(box, load_lanes(corner[0].data())) &
                encloses(box, load_lanes(corner[1].data())) & encloses(box, last);
      continue;
    }
    for (const Eigen::Vector3f& point : corner) {
      for (int axis = 0; axis < 3; ++axis) {
        const FloatInterval p = project(tree.axes, axis, point);
        if (!(leaf.box.min[axis] <= p.low && p.high <= leaf.box.max[axis])) inside[axis] = 0;
      }
    }
  }
  return inside;
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

/// Bytes, so that a zero of the other sign is another coordinate.
inline bool same_bytes(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::memcmp(a.data(), b.data(), 3 * sizeof(float)) == 0;
}

inline Status validate_slots(const AabbTree& tree, const TriangleMesh& mesh) {
  const auto broken = [](std::size_t slot, const char* reason) {
    return broken_tree("slot " + std::to_string(slot), reason);
  };
  const View<const std::array<std::uint32_t, 3>> triangles = mesh.triangles;
  const View<const Eigen::Vector3f> vertices = mesh.vertices;
  std::vector<unsigned char> seen(triangles.size(), 0);
  for (std::size_t slot = 0; slot < tree.order.size(); ++slot) {
    const std::uint32_t triangle = tree.order[slot];
    if (triangle >= triangles.size()) return broken(slot, "names a triangle that does not exist");
    if (seen[triangle] != 0) return broken(slot, "names a triangle for the second time");
    seen[triangle] = 1;
    const auto [a, b, c] = triangles[triangle];
    if (a >= vertices.size() || b >= vertices.size() || c >= vertices.size()) {
      return broken(slot, "names a triangle whose vertex does not exist");
    }
    const Triangle& here = tree.triangles[slot];
    if (!same_bytes(here.corner[0], vertices[a]) || !same_bytes(here.corner[1], vertices[b]) ||
        !same_bytes(here.corner[2], vertices[c])) {
      return broken(slot, "its corners are not those of its triangle");
    }
  }
  return Success{};
}

/// What lies below a node.
struct Below {
  std::uint32_t nodes;
  std::uint32_t first_slot;
  std::uint32_t end_slot;
  std::uint32_t depth;
};

/// Which box it is that breaks a rule, once it is known that one does.
inline Error find_broken_box(const AabbTree& tree) {
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    const LaneBox box = lanes(node);
    if (!all_three(box.min <= box.max)) return broken_node(i, "its box is empty or not finite");
    if (node.is_leaf()) {
      if (!all_three(leaf_encloses(tree, node, box))) {
        return broken_node(i, "a triangle reaches out of its box");
      }
      continue;
    }
    for (std::uint32_t child = node.first; child < node.first + 2; ++child) {
      if (!all_three(encloses(box, lanes(tree.nodes[child])))) {
        return broken_node(child, "its box reaches out of its parent's");
      }
    }
  }
  return broken_tree("nodes", "a box is wrong");
}

/// Checks the nodes from the last to the first, children before parents, and notes what lies below
/// each. Let the descendants of both children of a node lie where the layout puts them: the left
/// one's from first + 2 on, the right one's right behind. Then those of the node are the run that
/// begins at its left child, which ends within the array because theirs do, and no sum overflows.
/// So when the root's run holds all other nodes, each of them is reached once. Slots alike.
inline Status validate_nodes(const AabbTree& tree, Below* below) {
  const View<const Node> nodes = tree.nodes;
  const std::size_t slots = tree.order.size();
  IntLanes fine = {-1, -1, -1, -1};
  for (std::size_t i = nodes.size(); i-- > 0;) {
    const Node& node = nodes[i];
    const LaneBox box = lanes(node);
    fine &= box.min <= box.max;
    const std::uint32_t first = node.first;
    if (node.is_leaf()) {
      if (first >= slots || node.count > slots - first) {
        return broken_node(i, "its triangles are not where the layout puts them");
      }
      fine &= leaf_encloses(tree, node, box);
      below[i] = {0, first, first + node.count, 0};
      continue;
    }
    if (first <= i || first >= nodes.size() - 1) {
      return broken_node(i, "its children are not where the layout puts them");
    }
    const Below& left = below[first];
    const Below& right = below[first + 1];
    if ((left.nodes != 0 && nodes[first].first != first + 2) ||
        (right.nodes != 0 && nodes[first + 1].first != first + 2 + left.nodes)) {
      return broken_node(i, "what lies below it is not where the layout puts it");
    }
    if (left.end_slot != right.first_slot) {
      return broken_node(i, "its triangles are not where the layout puts them");
    }
    fine &= encloses(box, lanes(nodes[first])) & encloses(box, lanes(nodes[first + 1]));
    below[i] = {2 + left.nodes + right.nodes, left.first_slot, right.end_slot,
                1 + std::max(left.depth, right.depth)};
  }
  const Node& root = nodes[0];
  if (below[0].nodes != nodes.size() - 1 || (!root.is_leaf() && root.first != 1)) {
    return broken_tree("nodes", "some of them are below no other");
  }
  if (below[0].first_slot != 0 || below[0].end_slot != slots) {
    return broken_tree("slots", "some of them are in no leaf");
  }
  if (tree.depth != below[0].depth) {
    return broken_tree("depth", "it is not that of the deepest leaf");
  }
  // All boxes lie in the root's, so that they are finite when it is.
  if (!root.box.min.allFinite() || !root.box.max.allFinite()) {
    return broken_node(0, "its box is not finite");
  }
  if (!all_three(fine)) return find_broken_box(tree);
  return Success{};
}

/// `validate`, telling what lies below each node.
inline Status validate_tree(const AabbTree& tree, const TriangleMesh& mesh,
                            std::unique_ptr<Below[]>& below) {
  if (Status status = validate_sizes(tree, mesh); !status) return status;
  if (Status status = validate_slots(tree, mesh); !status) return status;
  below.reset(new Below[tree.nodes.size()]);
  return validate_nodes(tree, below.get());
}

}  // namespace detail

/// Checks every invariant of a tree over its mesh and says what is broken: sizes, axes, each
/// triangle in one slot with its own corners, nodes laid out as documented, slots handed out in
/// order without gap, each box finite and inside its parent's, each triangle inside its leaf's box.
/// Believes nothing: any content is safe to pass. O(n), memory O(n), no recursion. Errors:
/// bad_input. Throws std::bad_alloc.
inline Status validate(const AabbTree& tree, const TriangleMesh& mesh) {
  std::unique_ptr<detail::Below[]> below;
  return detail::validate_tree(tree, mesh, below);
}

}  // namespace crashrank
