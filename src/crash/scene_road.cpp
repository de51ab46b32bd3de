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
  constexpr double push_factor = 2.0;
  constexpr double impact_s = 0.05;
  const SceneBody& body = bodies_[i];
  const double grip = grip_of(i);
  const double push_limit_mps = push_factor * grip * gravity_mps2 * step_s;
  Member& m = members_[i];
  if (m.action.path_mps > push_limit_mps) {
    m.last_impact_s = now_s_;
  }
  if (now_s_ - m.last_impact_s < impact_s) return;
  apply_tyre_forces(*body.footing, m.wheels, grip, step_s, motion_of(i));
}

}  // namespace crashrank::detail
