#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/internal/base/predicates.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace crashrank {

/// Three corners in double, m, in A's frame: A's own, or B's transformed by `carry`.
struct TriangleD {
  std::array<Eigen::Vector3d, 3> corner;  ///< m
};

/// The same corners in double.
inline TriangleD to_double(const Triangle& t) {
  return {{t.corner[0].cast<double>(), t.corner[1].cast<double>(), t.corner[2].cast<double>()}};
}

/// Its corners, each transformed by the pose.
inline TriangleD carry(const Pose& pose, const Triangle& t) {
  return {{carry(pose, t.corner[0]), carry(pose, t.corner[1]), carry(pose, t.corner[2])}};
}

namespace detail {

/// The general test: right for every input, degenerate or coplanar, and slow. Used for those only.
class HullTest {
public:
  explicit HullTest(std::uint64_t& exact_calls) : exact_calls_(exact_calls) {}

  /// Two closed triangles share a point exactly when an edge of one shares a point with the other:
  /// if neither's edges met the other, a common point would be inner to both, and the common set,
  /// convex and closed, could be followed to the rim of one of them.
  bool triangles_meet(const TriangleD& a, const TriangleD& b) {
    const bool a_flat = is_flat(a);
    const bool b_flat = is_flat(b);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (segment_meets(a.corner[i], a.corner[j], b, b_flat)) return true;
      if (segment_meets(b.corner[i], b.corner[j], a, a_flat)) return true;
    }
    return false;
  }

private:
  using Point = Eigen::Vector3d;

  /// Collinear or coinciding corners: the projections on all three coordinate planes are flat.
  bool is_flat(const TriangleD& t) {
    for (int dropped = 0; dropped < 3; ++dropped) {
      if (orient2d(t.corner[0], t.corner[1], t.corner[2], dropped, exact_calls_) != 0) return false;
    }
    return true;
  }

  bool segment_meets(const Point& p, const Point& q, const TriangleD& t, bool flat) {
    if (flat) {
      // A flat triangle is the union of its edges.
      for (std::size_t i = 0; i < 3; ++i) {
        if (segments_meet(p, q, t.corner[i], t.corner[(i + 1) % 3])) return true;
      }
      return false;
    }
    const auto& [a, b, c] = t.corner;
    const int side_p = orient3d(a, b, c, p, exact_calls_);
    const int side_q = orient3d(a, b, c, q, exact_calls_);
    if (side_p * side_q > 0) return false;
    if (side_p == 0 && side_q == 0) return coplanar_segment_meets(p, q, t);
    // The line pq crosses the plane in one point, within the segment; it is inside when it does not
    // lie on different sides of two edges.
    const int ab = orient3d(p, q, a, b, exact_calls_);
    const int bc = orient3d(p, q, b, c, exact_calls_);
    const int ca = orient3d(p, q, c, a, exact_calls_);
    return std::max({ab, bc, ca}) - std::min({ab, bc, ca}) < 2;
  }

  bool coplanar_segment_meets(const Point& p, const Point& q, const TriangleD& t) {
    const Point& a = t.corner[0];
    const Point& b = t.corner[1];
    const Point& c = t.corner[2];
    // Any coordinate plane on which the triangle does not fall flat shows the picture undistorted.
    int dropped = 0;
    while (orient2d(a, b, c, dropped, exact_calls_) == 0) ++dropped;
    const auto inside = [&](const Point& x) {
      const int ab = orient2d(a, b, x, dropped, exact_calls_);
      const int bc = orient2d(b, c, x, dropped, exact_calls_);
      const int ca = orient2d(c, a, x, dropped, exact_calls_);
      return std::max({ab, bc, ca}) - std::min({ab, bc, ca}) < 2;
    };
    return inside(p) || inside(q) || segments_meet_2d(p, q, a, b, dropped) ||
           segments_meet_2d(p, q, b, c, dropped) || segments_meet_2d(p, q, c, a, dropped);
  }

  /// Coplanar segments meet exactly when their shadows meet on all three coordinate planes: a
  /// common point casts a common shadow, and at least one of the shadows is undistorted.
  bool segments_meet(const Point& p, const Point& q, const Point& r, const Point& s) {
    if (orient3d(p, q, r, s, exact_calls_) != 0) return false;
    return segments_meet_2d(p, q, r, s, 0) && segments_meet_2d(p, q, r, s, 1) &&
           segments_meet_2d(p, q, r, s, 2);
  }

  bool segments_meet_2d(const Point& p, const Point& q, const Point& r, const Point& s,
                        int dropped) {
    const int pq_r = orient2d(p, q, r, dropped, exact_calls_);
    const int pq_s = orient2d(p, q, s, dropped, exact_calls_);
    if (pq_r * pq_s > 0) return false;
    const int rs_p = orient2d(r, s, p, dropped, exact_calls_);
    const int rs_q = orient2d(r, s, q, dropped, exact_calls_);
    if (rs_p * rs_q > 0) return false;
    if (pq_r != 0 || pq_s != 0 || rs_p != 0 || rs_q != 0) return true;
    for (const int axis : {(dropped + 1) % 3, (dropped + 2) % 3}) {  // all on one line
      if (std::max(p[axis], q[axis]) < std::min(r[axis], s[axis])) return false;
      if (std::max(r[axis], s[axis]) < std::min(p[axis], q[axis])) return false;
    }
    return true;
  }

  std::uint64_t& exact_calls_;
};

/// Whether three signs are all +1 or all −1.
inline bool one_sided(const std::array<int, 3>& side) {
  return side[0] != 0 && side[0] == side[1] && side[1] == side[2];
}

/// Index of the corner that stands alone: the other two lie together in the closed half-space
/// opposite to it, and not both it and another lie in the plane. `side` is neither one-sided nor
/// all zero. `positive` says whether the alone corner's half-space is the positive one.
inline std::size_t alone(const std::array<int, 3>& side, bool& positive) {
  for (std::size_t i = 0; i < 3; ++i) {
    const int next = side[(i + 1) % 3];
    const int last = side[(i + 2) % 3];
    if ((side[i] > 0 && next <= 0 && last <= 0) || (side[i] == 0 && next < 0 && last < 0)) {
      positive = true;
      return i;
    }
    if ((side[i] < 0 && next >= 0 && last >= 0) || (side[i] == 0 && next > 0 && last > 0)) {
      positive = false;
      return i;
    }
  }
  assert(false);
  return 0;
}

}  // namespace detail

/// Do two closed triangles, each the convex hull of its corners, share a point? Exact for all
/// finite corners: touching, coplanar, degenerate. About 20 ns where doubles decide.
/// `exact_calls` grows by the number of predicates that needed integers.
///
/// Method: reject by the corners' sides of each other's planes; otherwise both triangles cut the
/// line common to the planes in an interval each, and two more signs tell whether those overlap
/// (the idea of Devillers and Guigue, "Faster triangle-triangle intersection tests", 2002).
inline bool triangles_intersect(const TriangleD& a, const TriangleD& b,
                                std::uint64_t& exact_calls) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [a_min, a_max] =
        std::minmax({a.corner[0][axis], a.corner[1][axis], a.corner[2][axis]});
    const auto [b_min, b_max] =
        std::minmax({b.corner[0][axis], b.corner[1][axis], b.corner[2][axis]});
    if (a_max < b_min || b_max < a_min) return false;
  }
  std::array<int, 3> b_side{};
  for (std::size_t i = 0; i < 3; ++i) {
    b_side[i] = orient3d(a.corner[0], a.corner[1], a.corner[2], b.corner[i], exact_calls);
  }
  if (detail::one_sided(b_side)) return false;
  std::array<int, 3> a_side{};
  for (std::size_t i = 0; i < 3; ++i) {
    a_side[i] = orient3d(b.corner[0], b.corner[1], b.corner[2], a.corner[i], exact_calls);
  }
  if (detail::one_sided(a_side)) return false;
  const std::array<int, 3> zero{};
  if (a_side == zero || b_side == zero) {
    return detail::HullTest(exact_calls).triangles_meet(a, b);
  }
  // From here both triangles are proper and their planes cross in a line.
  bool a_positive = false;
  bool b_positive = false;
  const std::size_t ia = detail::alone(a_side, a_positive);
  const std::size_t ib = detail::alone(b_side, b_positive);
  // Turn each triangle so that the other's lone corner is on its positive side. Then, along the
  // common line, a0a1 cuts before a0a2 and b0b2 before b0b1, and the intervals overlap when a0a1
  // does not cut beyond b0b1 and b0b2 not beyond a0a2; each is the side on which two edges pass.
  const std::size_t turn_a = b_positive ? 1 : 2;
  const std::size_t turn_b = a_positive ? 1 : 2;
  const Eigen::Vector3d& a0 = a.corner[ia];
  const Eigen::Vector3d& a1 = a.corner[(ia + turn_a) % 3];
  const Eigen::Vector3d& a2 = a.corner[(ia + 3 - turn_a) % 3];
  const Eigen::Vector3d& b0 = b.corner[ib];
  const Eigen::Vector3d& b1 = b.corner[(ib + turn_b) % 3];
  const Eigen::Vector3d& b2 = b.corner[(ib + 3 - turn_b) % 3];
  return orient3d(a0, a1, b0, b1, exact_calls) <= 0 && orient3d(a0, a2, b0, b2, exact_calls) >= 0;
}

/// The same, without counting.
inline bool triangles_intersect(const TriangleD& a, const TriangleD& b) {
  std::uint64_t exact_calls = 0;
  return triangles_intersect(a, b, exact_calls);
}

}  // namespace crashrank
