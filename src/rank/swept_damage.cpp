#include "rank/swept_damage.hpp"

#include "crashrank/internal/base/predicates.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

// Margin far above the rounding of coordinates below a kilometre, and far below any relevant
// length.
constexpr double margin_m = 1e-6;

struct BoxD {
  Eigen::Vector3d center;
  Eigen::Vector3d half;
};

BoxD to_double(const Box& box) {
  const Eigen::Vector3d low = box.min.cast<double>();
  const Eigen::Vector3d high = box.max.cast<double>();
  return {0.5 * (low + high), 0.5 * (high - low)};
}

// Swept boxes of the nodes of one tree, whose points move along chords between two poses, in the
// frame of another tree.
class SweptBoxes {
public:
  SweptBoxes(const AabbTree& tree, const Pose& first, const Pose& last, const AabbTree& other)
      : first_(in_frame(tree, first, other)), last_(in_frame(tree, last, other)) {}

  Box operator()(const Box& box) const {
    const BoxD local = to_double(box);
    const BoxD a = at(first_, local);
    const BoxD b = at(last_, local);
    Box swept;
    swept.min = rounded((a.center - a.half).cwiseMin(b.center - b.half), -1.0);
    swept.max = rounded((a.center + a.half).cwiseMax(b.center + b.half), 1.0);
    return swept;
  }

private:
  static Pose in_frame(const AabbTree& tree, const Pose& pose, const AabbTree& other) {
    return {other.axes.transpose() * pose.rotation * tree.axes,
            other.axes.transpose() * pose.translation};
  }
  static BoxD at(const Pose& pose, const BoxD& box) {
    return {pose.rotation * box.center + pose.translation, pose.rotation.cwiseAbs() * box.half};
  }
  // Rounds outwards by the margin and by more than the error of the conversion.
  static Eigen::Vector3f rounded(const Eigen::Vector3d& x, double sign) {
    constexpr double rounding = 1e-7;
    const Eigen::Array3d out = margin_m + rounding * x.cwiseAbs().array();
    return (x.array() + sign * out).cast<float>();
  }

  Pose first_;
  Pose last_;
};

bool overlap(const Box& a, const Box& b) {
  return a.min.x() <= b.max.x() && b.min.x() <= a.max.x() && a.min.y() <= b.max.y() &&
         b.min.y() <= a.max.y() && a.min.z() <= b.max.z() && b.min.z() <= a.max.z();
}

// A line segment in the frame of the boxes of a tree.
struct Segment {
  Eigen::Vector3d center;
  Eigen::Vector3d half;  // vector from the centre to one end
};

bool may_touch(const Segment& s, const Box& node) {
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

// Exact test of a path against a triangle. A path within the plane of the triangle does not cross
// it.
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

// Returns true if a path crosses a triangle below one of the nodes from index `begin` on. Removes
// these nodes from the list.
bool crosses(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const AabbTree& tree,
             std::size_t begin, std::vector<std::uint32_t>& nodes) {
  const Segment segment{tree.axes.transpose() * (0.5 * (p + q)),
                        tree.axes.transpose() * (0.5 * (q - p))};
  while (nodes.size() > begin) {
    const Node& node = tree.nodes[nodes.back()];
    nodes.pop_back();
    if (!may_touch(segment, node.box)) continue;
    if (!node.is_leaf()) {
      nodes.push_back(node.first + 1);
      nodes.push_back(node.first);
    } else if (crosses(p, q, tree, node)) {
      nodes.resize(begin);
      return true;
    }
  }
  return false;
}

// Appends to `near` the nodes in its range [begin, end) that overlap a box; nodes larger than the
// box are replaced by their children.
void list_overlapping(const AabbTree& tree, const Box& box, std::uint32_t begin, std::uint32_t end,
                      std::vector<std::uint32_t>& near) {
  const auto size = [](const Box& b) { return (b.max - b.min).squaredNorm(); };
  const float own = size(box);
  near.resize(end);
  for (std::uint32_t k = begin; k < end; ++k) {
    const Node& node = tree.nodes[near[k]];
    if (!overlap(box, node.box)) continue;
    if (node.is_leaf() || size(node.box) <= own) {
      near.push_back(near[k]);
      continue;
    }
    for (const std::uint32_t child : {node.first, node.first + 1}) {
      if (overlap(box, tree.nodes[child].box)) near.push_back(child);
    }
  }
}

// Returns true if the set contains all triangles of a leaf.
bool contains_leaf(const TriangleSet& set, const AabbTree& tree, const Node& leaf) {
  const auto* const first = tree.order.data() + leaf.first;
  return std::all_of(first, first + leaf.count,
                     [&](std::uint32_t triangle) { return set.contains(triangle); });
}

}  // namespace

std::uint64_t add_swept_triangles(const Body& moving, const Pose& first, const Pose& last,
                                  const Body& fixed, TriangleSet& set, SweptScratch& scratch) {
  using Path = SweptScratch::Path;
  const TriangleMesh& mesh = moving.model->mesh;
  const AabbTree& tree = moving.model->tree;
  const AabbTree& other = fixed.model->tree;
  const SweptBoxes swept(tree, first, last, other);
  scratch.path.assign(mesh.vertices.size(), Path::unknown);
  std::uint64_t followed = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
  // The path of a corner lies in the swept boxes of all leaves that contain the corner. So it is
  // enough to search below the nodes that overlap the box of any one of them.
  const auto crossing = [&](std::uint32_t vertex) {
    Path& path = scratch.path[vertex];
    if (path == Path::unknown) {
      ++followed;
      const Eigen::Vector3d p = carry(first, mesh.vertices[vertex]);
      const Eigen::Vector3d q = carry(last, mesh.vertices[vertex]);
      for (std::size_t k = begin; k < end; ++k) scratch.near.push_back(scratch.near[k]);
      path = crosses(p, q, other, end, scratch.near) ? Path::crossing : Path::clear;
    }
    return path == Path::crossing;
  };
  scratch.near.assign(1, 0);
  scratch.visits.assign(1, {0, 0, 1, false});
  while (!scratch.visits.empty()) {
    const SweptScratch::Visit visit = scratch.visits.back();
    scratch.visits.pop_back();
    if (set.is_full(visit.node)) continue;
    const Node& node = tree.nodes[visit.node];
    // Most triangles nearby were already added at an earlier pose.
    const bool is_full = node.is_leaf() ? contains_leaf(set, tree, node)
                                        : set.is_full(node.first) && set.is_full(node.first + 1);
    if (is_full) set.note_full(visit.node);
    if (is_full || visit.is_done) continue;
    list_overlapping(other, swept(node.box), visit.begin, visit.end, scratch.near);
    begin = visit.end;
    end = scratch.near.size();
    if (end == begin) continue;
    if (!node.is_leaf()) {
      const auto last_near = static_cast<std::uint32_t>(end);
      scratch.visits.push_back({visit.node, 0, 0, true});
      scratch.visits.push_back({node.first + 1, visit.end, last_near, false});
      scratch.visits.push_back({node.first, visit.end, last_near, false});
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
