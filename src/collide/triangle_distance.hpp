#pragma once

#include "crashrank/internal/collide/triangle_test.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace crashrank {

/// How far two triangles are apart, m, in the frame of their corners. The true distance lies in
/// [lower, upper].
struct TriangleGap {
  double lower = 0.0;  ///< proved by a separating direction; 0 exactly when the triangles intersect
  double upper = 0.0;  ///< distance of the two points
  Eigen::Vector3d point_a = Eigen::Vector3d::Zero();  ///< nearest point of the first, m
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  ///< nearest point of the second, m
  /// Unit vector along which `lower` was proved, from A to B; zero when the triangles intersect or
  /// are apart by too little for a proof in doubles (`lower` is then the smallest positive number).
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

namespace detail {

/// Width of the gap between two triangles along a unit direction, negative when they overlap there,
/// less what rounding may have added. Corners are taken relative to a point near both, so that the
/// margin follows the triangles' size and not their place: of the 7 operations for each corner none
/// handles more than 2·reach, which makes 14 u·reach a side; the direction's length is within 4 u
/// of 1, which adds 4 u·gap. 64 u·reach covers both sides.
inline double gap_along(const Eigen::Vector3d& direction, const TriangleD& a, const TriangleD& b,
                        const Eigen::Vector3d& near) {
  double a_end = -std::numeric_limits<double>::infinity();
  double b_begin = std::numeric_limits<double>::infinity();
  double reach = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d p = a.corner[i] - near;
    const Eigen::Vector3d q = b.corner[i] - near;
    a_end = std::max(a_end, direction.dot(p));
    b_begin = std::min(b_begin, direction.dot(q));
    reach = std::max({reach, p.cwiseAbs().sum(), q.cwiseAbs().sum()});
  }
  return (b_begin - a_end) - 0x1p-47 * reach;
}

/// Collects the closest pair of points and the directions worth a proof.
class GapSearch {
public:
  GapSearch(const TriangleD& a, const TriangleD& b) : a_(a), b_(b) {}

  TriangleGap run(std::uint64_t& exact_calls) {
    if (!edges_decide()) faces();
    TriangleGap gap;
    gap.point_a = point_a_;
    gap.point_b = point_b_;
    gap.upper = std::sqrt(best_);
    prove(gap);
    if (gap.lower <= 0.0) {
      if (triangles_intersect(a_, b_, exact_calls)) {
        gap.lower = 0.0;
        gap.upper = 0.0;
        gap.point_a = gap.point_b = common_point();
        gap.direction.setZero();
      } else {
        gap.lower = std::numeric_limits<double>::min();
        gap.upper = std::max(gap.upper, gap.lower);
        gap.direction.setZero();
      }
    }
    return gap;
  }

private:
  using Point = Eigen::Vector3d;

  void offer(const Point& p, const Point& q) {
    const double squared = (q - p).squaredNorm();
    if (squared < best_) {
      best_ = squared;
      point_a_ = p;
      point_b_ = q;
    }
  }

  static double on_segment(const Point& x, const Point& p, const Point& d, double dd) {
    return dd > 0.0 ? std::clamp(d.dot(x - p) / dd, 0.0, 1.0) : 0.0;
  }

  /// Closest points of two segments p + s·d, q + t·e. Nearly parallel ones have a closest pair at
  /// an end, which the four projections show in place of a cancelled determinant.
  void offer_segments(const Point& p, const Point& d, const Point& q, const Point& e, Point& x,
                      Point& y) const {
    const double dd = d.squaredNorm();
    const double ee = e.squaredNorm();
    const double de = d.dot(e);
    const double determinant = dd * ee - de * de;
    if (determinant > 1e-10 * dd * ee) {
      const Point r = p - q;
      const double dr = d.dot(r);
      const double er = e.dot(r);
      double s = std::clamp((de * er - dr * ee) / determinant, 0.0, 1.0);
      double t = (de * s + er) / ee;
      if (t < 0.0 || t > 1.0) {
        t = std::clamp(t, 0.0, 1.0);
        s = std::clamp((de * t - dr) / dd, 0.0, 1.0);
      }
      x = p + s * d;
      y = q + t * e;
      return;
    }
    double best = std::numeric_limits<double>::infinity();
    const auto consider = [&](const Point& u, const Point& v) {
      const double squared = (v - u).squaredNorm();
      if (squared < best) {
        best = squared;
        x = u;
        y = v;
      }
    };
    const Point p1 = p + d;
    const Point q1 = q + e;
    consider(p, q + on_segment(p, q, e, ee) * e);
    consider(p1, q + on_segment(p1, q, e, ee) * e);
    consider(p + on_segment(q, p, d, dd) * d, q);
    consider(p + on_segment(q1, p, d, dd) * d, q1);
  }

  /// Goes through the nine pairs of edges. True when one of them is the closest pair for certain:
  /// both remaining corners lie on the far sides of the two planes through it.
  bool edges_decide() {
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& p = a_.corner[i];
      const Point d = a_.corner[(i + 1) % 3] - p;
      for (std::size_t j = 0; j < 3; ++j) {
        const Point& q = b_.corner[j];
        const Point e = b_.corner[(j + 1) % 3] - q;
        Point x = p;
        Point y = q;
        offer_segments(p, d, q, e, x, y);
        const Point v = y - x;
        const double squared = v.squaredNorm();
        if (squared > best_) continue;
        offer(x, y);
        edge_a_ = i;
        edge_b_ = j;
        if (squared > 0.0 && v.dot(a_.corner[(i + 2) % 3] - x) <= 0.0 &&
            v.dot(b_.corner[(j + 2) % 3] - y) >= 0.0) {
          return true;
        }
      }
    }
    return false;
  }

  /// The corners of one triangle over the inside of the other.
  void faces() {
    for (const Point& corner : b_.corner) {
      Point foot;
      if (over(corner, a_, foot)) offer(foot, corner);
    }
    for (const Point& corner : a_.corner) {
      Point foot;
      if (over(corner, b_, foot)) offer(corner, foot);
    }
  }

  static bool over(const Point& x, const TriangleD& t, Point& foot) {
    const Point u = t.corner[1] - t.corner[0];
    const Point v = t.corner[2] - t.corner[0];
    const Point n = u.cross(v);
    const double nn = n.squaredNorm();
    if (!(nn > 0.0)) return false;
    const Point w = x - t.corner[0];
    const double beta = w.cross(v).dot(n) / nn;
    const double gamma = u.cross(w).dot(n) / nn;
    if (!(beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0)) return false;
    foot = t.corner[0] + beta * u + gamma * v;
    return true;
  }

  void try_direction(Point n, TriangleGap& gap) const {
    const double length = n.norm();
    if (!(length > 0.0)) return;
    n /= length;
    if (n.dot(point_b_ - point_a_) < 0.0) n = -n;
    const double width = gap_along(n, a_, b_, point_a_);
    if (width > gap.lower) {
      gap.lower = width;
      gap.direction = n;
    }
  }

  /// The line through the closest points proves the distance unless the points are so close that
  /// its direction is lost in rounding; then the normals of what they lie on do.
  void prove(TriangleGap& gap) const {
    try_direction(point_b_ - point_a_, gap);
    if (gap.lower >= gap.upper * (1.0 - 1e-9)) return;
    for (const TriangleD* t : {&a_, &b_}) {
      const Point n = (t->corner[1] - t->corner[0]).cross(t->corner[2] - t->corner[0]);
      try_both(n, gap);
    }
    const Point d = a_.corner[(edge_a_ + 1) % 3] - a_.corner[edge_a_];
    const Point e = b_.corner[(edge_b_ + 1) % 3] - b_.corner[edge_b_];
    try_both(d.cross(e), gap);
    gap.lower = std::min(gap.lower, gap.upper);
  }

  void try_both(const Point& n, TriangleGap& gap) const {
    const double length = n.norm();
    if (!(length > 0.0)) return;
    for (const double sign : {1.0, -1.0}) {
      const Point unit = n * (sign / length);
      const double width = gap_along(unit, a_, b_, point_a_);
      if (width > gap.lower) {
        gap.lower = width;
        gap.direction = unit;
      }
    }
  }

  /// A point of two triangles that intersect, within rounding: where an edge of one crosses the
  /// other's inside; for coplanar and touching ones the closest points found above. Of those the
  /// pair that lies closest together: where a sliver's normal is mostly rounding, a computed
  /// crossing may be far from the other triangle.
  Point common_point() const {
    Point common = 0.5 * (point_a_ + point_b_);
    double apart = (point_b_ - point_a_).squaredNorm();
    for (const auto& [s, t] : {std::pair{&a_, &b_}, std::pair{&b_, &a_}}) {
      const Point n = (t->corner[1] - t->corner[0]).cross(t->corner[2] - t->corner[0]);
      for (std::size_t i = 0; i < 3; ++i) {
        const Point& p = s->corner[i];
        const Point& q = s->corner[(i + 1) % 3];
        const double hp = n.dot(p - t->corner[0]);
        const double hq = n.dot(q - t->corner[0]);
        if (!(hp * hq < 0.0)) continue;
        const Point x = p + (hp / (hp - hq)) * (q - p);
        Point foot;
        if (over(x, *t, foot) && (foot - x).squaredNorm() < apart) {
          common = foot;
          apart = (foot - x).squaredNorm();
        }
      }
    }
    return common;
  }

  const TriangleD& a_;
  const TriangleD& b_;
  double best_ = std::numeric_limits<double>::infinity();
  Point point_a_ = Point::Zero();
  Point point_b_ = Point::Zero();
  std::size_t edge_a_ = 0;
  std::size_t edge_b_ = 0;
};

}  // namespace detail

/// Distance of two closed triangles, each the convex hull of its corners: segments and points
/// included. `lower` is sound whatever the corners' shape; where the triangles are proper it is
/// within about 1e-15 of their size below `upper`. About 0.2 us. `exact_calls` as in
/// triangles_intersect. Corners finite and below 1e75 m.
inline TriangleGap triangle_distance(const TriangleD& a, const TriangleD& b,
                                     std::uint64_t& exact_calls) {
  return detail::GapSearch(a, b).run(exact_calls);
}

/// The same, without counting.
inline TriangleGap triangle_distance(const TriangleD& a, const TriangleD& b) {
  std::uint64_t exact_calls = 0;
  return triangle_distance(a, b, exact_calls);
}

}  // namespace crashrank
