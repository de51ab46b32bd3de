#include "crashrank/scenario/candidate.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "scenario/demand.hpp"
#include "scenario/motion_check.hpp"
#include "scenario/scenario_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

namespace crashrank {
namespace {

double full_grip_mps2(const Scenario& scenario) { return scenario.grip * standard_gravity_mps2; }

/// What grip and brakes give together.
double full_braking_mps2(const Scenario& scenario) {
  const double grip = full_grip_mps2(scenario);
  return std::min(grip, scenario.ego.max_deceleration_mps2.value_or(grip));
}

// Of an ego this slow the measured yaw rate says nothing of the path: a thousandth of a metre a
// second and a tenth of a degree would make a circle smaller than the car.
constexpr double least_curving_mps = 0.5;

double direction_of(double speed_mps) { return speed_mps < 0.0 ? -1.0 : 1.0; }

Result<Motion> timed_motion(const std::vector<TimedPose>& poses, const std::string& path) {
  Result<Motion> motion = Motion::timed(poses);
  if (!motion) motion.error().place = path + ".poses: " + motion.error().place;
  return motion;
}

Candidate arc_candidate(const ScenarioEgo& ego, std::string name, CandidateOrigin origin,
                        double acceleration_mps2, double curvature_per_m) {
  ArcMotion arc;
  arc.start = ego.pose;
  arc.speed_mps = ego.speed_mps;
  arc.curvature_per_m = curvature_per_m;
  arc.acceleration_mps2 = acceleration_mps2;
  return {std::move(name), origin, arc, acceleration_mps2, curvature_per_m};
}

Result<Candidate> listed_candidate(const Scenario& scenario, std::size_t index, double wheelbase) {
  const ListedCandidate& listed = scenario.listed[index];
  const ScenarioEgo& ego = scenario.ego;
  if (!listed.poses.empty()) {
    Result<Motion> motion =
        timed_motion(listed.poses, "candidates.listed[" + std::to_string(index) + "]");
    if (!motion) {
      motion.error().place += " of '" + listed.name + "'";
      return motion.error();
    }
    return Candidate{listed.name, CandidateOrigin::listed, std::move(*motion), 0.0, 0.0};
  }
  const bool crawls = std::abs(ego.speed_mps) < least_curving_mps;
  if (listed.yaw_rate_radps || (!listed.steering_rad && crawls)) {
    TurnMotion turn;
    turn.start = ego.pose;
    turn.speed_mps = ego.speed_mps;
    turn.yaw_rate_radps = listed.yaw_rate_radps.value_or(ego.yaw_rate_radps);
    turn.acceleration_mps2 = listed.acceleration_mps2;
    const double curvature = crawls ? 0.0 : turn.yaw_rate_radps / ego.speed_mps;
    return Candidate{listed.name, CandidateOrigin::listed, turn, listed.acceleration_mps2,
                     curvature};
  }
  const double tightest = curvature_from_steering(ego.max_steering_rad, wheelbase);
  const double curvature =
      listed.steering_rad ? curvature_from_steering(*listed.steering_rad, wheelbase)
                          : std::clamp(ego.yaw_rate_radps / ego.speed_mps, -tightest, tightest);
  return arc_candidate(ego, listed.name, CandidateOrigin::listed, listed.acceleration_mps2,
                       curvature);
}

// Straight ahead, with at least half of the deceleration that can be had, and no more than that.
bool brakes_straight(const Candidate& candidate, const Scenario& scenario) {
  const double deceleration = -candidate.acceleration_mps2 * direction_of(scenario.ego.speed_mps);
  const double full = full_braking_mps2(scenario);
  return candidate.curvature_per_m == 0.0 && deceleration >= 0.5 * full &&
         deceleration <= feasible_demand * full;
}

double level(std::size_t index, std::size_t count) {
  if (count == 1) return 0.0;
  return (2.0 * static_cast<double>(index) - static_cast<double>(count - 1)) /
         static_cast<double>(count - 1);
}

double highest_speed_mps(double speed, double acceleration, double horizon_s) {
  return std::max(std::abs(speed), std::abs(speed + acceleration * horizon_s));
}

struct GridPoint {
  double acceleration_mps2;
  double curvature_per_m;
};

GridPoint grid_point(const Scenario& scenario, double u, double w, double max_curvature) {
  const ScenarioEgo& ego = scenario.ego;
  const double grip = full_grip_mps2(scenario);
  const double longitudinal =
      u < 0.0 ? full_braking_mps2(scenario) : std::min(grip, ego.max_acceleration_mps2);
  double along_way = u * longitudinal * std::sqrt(1.0 - 0.5 * w * w);
  // A vehicle that stands has nothing to brake.
  if (ego.speed_mps == 0.0) along_way = std::max(along_way, 0.0);
  const double lateral = w * grip * std::sqrt(1.0 - 0.5 * u * u);
  const double start = std::abs(ego.speed_mps);
  const double speed =
      along_way < 0.0 ? start : highest_speed_mps(start, along_way, scenario.horizon_s);
  const double held = speed == 0.0 ? std::copysign(max_curvature, w) : lateral / (speed * speed);
  const double curvature = w == 0.0 ? 0.0 : std::clamp(held, -max_curvature, max_curvature);
  return {along_way * direction_of(ego.speed_mps), curvature};
}

/// What the manoeuvre does, and its place in the grid: "brake 7.85 m/s2, 0.54 deg left (a00 s08)".
std::string grid_name(std::size_t i, std::size_t j, const GridPoint& point, double speed_mps,
                      double wheelbase) {
  constexpr double deg_per_rad = 57.29577951308232;
  constexpr double half = 0.005;  // of the last digit
  const double along_way = point.acceleration_mps2 * direction_of(speed_mps);
  const double steering = std::atan(point.curvature_per_m * wheelbase) * deg_per_rad;
  char pace[48];
  if (std::abs(along_way) < half) {
    std::snprintf(pace, sizeof pace, "%s", speed_mps == 0.0 ? "stand" : "hold speed");
  } else {
    std::snprintf(pace, sizeof pace, "%s %.2f m/s2", along_way < 0.0 ? "brake" : "speed up",
                  std::abs(along_way));
  }
  char way[48] = "straight";
  if (std::abs(steering) >= half) {
    std::snprintf(way, sizeof way, "%.2f deg %s", std::abs(steering),
                  steering > 0.0 ? "left" : "right");
  }
  char text[128];
  std::snprintf(text, sizeof text, "%s, %s (a%02zu s%02zu)", pace, way, i, j);
  return text;
}

struct GridIndex {
  std::size_t i;
  std::size_t j;
  std::size_t demand;  // u² + w² times the squares of both sides' steps, a whole number
};

// Where many manoeuvres hit nothing the first one wins, so the gentlest come first.
std::vector<GridIndex> gentlest_first(const CandidateGrid& grid) {
  const auto offset = [](std::size_t index, std::size_t count) {
    return 2 * index > count - 1 ? 2 * index - (count - 1) : (count - 1) - 2 * index;
  };
  const std::size_t steps_i = std::max<std::size_t>(grid.accelerations - 1, 1);
  const std::size_t steps_j = std::max<std::size_t>(grid.steerings - 1, 1);
  std::vector<GridIndex> order;
  order.reserve(grid.accelerations * grid.steerings);
  for (std::size_t i = 0; i < grid.accelerations; ++i) {
    for (std::size_t j = 0; j < grid.steerings; ++j) {
      const std::size_t u = offset(i, grid.accelerations) * steps_j;
      const std::size_t w = offset(j, grid.steerings) * steps_i;
      order.push_back({i, j, u * u + w * w});
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const GridIndex& p, const GridIndex& q) { return p.demand < q.demand; });
  return order;
}

std::vector<Candidate> grid_candidates(const Scenario& scenario, double wheelbase) {
  std::vector<Candidate> candidates;
  const CandidateGrid& grid = *scenario.grid;
  const double max_curvature = curvature_from_steering(scenario.ego.max_steering_rad, wheelbase);
  candidates.reserve(grid.accelerations * grid.steerings);
  for (const auto& [i, j, demand] : gentlest_first(grid)) {
    const GridPoint point =
        grid_point(scenario, level(i, grid.accelerations), level(j, grid.steerings), max_curvature);
    candidates.push_back(
        arc_candidate(scenario.ego, grid_name(i, j, point, scenario.ego.speed_mps, wheelbase),
                      CandidateOrigin::grid, point.acceleration_mps2, point.curvature_per_m));
  }
  return candidates;
}

// The wish, numbered when it is taken; taken from then on.
std::string free_name(std::set<std::string>& taken, const std::string& wish) {
  std::string name = wish;
  for (int number = 2; !taken.insert(name).second; ++number) {
    name = wish + " " + std::to_string(number);
  }
  return name;
}

Result<std::vector<Candidate>> make_all(const Scenario& scenario, double ego_length_m) {
  if (Status sound = detail::check_scenario(scenario); !sound) return sound.error();
  const double wheelbase =
      detail::ego_limits(scenario, ego_length_m, Eigen::Vector3d::Zero(), 0.0).wheelbase_m;
  std::vector<Candidate> candidates;
  std::set<std::string> names;
  for (std::size_t i = 0; i < scenario.listed.size(); ++i) {
    Result<Candidate> candidate = listed_candidate(scenario, i, wheelbase);
    if (!candidate) return candidate.error();
    names.insert(candidate->name);
    candidates.push_back(std::move(*candidate));
  }
  std::vector<Candidate> grid;
  if (scenario.grid) grid = grid_candidates(scenario, wheelbase);

  const auto braking = [&scenario](const Candidate& candidate) {
    return brakes_straight(candidate, scenario);
  };
  if (scenario.add_straight_braking &&
      std::none_of(candidates.begin(), candidates.end(), braking) &&
      std::none_of(grid.begin(), grid.end(), braking)) {
    const double deceleration = scenario.ego.speed_mps == 0.0 ? 0.0 : full_braking_mps2(scenario);
    candidates.push_back(arc_candidate(scenario.ego, free_name(names, "brake straight ahead"),
                                       CandidateOrigin::added_braking,
                                       -deceleration * direction_of(scenario.ego.speed_mps), 0.0));
  }
  for (Candidate& candidate : grid) candidate.name = free_name(names, candidate.name);
  candidates.insert(candidates.end(), std::make_move_iterator(grid.begin()),
                    std::make_move_iterator(grid.end()));
  for (const Candidate& candidate : candidates) {
    if (const char* const fault = detail::motion_fault(candidate.motion, scenario.horizon_s)) {
      return detail::refused_motion("candidate '" + candidate.name + "'", "its motion", fault);
    }
  }
  return candidates;
}

}  // namespace

Result<std::vector<Candidate>> make_candidates(const Scenario& scenario, double ego_length_m) {
  return detail::guarded([&] { return make_all(scenario, ego_length_m); });
}

Result<Motion> make_motion(const ActorMotion& motion, const std::string& place) {
  return detail::guarded([&]() -> Result<Motion> {
    if (!motion.poses.empty()) return timed_motion(motion.poses, place);
    TurnMotion turn;
    turn.start = motion.pose;
    turn.speed_mps = motion.speed_mps;
    turn.yaw_rate_radps = motion.yaw_rate_radps;
    turn.acceleration_mps2 = motion.acceleration_mps2;
    return Motion(turn);
  });
}

Result<Motion> make_motion(const ScenarioActor& actor) {
  return make_motion(actor, "actors." + actor.name);
}

}  // namespace crashrank
