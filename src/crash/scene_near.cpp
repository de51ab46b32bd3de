#include "crash/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank::detail {

void SceneRun::compute_extents(const Vehicle& vehicle, Member& m) {
  const Silhouettes& s = vehicle.silhouettes;
  m.half_x = 0.5 * static_cast<double>(s.max_x - s.min_x);
  m.half_y = 0.5 * static_cast<double>(s.max_y - s.min_y);
  m.box_x = static_cast<double>(s.min_x) + m.half_x - vehicle.center_m.x();
  m.box_y = static_cast<double>(s.min_y) + m.half_y - vehicle.center_m.y();
  m.radius_m = std::hypot(std::abs(m.box_x) + m.half_x, std::abs(m.box_y) + m.half_y);
}

/// Lower bound of the gap: that of the bounding circles about the centres of mass.
double SceneRun::gap_lower_bound_m(std::size_t i, std::size_t j) const {
  constexpr double rounding_m = 1e-6;
  const PlanarBody& p = body(i);
  const PlanarBody& q = body(j);
  return plane_length(p.x - q.x, p.y - q.y) - (members_[i].radius_m + members_[j].radius_m) -
         rounding_m;
}

double SceneRun::gap_m(std::size_t i, std::size_t j) const {
  return gap_m(members_[i], body(i), members_[j], body(j));
}

/// Distance of the bounding boxes seen from above: a lower bound of the distance of the outlines,
/// negative if the boxes overlap. Beyond `listed_m` a lower bound of the box distance. It changes
/// no faster than the closing bound, so that the time at which lists are made does not influence
/// any step.
double SceneRun::gap_m(const Member& m, const PlanarBody& p, const Member& n, const PlanarBody& q) {
  const double x =
      q.x + q.cosine * n.box_x - q.sine * n.box_y - (p.x + p.cosine * m.box_x - p.sine * m.box_y);
  const double y =
      q.y + q.sine * n.box_x + q.cosine * n.box_y - (p.y + p.sine * m.box_x + p.cosine * m.box_y);
  const double cosine = p.cosine * q.cosine + p.sine * q.sine;
  const double sine = p.cosine * q.sine - p.sine * q.cosine;
  const double c = std::abs(cosine);
  const double s = std::abs(sine);
  const double ahead_p = p.cosine * x + p.sine * y;
  const double left_p = p.cosine * y - p.sine * x;
  const double ahead_q = q.cosine * x + q.sine * y;
  const double left_q = q.cosine * y - q.sine * x;
  const double along_p = std::abs(ahead_p) - m.half_x - c * n.half_x - s * n.half_y;
  const double beside_p = std::abs(left_p) - m.half_y - s * n.half_x - c * n.half_y;
  const double along_q = std::abs(ahead_q) - n.half_x - c * m.half_x - s * m.half_y;
  const double beside_q = std::abs(left_q) - n.half_y - s * m.half_x - c * m.half_y;
  const double apart = std::max(std::max(along_p, beside_p), std::max(along_q, beside_q));
  if (!(apart > 0.0) || apart > listed_m) return apart;
  // The nearest point of one of two separate boxes is a corner of one of them.
  return std::sqrt(std::min(corner_distance2(m, n, ahead_p, left_p, cosine, sine),
                            corner_distance2(n, m, ahead_q, left_q, cosine, -sine)));
}

/// Squared distance from `box`, centred at the origin, to the nearest corner of `of`, whose centre
/// is at (x, y) and which is rotated by the angle with the given cosine and sine.
double SceneRun::corner_distance2(const Member& box, const Member& of, double x, double y,
                                  double cosine, double sine) {
  double least = std::numeric_limits<double>::infinity();
  for (const double ahead : {-of.half_x, of.half_x}) {
    for (const double left : {-of.half_y, of.half_y}) {
      const double along = std::abs(x + (cosine * ahead - sine * left)) - box.half_x;
      const double beside = std::abs(y + (sine * ahead + cosine * left)) - box.half_y;
      const double dx = std::max(along, 0.0);
      const double dy = std::max(beside, 0.0);
      least = std::min(least, dx * dx + dy * dy);
    }
  }
  return least;
}

/// Upper bound of the relative speed of any two points of the bodies, m/s.
double SceneRun::closing_bound(std::size_t i, std::size_t j) const {
  const PlanarBody& p = body(i);
  const PlanarBody& q = body(j);
  // Add both rotational terms first: the result then does not depend on the order of the bodies.
  const double turning =
      members_[i].radius_m * std::abs(p.spin) + members_[j].radius_m * std::abs(q.spin);
  return plane_length(p.vx - q.vx, p.vy - q.vy) + turning;
}

/// Returns true if no height of two bodies can be the same while both are within `listed_m` of
/// where they are. `at`: state of the second body.
bool SceneRun::heights_apart(std::size_t i, std::size_t j, const PlanarBody& at) const {
  const PlanarBody& own = body(i);
  const HeightRange& p = bodies_[i].vehicle->silhouettes.all_heights;
  const HeightRange& q = bodies_[j].vehicle->silhouettes.all_heights;
  // The smaller body is where both meet; the way to there and while the list is valid.
  const double reach_m = 2.0 * listed_m + std::min(members_[i].radius_m, members_[j].radius_m);
  const bool own_is_smaller = members_[i].radius_m < members_[j].radius_m;
  const double x = own_is_smaller ? own.x : at.x;
  const double y = own_is_smaller ? own.y : at.y;
  const double rise_m = own.ground_at(x, y) - at.ground_at(x, y);
  const double varies_m =
      reach_m * plane_length(own.rise_x - at.rise_x, own.rise_y - at.rise_y) + 1e-3;
  return static_cast<double>(p.low_m) + rise_m > static_cast<double>(q.high_m) + varies_m ||
         static_cast<double>(p.high_m) + rise_m < static_cast<double>(q.low_m) - varies_m;
}

bool SceneRun::has_listed(std::size_t i, std::size_t j) const {
  const auto begin = near_.begin() + static_cast<std::ptrdiff_t>(i * most_near);
  const auto end = begin + static_cast<std::ptrdiff_t>(members_[i].near);
  return std::find(begin, end, j) != end;
}

/// Returns true if a fixed body adjoins one of the fixed bodies of a contact. A fixed body that
/// stands apart has its own contact, with its own rebound, end and damage.
bool SceneRun::adjoins_any(std::size_t i, const ContactRun& run) const {
  const View<const std::uint32_t> adjoins = bodies_[i].adjoins;
  if (adjoins.empty()) return false;
  for (const std::uint32_t pair : run.pairs()) {
    const std::uint32_t number = bodies_[memory_.pairs[pair].second].number;
    if (std::find(adjoins.begin(), adjoins.end(), number) != adjoins.end()) return true;
  }
  return false;
}

/// Lists the nearest bodies within `listed_m`.
void SceneRun::list_near(std::size_t i) {
  Member& m = members_[i];
  m.near = 0;
  m.slack_m = listed_m;
  std::uint32_t* const list = near_.data() + i * most_near;
  const Vehicle& own = *bodies_[i].vehicle;
  for (std::size_t j = 0; j < bodies_.size(); ++j) {
    if (j == i || !can_press(own, *bodies_[j].vehicle)) continue;
    // A planned body is at its last placement, or as far from it as the fastest plan allows.
    const double moved_m = members_[j].state == State::planned
                               ? fastest_plan_mps_ * (now_s_ - members_[j].placed_s)
                               : 0.0;
    if (gap_lower_bound_m(i, j) - moved_m > listed_m) continue;
    const PlanarBody at =
        members_[j].state == State::planned ? make_planar(contact_body(j), origin_m_) : body(j);
    const double gap = gap_m(m, body(i), members_[j], at);
    if (gap > listed_m || heights_apart(i, j, at)) continue;
    // Place the body for the middle of the last step, as a body that was already listed would have
    // been: results then do not depend on when the list is made.
    if (members_[j].placed_s < placed_s_) place_planned(j);
    if (m.near < most_near) {
      list[m.near++] = static_cast<std::uint32_t>(j);
      continue;
    }
    limit_exceeded_ = true;
    std::size_t furthest = 0;
    for (std::size_t k = 1; k < most_near; ++k) {
      if (gap_m(i, list[k]) > gap_m(i, list[furthest])) furthest = k;
    }
    if (gap_m(i, list[furthest]) > gap) list[furthest] = static_cast<std::uint32_t>(j);
  }
}

void SceneRun::list_near() {
  // Until the next list, no body left out comes close enough to press or to shorten a step, even if
  // its position is half a step old. Steps therefore do not depend on when lists are made.
  const double needed_m = live_m + 3.0 * options_.rolling_step_s * fastest_mps_;
  for (const std::uint32_t i : chain_) {
    if (members_[i].slack_m < needed_m) list_near(i);
  }
}

}  // namespace crashrank::detail
