#include "rank/adjoin.hpp"

#include "crash/surface_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

double half_extent_along(const Rectangle& r, const Vector2d& direction) {
  return r.half[0] * std::abs(r.axis[0].dot(direction)) +
         r.half[1] * std::abs(r.axis[1].dot(direction));
}

constexpr double side_gap_m = 0.05;

/// Largest gap at which the bodies count as parts of one structure, m. It is larger where they
/// stand end to end.
double max_gap_m(const Rectangle& p, const Rectangle& q) {
  const Vector2d apart = q.center - p.center;
  double widest_gap = 0.0;
  double reach = side_gap_m;
  for (const Rectangle* r : {&p, &q}) {
    for (const Vector2d& axis : r->axis) {
      const double gap =
          std::abs(apart.dot(axis)) - half_extent_along(p, axis) - half_extent_along(q, axis);
      if (gap <= widest_gap) continue;
      widest_gap = gap;
      const Vector2d across(-axis.y(), axis.x());
      const double half_p = half_extent_along(p, across);
      const double half_q = half_extent_along(q, across);
      const double common =
          std::min({half_p + half_q - std::abs(apart.dot(across)), 2.0 * half_p, 2.0 * half_q});
      reach = common >= std::max(half_p, half_q) ? widest_joint_m : side_gap_m;
    }
  }
  return reach;
}

/// Separating-axis test: returns true if no side direction separates the rectangles by more than
/// `reach_m`.
bool boxes_within(const Rectangle& p, const Rectangle& q, double reach_m) {
  for (const Rectangle* r : {&p, &q}) {
    for (const Vector2d& axis : r->axis) {
      const double gap = std::abs((q.center - p.center).dot(axis)) - half_extent_along(p, axis) -
                         half_extent_along(q, axis);
      if (gap > reach_m) return false;
    }
  }
  return true;
}

/// Returns true if the heights of two bodies come within `reach_m` of each other.
bool heights_within(const Rectangle& p, const Rectangle& q, double reach_m) {
  return p.low_m - q.high_m <= reach_m && q.low_m - p.high_m <= reach_m;
}

/// A straight piece of an outline in plan view.
struct FixedSegment {
  Vector2d middle;  ///< relative to the origin of the search, world axes, m
  Vector2d half;    ///< vector from the middle to one end, m
  double half_m = 0.0;
};

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

double distance_m(const FixedSegment& s, const Vector2d& point) {
  const double along = std::clamp((point - s.middle).dot(s.half) / s.half.squaredNorm(), -1.0, 1.0);
  return (s.middle + along * s.half - point).norm();
}

bool cross_each_other(const FixedSegment& s, const FixedSegment& t) {
  const auto side = [](const FixedSegment& line, const Vector2d& point) {
    return cross(line.half, point - line.middle) > 0.0;
  };
  return side(s, t.middle - t.half) != side(s, t.middle + t.half) &&
         side(t, s.middle - s.half) != side(t, s.middle + s.half);
}

bool are_near(const FixedSegment& s, const FixedSegment& t, double reach_m) {
  if ((s.middle - t.middle).norm() > s.half_m + t.half_m + reach_m) return false;
  return distance_m(s, t.middle - t.half) <= reach_m ||
         distance_m(s, t.middle + t.half) <= reach_m ||
         distance_m(t, s.middle - s.half) <= reach_m ||
         distance_m(t, s.middle + s.half) <= reach_m || cross_each_other(s, t);
}

/// Planar frame of a body: its forward axis and its origin in plan view, as the contact law uses
/// them.
struct Heading {
  explicit Heading(const Pose& pose)
      : forward(pose.rotation.col(0).head<2>().normalized()), at(pose.translation.head<2>()) {}
  Vector2d to_world(double x, double y) const {
    return at + x * forward + y * Vector2d(-forward.y(), forward.x());
  }
  Vector2d to_body(const Vector2d& point) const {
    return {(point - at).dot(forward), cross(forward, point - at)};
  }
  Vector2d forward;
  Vector2d at;
};

/// Outline pieces of a body within `reach_m` of a rectangle, in ascending order of height bands.
std::vector<FixedSegment> segments_near(const Body& body, const Rectangle& box,
                                        const Vector2d& origin, double reach_m) {
  const Heading heading(body.fixed_pose);
  std::vector<FixedSegment> near;
  for (const OutlinePiece& piece : body.vehicle->profile->pieces) {
    const Vector2d middle = heading.to_world(piece.x, piece.y);
    const double half_m = 0.5 * static_cast<double>(piece.length_m);
    if (distance_m(box, middle) > half_m + reach_m) continue;
    const Vector2d end =
        heading.to_world(piece.x - half_m * piece.normal_y, piece.y + half_m * piece.normal_x);
    near.push_back({middle - origin, end - middle, half_m});
  }
  return near;
}

/// Uniform grid over segments, keyed by their middles. A cell is at least as wide as the largest
/// distance between the middles of two segments that are near each other, so searching a cell and
/// its eight neighbours finds every such pair.
class Grid {
public:
  Grid(const std::vector<FixedSegment>& segments, double longest_half_m)
      : cell_m_(2.0 * longest_half_m + widest_joint_m) {
    cells_.reserve(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i) {
      cells_.emplace_back(cell_of(segments[i]), static_cast<std::uint32_t>(i));
    }
    std::sort(cells_.begin(), cells_.end());
  }

  /// Returns true if the predicate holds for the index of any segment in the cell of `s` or in a
  /// neighbouring cell.
  template <class Predicate> bool any_near(const FixedSegment& s, Predicate&& predicate) const {
    const Cell own = cell_of(s);
    for (std::int64_t column = own.first - 1; column <= own.first + 1; ++column) {
      auto at = std::lower_bound(cells_.begin(), cells_.end(),
                                 std::pair{Cell{column, own.second - 1}, std::uint32_t{0}});
      for (; at != cells_.end() && at->first <= Cell{column, own.second + 1}; ++at) {
        if (predicate(at->second)) return true;
      }
    }
    return false;
  }

private:
  using Cell = std::pair<std::int64_t, std::int64_t>;
  Cell cell_of(const FixedSegment& s) const {
    return {static_cast<std::int64_t>(std::floor(s.middle.x() / cell_m_)),
            static_cast<std::int64_t>(std::floor(s.middle.y() / cell_m_))};
  }

  double cell_m_;
  std::vector<std::pair<Cell, std::uint32_t>> cells_;
};

double longest_half_m(const std::vector<FixedSegment>& segments) {
  double longest = 0.0;
  for (const FixedSegment& s : segments) longest = std::max(longest, s.half_m);
  return longest;
}

bool outlines_within(const std::vector<FixedSegment>& p, const std::vector<FixedSegment>& q,
                     double reach_m) {
  const Grid grid(q, std::max(longest_half_m(p), longest_half_m(q)));
  return std::any_of(p.begin(), p.end(), [&](const FixedSegment& s) {
    return grid.any_near(s, [&](std::uint32_t i) { return are_near(s, q[i], reach_m); });
  });
}

/// Returns true if `other` faces `s`: it runs in the opposite direction and crosses the outward
/// normal of `s` within `widest_joint_m`. All segments have the body on the same side.
bool faces(const FixedSegment& s, const FixedSegment& other) {
  constexpr double opposed = -0.5;
  const Vector2d along = s.half / s.half_m;
  if (along.dot(other.half) > opposed * other.half_m) return false;
  // Intersection of the outward normal through the middle of `s` with the line of `other`.
  const Vector2d normal(along.y(), -along.x());
  const Vector2d apart = other.middle - s.middle;
  const double across = cross(normal, other.half);
  if (across == 0.0) return false;
  const double ahead_m = cross(apart, other.half) / across;
  const double on_other = cross(apart, normal) / across;
  constexpr double reach = 1.0 + 1e-6;
  return ahead_m > 0.0 && ahead_m <= widest_joint_m && std::abs(on_other) <= reach;
}

/// Returns true if at least one piece lies inside the outlines of the body. Requires that no piece
/// crosses these outlines.
bool lies_inside(const std::vector<FixedSegment>& pieces, const Body& body,
                 const Vector2d& origin) {
  const Heading heading(body.fixed_pose);
  const FixedSegment* before = nullptr;
  for (const FixedSegment& s : pieces) {
    // No outline crosses the loop, so all of its pieces lie on the same side: testing the first is
    // enough.
    const bool same_loop = before != nullptr &&
                           (s.middle - before->middle).norm() <= 1.01 * (s.half_m + before->half_m);
    before = &s;
    if (same_loop) continue;
    const Vector2d local = heading.to_body(s.middle + origin);
    for (std::size_t band = 0; band < profile_bands; ++band) {
      if (inside_outline(*body.vehicle, band, static_cast<float>(local.x()),
                         static_cast<float>(local.y()))) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

Rectangle rectangle_of(const Body& fixed) {
  const Box box = fixed.model->mesh.bounds();
  const Pose pose = fixed.fixed_pose;
  const Eigen::Vector3d center = pose.rotation * box.center().cast<double>() + pose.translation;
  const Eigen::Vector3d size = box.extent().cast<double>();
  return {
      center.head<2>(),
      {pose.rotation.col(0).head<2>().normalized(), pose.rotation.col(1).head<2>().normalized()},
      {0.5 * size.x(), 0.5 * size.y()},
      center.z() - 0.5 * size.z(),
      center.z() + 0.5 * size.z()};
}

double distance_m(const Rectangle& rectangle, const Vector2d& point) {
  const Vector2d from = point - rectangle.center;
  const double along = std::abs(from.dot(rectangle.axis[0])) - rectangle.half[0];
  const double beside = std::abs(from.dot(rectangle.axis[1])) - rectangle.half[1];
  return std::hypot(std::max(along, 0.0), std::max(beside, 0.0));
}

bool adjoin(const Body& p, const Rectangle& box_p, const Body& q, const Rectangle& box_q) {
  const double reach_m = max_gap_m(box_p, box_q);
  if (!boxes_within(box_p, box_q, reach_m) || !heights_within(box_p, box_q, side_gap_m)) {
    return false;
  }
  const Vector2d origin = box_p.center;
  const std::vector<FixedSegment> of_p = segments_near(p, box_q, origin, reach_m);
  const std::vector<FixedSegment> of_q = segments_near(q, box_p, origin, reach_m);
  return outlines_within(of_p, of_q, reach_m) || lies_inside(of_p, q, origin) ||
         lies_inside(of_q, p, origin);
}

std::vector<std::uint8_t> pieces_in_joints(const Profile& profile) {
  std::vector<std::uint8_t> in_joint(profile.pieces.size(), 0);
  for (std::size_t band = 0; band < profile_bands; ++band) {
    std::vector<FixedSegment> segments;
    for (std::size_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
      const OutlinePiece& piece = profile.pieces[i];
      const double half_m = 0.5 * static_cast<double>(piece.length_m);
      segments.push_back({Vector2d(static_cast<double>(piece.x), static_cast<double>(piece.y)),
                          half_m * Vector2d(-static_cast<double>(piece.normal_y),
                                            static_cast<double>(piece.normal_x)),
                          half_m});
    }
    const Grid grid(segments, longest_half_m(segments));
    for (std::size_t i = 0; i < segments.size(); ++i) {
      in_joint[profile.first[band] + i] = static_cast<std::uint8_t>(grid.any_near(
          segments[i], [&](std::uint32_t k) { return faces(segments[i], segments[k]); }));
    }
  }
  return in_joint;
}

}  // namespace crashrank::detail
