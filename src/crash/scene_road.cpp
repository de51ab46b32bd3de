#include "crash/scene_run.hpp"

#include <algorithm>

namespace crashrank::detail {

double SceneRun::grip_of(std::size_t i) const {
  double grip = options_.grip;
  if (!options_.drivable.empty() && options_.off_road_grip != options_.grip) {
    const PlanarBody& b = body(i);
    const Eigen::Vector2d at = origin_m_.head<2>() + Eigen::Vector2d(b.x, b.y);
    if (!holds(options_.drivable, at)) grip = options_.off_road_grip;
  }
  return bodies_[i].footing->wheels ? grip : std::min(grip, options_.sliding_grip);
}

/// Applies the forces of the road. During an impact they are neglected, as usual in impact
/// mechanics.
void SceneRun::apply_road_forces(std::size_t i, double step_s) {
  // A contact force no larger than `push_factor` times the road force only pushes the body along.
  // The part of it that the road cancels in the same step is not a velocity change.
  constexpr double push_factor = 2.0;
  constexpr double impact_s = 0.05;
  const SceneBody& body = bodies_[i];
  const double grip = grip_of(i);
  const double push_limit_mps = push_factor * grip * gravity_mps2 * step_s;
  Member& m = members_[i];
  const auto for_each_pressing_run = [&](auto&& function) {
    for (const std::uint32_t k : active_) {
      ContactRun& run = runs_[k];
      if (run.presses() && (run.first() == i || run.second() == i)) function(run, run.first() == i);
    }
  };
  for_each_pressing_run([&](const ContactRun& run, bool is_first) {
    if (run.step_change_mps(is_first).norm() > push_limit_mps) m.last_impact_s = now_s_;
  });
  if (now_s_ - m.last_impact_s < impact_s) return;
  PlanarBody& b = motion_of(i);
  const PlanarBody before = b;
  apply_tyre_forces(*body.footing, m.wheels, grip, step_s, b);
  for_each_pressing_run([&](ContactRun& run, bool is_first) {
    const Eigen::Vector2d contact_change = run.step_change_mps(is_first);
    const double change2 = contact_change.squaredNorm();
    if (!(change2 > 0.0)) return;
    const double resisted =
        -((b.vx - before.vx) * contact_change.x() + (b.vy - before.vy) * contact_change.y()) /
        change2;
    run.exclude(is_first, std::clamp(resisted, 0.0, 1.0));
  });
}

}  // namespace crashrank::detail
