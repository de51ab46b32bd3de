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

/// Forces of the road. During an impact they are left out, as impact mechanics does.
void SceneRun::drive_on_road(std::size_t i, double step_s) {
  // A contact whose force is no larger than a few of the road's pushes its body along: what the
  // road takes of it at once is no change of velocity.
  constexpr double pushing = 2.0;
  constexpr double impact_s = 0.05;
  const SceneBody& body = bodies_[i];
  const double grip = grip_of(i);
  const double pushed_mps = pushing * grip * gravity_mps2 * step_s;
  Member& m = members_[i];
  const auto each_run = [&](auto&& each) {
    for (const std::uint32_t k : live_) {
      ContactRun& run = runs_[k];
      if (run.presses() && (run.first() == i || run.second() == i)) each(run, run.first() == i);
    }
  };
  each_run([&](const ContactRun& run, bool is_first) {
    if (run.step_change_mps(is_first).norm() > pushed_mps) m.struck_s = now_s_;
  });
  if (now_s_ - m.struck_s < impact_s) return;
  PlanarBody& b = motion_of(i);
  const PlanarBody before = b;
  drive(*body.footing, m.wheels, grip, step_s, b);
  each_run([&](ContactRun& run, bool is_first) {
    const Eigen::Vector2d pushed = run.step_change_mps(is_first);
    const double change2 = pushed.squaredNorm();
    if (!(change2 > 0.0)) return;
    const double against =
        -((b.vx - before.vx) * pushed.x() + (b.vy - before.vy) * pushed.y()) / change2;
    run.take_back(is_first, std::clamp(against, 0.0, 1.0));
  });
}

}  // namespace crashrank::detail
