#include "motion/impact_search.hpp"

#include "collide/box_gap.hpp"
#include "collide/triangle_distance.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Farthest corner of a tree's root box from the body's origin, with room for rounding and for
/// rotations that are not quite orthonormal.
double radius_of(const AabbTree& tree) {
  const Box& box = tree.nodes[0].box;
  const Vector3d far =
      box.min.cast<double>().cwiseAbs().cwiseMax(box.max.cast<double>().cwiseAbs());
  return far.norm() * (1.0 + 1e-9);
}

/// Axis-aligned bounds of a triangle.
struct Span {
  Vector3d low;
  Vector3d high;
};

Span span_of(const TriangleD& t) {
  return {t.corner[0].cwiseMin(t.corner[1]).cwiseMin(t.corner[2]),
          t.corner[0].cwiseMax(t.corner[1]).cwiseMax(t.corner[2])};
}

/// How far two spans lie apart along each axis, signed from A to B.
Vector3d gap_between(const Span& a, const Span& b) {
  Vector3d gap;
  for (int i = 0; i < 3; ++i) {
    const double above = b.low[i] - a.high[i];
    const double below = a.low[i] - b.high[i];
    gap[i] = above > 0.0 ? above : (below > 0.0 ? -below : 0.0);
  }
  return gap;
}

/// Longest time for which `gap` (signed along three axes) is proved to stay open, trying the axes
/// one by one and together. `closing(n)` bounds the closing speed along a unit direction.
template <class Closing>
double longest(const Vector3d& gap, double less, double acceleration, double enough,
               Closing&& closing) {
  const double length = gap.norm();
  if (!(length > less)) return 0.0;
  Vector3d n = gap / length;
  double seconds = open_for(length - less, closing(n), acceleration);
  for (int i = 0; i < 3 && seconds < enough; ++i) {
    const double width = std::abs(gap[i]);
    if (!(width > less) || width == length) continue;
    n.setZero();
    n[i] = std::copysign(1.0, gap[i]);
    seconds = std::max(seconds, open_for(width - less, closing(n), acceleration));
  }
  return seconds;
}

}  // namespace

ImpactSearch::ImpactSearch(const AabbTree& a, const Motion& motion_a, const AabbTree& b,
                           const Motion& motion_b, double from, double until,
                           const ImpactOptions& options, SearchMemory& memory)
    : a_(a),
      motion_a_(motion_a),
      b_(b),
      motion_b_(motion_b),
      radii_{radius_of(a), radius_of(b)},
      until_(until),
      steps_left_(options.max_steps),
      stop_(options.stop),
      stop_context_(options.stop_context),
      memory_(memory) {
  const std::size_t needed = traversal_stack_size(a.depth, b.depth);
  if (memory_.stack.size() < needed) memory_.stack.resize(needed);
  place_knots(from);
}

/// Between knots a pair of boxes is extrapolated along its tangent; the knots are so close that
/// this gives away no more than a few millimetres of clearance, which is less than the smallest
/// boxes of a vehicle. Kinks are knots too, up to the very end: no pair of boxes is extrapolated
/// over a kink, and where one is left out, for want of room, all that is left of the work falls to
/// pairs of triangles.
void ImpactSearch::place_knots(double from) {
  constexpr double clearance = 0.004;
  constexpr double fewest = 16;
  std::vector<double>& times = memory_.times;
  times.clear();
  const double window = until_ - from;
  const double acceleration = state_at(from).acceleration;
  const double by_curve =
      acceleration > 0.0 ? window / std::sqrt(2.0 * clearance / acceleration) : 0.0;
  const auto count =
      static_cast<std::size_t>(std::clamp(by_curve, fewest, double{most_even_times}));
  double kink = from;
  for (std::size_t i = 0; i <= count; ++i) {
    const double t =
        i < count ? from + window * (static_cast<double>(i) / static_cast<double>(count)) : until_;
    while (times.size() + most_even_times < most_search_times) {
      const double next = std::min(motion_a_.next_kink(kink), motion_b_.next_kink(kink));
      if (!(next <= t)) break;
      kink = next;
      if (kink < t) times.push_back(kink);
    }
    if (i < count) times.push_back(t);
  }
  const std::size_t kept = std::min(times.size(), kept_knots);
  if (memory_.knots.size() < kept) memory_.knots.resize(kept);
  for (std::size_t i = 0; i < kept; ++i) memory_.knots[i].index = Knot::unmade;
}

RelativeState ImpactSearch::state_at(double t) {
  if (!last_ready_ || last_.time != t) {
    ++work_.poses;
    last_ = relative_state(motion_a_, motion_b_, radii_, t, until_);
    last_ready_ = true;
  }
  return last_;
}

std::size_t ImpactSearch::knot_index(double t) const {
  const auto after = std::upper_bound(memory_.times.begin(), memory_.times.end(), t);
  return static_cast<std::size_t>(after - memory_.times.begin()) - 1;
}

const Knot& ImpactSearch::knot(std::size_t index) {
  Knot& k = memory_.knots[index % kept_knots];
  if (k.index != index) {
    ++work_.poses;
    k.index = index;
    k.state = relative_state(motion_a_, motion_b_, radii_, memory_.times[index], until_);
    k.to = box_transform(a_, b_, k.state.b_in_a);
    k.shrink_b = shrink_along_b(k.to);
    k.v = k.state.v;
    k.omega_a = k.state.omega_a;
    k.omega_b = k.state.omega_b;
    if (!a_.axes_are_world) {
      const Eigen::Matrix3d back = a_.axes.transpose();
      // Fitted axes may form a left-handed frame, in which cross products turn round.
      const double hand = a_.axes.determinant() < 0.0 ? -1.0 : 1.0;
      k.v = rotate(back, k.v);
      k.omega_a = hand * rotate(back, k.omega_a);
      k.omega_b = hand * rotate(back, k.omega_b);
    }
    k.spin_a = k.omega_a.norm();
    k.spin_b = k.omega_b.norm();
  }
  return k;
}

double ImpactSearch::limit() const noexcept { return std::min(best_.time, until_); }

bool ImpactSearch::spend(std::uint64_t& counter) {
  constexpr std::uint64_t between_looks = 64;
  ++counter;
  const bool look = stop_ != nullptr && steps_left_ % between_looks == 0;
  if (steps_left_ == 0 || (look && stop_(stop_context_))) {
    exhausted_ = true;
    return false;
  }
  --steps_left_;
  return true;
}

/// Until when two boxes are proved apart by what is known of them at a knot. No point of a box
/// moves against its middle faster than the spin times half the box's diagonal, for which the sum
/// of the half extents stands.
double ImpactSearch::open_until(const Node& na, const Node& nb, const Knot& k, double limit,
                                double& guess) const {
  const RelativeState& s = k.state;
  const CentredBox box_a = centred(na.box);
  const CentredBox box_b = centred(nb.box);
  const Vector3d arm_b = rotate(k.to.rotation, box_b.center);
  const Vector3d apart = arm_b + k.to.translation - box_a.center;
  const BoxGap gap = box_gap(box_a, box_b, apart, k.to);
  const double less = thresholds_.prove_m + s.margin;
  const double enough = limit - s.time;
  const Vector3d v = k.v + k.omega_a.cross(box_a.center) - k.omega_b.cross(arm_b);
  const double spread = k.spin_a * box_a.half.sum() + k.spin_b * box_b.half.sum();
  double seconds = longest(gap.along_a, less, s.acceleration, enough,
                           [&](const Vector3d& n) { return n.dot(v) + spread; });
  if (seconds < enough) {
    const Vector3d v_b = rotate(k.to.rotation.transpose(), v);
    seconds = std::max(seconds, longest(gap.along_b * k.shrink_b, less, s.acceleration, enough,
                                        [&](const Vector3d& n) { return n.dot(v_b) + spread; }));
  }
  // How far along their closing velocity the boxes are from overlapping, or into it: not a bound,
  // but it orders two pairs of which both overlap by time.
  const double speed = v.norm();
  guess = s.time;
  if (speed > 0.0) {
    const Vector3d n = v / speed;
    const double reach = n.cwiseAbs().dot(box_a.half) +
                         rotate(k.to.rotation.transpose(), n).cwiseAbs().dot(box_b.half);
    guess += (n.dot(apart) - reach) / speed;
  }
  return std::min(s.time + seconds, s.horizon);
}

/// Carries a pair of boxes forward from the time until which what encloses it is proved apart, knot
/// by knot, as far as it can be.
ImpactSearch::Entry ImpactSearch::pair(std::uint32_t a, std::uint32_t b, double free_until) {
  const Node& na = a_.nodes[a];
  const Node& nb = b_.nodes[b];
  std::size_t index = knot_index(free_until);
  double guess = free_until;
  for (;;) {
    if (!spend(work_.bv_tests)) break;
    const double open = open_until(na, nb, knot(index), limit(), guess);
    if (open <= free_until) break;
    free_until = open;
    if (free_until >= limit()) break;
    const std::size_t next = knot_index(free_until);
    if (next == index) break;
    index = next;
  }
  return {a, b, free_until, guess};
}

PairContact ImpactSearch::follow(std::uint32_t slot_a, std::uint32_t slot_b, double from,
                                 double before, const Thresholds& thresholds, double give_up_m) {
  const TriangleD ta = to_double(a_.triangles[slot_a]);
  const Span span_a = span_of(ta);
  PairContact contact;
  double t = from;
  while (spend(work_.primitive_tests)) {
    const RelativeState s = state_at(t);
    const TriangleD tb = carry(s.b_in_a, b_.triangles[slot_b]);
    const TriangleGap gap = triangle_distance(ta, tb);
    const auto closing = [&](const Vector3d& n) { return closing_speed(n, ta, tb, s); };
    const double less = thresholds.prove_m + s.margin;
    double next = t;
    if (gap.upper > thresholds.stop_m) {
      if (gap.upper > give_up_m) return contact;
      double seconds = gap.lower > less
                           ? open_for(gap.lower - less, closing(gap.direction), s.acceleration)
                           : 0.0;
      const double enough = before - t;
      if (seconds < enough) {
        seconds = std::max(seconds, longest(gap_between(span_a, span_of(tb)), less, s.acceleration,
                                            enough, closing));
      }
      next = std::min(t + seconds, s.horizon);
    }
    // A gap that cannot be advanced although it is wider than `stop_m` is so by rounding alone.
    if (next <= t) {
      contact.time = t;
      contact.slot_a = slot_a;
      contact.slot_b = slot_b;
      contact.gap = gap;
      return contact;
    }
    t = next;
    if (t >= before) return contact;
  }
  return contact;
}

/// The same of two triangles, along the axes of A's body and along their own normals.
double ImpactSearch::open_until(const TriangleD& ta, const TriangleD& tb, const Knot& k,
                                double limit) const {
  const RelativeState& s = k.state;
  const double less = thresholds_.prove_m + s.margin;
  const double enough = limit - s.time;
  const Span a = span_of(ta);
  const Span b = span_of(tb);
  const Vector3d v = s.v + s.omega_a.cross(0.5 * (a.low + a.high)) -
                     s.omega_b.cross(0.5 * (b.low + b.high) - s.b_in_a.translation);
  const double spread =
      0.5 * (k.spin_a * (a.high - a.low).sum() + k.spin_b * (b.high - b.low).sum());
  const auto closing = [&](const Vector3d& n) { return n.dot(v) + spread; };
  double seconds = longest(gap_between(a, b), less, s.acceleration, enough, closing);
  for (const TriangleD* t : {&ta, &tb}) {
    if (seconds >= enough) break;
    const Vector3d normal = (t->corner[1] - t->corner[0]).cross(t->corner[2] - t->corner[0]);
    const double length = normal.norm();
    if (!(length > 0.0)) continue;
    Vector3d n = normal / length;
    if (n.dot(tb.corner[0] - ta.corner[0]) < 0.0) n = -n;
    const double gap = gap_along(n, ta, tb, t->corner[0]);
    if (gap > less) seconds = std::max(seconds, open_for(gap - less, closing(n), s.acceleration));
  }
  return std::min(s.time + seconds, s.horizon);
}

void ImpactSearch::leaves(const Node& na, const Node& nb, double free_until) {
  const Knot& k = knot(knot_index(free_until));
  for (std::uint32_t j = nb.first; j < nb.first + nb.count; ++j) {
    const TriangleD tb = carry(k.state.b_in_a, b_.triangles[j]);
    for (std::uint32_t i = na.first; i < na.first + na.count; ++i) {
      const double open =
          std::max(free_until, open_until(to_double(a_.triangles[i]), tb, k, limit()));
      if (open >= limit()) continue;
      const PairContact contact =
          follow(i, j, open, limit(), thresholds_, std::numeric_limits<double>::infinity());
      if (contact.time < best_.time) best_ = contact;
      if (exhausted_) return;
    }
  }
}

PairContact ImpactSearch::first(double from, const Thresholds& thresholds,
                                const PairContact& known) {
  thresholds_ = thresholds;
  best_ = known;
  std::vector<Entry>& stack = memory_.stack;
  std::size_t waiting = 0;
  Entry entry = pair(0, 0, from);
  for (;;) {
    if (exhausted_) {
      proved_until_ = std::min(entry.free_until, limit());
      for (std::size_t i = 0; i < waiting; ++i) {
        proved_until_ = std::min(proved_until_, stack[i].free_until);
      }
      return best_;
    }
    if (entry.free_until < limit()) {
      const Node& na = a_.nodes[entry.a];
      const Node& nb = b_.nodes[entry.b];
      if (!na.is_leaf() || !nb.is_leaf()) {
        const bool split_a =
            nb.is_leaf() || (!na.is_leaf() && half_area(na.box) >= half_area(nb.box));
        const double t = entry.free_until;
        Entry sooner = split_a ? pair(na.first, entry.b, t) : pair(entry.a, nb.first, t);
        Entry later = split_a ? pair(na.first + 1, entry.b, t) : pair(entry.a, nb.first + 1, t);
        if (later.free_until < sooner.free_until ||
            (later.free_until == sooner.free_until && later.guess < sooner.guess)) {
          std::swap(sooner, later);
        }
        if (later.free_until < limit()) stack[waiting++] = later;
        entry = sooner;
        continue;
      }
      leaves(na, nb, entry.free_until);
      if (exhausted_) continue;
    }
    if (waiting == 0) return best_;
    entry = stack[--waiting];
  }
}

}  // namespace crashrank::detail
