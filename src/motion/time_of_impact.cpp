#include "crashrank/motion/time_of_impact.hpp"

#include "base/hidden.hpp"
#include "motion/impact_search.hpp"
#include "motion/relative_motion.hpp"

#include "collide/triangle_distance.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/internal/base/products.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/internal/motion/containment.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank {

struct CRASHRANK_HIDDEN ImpactWorkspace::State {
  detail::SearchMemory search;
  DistanceWorkspace distance;
  CollideWorkspace collide;
  std::vector<Pair> pairs;
};

ImpactWorkspace::ImpactWorkspace() : state_(std::make_unique<State>()) {}
ImpactWorkspace::~ImpactWorkspace() = default;
ImpactWorkspace::ImpactWorkspace(ImpactWorkspace&&) noexcept = default;
ImpactWorkspace& ImpactWorkspace::operator=(ImpactWorkspace&&) noexcept = default;

void ImpactWorkspace::prepare(std::uint32_t depth_a, std::uint32_t depth_b) {
  const std::size_t needed = traversal_stack_size(depth_a, depth_b);
  State& memory = *state_;
  if (memory.search.stack.size() < needed) memory.search.stack.resize(needed);
  if (memory.distance.stack.size() < needed) memory.distance.stack.resize(needed);
  memory.collide.prepare(depth_a, depth_b);
  memory.search.times.reserve(detail::most_search_times);
  memory.search.knots.resize(detail::kept_knots);
  // A leaf's triangles against a leaf's: a query for any pair ends with them.
  constexpr std::size_t leaf_pairs = 4096;
  memory.pairs.reserve(leaf_pairs);
}

namespace {

using Eigen::Vector3d;

/// Surfaces this close touch: below what float32 vertices of a vehicle are rounded by.
constexpr double touch_m = 1e-7;

struct Sphere {
  Vector3d center;  ///< body coordinates
  double radius = 0.0;
};

Sphere sphere_around(const AabbTree& tree) {
  const Box& box = tree.nodes[0].box;
  const Vector3d low = box.min.cast<double>();
  const Vector3d high = box.max.cast<double>();
  Vector3d center = 0.5 * (low + high);
  if (!tree.axes_are_world) center = detail::rotate(tree.axes, center);
  const double size = center.cwiseAbs().sum() + (high - low).norm();
  return {center, 0.5 * (high - low).norm() + 1e-9 * size};
}

/// A time in [from, until] before which two bodies' bounding spheres stay apart by `less` and more:
/// the end if they never touch.
double spheres_apart_until(const AabbTree& a, const Motion& motion_a, const AabbTree& b,
                           const Motion& motion_b, double from, double until, double less,
                           ImpactWork& work) {
  constexpr int most_steps = 64;
  const Sphere ball_a = sphere_around(a);
  const Sphere ball_b = sphere_around(b);
  const double reach = ball_a.radius + ball_b.radius + less;
  double t = from;
  for (int step = 0; step < most_steps && t < until; ++step) {
    ++work.poses;
    ++work.bv_tests;
    Pose pose_a;
    Pose pose_b;
    Velocity velocity_a;
    Velocity velocity_b;
    motion_a.state_at(t, pose_a, velocity_a);
    motion_b.state_at(t, pose_b, velocity_b);
    const Vector3d center_a = detail::rotate(pose_a.rotation, ball_a.center) + pose_a.translation;
    const Vector3d center_b = detail::rotate(pose_b.rotation, ball_b.center) + pose_b.translation;
    const Vector3d apart = center_b - center_a;
    const double distance = apart.norm();
    const double margin = 0x1p-46 * (center_a.cwiseAbs().sum() + center_b.cwiseAbs().sum() + reach);
    const double gap = distance - reach - margin;
    // Once the spheres nearly touch, the boxes give a better bound than many small steps.
    if (gap <= 0.02 * reach) return t;
    const Vector3d n = apart / distance;
    const double closing = n.dot(velocity_of_point(velocity_a, pose_a.translation, center_a) -
                                 velocity_of_point(velocity_b, pose_b.translation, center_b));
    const double horizon = std::min({motion_a.next_kink(t), motion_b.next_kink(t), until});
    const double acceleration =
        detail::point_acceleration(motion_a.bound(t, horizon), ball_a.center.norm()) +
        detail::point_acceleration(motion_b.bound(t, horizon), ball_b.center.norm());
    t = std::min(t + detail::open_for(gap, closing, acceleration), horizon);
  }
  return t;
}

bool root_boxes_apart(const AabbTree& a, const AabbTree& b, const Pose& b_in_a) {
  return !boxes_may_touch(a.nodes[0].box, b.nodes[0].box, box_transform(a, b, b_in_a));
}

/// Overlap or containment of two bodies as they stand; false when they are apart. Fills the
/// witnesses in A's frame.
bool overlap(const AabbTree& a, const AabbTree& b, const Pose& b_in_a,
             ImpactWorkspace::State& memory, Impact& impact) {
  ++impact.work.bv_tests;
  if (root_boxes_apart(a, b, b_in_a)) return false;
  CollideOptions any;
  any.any = true;
  const CollideResult result = collide(a, b, b_in_a, memory.pairs, memory.collide, any);
  impact.work.bv_tests += result.work.bv_tests;
  impact.work.primitive_tests += result.work.primitive_tests;
  if (result.intersecting) {
    impact.state = ImpactState::overlapping;
    impact.triangle_a = memory.pairs[0].a;
    impact.triangle_b = memory.pairs[0].b;
    const auto slot_of = [](const AabbTree& tree, std::int32_t triangle) {
      const auto at =
          std::find(tree.order.begin(), tree.order.end(), static_cast<std::uint32_t>(triangle));
      return static_cast<std::size_t>(at - tree.order.begin());
    };
    const TriangleGap gap =
        triangle_distance(to_double(a.triangles[slot_of(a, impact.triangle_a)]),
                          carry(b_in_a, b.triangles[slot_of(b, impact.triangle_b)]));
    impact.point_a_m = gap.point_a;
    impact.point_b_m = gap.point_b;
    return true;
  }
  if (containment(a, b, b_in_a) != Containment::apart) {
    impact.state = ImpactState::contained;
    return true;
  }
  return false;
}

void to_world(const Pose& a_in_world, Impact& impact) {
  if (impact.triangle_a < 0) return;
  for (Vector3d* point : {&impact.point_a_m, &impact.point_b_m}) {
    *point = detail::rotate(a_in_world.rotation, *point) + a_in_world.translation;
  }
  impact.normal = detail::rotate(a_in_world.rotation, impact.normal);
}

class Query {
public:
  Query(const AabbTree& a, const Motion& motion_a, const AabbTree& b, const Motion& motion_b,
        double until, ImpactWorkspace::State& memory, const ImpactOptions& options)
      : a_(a),
        motion_a_(motion_a),
        b_(b),
        motion_b_(motion_b),
        until_(until),
        memory_(memory),
        options_(options) {}

  void run(double from, Impact& impact) {
    const double tolerance = options_.tolerance_m;
    const double near =
        spheres_apart_until(a_, motion_a_, b_, motion_b_, from, until_, tolerance, impact.work);
    if (near >= until_) {
      impact.time_s = until_;
      return;
    }
    detail::ImpactSearch search(a_, motion_a_, b_, motion_b_, near, until_, options_,
                                memory_.search);
    decide(search, near, impact);
    impact.work += search.work();
  }

private:
  void decide(detail::ImpactSearch& search, double from, Impact& impact) {
    const double tolerance = options_.tolerance_m;
    const detail::PairContact near = search.first(from, {tolerance, tolerance * (1.0 - 1e-3)});
    if (search.exhausted()) {
      impact.state = ImpactState::undecided;
      impact.time_s = search.proved_until();
      return;
    }
    if (near.time >= until_) {
      impact.time_s = until_;
      return;
    }
    // Do they go on to touch? Mostly the two triangles that came near do so at once.
    const detail::Thresholds touching{std::min(touch_m, 1e-3 * tolerance), 0.0};
    const detail::PairContact same =
        search.follow(near.slot_a, near.slot_b, near.time, until_, touching, tolerance);
    detail::PairContact touch = same;
    if (same.time >= until_) touch = search.first(near.time, touching);
    if (search.exhausted()) {
      impact.state = ImpactState::undecided;
      impact.time_s = near.time;
      return;
    }
    const bool touches = touch.time < until_;
    const bool apart_between =
        touches && same.time >= until_ && parted(search, near.time, touch.time, impact.work);
    if (stopped_) {
      impact.state = ImpactState::undecided;
      impact.time_s = near.time;
      return;
    }
    impact.state = touches ? ImpactState::contact : ImpactState::grazing;
    detail::PairContact reported = near;
    if (apart_between) {
      reported = touch;
      impact.grazed = true;
      impact.graze_time_s = near.time;
    }
    impact.time_s = reported.time;
    impact.gap_m = reported.gap.upper;
    impact.triangle_a = static_cast<std::int32_t>(a_.order[reported.slot_a]);
    impact.triangle_b = static_cast<std::int32_t>(b_.order[reported.slot_b]);
    impact.point_a_m = reported.gap.point_a;
    impact.point_b_m = reported.gap.point_b;
    impact.normal = reported.gap.direction;
    to_world(search.state_at(reported.time).a_in_world, impact);
  }

  /// Whether the surfaces are seen further apart than the tolerance between two times.
  bool parted(detail::ImpactSearch& search, double from, double until, ImpactWork& work) {
    constexpr int instants = 16;
    for (int i = 1; i < instants; ++i) {
      stopped_ = options_.stop != nullptr && options_.stop(options_.stop_context);
      if (stopped_) return false;
      const detail::RelativeState s = search.state_at(from + (until - from) * i / instants);
      DistanceOptions cutoff;
      cutoff.cutoff_m = options_.tolerance_m;
      const DistanceResult gap = distance(a_, b_, s.b_in_a, memory_.distance, cutoff);
      work.bv_tests += gap.work.bv_tests;
      work.primitive_tests += gap.work.primitive_tests;
      if (gap.beyond_cutoff) return true;
    }
    return false;
  }

  const AabbTree& a_;
  const Motion& motion_a_;
  const AabbTree& b_;
  const Motion& motion_b_;
  double until_;
  ImpactWorkspace::State& memory_;
  const ImpactOptions& options_;
  bool stopped_ = false;
};

}  // namespace

Impact initial_state(const AabbTree& a, const Pose& a_in_world, const AabbTree& b,
                     const Pose& b_in_world, ImpactWorkspace& workspace,
                     const ImpactOptions& options) {
  Impact impact;
  if (a.empty() || b.empty()) return impact;
  ImpactWorkspace::State& memory = workspace.state();
  const Pose b_in_a = relative(a_in_world, b_in_world);
  if (!overlap(a, b, b_in_a, memory, impact)) {
    DistanceOptions cutoff;
    cutoff.cutoff_m = options.tolerance_m;
    const DistanceResult gap = distance(a, b, b_in_a, memory.distance, cutoff);
    impact.work.bv_tests += gap.work.bv_tests;
    impact.work.primitive_tests += gap.work.primitive_tests;
    if (!gap.beyond_cutoff) {
      impact.state = ImpactState::grazing;
      impact.gap_m = gap.upper_m;
      impact.triangle_a = gap.triangle_a;
      impact.triangle_b = gap.triangle_b;
      impact.point_a_m = gap.point_a_m;
      impact.point_b_m = gap.point_b_m;
      const Vector3d across = gap.point_b_m - gap.point_a_m;
      if (across.norm() > 0.0) impact.normal = across.normalized();
    }
  }
  to_world(a_in_world, impact);
  return impact;
}

Impact time_of_impact(const AabbTree& a, const Motion& motion_a, const AabbTree& b,
                      const Motion& motion_b, double from_s, double until_s,
                      ImpactWorkspace& workspace, const ImpactOptions& options) {
  Impact impact;
  impact.time_s = std::max(from_s, until_s);
  if (a.empty() || b.empty()) return impact;
  if (!(until_s > from_s)) {
    impact =
        initial_state(a, motion_a.pose_at(from_s), b, motion_b.pose_at(from_s), workspace, options);
    impact.time_s = from_s;
    return impact;
  }
  ImpactWorkspace::State& memory = workspace.state();
  if (!options.start_is_apart) {
    const Pose a_in_world = motion_a.pose_at(from_s);
    ++impact.work.poses;
    if (overlap(a, b, relative(a_in_world, motion_b.pose_at(from_s)), memory, impact)) {
      impact.time_s = from_s;
      to_world(a_in_world, impact);
      return impact;
    }
  }
  Query(a, motion_a, b, motion_b, until_s, memory, options).run(from_s, impact);
  return impact;
}

}  // namespace crashrank
