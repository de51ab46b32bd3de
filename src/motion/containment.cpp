#include "crashrank/internal/motion/containment.hpp"

#include "crashrank/internal/base/products.hpp"
#include "crashrank/internal/collide/box_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace crashrank {
namespace {

using Eigen::Vector3d;

Vector3d in_tree_frame(const AabbTree& tree, const Vector3d& point) {
  return tree.axes_are_world ? point : detail::rotate(tree.axes.transpose(), point);
}

/// Counts crossings of the two rays along one axis with the surface, modulo 2, in the plane across
/// them: the line crosses a triangle when a half-line drawn in that plane from the line's foot
/// crosses an odd number of the triangle's edges. Every edge is judged alone, with its ends in one
/// fixed order, so both triangles at an edge see the same and no crossing is lost or doubled
/// between them, however the arithmetic rounds.
class RayParity {
public:
  RayParity(const Vector3d& origin, int axis, double slack)
      : origin_(origin), axis_(axis), u_((axis + 1) % 3), v_((axis + 2) % 3), slack_(slack) {}

  /// `slack` is room for the rounding of corners turned into the tree's frame.
  bool intersects(const Box& box) const {
    return origin_[u_] >= box.min[u_] - slack_ && origin_[u_] <= box.max[u_] + slack_ &&
           origin_[v_] >= box.min[v_] - slack_ && origin_[v_] <= box.max[v_] + slack_;
  }

  void cross(const std::array<Vector3d, 3>& corner) {
    bool inside = false;
    for (std::size_t i = 0; i < 3; ++i) inside ^= crosses_edge(corner[i], corner[(i + 1) % 3]);
    if (!inside) return;
    const double height = height_of(corner) - origin_[axis_];
    forward_ ^= height > 0.0;
    backward_ ^= height < 0.0;
  }

  int votes() const { return (forward_ ? 1 : 0) + (backward_ ? 1 : 0); }

private:
  /// Whether the half-line from the foot in direction +v crosses the edge from p to q.
  bool crosses_edge(const Vector3d& p, const Vector3d& q) const {
    const bool ordered = p[u_] < q[u_] || (p[u_] == q[u_] && p[v_] < q[v_]);
    const Vector3d& low = ordered ? p : q;
    const Vector3d& high = ordered ? q : p;
    const double u = origin_[u_];
    if (!(low[u_] <= u && u < high[u_])) return false;
    return (high[u_] - low[u_]) * (origin_[v_] - low[v_]) < (high[v_] - low[v_]) * (u - low[u_]);
  }

  /// Where the line intersects the triangle's plane.
  double height_of(const std::array<Vector3d, 3>& corner) const {
    const Vector3d e = corner[1] - corner[0];
    const Vector3d f = corner[2] - corner[0];
    const double across = e[u_] * f[v_] - e[v_] * f[u_];
    if (across == 0.0) return corner[0][axis_];
    const double du = origin_[u_] - corner[0][u_];
    const double dv = origin_[v_] - corner[0][v_];
    return corner[0][axis_] +
           (e[axis_] * (du * f[v_] - dv * f[u_]) + f[axis_] * (e[u_] * dv - e[v_] * du)) / across;
  }

  Vector3d origin_;
  int axis_;
  int u_;
  int v_;
  double slack_;
  bool forward_ = false;
  bool backward_ = false;
};

/// Solid angle of the surface over the full sphere (Van Oosterom & Strackee 1983).
double winding_number(const AabbTree& tree, const Vector3d& point) {
  double sum = 0.0;
  for (const Triangle& t : tree.triangles) {
    const Vector3d a = t.corner[0].cast<double>() - point;
    const Vector3d b = t.corner[1].cast<double>() - point;
    const Vector3d c = t.corner[2].cast<double>() - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    const double volume = a.dot(b.cross(c));
    const double base = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    if (volume != 0.0 || base != 0.0) sum += std::atan2(volume, base);
  }
  return sum / (2.0 * std::numbers::pi);
}

/// True if a corner of `inner`, transformed by `to_outer`, is inside `outer`.
bool any_inside(const AabbTree& inner, const AabbTree& outer, const Pose& to_outer) {
  constexpr std::size_t samples = 16;
  const Box& box = outer.nodes[0].box;
  const std::size_t count = inner.triangles.size();
  const std::size_t tested = std::min(count, samples);
  for (std::size_t k = 0; k < tested; ++k) {
    const Triangle& t = inner.triangles[k * count / tested];
    const Vector3d point = carry(to_outer, t.corner[0]);
    const Vector3d local = in_tree_frame(outer, point);
    if ((local.array() < box.min.cast<double>().array()).any() ||
        (local.array() > box.max.cast<double>().array()).any()) {
      continue;
    }
    if (contains_point(outer, point)) return true;
  }
  return false;
}

}  // namespace

bool contains_point(const AabbTree& tree, const Vector3d& point_m) {
  const Vector3d origin = in_tree_frame(tree, point_m);
  const double slack = 1e-6 * detail::largest_coordinate(tree.nodes[0].box);
  std::array<RayParity, 3> rays{RayParity(origin, 0, slack), RayParity(origin, 1, slack),
                                RayParity(origin, 2, slack)};
  for (const Node& node : tree.nodes) {
    if (!node.is_leaf()) continue;
    for (RayParity& ray : rays) {
      if (!ray.intersects(node.box)) continue;
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const std::array<Eigen::Vector3f, 3>& corner = tree.triangles[i].corner;
        ray.cross({in_tree_frame(tree, corner[0].cast<double>()),
                   in_tree_frame(tree, corner[1].cast<double>()),
                   in_tree_frame(tree, corner[2].cast<double>())});
      }
    }
  }
  const int votes = rays[0].votes() + rays[1].votes() + rays[2].votes();
  if (votes == 0 || votes == 6) return votes == 6;
  return std::abs(winding_number(tree, point_m)) > 0.5;
}

Containment containment(const AabbTree& a, const AabbTree& b, const Pose& b_in_a) {
  if (any_inside(b, a, b_in_a)) return Containment::b_in_a;
  if (any_inside(a, b, inverse(b_in_a))) return Containment::a_in_b;
  return Containment::apart;
}

}  // namespace crashrank
