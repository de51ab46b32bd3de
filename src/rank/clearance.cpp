#include "rank/clearance.hpp"

#include "crashrank/rank/rank.hpp"
#include "rank/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crashrank::detail {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// At 30 m/s a car moves by a third of its length in one step.
constexpr double longest_step_s = 0.05;
constexpr double max_steps = 400.0;

/// A body with its sampled trajectory.
struct MovingBody {
  const BodyOutline& outline;
  const Motion& motion;
  View<const PlanarPose> poses;
  double fastest_mps = 0.0;

  PlanarPose at(double time_s) const { return planar_pose(motion.pose_at(time_s)); }
};

double fastest_point_mps(const Motion& motion, const BodyOutline& outline, double until_s) {
  const MotionBound bound = motion.bound(0.0, until_s);
  return bound.speed_mps + bound.angular_radps * outline.radius_m();
}

/// Returns true if the height ranges of the bodies are disjoint, so that one passes over the other.
bool passes_over(const Body& a, const Motion& of_a, const Body& b, const Motion& of_b) {
  const auto reach = [](const Body& body, const Motion& motion) {
    const Pose pose = motion.pose_at(0.0);
    const double middle = (pose.rotation * body.center_m + pose.translation).z();
    const double half = (pose.rotation * body.half_axes_m).row(2).cwiseAbs().sum();
    return std::pair(middle - half, middle + half);
  };
  const auto [low_a, high_a] = reach(a, of_a);
  const auto [low_b, high_b] = reach(b, of_b);
  return low_a > high_b || low_b > high_a;
}

/// Smallest distance between the outlines of two bodies along their trajectories.
class MinimumDistance {
public:
  MinimumDistance(const MovingBody& a, const MovingBody& b, double step_s, const StopCheck& stop)
      : a_(a),
        b_(b),
        stop_(stop),
        step_s_(step_s),
        travel_m_((a.fastest_mps + b.fastest_mps) * step_s) {
    for (std::size_t i = 0; i < a.poses.size(); ++i) {
      const double apart = rectangle_distance_m(a.outline, a.poses[i], b.outline, b.poses[i]);
      if (apart < coarse_m_) {
        coarse_m_ = apart;
        nearest_ = i;
      }
    }
  }

  /// Lower bound on the distance: between two samples it is smaller than at the nearer sample by at
  /// most half the relative travel of one step.
  double lower_bound_m() const noexcept { return coarse_m_ - 0.5 * travel_m_; }

  /// Returns the smallest distance. Computes exact distances only at times at which the bounding
  /// rectangles are near enough to improve the result.
  double find() {
    double best = at(nearest_, unbounded);
    double before = unbounded;
    double here = near(0, best);
    for (std::size_t i = 0; i < a_.poses.size() && !stop_(); ++i) {
      const double behind = i + 1 < a_.poses.size() ? near(i + 1, best) : unbounded;
      best = std::min(best, here);
      if (here < unbounded && here <= before && here <= behind && here - travel_m_ < best) {
        best = std::min(best, refine(i, here));
      }
      before = here;
      here = behind;
    }
    return best;
  }

private:
  double at(std::size_t i, double cutoff_m) {
    return outline_distance_m(a_.outline, a_.poses[i], b_.outline, b_.poses[i], cutoff_m, chains_);
  }
  /// Returns the distance at sample `i`, or infinity if no distance below `best` is possible near
  /// that time.
  double near(std::size_t i, double best) {
    const double reach = best + travel_m_;
    if (rectangle_distance_m(a_.outline, a_.poses[i], b_.outline, b_.poses[i]) >= reach) {
      return unbounded;
    }
    const double apart = at(i, reach);
    if (apart < reach) return apart;
    return unbounded;
  }
  double at_time(double time_s, double cutoff_m) {
    return outline_distance_m(a_.outline, a_.at(time_s), b_.outline, b_.at(time_s), cutoff_m,
                              chains_);
  }
  /// Golden-section search between the neighbours of sample `i`.
  double refine(std::size_t i, double here) {
    constexpr double golden = 0.6180339887498949;
    constexpr int rounds = 10;  // 0.1 s · 0.618^10 is less than a millisecond
    const double end_s = step_s_ * static_cast<double>(a_.poses.size() - 1);
    const double middle = step_s_ * static_cast<double>(i);
    const double cutoff = here + travel_m_;
    // A minimum at one end of the horizon is the most frequent case: one evaluation just inside
    // shows that the distance still falls towards the end.
    const bool at_end = i == 0 || i + 1 == a_.poses.size();
    const double inside = middle + (i == 0 ? 0.05 : -0.05) * step_s_;
    if (at_end && at_time(inside, cutoff) >= here) return here;
    double low = std::max(middle - step_s_, 0.0);
    double high = std::min(middle + step_s_, end_s);
    double p = high - golden * (high - low);
    double q = low + golden * (high - low);
    double of_p = at_time(p, cutoff);
    double of_q = at_time(q, cutoff);
    double best = std::min({here, of_p, of_q});
    for (int round = 0; round < rounds && !stop_(); ++round) {
      if (of_p <= of_q) {
        high = std::exchange(q, p);
        of_q = of_p;
        p = high - golden * (high - low);
        of_p = at_time(p, cutoff);
      } else {
        low = std::exchange(p, q);
        of_p = of_q;
        q = low + golden * (high - low);
        of_q = at_time(q, cutoff);
      }
      best = std::min({best, of_p, of_q});
    }
    return best;
  }

  const MovingBody& a_;
  const MovingBody& b_;
  const StopCheck& stop_;
  double step_s_;
  double travel_m_;
  double coarse_m_ = unbounded;
  std::size_t nearest_ = 0;
  NearestChains chains_;
};

bool overlap(const MovingBody& a, const PlanarPose& pose_a, const MovingBody& b,
             const PlanarPose& pose_b) {
  const double reach = a.outline.radius_m() + b.outline.radius_m();
  const double dx = pose_b.x - pose_a.x;
  const double dy = pose_b.y - pose_a.y;
  return dx * dx + dy * dy <= reach * reach &&
         !(rectangle_distance_m(a.outline, pose_a, b.outline, pose_b) > 0.0);
}

/// Returns true if b, at some time near step `i` shifted by `lag_s`, overlaps the place of a at the
/// unshifted time.
bool overlaps_near(const MovingBody& a, const MovingBody& b, double step_s, std::size_t i,
                   double lag_s) {
  constexpr int parts = 8;
  const double end_s = step_s * static_cast<double>(a.poses.size() - 1);
  const double middle = step_s * static_cast<double>(i);
  for (int part = -parts; part <= parts; ++part) {
    const double time_s = middle + step_s * part / parts;
    const double other_s = time_s + lag_s;
    if (time_s < 0.0 || time_s > end_s || other_s < 0.0 || other_s > end_s) continue;
    if (overlap(a, a.at(time_s), b, b.at(other_s))) return true;
  }
  return false;
}

/// Smallest time between a and b occupying the same place, if it is at most `most_s`; otherwise
/// infinity.
double least_time_gap_s(const MovingBody& a, const MovingBody& b, double step_s, double most_s,
                        const StopCheck& stop) {
  constexpr std::size_t parts = 16;
  const std::size_t count = a.poses.size();
  const auto lag_s = [step_s](std::size_t part) {
    return step_s / static_cast<double>(parts) * static_cast<double>(part);
  };
  for (std::size_t lag = 0; lag < count && !stop(); ++lag) {
    // An overlap found at a whole-step lag can begin up to two steps earlier.
    if (lag > 2 && lag_s((lag - 2) * parts) > most_s) break;
    std::size_t least = lag * parts;
    bool overlaps = false;
    for (std::size_t i = 0; i + lag < count; ++i) {
      for (const bool b_later : {true, false}) {
        const std::size_t in_a = b_later ? i : i + lag;
        const std::size_t in_b = b_later ? i + lag : i;
        if (!overlap(a, a.poses[in_a], b, b.poses[in_b])) continue;
        overlaps = true;
        while (least > 0 &&
               overlaps_near(a, b, step_s, in_a, b_later ? lag_s(least - 1) : -lag_s(least - 1))) {
          --least;
        }
      }
    }
    if (overlaps) return lag_s(least);
  }
  return unbounded;
}

}  // namespace

void sample_trajectories(const Scene& scene, PlanTrajectories& trajectories) {
  const double horizon_s = scene.slice_s.back();
  trajectories.steps =
      static_cast<std::size_t>(std::clamp(std::ceil(horizon_s / longest_step_s), 1.0, max_steps));
  trajectories.step_s = horizon_s / static_cast<double>(trajectories.steps);
  const std::vector<Plan>& plans = scene.futures.plans;
  const std::size_t count = scene.futures.own_plans();
  trajectories.poses.resize(count * (trajectories.steps + 1));
  trajectories.fastest_mps.resize(count);
  trajectories.drift.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    if (!scene.futures.exists(plans[p].actor)) continue;
    const BodyOutline& outline = *scene.actors[plans[p].actor].outline;
    trajectories.fastest_mps[p] = fastest_point_mps(plans[p].motion, outline, horizon_s);
    trajectories.drift[p] = drift_of(plans[p].motion, horizon_s);
    for (std::size_t i = 0; i <= trajectories.steps; ++i) {
      trajectories.poses[p * (trajectories.steps + 1) + i] =
          planar_pose(plans[p].motion.pose_at(trajectories.step_s * static_cast<double>(i)));
    }
  }
}

Clearance clearance_of(const Scene& scene, const Motion& ego, std::vector<PlanarPose>& ego_poses,
                       const StopCheck& stop) {
  const PlanTrajectories& trajectories = scene.trajectories;
  ego_poses.resize(trajectories.steps + 1);
  for (std::size_t i = 0; i <= trajectories.steps; ++i) {
    ego_poses[i] = planar_pose(ego.pose_at(trajectories.step_s * static_cast<double>(i)));
  }
  const MovingBody own{*scene.ego.outline,
                       ego,
                       {ego_poses.data(), ego_poses.size()},
                       fastest_point_mps(ego, *scene.ego.outline, scene.slice_s.back())};
  const DriftingBody own_end{own.outline, own.poses[trajectories.steps],
                             drift_of(ego, scene.slice_s.back())};
  Clearance least;
  // A pair is skipped only if its lower bound is not below the smallest distance so far, so
  // skipping cannot change any bit of the result.
  double nearest = farthest_clearance_m;
  const std::vector<Plan>& plans = scene.futures.plans;
  for (std::size_t p = 0; p < scene.futures.own_plans(); ++p) {
    if (stop()) return least;
    if (!scene.futures.is_followed(p)) continue;
    const Body& actor = scene.actors[plans[p].actor];
    if (!actor.vehicle->has_outline() || passes_over(scene.ego, ego, actor, plans[p].motion)) {
      continue;
    }
    const MovingBody other{*actor.outline, plans[p].motion, trajectories.of(p),
                           trajectories.fastest_mps[p]};
    MinimumDistance distance(own, other, trajectories.step_s, stop);
    if (distance.lower_bound_m() < nearest) {
      if (const double apart_m = distance.find(); apart_m < nearest) {
        nearest = apart_m;
        least.nearest = plans[p].actor;
      }
    }
    if (other.fastest_mps > 0.0) {
      const double gap_s =
          least_time_gap_s(own, other, trajectories.step_s, least.time_gap_s, stop);
      if (gap_s < least.time_gap_s) {
        least.time_gap_s = gap_s;
        least.soonest = plans[p].actor;
      }
    }
    const DriftingBody other_end{other.outline, other.poses[trajectories.steps],
                                 trajectories.drift[p]};
    if (!((own_end.drift.velocity_mps - trajectories.drift[p].velocity_mps).norm() >=
          slow_crash_mps)) {
      continue;
    }
    const double most_s = std::min(least.time_to_collision_s, longest_time_to_collision_s);
    const double collision_s = time_to_collision_s(own_end, other_end, most_s, stop);
    if (collision_s < least.time_to_collision_s) {
      least.time_to_collision_s = collision_s;
      least.imminent = plans[p].actor;
    }
  }
  if (nearest < farthest_clearance_m) least.distance_m = nearest;
  return least;
}

}  // namespace crashrank::detail
