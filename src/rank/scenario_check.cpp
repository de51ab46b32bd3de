#include "rank/scenario_check.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace crashrank::detail {
namespace {

namespace limits = scenario_limits;

constexpr double rad_per_deg = 0.017453292519943295;
constexpr double max_yaw_rate_radps = limits::yaw_rate_dps * rad_per_deg;
// Conversion from degrees rounds; the limits are meant in degrees.
constexpr double rounding = 1.0 + 1e-12;

class Check {
public:
  Status status = Success{};

  void at_most(const std::string& path, double number, double limit) {
    if (std::abs(number) <= limit * rounding) return;
    refuse(path, std::isfinite(number) ? "is out of range" : "is not a finite number");
  }

  void positive(const std::string& path, double number, double limit) {
    at_most(path, number, limit);
    if (!(number > 0.0)) refuse(path, "is not positive");
  }

  void not_negative(const std::string& path, double number, double limit) {
    at_most(path, number, limit);
    if (number < 0.0) refuse(path, "is negative");
  }

  void pose(const std::string& path, const Pose& pose) {
    if (!(rigidity_error(pose) <= max_rigidity_error)) refuse(path, "is not a rigid pose");
    for (int axis = 0; axis < 3; ++axis) {
      at_most(path, pose.translation[axis], limits::position_m);
    }
  }

  void poses(const std::string& path, const std::vector<TimedPose>& poses) {
    for (const TimedPose& timed : poses) {
      not_negative(path, timed.time_s, limits::horizon_s);
      pose(path, timed.pose);
    }
  }

  void refuse(const std::string& path, const char* reason) {
    if (status.ok()) {
      status = Error{ErrorCode::bad_input, {}, path, reason, "see the ranges of scenario_limits"};
    }
  }
};

void check_ego(const Scenario& scenario, Check& check) {
  const ScenarioEgo& ego = scenario.ego;
  if (ego.model >= scenario.models.size()) check.refuse("ego.model", "is not among the models");
  check.pose("ego.pose", ego.pose);
  check.at_most("ego.speed_mps", ego.speed_mps, limits::speed_mps);
  check.at_most("ego.yaw_rate_dps", ego.yaw_rate_radps, max_yaw_rate_radps);
  check.not_negative("ego.max_acceleration_mps2", ego.max_acceleration_mps2,
                     limits::acceleration_mps2);
  check.not_negative("ego.max_steering_deg", ego.max_steering_rad,
                     limits::steering_deg * rad_per_deg);
  if (ego.wheelbase_m) {
    check.positive("ego.wheelbase_m", *ego.wheelbase_m, limits::max_wheelbase_m);
  }
}

void check_candidates(const Scenario& scenario, Check& check) {
  for (std::size_t i = 0; i < scenario.listed.size() && check.status.ok(); ++i) {
    const ListedCandidate& candidate = scenario.listed[i];
    const std::string path = "candidates.listed[" + std::to_string(i) + "]";
    check.at_most(path + ".acceleration_mps2", candidate.acceleration_mps2,
                  limits::acceleration_mps2);
    check.at_most(path + ".steering_deg", candidate.steering_rad.value_or(0.0),
                  limits::steering_deg * rad_per_deg);
    check.at_most(path + ".yaw_rate_dps", candidate.yaw_rate_radps.value_or(0.0),
                  max_yaw_rate_radps);
    check.poses(path + ".poses", candidate.poses);
  }
  if (!scenario.grid) {
    if (scenario.listed.empty() && !scenario.add_straight_braking) {
      check.refuse("candidates", "leaves no manoeuvre to rank; list one, or let the grid be made");
    }
    return;
  }
  const CandidateGrid& grid = *scenario.grid;
  if (grid.accelerations < 1 || grid.accelerations > limits::grid_side || grid.steerings < 1 ||
      grid.steerings > limits::grid_side) {
    check.refuse("candidates.grid", "is empty or too fine");
  }
}

void check_actors(const Scenario& scenario, Check& check) {
  for (std::size_t i = 0; i < scenario.actors.size() && check.status.ok(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    const std::string path = "actors[" + std::to_string(i) + "]";
    if (actor.model >= scenario.models.size()) {
      check.refuse(path + ".model", "is not among the models");
    }
    check.pose(path + ".pose", actor.pose);
    check.at_most(path + ".speed_mps", actor.speed_mps, limits::speed_mps);
    check.at_most(path + ".acceleration_mps2", actor.acceleration_mps2, limits::acceleration_mps2);
    check.at_most(path + ".yaw_rate_dps", actor.yaw_rate_radps, max_yaw_rate_radps);
    check.poses(path + ".poses", actor.poses);
  }
}

}  // namespace

Status check_scenario(const Scenario& scenario) {
  Check check;
  for (const ScenarioModel& model : scenario.models) {
    const double mass = model.mass_kg.value_or(limits::min_mass_kg);
    check.positive("models." + model.name + ".mass_kg", mass, limits::max_mass_kg);
  }
  check_ego(scenario, check);
  check_candidates(scenario, check);
  check_actors(scenario, check);
  check.positive("horizon_s", scenario.horizon_s, limits::horizon_s);
  check.positive("grip", scenario.grip, limits::max_grip);
  check.not_negative("crush.time_s", scenario.crush.time_s, limits::crush_time_s);
  check.not_negative("crush.depth_m", scenario.crush.depth_m.value_or(0.0), limits::crush_depth_m);
  return check.status;
}

}  // namespace crashrank::detail
