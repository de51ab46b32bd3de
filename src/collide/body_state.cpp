#include "crashrank/collide/body_state.hpp"

#include "crashrank/internal/base/predicates.hpp"
#include "crashrank/internal/base/products.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// For each vertex the first one of its position.
std::vector<std::uint32_t> weld(const TriangleMesh& mesh) {
  const auto before = [&](std::uint32_t p, std::uint32_t q) {
    const Vector3f& a = mesh.vertices[p];
    const Vector3f& b = mesh.vertices[q];
    for (int axis = 0; axis < 3; ++axis) {
      if (a[axis] != b[axis]) return a[axis] < b[axis];
    }
    return p < q;
  };
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), before);
  std::vector<std::uint32_t> welded(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && mesh.vertices[order[i]] == mesh.vertices[order[i - 1]];
    welded[order[i]] = same ? welded[order[i - 1]] : order[i];
  }
  return welded;
}

/// Union of vertices, by halving paths.
std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t vertex) {
  while (parent[vertex] != vertex) {
    parent[vertex] = parent[parent[vertex]];
    vertex = parent[vertex];
  }
  return vertex;
}

/// A side of a triangle, from its lower to its higher vertex.
struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t surface;
  int direction;  // −1 where the triangle runs from high to low
};

void judge_edges(std::vector<Edge>& edges, std::vector<Solid::Surface>& surfaces) {
  std::sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) {
    return p.low != q.low ? p.low < q.low : p.high < q.high;
  });
  for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
    int sum = 0;
    for (next = i; next < edges.size() && edges[next].low == edges[i].low &&
                   edges[next].high == edges[i].high;
         ++next) {
      sum += edges[next].direction;
    }
    Solid::Surface& surface = surfaces[edges[i].surface];
    if (sum != 0) surface.oriented = false;
    if ((next - i) % 2 != 0) surface.closed = false;
  }
}

/// One body as the other sees it: its triangles in A's frame, in double, as the query has them.
struct Outer {
  const Model& model;
  const Solid& solid;
  const Pose* pose;  // of the body in A's frame; null for A itself

  std::array<Vector3d, 3> corners(std::size_t slot) const {
    const TriangleD triangle = pose == nullptr ? to_double(model.tree.triangles[slot])
                                               : carry(*pose, model.tree.triangles[slot]);
    return triangle.corner;
  }
};

/// The bounds of boxes of a tree in A's frame, with room for all rounding (see box_transform).
class BoxesInA {
public:
  explicit BoxesInA(const Outer& outer) {
    const AabbTree& tree = outer.model.tree;
    if (!tree.axes_are_world) rotation_ = tree.axes;
    if (outer.pose != nullptr) {
      rotation_ = detail::multiply(outer.pose->rotation, rotation_);
      translation_ = outer.pose->translation;
    }
    const double size =
        translation_.cwiseAbs().sum() + 6.0 * detail::largest_coordinate(tree.nodes[0].box);
    margin_ = 0x1p-43 * size;
  }

  /// Whether the half-line from the point along +z may meet the box.
  bool may_meet(const Box& box, const Vector3d& point) const {
    const Vector3d center = 0.5 * (box.min.cast<double>() + box.max.cast<double>());
    const Vector3d half = 0.5 * (box.max.cast<double>() - box.min.cast<double>());
    const Vector3d middle = detail::rotate(rotation_, center) + translation_ - point;
    const Vector3d reach = detail::rotate(rotation_.cwiseAbs(), half).array() + margin_;
    return std::abs(middle.x()) <= reach.x() && std::abs(middle.y()) <= reach.y() &&
           middle.z() >= -reach.z();
  }

private:
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
  Vector3d translation_ = Vector3d::Zero();
  double margin_ = 0.0;
};

/// Whether the line through the point along z, seen from above, passes the edge on its far side:
/// the point is moved by an infinitely small step along y, and by one smaller still along x, so
/// that it lies on no edge. Triangles at one edge see the same.
bool passes_edge(const Vector3d& p, const Vector3d& q, const Vector3d& point) {
  const bool ordered = p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
  const Vector3d& low = ordered ? p : q;
  const Vector3d& high = ordered ? q : p;
  if (!(low.x() <= point.x() && point.x() < high.x())) return false;
  std::uint64_t exact_calls = 0;
  return orient2d(low, high, point, 2, exact_calls) < 0;
}

/// +1 where the half-line along +z leaves through the triangle, −1 where it enters, 0 elsewhere.
int crossing(const std::array<Vector3d, 3>& corner, const Vector3d& point) {
  bool hit = false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (passes_edge(corner[i], corner[(i + 1) % 3], point)) hit = !hit;
  }
  if (!hit) return 0;
  std::uint64_t exact_calls = 0;
  const int turn = orient2d(corner[0], corner[1], corner[2], 2, exact_calls);
  const int side = orient3d(corner[0], corner[1], corner[2], point, exact_calls);
  return turn * side < 0 ? turn : 0;
}

/// Whether the point lies inside the closed surfaces of the body.
bool is_inside(const Vector3d& point, const Outer& outer) {
  const AabbTree& tree = outer.model.tree;
  const BoxesInA boxes(outer);
  int winding = 0;
  std::vector<std::uint32_t> crossed;  // surfaces without orientation, once for each crossing
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const Node& node = tree.nodes[open.back()];
    open.pop_back();
    if (!boxes.may_meet(node.box, point)) continue;
    if (!node.is_leaf()) {
      open.push_back(node.first);
      open.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t slot = node.first; slot < node.first + node.count; ++slot) {
      const std::uint32_t number = outer.solid.surface_of[tree.order[slot]];
      const Solid::Surface& surface = outer.solid.surfaces[number];
      if (!surface.closed) continue;
      const int sign = crossing(outer.corners(slot), point);
      if (surface.oriented) {
        winding += sign;
      } else if (sign != 0) {
        crossed.push_back(number);
      }
    }
  }
  if (winding != 0) return true;
  std::sort(crossed.begin(), crossed.end());
  for (std::size_t i = 0, next = 0; i < crossed.size(); i = next) {
    for (next = i; next < crossed.size() && crossed[next] == crossed[i];) ++next;
    if ((next - i) % 2 == 1) return true;
  }
  return false;
}

/// Which surfaces lie within the bounds of the other body with all their corners. O(triangles).
std::vector<bool> within_bounds(const Model& inner, const Solid& solid, const Pose& inner_in_outer,
                                const AabbTree& outer) {
  const Box& bounds = outer.nodes[0].box;
  const double margin = 1e-9 * (detail::largest_coordinate(bounds) +
                                inner_in_outer.translation.cwiseAbs().maxCoeff());
  std::vector<bool> within(solid.surfaces.size(), true);
  for (std::size_t t = 0; t < inner.mesh.size(); ++t) {
    if (!within[solid.surface_of[t]]) continue;
    const Triangle triangle = inner.mesh.triangle(t);
    for (const Vector3f& corner : triangle.corner) {
      Vector3d point = carry(inner_in_outer, corner);
      if (!outer.axes_are_world) point = detail::rotate(outer.axes.transpose(), point);
      if ((point.array() < bounds.min.cast<double>().array() - margin).any() ||
          (point.array() > bounds.max.cast<double>().array() + margin).any()) {
        within[solid.surface_of[t]] = false;
      }
    }
  }
  return within;
}

struct Insides {
  bool some = false;     // a surface of the inner body lies inside
  bool all = true;       // all do
  bool unknown = false;  // one lies within the bounds of a body that is not closed
};

/// `inner_in_a` is null for A; `inner_in_outer` its pose in the other body.
Insides find_insides(const Model& inner, const Solid& solid, const Pose* inner_in_a,
                     const Pose& inner_in_outer, const Outer& outer) {
  Insides found;
  std::vector<bool> inside;
  for (const Solid::Surface& surface : solid.surfaces) {
    const Vector3f corner = inner.mesh.triangle(surface.triangle).corner[0];
    inside.push_back(is_inside(
        inner_in_a == nullptr ? corner.cast<double>().eval() : carry(*inner_in_a, corner), outer));
    found.some = found.some || inside.back();
    found.all = found.all && inside.back();
  }
  if (found.all || outer.solid.closed) return found;
  const std::vector<bool> within = within_bounds(inner, solid, inner_in_outer, outer.model.tree);
  for (std::size_t i = 0; i < within.size(); ++i) {
    found.unknown = found.unknown || (within[i] && !inside[i]);
  }
  return found;
}

}  // namespace

const char* body_state_name(BodyState state) {
  switch (state) {
    case BodyState::separate:
      return "separate";
    case BodyState::intersecting:
      return "intersecting";
    case BodyState::a_inside_b:
      return "a_inside_b";
    case BodyState::b_inside_a:
      return "b_inside_a";
    case BodyState::unknown_open:
      return "unknown_open";
  }
  return "unknown_open";
}

Solid make_solid(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> welded = weld(mesh);
  std::vector<std::uint32_t> parent(welded.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const auto& triangle : mesh.triangles) {
    const std::uint32_t root = root_of(parent, welded[triangle[0]]);
    for (const std::uint32_t vertex : {triangle[1], triangle[2]}) {
      parent[root_of(parent, welded[vertex])] = root;
    }
  }
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> number(welded.size(), none);  // of the surface, by its root
  Solid solid;
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.size());
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    std::uint32_t& surface = number[root_of(parent, welded[triangle[0]])];
    if (surface == none) {
      surface = static_cast<std::uint32_t>(solid.surfaces.size());
      solid.surfaces.push_back({static_cast<std::uint32_t>(t), true, true});
    }
    solid.surface_of.push_back(surface);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = welded[triangle[i]];
      const std::uint32_t to = welded[triangle[(i + 1) % 3]];
      // Sides that meet in one point cancel each other, or have no length.
      if (from != to)
        edges.push_back({std::min(from, to), std::max(from, to), surface, from < to ? 1 : -1});
    }
  }
  judge_edges(edges, solid.surfaces);
  for (Solid::Surface& surface : solid.surfaces) {
    surface.oriented = surface.oriented && surface.closed;
  }
  solid.closed = std::all_of(solid.surfaces.begin(), solid.surfaces.end(),
                             [](const Solid::Surface& surface) { return surface.closed; });
  return solid;
}

BodyState body_state(const Model& a, const Solid& solid_a, const Model& b, const Solid& solid_b,
                     const Pose& b_in_a, const CollideResult& result) {
  if (result.intersecting) return BodyState::intersecting;
  const BoxTransform to = box_transform(a.tree, b.tree, b_in_a);
  if (!boxes_may_touch(a.tree.nodes[0].box, b.tree.nodes[0].box, to)) return BodyState::separate;
  const Pose a_in_b = inverse(b_in_a);
  const Insides a_in = find_insides(a, solid_a, nullptr, a_in_b, {b, solid_b, &b_in_a});
  if (a_in.some && a_in.all) return BodyState::a_inside_b;
  const Insides b_in = find_insides(b, solid_b, &b_in_a, b_in_a, {a, solid_a, nullptr});
  if (b_in.some && b_in.all) return BodyState::b_inside_a;
  if (a_in.some) return BodyState::a_inside_b;
  if (b_in.some) return BodyState::b_inside_a;
  return a_in.unknown || b_in.unknown ? BodyState::unknown_open : BodyState::separate;
}

}  // namespace crashrank
