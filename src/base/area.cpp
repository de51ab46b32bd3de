#include "crashrank/base/area.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace crashrank {
namespace {

using Eigen::Vector2d;

struct RingEdge {
  Vector2d from;
  Vector2d to;
  std::size_t ring = 0;   ///< 0: the outer one, then the holes
  std::size_t index = 0;  ///< of its first corner
  std::size_t corners = 0;
};

std::string ring_name(const std::string& place, std::size_t ring) {
  return ring == 0 ? place + ".outer" : place + ".holes[" + std::to_string(ring - 1) + "]";
}

Error refused(std::string place, std::string reason, std::string remedy) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), std::move(remedy));
  error.place = std::move(place);
  return error;
}

/// Twice the area of the triangle, positive to the left. Coordinates below 1e6 m keep its sign but
/// for corners a few nanometres from the line.
double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool boxes_overlap(const RingEdge& p, const RingEdge& q) {
  return std::min(p.from.x(), p.to.x()) <= std::max(q.from.x(), q.to.x()) &&
         std::min(q.from.x(), q.to.x()) <= std::max(p.from.x(), p.to.x()) &&
         std::min(p.from.y(), p.to.y()) <= std::max(q.from.y(), q.to.y()) &&
         std::min(q.from.y(), q.to.y()) <= std::max(p.from.y(), p.to.y());
}

bool edges_touch(const RingEdge& p, const RingEdge& q) {
  if (!boxes_overlap(p, q)) return false;
  const double a = turn(p.from, p.to, q.from);
  const double b = turn(p.from, p.to, q.to);
  const double c = turn(q.from, q.to, p.from);
  const double d = turn(q.from, q.to, p.to);
  return !((a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0) || (c > 0.0 && d > 0.0) ||
           (c < 0.0 && d < 0.0));
}

/// Whether an edge runs back along the one before it.
bool turns_back(const RingEdge& edge, const RingEdge& next) {
  return turn(edge.from, edge.to, next.to) == 0.0 &&
         (edge.to - edge.from).dot(next.to - next.from) < 0.0;
}

bool are_neighbours(const RingEdge& p, const RingEdge& q) {
  return p.ring == q.ring &&
         ((p.index + 1) % p.corners == q.index || (q.index + 1) % q.corners == p.index);
}

Status add_edges(const std::vector<Vector2d>& ring, std::size_t index, const std::string& place,
                 std::vector<RingEdge>& edges) {
  if (ring.size() < 3) {
    return refused(ring_name(place, index), "has fewer than three corners",
                   "list the corners of a polygon in their order");
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const RingEdge edge{ring[i], ring[(i + 1) % ring.size()], index, i, ring.size()};
    if (!edge.from.allFinite()) {
      return refused(ring_name(place, index), "has a corner that is not finite", "correct it");
    }
    if (edge.from == edge.to) {
      return refused(ring_name(place, index) + "[" + std::to_string(i) + "]",
                     "is the same corner as the next one",
                     "list each corner once; the last is joined with the first");
    }
    edges.push_back(edge);
  }
  return Success{};
}

/// Even-odd rule; an edge holds its lower end, so that common edges count for one of two areas.
bool is_inside(const std::vector<Vector2d>& ring, const Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, k = ring.size() - 1; i < ring.size(); k = i++) {
    const Vector2d& a = ring[i];
    const Vector2d& b = ring[k];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    // From the lower end to the upper, so that a common edge has the same bits for both areas.
    const Vector2d& low = a.y() < b.y() ? a : b;
    const Vector2d& high = a.y() < b.y() ? b : a;
    if (turn(low, high, point) > 0.0) inside = !inside;
  }
  return inside;
}

}  // namespace

Status check_area(const Area& area, const std::string& place) {
  std::vector<RingEdge> edges;
  if (Status sound = add_edges(area.outer, 0, place, edges); !sound) return sound;
  for (std::size_t i = 0; i < area.holes.size(); ++i) {
    if (Status sound = add_edges(area.holes[i], i + 1, place, edges); !sound) return sound;
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t k = i + 1; k < edges.size(); ++k) {
      const RingEdge& p = edges[i];
      const RingEdge& q = edges[k];
      bool crossing = false;
      if (are_neighbours(p, q)) {
        const bool p_first = (p.index + 1) % p.corners == q.index;
        crossing = p_first ? turns_back(p, q) : turns_back(q, p);
      } else {
        crossing = edges_touch(p, q);
      }
      if (!crossing) continue;
      const auto name = [](const RingEdge& edge) {
        return std::to_string(edge.index) + " to " +
               std::to_string((edge.index + 1) % edge.corners);
      };
      const std::string other = q.ring == p.ring ? "the edge from corner " + name(q)
                                                 : "an edge of " + ring_name(place, q.ring);
      return refused(
          ring_name(place, p.ring),
          "crosses or touches itself: the edge from corner " + name(p) + " and " + other + " touch",
          "list the corners in their order around it; write parts that touch as areas of "
          "their own");
    }
  }
  // No two rings touch, so a hole is on one side of the border as a whole.
  for (std::size_t i = 0; i < area.holes.size(); ++i) {
    if (is_inside(area.outer, area.holes[i].front())) continue;
    return refused(ring_name(place, i + 1), "lies outside " + ring_name(place, 0),
                   "remove it, or move it inside the border of its area");
  }
  return Success{};
}

namespace {

double distance2(const std::vector<Vector2d>& ring, const Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, k = ring.size() - 1; i < ring.size(); k = i++) {
    const Vector2d along = ring[i] - ring[k];
    const double share = std::clamp((point - ring[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (ring[k] + share * along - point).squaredNorm());
  }
  return least;
}

}  // namespace

bool holds(View<const Area> areas, const Vector2d& point_m) noexcept {
  return std::any_of(areas.begin(), areas.end(), [&](const Area& area) {
    return is_inside(area.outer, point_m) &&
           std::none_of(area.holes.begin(), area.holes.end(),
                        [&](const auto& hole) { return is_inside(hole, point_m); });
  });
}

double distance_to_border_m(View<const Area> areas, const Vector2d& point_m) noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (const Area& area : areas) {
    least = std::min(least, distance2(area.outer, point_m));
    for (const auto& hole : area.holes) least = std::min(least, distance2(hole, point_m));
  }
  return std::sqrt(least);
}

}  // namespace crashrank
