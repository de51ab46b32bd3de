#include "rank/passed.hpp"

#include "crashrank/collide/predicates.hpp"
#include "crashrank/collide/triangle_test.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

struct BoxD {
  Eigen::Vector3d center;
  Eigen::Vector3d half;
};

BoxD to_double(const Box& box) {
  const Eigen::Vector3d low = box.min.cast<double>();
  const Eigen::Vector3d high = box.max.cast<double>();
  return {0.5 * (low + high), 0.5 * (high - low)};
}

bool overlap(const BoxD& a, const BoxD& b) {
  return ((a.center - b.center).cwiseAbs().array() <= (a.half + b.half).array()).all();
}

// A box whose points move on chords between two poses, seen from the other body.
class SweptBoxes {
public:
  SweptBoxes(const AabbTree& tree, const Pose& first, const Pose& last)
      : first_{first.rotation * tree.axes, first.translation},
        last_{last.rotation * tree.axes, last.translation} {}

  BoxD operator()(const Box& box) const {
    const BoxD local = to_double(box);
    const BoxD a = at(first_, local);
    const BoxD b = at(last_, local);
    const Eigen::Vector3d low = (a.center - a.half).cwiseMin(b.center - b.half);
    const Eigen::Vector3d high = (a.center + a.half).cwiseMax(b.center + b.half);
    return {0.5 * (low + high), 0.5 * (high - low)};
  }

private:
  static BoxD at(const Pose& pose, const BoxD& box) {
    return {pose.rotation * box.center + pose.translation,
            pose.rotation.cwiseAbs() * box.half + Eigen::Vector3d::Constant(margin_m)};
  }

  // Far above the rounding of coordinates below a kilometre, far below anything that matters.
  static constexpr double margin_m = 1e-6;

  Pose first_;
  Pose last_;
};

// A segment in the frame of a tree's boxes.
struct Segment {
  Eigen::Vector3d center;
  Eigen::Vector3d half;  // from the centre to one end
};

bool may_touch(const Segment& s, const Box& node) {
  constexpr double margin_m = 1e-6;
  const BoxD box = to_double(node);
  const Eigen::Vector3d apart = s.center - box.center;
  const Eigen::Vector3d reach = s.half.cwiseAbs();
  const Eigen::Vector3d half = box.half + Eigen::Vector3d::Constant(margin_m);
  if ((apart.cwiseAbs().array() > (half + reach).array()).any()) return false;
  const Eigen::Vector3d across = s.half.cross(apart).cwiseAbs();
  return across.x() <= half.y() * reach.z() + half.z() * reach.y() &&
         across.y() <= half.z() * reach.x() + half.x() * reach.z() &&
         across.z() <= half.x() * reach.y() + half.y() * reach.x();
}

// A path that only slides along a triangle, in its plane, crosses nothing.
bool crosses(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const TriangleD& t) {
  std::uint64_t exact = 0;
  const auto& [a, b, c] = t.corner;
  const int side_p = orient3d(a, b, c, p, exact);
  const int side_q = orient3d(a, b, c, q, exact);
  if (side_p * side_q > 0 || (side_p == 0 && side_q == 0)) return false;
  const int ab = orient3d(p, q, a, b, exact);
  const int bc = orient3d(p, q, b, c, exact);
  const int ca = orient3d(p, q, c, a, exact);
  return std::max({ab, bc, ca}) - std::min({ab, bc, ca}) < 2;
}

bool crosses(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const AabbTree& tree,
             const Node& leaf) {
  for (std::uint32_t slot = leaf.first; slot < leaf.first + leaf.count; ++slot) {
    if (crosses(p, q, crashrank::to_double(tree.triangles[slot]))) return true;
  }
  return false;
}

// `hint` is the leaf that the path before this one crossed, if any: neighbours often cross it too.
bool crosses(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const AabbTree& tree,
             std::vector<std::uint32_t>& stack, std::uint32_t& hint) {
  const Segment segment{tree.axes.transpose() * (0.5 * (p + q)),
                        tree.axes.transpose() * (0.5 * (q - p))};
  if (!may_touch(segment, tree.nodes[0].box)) return false;
  if (tree.nodes[hint].is_leaf() && may_touch(segment, tree.nodes[hint].box) &&
      crosses(p, q, tree, tree.nodes[hint])) {
    return true;
  }
  stack.assign(1, 0);
  while (!stack.empty()) {
    const std::uint32_t index = stack.back();
    const Node& node = tree.nodes[index];
    stack.pop_back();
    if (node.is_leaf()) {
      if (!crosses(p, q, tree, node)) continue;
      hint = index;
      return true;
    }
    for (const std::uint32_t child : {node.first + 1, node.first}) {
      if (may_touch(segment, tree.nodes[child].box)) stack.push_back(child);
    }
  }
  return false;
}

}  // namespace

std::uint64_t add_passed(const Body& moving, const Pose& first, const Pose& last, const Body& fixed,
                         TriangleSet& set, PassedScratch& scratch) {
  using Path = PassedScratch::Path;
  const TriangleMesh& mesh = moving.model->mesh;
  const AabbTree& tree = moving.model->tree;
  const AabbTree& other = fixed.model->tree;
  const BoxD target{fixed.center_m, fixed.half_axes_m.cwiseAbs().rowwise().sum()};
  const SweptBoxes swept(tree, first, last);
  scratch.path.assign(mesh.vertices.size(), Path::unknown);
  std::uint64_t followed = 0;
  std::uint32_t hint = 0;
  const auto crossing = [&](std::uint32_t vertex) {
    Path& path = scratch.path[vertex];
    if (path == Path::unknown) {
      ++followed;
      const Eigen::Vector3d p = carry(first, mesh.vertices[vertex]);
      const Eigen::Vector3d q = carry(last, mesh.vertices[vertex]);
      path = crosses(p, q, other, scratch.fixed_stack, hint) ? Path::crossing : Path::clear;
    }
    return path == Path::crossing;
  };
  scratch.moving_stack.assign(1, 0);
  while (!scratch.moving_stack.empty()) {
    const Node& node = tree.nodes[scratch.moving_stack.back()];
    scratch.moving_stack.pop_back();
    if (!overlap(swept(node.box), target)) continue;
    if (!node.is_leaf()) {
      scratch.moving_stack.push_back(node.first + 1);
      scratch.moving_stack.push_back(node.first);
      continue;
    }
    for (std::uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
      const std::uint32_t triangle = tree.order[slot];
      if (set.contains(triangle)) continue;
      const auto& [a, b, c] = mesh.triangles[triangle];
      if (crossing(a) || crossing(b) || crossing(c)) set.add(triangle);
    }
  }
  return followed;
}

}  // namespace crashrank::detail
