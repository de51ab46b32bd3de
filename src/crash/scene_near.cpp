#include "crash/scene_run.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

/// Bodies nearer than this are in each other's lists, m.
constexpr double listed_m = 5.0;

}  // namespace

/// No smaller than the distance of their outlines: the greatest along the axes of both boxes.
double SceneRun::gap_m(std::size_t i, std::size_t j) const {
  const Member& m = members_[i];
  const Member& n = members_[j];
  const PlanarBody& p = body(i);
  const PlanarBody& q = body(j);
  const double x =
      q.x + q.cosine * n.box_x - q.sine * n.box_y - (p.x + p.cosine * m.box_x - p.sine * m.box_y);
  const double y =
      q.y + q.sine * n.box_x + q.cosine * n.box_y - (p.y + p.sine * m.box_x + p.cosine * m.box_y);
  const double c = std::abs(p.cosine * q.cosine + p.sine * q.sine);
  const double s = std::abs(p.cosine * q.sine - p.sine * q.cosine);
  const double along_p =
      std::abs(p.cosine * x + p.sine * y) - m.half_x - c * n.half_x - s * n.half_y;
  const double beside_p =
      std::abs(p.cosine * y - p.sine * x) - m.half_y - s * n.half_x - c * n.half_y;
  const double along_q =
      std::abs(q.cosine * x + q.sine * y) - n.half_x - c * m.half_x - s * m.half_y;
  const double beside_q =
      std::abs(q.cosine * y - q.sine * x) - n.half_y - s * m.half_x - c * m.half_y;
  return std::max(std::max(along_p, beside_p), std::max(along_q, beside_q));
}

/// No two of their points are faster against each other.
double SceneRun::closing_bound(std::size_t i, std::size_t j) const {
  const PlanarBody& p = body(i);
  const PlanarBody& q = body(j);
  // The sum of both turns first: it does not depend on which is which.
  const double turning =
      members_[i].rim_m * std::abs(p.spin) + members_[j].rim_m * std::abs(q.spin);
  return plane_length(p.vx - q.vx, p.vy - q.vy) + turning;
}

bool SceneRun::lists(std::size_t i, std::size_t j) const {
  const auto begin = near_.begin() + static_cast<std::ptrdiff_t>(i * most_near);
  const auto end = begin + static_cast<std::ptrdiff_t>(members_[i].near);
  return std::find(begin, end, j) != end;
}

/// The nearest bodies within `listed_m`.
void SceneRun::list_near(std::size_t i) {
  Member& m = members_[i];
  m.near = 0;
  m.slack_m = listed_m;
  std::uint32_t* const list = near_.data() + i * most_near;
  const Vehicle& own = *bodies_[i].vehicle;
  for (std::size_t j = 0; j < bodies_.size(); ++j) {
    if (j == i || !can_press(own, *bodies_[j].vehicle)) continue;
    place(j);
    const double gap = gap_m(i, j);
    if (gap > listed_m) continue;
    if (m.near < most_near) {
      list[m.near++] = static_cast<std::uint32_t>(j);
      continue;
    }
    crowded_ = true;
    std::size_t furthest = 0;
    for (std::size_t k = 1; k < most_near; ++k) {
      if (gap_m(i, list[k]) > gap_m(i, list[furthest])) furthest = k;
    }
    if (gap_m(i, list[furthest]) > gap) list[furthest] = static_cast<std::uint32_t>(j);
  }
}

void SceneRun::list_near() {
  // Before the next list none that is left out comes so near as to press.
  const double needed_m = live_m + 2.0 * options_.rolling_step_s * fastest_mps_;
  for (const std::uint32_t i : chain_) {
    if (members_[i].slack_m < needed_m) list_near(i);
  }
}

}  // namespace crashrank::detail
