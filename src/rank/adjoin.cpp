#include "rank/adjoin.hpp"

#include "crash/surface_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace crashrank::detail {
namespace {

using Eigen::Vector2d;

constexpr double adjoining_m = 0.05;

double reach_along(const Rectangle& r, const Vector2d& direction) {
  return r.half[0] * std::abs(r.axis[0].dot(direction)) +
         r.half[1] * std::abs(r.axis[1].dot(direction));
}

/// Separating axes of two rectangles.
bool boxes_adjoin(const Rectangle& p, const Rectangle& q) {
  for (const Rectangle* r : {&p, &q}) {
    for (const Vector2d& axis : r->axis) {
      const double gap =
          std::abs((q.center - p.center).dot(axis)) - reach_along(p, axis) - reach_along(q, axis);
      if (gap > adjoining_m) return false;
    }
  }
  return true;
}

/// A piece of an outline.
struct Segment {
  Vector2d middle;  ///< from the origin of the search, world axes, m
  Vector2d half;    ///< from the middle to one end
  double half_m = 0.0;
};

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

double distance_m(const Segment& s, const Vector2d& point) {
  const double along = std::clamp((point - s.middle).dot(s.half) / s.half.squaredNorm(), -1.0, 1.0);
  return (s.middle + along * s.half - point).norm();
}

bool cross_each_other(const Segment& s, const Segment& t) {
  const auto side = [](const Segment& line, const Vector2d& point) {
    return cross(line.half, point - line.middle) > 0.0;
  };
  return side(s, t.middle - t.half) != side(s, t.middle + t.half) &&
         side(t, s.middle - s.half) != side(t, s.middle + s.half);
}

bool are_near(const Segment& s, const Segment& t) {
  if ((s.middle - t.middle).norm() > s.half_m + t.half_m + adjoining_m) return false;
  return distance_m(s, t.middle - t.half) <= adjoining_m ||
         distance_m(s, t.middle + t.half) <= adjoining_m ||
         distance_m(t, s.middle - s.half) <= adjoining_m ||
         distance_m(t, s.middle + s.half) <= adjoining_m || cross_each_other(s, t);
}

/// A body's heading seen from above, as the contact law has it.
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

/// The pieces of a body's outlines that lie within reach of a rectangle, by rising band.
std::vector<Segment> segments_near(const Body& body, const Rectangle& box, const Vector2d& origin) {
  const Heading heading(body.standing);
  std::vector<Segment> near;
  for (const OutlinePiece& piece : body.vehicle.profile->pieces) {
    const Vector2d middle = heading.to_world(piece.x, piece.y);
    const double half_m = 0.5 * static_cast<double>(piece.length_m);
    if (distance_m(box, middle) > half_m + adjoining_m) continue;
    const Vector2d end =
        heading.to_world(piece.x - half_m * piece.normal_y, piece.y + half_m * piece.normal_x);
    near.push_back({middle - origin, end - middle, half_m});
  }
  return near;
}

/// Sorts one's pieces into the cells of a grid and looks around each of the other's.
bool outlines_near(const std::vector<Segment>& p, const std::vector<Segment>& q) {
  double longest_m = 0.0;
  for (const std::vector<Segment>* side : {&p, &q}) {
    for (const Segment& s : *side) longest_m = std::max(longest_m, s.half_m);
  }
  // No two pieces that are near have middles in cells that do not touch.
  const double cell_m = 2.0 * longest_m + adjoining_m;
  using Cell = std::pair<std::int64_t, std::int64_t>;
  const auto cell_of = [cell_m](const Segment& s) {
    return Cell{static_cast<std::int64_t>(std::floor(s.middle.x() / cell_m)),
                static_cast<std::int64_t>(std::floor(s.middle.y() / cell_m))};
  };
  std::vector<std::pair<Cell, std::uint32_t>> grid;
  grid.reserve(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    grid.emplace_back(cell_of(q[i]), static_cast<std::uint32_t>(i));
  }
  std::sort(grid.begin(), grid.end());
  for (const Segment& s : p) {
    const Cell own = cell_of(s);
    for (std::int64_t column = own.first - 1; column <= own.first + 1; ++column) {
      auto at = std::lower_bound(grid.begin(), grid.end(),
                                 std::pair{Cell{column, own.second - 1}, std::uint32_t{0}});
      for (; at != grid.end() && at->first <= Cell{column, own.second + 1}; ++at) {
        if (are_near(s, q[at->second])) return true;
      }
    }
  }
  return false;
}

/// Whether one of the pieces, none of which is near the body's outlines, lies inside them.
bool lies_inside(const std::vector<Segment>& pieces, const Body& body, const Vector2d& origin) {
  const Heading heading(body.standing);
  const Segment* before = nullptr;
  for (const Segment& s : pieces) {
    // Of a loop that no outline crosses all pieces lie on one side.
    const bool same_loop = before != nullptr &&
                           (s.middle - before->middle).norm() <= 1.01 * (s.half_m + before->half_m);
    before = &s;
    if (same_loop) continue;
    const Vector2d local = heading.to_body(s.middle + origin);
    for (std::size_t band = 0; band < profile_bands; ++band) {
      if (inside_outline(body.vehicle, band, static_cast<float>(local.x()),
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
  const Pose pose = fixed.standing;
  const Eigen::Vector3d center = pose.rotation * box.center().cast<double>() + pose.translation;
  const Eigen::Vector3d size = box.extent().cast<double>();
  return {
      center.head<2>(),
      {pose.rotation.col(0).head<2>().normalized(), pose.rotation.col(1).head<2>().normalized()},
      {0.5 * size.x(), 0.5 * size.y()}};
}

double distance_m(const Rectangle& rectangle, const Vector2d& point) {
  const Vector2d from = point - rectangle.center;
  const double along = std::abs(from.dot(rectangle.axis[0])) - rectangle.half[0];
  const double beside = std::abs(from.dot(rectangle.axis[1])) - rectangle.half[1];
  return std::hypot(std::max(along, 0.0), std::max(beside, 0.0));
}

bool adjoin(const Body& p, const Rectangle& box_p, const Body& q, const Rectangle& box_q) {
  if (!boxes_adjoin(box_p, box_q)) return false;
  const Vector2d origin = box_p.center;
  const std::vector<Segment> of_p = segments_near(p, box_q, origin);
  const std::vector<Segment> of_q = segments_near(q, box_p, origin);
  return outlines_near(of_p, of_q) || lies_inside(of_p, q, origin) || lies_inside(of_q, p, origin);
}

}  // namespace crashrank::detail
