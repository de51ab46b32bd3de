#include "rank/box_crash.hpp"

#include "crash/contact_run.hpp"
#include "rank/crash_chain.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

// The coarseness is a design choice; regret_bench shows what comes of it.

/// Shortest step of boxes that overlap or meet, longest one of bodies on their wheels, longest one
/// of bodies on their plans, s.
constexpr double shortest_s = 0.012;
constexpr double rolling_s = 0.02;
constexpr double longest_s = 0.05;
/// Travel in a step of boxes that overlap, m.
constexpr double travel_m = 0.2;
/// Boxes that close more slowly do not crush each other, m/s.
constexpr double least_closing_mps = 0.5;
/// The crash ends this long after the ego has left its plan, s: what follows says little about the
/// order.
constexpr double whole_s = 1.0;
/// A body leaves its plan once contacts have changed its velocity by this, m/s.
constexpr double leaves_plan_mps = 0.5;
/// Between folded and smooth metal.
constexpr double friction = 0.4;
/// Slope behind the free crush length over that before it.
constexpr double hardening = 5.0;
/// Height over which crush intrudes, m.
constexpr double intruding_height_m = 0.5;
/// Bodies may become faster by this before a pair of them is looked at again, m/s.
constexpr double faster_mps = 10.0;
constexpr std::size_t most_pairs = 64;

/// Corners of a polygon: the overlap of two boxes.
struct Polygon {
  struct Point {
    double x = 0.0;
    double y = 0.0;
  };
  std::array<Point, 12> points;
  std::size_t count = 0;

  /// Keeps the part where `sign`·(coordinate `axis`) is at most `limit`.
  void clip(double Point::*axis, double Point::*other, double sign, double limit) {
    Polygon kept;
    for (std::size_t k = 0; k < count; ++k) {
      const Point& from = points[k];
      const Point& to = points[k + 1 == count ? 0 : k + 1];
      const double inside = limit - sign * from.*axis;
      const double next_inside = limit - sign * to.*axis;
      if (inside >= 0.0) kept.points[kept.count++] = from;
      if ((inside >= 0.0) == (next_inside >= 0.0)) continue;
      Point& cut = kept.points[kept.count++];
      cut.*axis = sign * limit;
      cut.*other = from.*other + inside / (inside - next_inside) * (to.*other - from.*other);
    }
    *this = kept;
  }
};

/// Overlap of two boxes, world axes.
struct Overlap {
  double area_m2 = 0.0;
  double x = 0.0;  ///< centroid, m
  double y = 0.0;
  /// Gradient of the area when the first box moves, m: points from the first to the second box.
  double normal_x = 0.0;
  double normal_y = 0.0;
};

template <typename Box> Overlap overlap_of(const Box& a, const Box& b) {
  using Point = Polygon::Point;
  const PlanarBody& p = a.motion;
  const PlanarBody& q = b.motion;
  // The second box in the axes of the first, about the centre of that box.
  const double c = p.cosine * q.cosine + p.sine * q.sine;
  const double s = p.cosine * q.sine - p.sine * q.cosine;
  const double x = p.cosine * (q.x - p.x) + p.sine * (q.y - p.y) - a.box_x;
  const double y = p.cosine * (q.y - p.y) - p.sine * (q.x - p.x) - a.box_y;
  Polygon polygon;
  for (const auto& [ahead, left] : {Point{1, 1}, Point{-1, 1}, Point{-1, -1}, Point{1, -1}}) {
    const double u = b.box_x + ahead * b.half_x;
    const double v = b.box_y + left * b.half_y;
    polygon.points[polygon.count++] = {x + c * u - s * v, y + s * u + c * v};
  }
  for (const double sign : {1.0, -1.0}) {
    polygon.clip(&Point::x, &Point::y, sign, a.half_x);
    polygon.clip(&Point::y, &Point::x, sign, a.half_y);
  }
  Overlap found;
  Point centre;
  Point normal;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    const Point& from = polygon.points[k];
    const Point& to = polygon.points[k + 1 == polygon.count ? 0 : k + 1];
    const double cross = from.x * to.y - from.y * to.x;
    found.area_m2 += 0.5 * cross;
    centre.x += cross * (from.x + to.x) / 6.0;
    centre.y += cross * (from.y + to.y) / 6.0;
    // Edges on the border of the first box: those of the second follow, since all edges close.
    if (from.x == to.x && std::abs(from.x) == a.half_x) {
      normal.x += std::copysign(to.y - from.y, from.x);
    } else if (from.y == to.y && std::abs(from.y) == a.half_y) {
      normal.y += std::copysign(to.x - from.x, from.y);
    }
  }
  constexpr double least_m2 = 1e-6;
  if (!(found.area_m2 > least_m2)) return {};
  const double ahead = centre.x / found.area_m2 + a.box_x;
  const double left = centre.y / found.area_m2 + a.box_y;
  found.x = p.x + p.cosine * ahead - p.sine * left;
  found.y = p.y + p.sine * ahead + p.cosine * left;
  found.normal_x = p.cosine * normal.x - p.sine * normal.y;
  found.normal_y = p.sine * normal.x + p.cosine * normal.y;
  return found;
}

/// Distance along the axis that parts two boxes furthest; negative if they overlap.
template <typename Box> double separation_m(const Box& a, const Box& b) {
  const PlanarBody& p = a.motion;
  const PlanarBody& q = b.motion;
  const double x =
      q.x + q.cosine * b.box_x - q.sine * b.box_y - (p.x + p.cosine * a.box_x - p.sine * a.box_y);
  const double y =
      q.y + q.sine * b.box_x + q.cosine * b.box_y - (p.y + p.sine * a.box_x + p.cosine * a.box_y);
  const double c = std::abs(p.cosine * q.cosine + p.sine * q.sine);
  const double s = std::abs(p.cosine * q.sine - p.sine * q.cosine);
  const auto beyond = [c, s](double distance, double half, double along, double across) {
    return std::abs(distance) - half - c * along - s * across;
  };
  return std::max(std::max(beyond(p.cosine * x + p.sine * y, a.half_x, b.half_x, b.half_y),
                           beyond(p.cosine * y - p.sine * x, a.half_y, b.half_y, b.half_x)),
                  std::max(beyond(q.cosine * x + q.sine * y, b.half_x, a.half_x, a.half_y),
                           beyond(q.cosine * y - q.sine * x, b.half_y, a.half_y, a.half_x)));
}

/// Resistance of a body against a push from outside, `x` and `y` the outward direction, at the
/// heights that both bodies have; blended by the squares of its components.
CrushLaw resistance(const Body& body, const PlanarBody& at, double x, double y, double low_m,
                    double high_m) {
  const CrushStrength& strength = body.vehicle->strength;
  const double ahead = at.cosine * x + at.sine * y;
  const CrushLaw& end = ahead > 0.0 ? strength.front : strength.rear;
  const CrushLaw& side = strength.side;
  const double share = strength.share_of_band(low_m, high_m);
  const auto blend = [ahead](double of_end, double of_side) {
    return of_side + ahead * ahead * (of_end - of_side);
  };
  constexpr double most_length_m = 2.0;
  return {share * blend(end.yield_npm, side.yield_npm),
          share * blend(end.slope_npm2, side.slope_npm2),
          blend(std::min(end.length_m, most_length_m), std::min(side.length_m, most_length_m))};
}

/// Change of velocity of two bodies at a point by an impulse of 1 along a direction, 1/kg.
double softness_along(const PlanarBody& p, const PlanarBody& q, const Overlap& at, double x,
                      double y) {
  const double arm_p = (at.x - p.x) * y - (at.y - p.y) * x;
  const double arm_q = (at.x - q.x) * y - (at.y - q.y) * x;
  return p.inverse_mass + q.inverse_mass + arm_p * arm_p * p.inverse_inertia +
         arm_q * arm_q * q.inverse_inertia;
}

}  // namespace

struct BoxCrash::Push {
  double x = 0.0;  ///< where, m
  double y = 0.0;
  double impulse_x = 0.0;  ///< on the second body, N s
  double impulse_y = 0.0;
  double width_m = 0.0;
  double lost_j = 0.0;
  std::array<double, 2> shares{};    ///< of the crush, by body
  std::array<double, 2> depths_m{};  ///< crush behind the free crush length, by body
};

void BoxCrash::prepare(std::size_t bodies) {
  boxes_.reserve(bodies);
  chain_.reserve(bodies);
  overlaps_.reserve(bodies * bodies);
  wake_s_.reserve(bodies * bodies);
  pairs_.reserve(most_pairs);
  cells_.resize(bodies);
  constexpr std::size_t windows = 16;
  for (std::vector<ExposureCell>& cells : cells_) cells.reserve(windows);
}

void BoxCrash::place(Box& box) const {
  ContactBody at;
  at.vehicle = box.body->vehicle.get();
  box.plan->state_at(now_s_, at.pose, at.velocity);
  box.motion = make_planar(at, Eigen::Vector3d::Zero());
  // A post that breaks away is free from the beginning.
  if (!at.vehicle->movable()) return;
  box.motion.inverse_mass = 1.0 / at.vehicle->mass_kg;
  box.motion.inverse_inertia = 1.0 / at.vehicle->yaw_inertia_kgm2;
}

void BoxCrash::begin(const Scene& scene, const Motion& ego, std::size_t future) {
  now_s_ = 0.0;
  begin_s_ = -1.0;
  end_s_ = scene.slice_s.back();
  tests_ = 0;
  boxes_.clear();
  pairs_.clear();
  const auto add = [&](std::size_t index, const Motion& plan) {
    const Vehicle& vehicle = *body_of(scene, index).vehicle;
    cells_[boxes_.size()].clear();
    Box& box = boxes_.emplace_back();
    box.index = index;
    box.body = &body_of(scene, index);
    box.plan = &plan;
    box.rest_s = plan.rest_time();
    const Silhouettes& s = vehicle.silhouettes;
    box.half_x = 0.5 * static_cast<double>(s.max_x - s.min_x);
    box.half_y = 0.5 * static_cast<double>(s.max_y - s.min_y);
    box.box_x = static_cast<double>(s.min_x) + box.half_x - vehicle.center_m.x();
    box.box_y = static_cast<double>(s.min_y) + box.half_y - vehicle.center_m.y();
    box.radius_m = plane_length(std::abs(box.box_x) + box.half_x, std::abs(box.box_y) + box.half_y);
    if (vehicle.movable()) box.state = State::planned;
    place(box);
  };
  add(ego_body, ego);
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    const std::uint32_t followed = scene.futures.plan(future, i);
    if (followed != Futures::absent) add(i, scene.futures.plans[followed].motion);
  }
  wake_s_.assign(boxes_.size() * boxes_.size(), 0.0);
  boxes_.front().in_chain = true;
  chain_.assign(1, 0);
}

/// Lists the overlaps of the present places and returns the length of the step.
double BoxCrash::list_overlaps() {
  overlaps_.clear();
  double step_s = longest_s;
  for (const std::uint32_t i : chain_) {
    if (boxes_[i].state == State::free) step_s = rolling_s;
  }
  for (const std::uint32_t i : chain_) {
    const Box& a = boxes_[i];
    double* const wake_s = &wake_s_[i * boxes_.size()];
    for (std::uint32_t j = 0; j < boxes_.size(); ++j) {
      if (wake_s[j] > now_s_) continue;
      const Box& b = boxes_[j];
      if (j == i || (b.in_chain && j < i)) continue;
      ++tests_;
      const PlanarBody& p = a.motion;
      const PlanarBody& q = b.motion;
      const double closing = plane_length(q.vx - p.vx, q.vy - p.vy) +
                             std::abs(p.spin) * a.radius_m + std::abs(q.spin) * b.radius_m;
      const double free_m =
          plane_length(q.x - p.x, q.y - p.y) - (a.radius_m + b.radius_m) - closing * step_s;
      if (free_m > 0.0) {
        wake_s[j] = now_s_ + free_m / (closing + faster_mps);
        continue;
      }
      const double gap_m = separation_m(a, b);
      if (gap_m > 0.0) {
        if (closing * step_s > gap_m) step_s = std::max(gap_m / closing, shortest_s);
      } else if (closing > least_closing_mps) {
        overlaps_.push_back({i, j});
        step_s = std::min(step_s, std::max(travel_m / closing, shortest_s));
      }
    }
  }
  return step_s;
}

/// The effect of a pair, for the measures that are sums over contacts; null if there is no room.
ContactEffect* BoxCrash::effect_of(std::uint32_t i, std::uint32_t j, double speed_mps) {
  for (Pair& pair : pairs_) {
    if (pair.first == i && pair.second == j) return &pair.effect;
  }
  if (pairs_.size() == most_pairs) return nullptr;
  Pair& pair = pairs_.emplace_back();
  pair.first = i;
  pair.second = j;
  pair.effect.closing_energy_j =
      closing_energy_j(boxes_[i].body->mass_kg, boxes_[j].body->mass_kg, speed_mps);
  pair.effect.sides[0].body = boxes_[i].index;
  pair.effect.sides[1].body = boxes_[j].index;
  return &pair.effect;
}

void BoxCrash::press(const Scene& scene, std::uint32_t i, std::uint32_t j, double step_s) {
  const Box& a = boxes_[i];
  const Box& b = boxes_[j];
  const Vehicle& of_a = *a.body->vehicle;
  const Vehicle& of_b = *b.body->vehicle;
  const double low_m = static_cast<double>(
      std::max(of_a.silhouettes.all_heights.low_m, of_b.silhouettes.all_heights.low_m));
  const double high_m = static_cast<double>(
      std::min(of_a.silhouettes.all_heights.high_m, of_b.silhouettes.all_heights.high_m));
  if (!can_press(of_a, of_b) || !(high_m > low_m)) return;
  const Overlap at = overlap_of(a, b);
  if (!(at.area_m2 > 0.0)) return;
  const PlanarBody& p = a.motion;
  const PlanarBody& q = b.motion;
  const double vx = (p.vx - p.spin * (at.y - p.y)) - (q.vx - q.spin * (at.y - q.y));
  const double vy = (p.vy + p.spin * (at.x - p.x)) - (q.vy + q.spin * (at.x - q.x));
  const double speed = plane_length(vx, vy);
  if (!(speed > 0.0)) return;
  Push push;
  push.x = at.x;
  push.y = at.y;
  push.width_m = plane_length(at.normal_x, at.normal_y);
  double nx = at.normal_x / push.width_m;
  double ny = at.normal_y / push.width_m;
  // A box inside the other, or right through it, has no gradient: it is stopped where it goes.
  constexpr double least_width_m = 0.05;
  if (!(push.width_m > least_width_m)) {
    push.width_m = std::max(least_width_m,
                            std::min(std::min(a.half_x, a.half_y), std::min(b.half_x, b.half_y)));
    nx = vx / speed;
    ny = vy / speed;
  }
  const double closing = vx * nx + vy * ny;
  if (!(closing > 0.0)) return;
  const CrushLaw law_a = resistance(*a.body, p, nx, ny, low_m, high_m);
  const CrushLaw law_b = resistance(*b.body, q, -nx, -ny, low_m, high_m);
  CrushLaw both = of_a.strength.rigid ? law_b : law_a;
  push.shares = {of_a.strength.rigid ? 0.0 : 1.0, of_b.strength.rigid ? 0.0 : 1.0};
  if (!of_a.strength.rigid && !of_b.strength.rigid) {
    both.slope_npm2 = 1.0 / (1.0 / law_a.slope_npm2 + 1.0 / law_b.slope_npm2);
    both.yield_npm = std::min(law_a.yield_npm, law_b.yield_npm);
    both.length_m = law_a.length_m + law_b.length_m;
    push.shares = {both.slope_npm2 / law_a.slope_npm2, both.slope_npm2 / law_b.slope_npm2};
  }
  const double depth_m = at.area_m2 / push.width_m;
  const double behind_m = std::max(0.0, depth_m - both.length_m);
  push.depths_m = {push.shares[0] * depth_m - law_a.length_m,
                   push.shares[1] * depth_m - law_b.length_m};
  const double force_npm =
      both.yield_npm + both.slope_npm2 * (depth_m + (hardening - 1.0) * behind_m);
  const double softness = softness_along(p, q, at, nx, ny);
  const double impulse = std::min(force_npm * push.width_m * step_s, closing / softness);
  const double slip = vy * nx - vx * ny;
  const double drag = std::copysign(
      std::min(friction * impulse, std::abs(slip) / softness_along(p, q, at, -ny, nx)), slip);
  push.impulse_x = impulse * nx - drag * ny;
  push.impulse_y = impulse * ny + drag * nx;
  push.lost_j = impulse * (closing - 0.5 * impulse * softness);
  if (begin_s_ < 0.0) begin_s_ = now_s_;
  if (ContactEffect* const effect = effect_of(i, j, speed)) {
    effect->dissipated_j += push.lost_j;
    effect->sides[0].crush_j += push.shares[0] * push.lost_j;
    effect->sides[1].crush_j += push.shares[1] * push.lost_j;
  }
  act(scene, i, *b.body, push, true);
  act(scene, j, *a.body, push, false);
}

/// Applies a push to one of its bodies.
void BoxCrash::act(const Scene& scene, std::uint32_t i, const Body& by, const Push& push,
                   bool first) {
  Box& box = boxes_[i];
  PlanarBody& motion = box.motion;
  if (!(motion.inverse_mass > 0.0)) return;
  if (!box.pressed) {
    box.pressed = true;
    box.action = {};
    box.action.forward_x = static_cast<float>(motion.cosine);
    box.action.forward_y = static_cast<float>(motion.sine);
    box.action.road_mps = static_cast<float>(plane_length(motion.vx, motion.vy));
  }
  const double sign = first ? -1.0 : 1.0;
  const std::size_t side = first ? 0 : 1;
  const double jx = sign * push.impulse_x;
  const double jy = sign * push.impulse_y;
  ContactAction& action = box.action.action;
  const double change_mps = motion.inverse_mass * plane_length(jx, jy);
  action.dvx_mps += motion.inverse_mass * jx;
  action.dvy_mps += motion.inverse_mass * jy;
  action.path_mps += change_mps;
  action.crush_j += push.shares[side] * push.lost_j;
  action.light_mps += change_mps * box.body->mass_kg / std::max(by.mass_kg, striking_car_kg);
  action.edge_m2ps += change_mps * by.vehicle->leading_edge_m;
  const double deeper_m = std::max(0.0, push.depths_m[side] - box.deepest_m);
  box.deepest_m += deeper_m;
  action.deepest_m += deeper_m;
  action.intruded_m3 += deeper_m * push.width_m * intruding_height_m;
  box.changed_mps += change_mps;
  motion.apply_impulse(jx, jy, (push.x - motion.x) * jy - (push.y - motion.y) * jx);
  if (!box.in_chain) {
    box.in_chain = true;
    chain_.push_back(i);
  }
  if (box.state == State::planned && box.changed_mps > leaves_plan_mps) leave_plan(scene, i);
}

void BoxCrash::leave_plan(const Scene& scene, std::uint32_t i) {
  Box& box = boxes_[i];
  box.state = State::free;
  if (i == 0) end_s_ = now_s_ + whole_s;
  const HeldControls held = controls_after(scene, *box.plan, *box.body->vehicle, now_s_);
  box.wheels =
      wheels_after(box.body->footing, scene.harm.after_contact, held.steering_rad, held.brake);
}

/// Adds the actions of the step to the record of a body, in cells as long as a window.
void BoxCrash::record(std::uint32_t i) {
  ExposureCell& now = boxes_[i].action;
  const double change_mps = plane_length(now.action.dvx_mps, now.action.dvy_mps);
  now.action.cancelled_mps = 0.5 * std::max(0.0, now.action.path_mps - change_mps);
  now.index = cells_per_window * static_cast<std::int32_t>((now_s_ - begin_s_) / exposure_window_s);
  std::vector<ExposureCell>& cells = cells_[i];
  if (!cells.empty() && cells.back().index == now.index) {
    cells.back().action.add(now.action, 1.0);
  } else if (cells.size() < cells.capacity()) {
    cells.push_back(now);
  }
}

/// Moves all bodies by a step.
void BoxCrash::move(const Scene& scene, double step_s) {
  for (const std::uint32_t i : chain_) {
    Box& box = boxes_[i];
    if (box.pressed) record(i);
    if (box.state != State::free) continue;
    const bool wheels = box.body->footing.wheels;
    const double grip = wheels ? scene.grip : std::min(scene.grip, SceneOptions{}.sliding_grip);
    if (!box.pressed) apply_tyre_forces(box.body->footing, box.wheels, grip, step_s, box.motion);
    box.motion.move(step_s);
  }
  const double before_s = now_s_;
  now_s_ += step_s;
  for (Box& box : boxes_) {
    if (box.state == State::planned && (box.pressed || box.rest_s > before_s)) place(box);
    box.pressed = false;
  }
}

std::optional<double> BoxCrash::score(const Scene& scene, const Motion& ego, std::size_t future,
                                      const StopCheck& stop, CrashEffects& effects,
                                      CrashScore& scorer) {
  constexpr int steps_per_check = 16;
  begin(scene, ego, future);
  for (int step = 1; now_s_ < end_s_; ++step) {
    if (step % steps_per_check == 0 && stop()) return std::nullopt;
    const double step_s = list_overlaps();
    for (const auto& [i, j] : overlaps_) press(scene, i, j, step_s);
    move(scene, step_s);
  }
  effects.clear();
  effects.begin_s = std::max(begin_s_, 0.0);
  for (const Pair& pair : pairs_) effects.contacts.push_back(pair.effect);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!cells_[i].empty()) effects.add(boxes_[i].index, cells_[i]);
  }
  return scorer.score(scene, effects, scene.nominal);
}

}  // namespace crashrank::detail
