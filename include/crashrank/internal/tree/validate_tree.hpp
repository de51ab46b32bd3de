#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/tree/lanes.hpp"
#include "crashrank/internal/tree/projection.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace crashrank::detail {

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

/// A tree's box around the corners of one triangle, along the axes of the body.
inline IntLanes encloses(const LaneBox& box, const Triangle& triangle) {
  const std::array<Eigen::Vector3f, 3>& corner = triangle.corner;
  // The last corner is read with what lies before it: nothing may lie behind.
  const Lanes last = load_lanes(&corner[1][2]);
  return encloses(box, load_lanes(corner[0].data())) & encloses(box, load_lanes(corner[1].data())) &
         encloses(box, __builtin_shufflevector(last, last, 1, 2, 3, 3));
}

/// Whether a leaf's box encloses its triangles, in the frame of the tree.
inline IntLanes leaf_encloses(const AabbTree& tree, const Node& leaf, const LaneBox& box) {
  const Triangle* const triangles = tree.triangles.data() + leaf.first;
  if (tree.axes_are_world) {
    // Most leaves hold one triangle or two: asked without a branch.
    IntLanes inside = encloses(box, triangles[0]) & encloses(box, triangles[leaf.count - 1]);
    for (std::uint32_t i = 1; i + 1 < leaf.count; ++i) inside &= encloses(box, triangles[i]);
    return inside;
  }
  IntLanes inside = {-1, -1, -1, -1};
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    for (const Eigen::Vector3f& point : triangles[i].corner) {
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
  return std::memcmp(a.data(), b.data(), 3 * sizeof(float)) == 0;  // NOLINT(*memory*,*flp37-c)
}

/// Which slot it is that breaks a rule, once it is known that one does.
inline Error find_broken_slot(const AabbTree& tree, const TriangleMesh& mesh) {
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
  return broken_tree("slots", "one of them is wrong");
}

/// Not zero where two points differ in a bit.
inline std::uint64_t difference(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  std::uint64_t xy_a = 0;
  std::uint64_t xy_b = 0;
  std::uint32_t z_a = 0;
  std::uint32_t z_b = 0;
  std::memcpy(&xy_a, a.data(), sizeof xy_a);
  std::memcpy(&xy_b, b.data(), sizeof xy_b);
  std::memcpy(&z_a, a.data() + 2, sizeof z_a);
  std::memcpy(&z_b, b.data() + 2, sizeof z_b);
  return (xy_a ^ xy_b) | (z_a ^ z_b);
}

/// What is wrong is gathered without a branch and looked for afterwards. As many triangles seen as
/// there are slots: none was seen twice.
inline Status validate_slots(const AabbTree& tree, const TriangleMesh& mesh) {
  const View<const std::array<std::uint32_t, 3>> triangles = mesh.triangles;
  const View<const Eigen::Vector3f> vertices = mesh.vertices;
  const View<const std::uint32_t> order = tree.order;
  const View<const Triangle> corners = tree.triangles;
  std::uint32_t last_triangle = 0;
  std::uint32_t last_vertex = 0;
  for (const std::uint32_t triangle : order) last_triangle = std::max(last_triangle, triangle);
  for (const auto& [a, b, c] : triangles) {
    last_vertex = std::max(last_vertex, std::max(std::max(a, b), c));
  }
  if (last_triangle >= triangles.size() || last_vertex >= vertices.size()) {
    return find_broken_slot(tree, mesh);
  }
  std::vector<std::uint64_t> seen((triangles.size() + 63) / 64, 0);
  std::uint64_t wrong = 0;
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    const std::uint32_t triangle = order[slot];
    seen[triangle / 64] |= std::uint64_t{1} << triangle % 64;
    const std::array<std::uint32_t, 3>& vertex = triangles[triangle];
    const std::array<Eigen::Vector3f, 3>& corner = corners[slot].corner;
    wrong |= difference(corner[0], vertices[vertex[0]]) |
             difference(corner[1], vertices[vertex[1]]) |
             difference(corner[2], vertices[vertex[2]]);
  }
  std::size_t different = 0;
  for (const std::uint64_t word : seen) {
    different += static_cast<std::size_t>(__builtin_popcountll(word));
  }
  if (wrong != 0 || different != order.size()) return find_broken_slot(tree, mesh);
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

/// Which node is not where the layout puts it, once it is known that one is not.
inline Error find_misplaced_node(const AabbTree& tree, Below* below) {
  const View<const Node> nodes = tree.nodes;
  const std::size_t slots = tree.order.size();
  for (std::size_t i = nodes.size(); i-- > 0;) {
    const Node& node = nodes[i];
    const std::uint32_t first = node.first;
    if (node.is_leaf()) {
      if (first >= slots || node.count > slots - first) {
        return broken_node(i, "its triangles are not where the layout puts them");
      }
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
    below[i] = {2 + left.nodes + right.nodes, left.first_slot, right.end_slot, 0};
  }
  return broken_tree("nodes", "one of them is not where the layout puts it");
}

/// Whether every node is where the layout puts it, and notes what lies below each: from the last to
/// the first, children before parents. Leaves and inner nodes take the same steps, since no
/// processor can foresee which comes next: a leaf takes itself for its children, as does a node
/// whose children do not exist. `leaves` receives the leaves, `fine` what is to be said of boxes.
inline bool nodes_are_placed(const AabbTree& tree, Below* below, std::uint32_t* leaves,
                             std::size_t& leaf_count, IntLanes& fine) {
  const Node* const nodes = tree.nodes.data();
  const std::size_t count = tree.nodes.size();
  const std::size_t slots = tree.order.size();
  bool placed = true;
  leaf_count = 0;
  for (std::size_t i = count; i-- > 0;) {
    const Node& node = nodes[i];
    const std::uint32_t first = node.first;
    const bool leaf = node.count != 0;
    const bool has_children = !leaf && first > i && first < count - 1;
    const bool has_triangles = leaf && std::uint64_t{first} + node.count <= slots;
    below[i] = {0, first, first + node.count, 0};
    const std::size_t a = has_children ? first : i;
    const std::size_t b = a + (has_children ? 1 : 0);
    const Below left = below[a];
    const Below right = below[b];
    const bool in_order = (left.nodes == 0 || nodes[a].first == first + 2) &
                          (right.nodes == 0 || nodes[b].first == first + 2 + left.nodes) &
                          (left.end_slot == right.first_slot);
    placed &= leaf ? has_triangles : has_children & in_order;
    below[i].nodes = has_children ? 2 + left.nodes + right.nodes : 0;
    below[i].first_slot = left.first_slot;
    below[i].end_slot = right.end_slot;
    below[i].depth = has_children ? 1 + std::max(left.depth, right.depth) : 0;
    const LaneBox box = lanes(node);
    fine &= (box.min <= box.max) & encloses(box, lanes(nodes[a])) & encloses(box, lanes(nodes[b]));
    leaves[leaf_count] = static_cast<std::uint32_t>(i);
    leaf_count += leaf ? 1 : 0;
  }
  return placed;
}

/// Checks the nodes. Let the descendants of both children of a node lie where the layout puts them:
/// the left one's from first + 2 on, the right one's right behind. Then those of the node are the
/// run that begins at its left child, which ends within the array because theirs do, and no sum
/// overflows. So when the root's run holds all other nodes, each of them is reached once. Slots
/// alike.
inline Status validate_nodes(const AabbTree& tree, Below* below) {
  const View<const Node> nodes = tree.nodes;
  const std::unique_ptr<std::uint32_t[]> leaves(new std::uint32_t[nodes.size()]);
  std::size_t leaf_count = 0;
  IntLanes fine = {-1, -1, -1, -1};
  if (!nodes_are_placed(tree, below, leaves.get(), leaf_count, fine)) {
    return find_misplaced_node(tree, below);
  }
  for (std::size_t k = leaf_count; k-- > 0;) {
    const Node& leaf = nodes[leaves[k]];
    fine &= leaf_encloses(tree, leaf, lanes(leaf));
  }
  const Node& root = nodes[0];
  if (below[0].nodes != nodes.size() - 1 || (!root.is_leaf() && root.first != 1)) {
    return broken_tree("nodes", "some of them are below no other");
  }
  if (below[0].first_slot != 0 || below[0].end_slot != tree.order.size()) {
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

/// `validate`, which also returns what lies below each node.
inline Status validate_tree(const AabbTree& tree, const TriangleMesh& mesh,
                            std::unique_ptr<Below[]>& below) {
  if (Status status = validate_sizes(tree, mesh); !status) return status;
  if (Status status = validate_slots(tree, mesh); !status) return status;
  below.reset(new Below[tree.nodes.size()]);
  return validate_nodes(tree, below.get());
}

}  // namespace crashrank::detail
