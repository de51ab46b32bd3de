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

/// Of a listed candidate's poses from the ego: what is farther was written in another frame.
constexpr double farthest_beginning_m = 1.0;

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

  void range(const std::string& path, double least, double most, double lowest, double highest) {
    if (!(least >= lowest && least <= most && most <= highest)) refuse(path, "is out of range");
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
      status = Error{ErrorCode::bad_input, {}, path, reason, "see scenario_limits and harm_limits"};
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
    if (candidate.poses.empty()) continue;
    const Eigen::Vector3d& begins = candidate.poses.front().pose.translation;
    if (!((begins - scenario.ego.pose.translation).norm() <= farthest_beginning_m)) {
      check.refuse(path + ".poses[0]",
                   "is more than 1 m from the ego's pose, where every manoeuvre begins");
    }
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

void check_harm(const HarmOptions& harm, const std::string& path, Check& check) {
  namespace bounds = harm_limits;
  const HarmWeights& w = harm.weights;
  check.not_negative(path + ".weights.ego_occupant", w.ego_occupant, bounds::weight);
  check.not_negative(path + ".weights.other_occupant", w.other_occupant, bounds::weight);
  check.not_negative(path + ".weights.pedestrian", w.pedestrian, bounds::weight);
  check.not_negative(path + ".weights.cyclist", w.cyclist, bounds::weight);
  check.not_negative(path + ".weights.motorcyclist", w.motorcyclist, bounds::weight);
  check.not_negative(path + ".weights.property_per_mj", w.property_per_mj, bounds::weight);
  check.not_negative(path + ".people.ego", w.people_in_ego, bounds::people);
  check.not_negative(path + ".people.car", w.people_in_car, bounds::people);
  check.not_negative(path + ".people.truck", w.people_in_truck, bounds::people);
  check.not_negative(path + ".people.bus", w.people_in_bus, bounds::people);
  check.not_negative(path + ".friction", harm.friction, bounds::friction);
  const HarmRanges& r = harm.ranges;
  check.range(path + ".ranges.friction", r.least_friction, r.most_friction, 0.0, bounds::friction);
  check.range(path + ".ranges.strength", r.least_strength, r.most_strength, bounds::min_strength,
              bounds::max_strength);
  check.range(path + ".ranges.restitution", r.least_restitution, r.most_restitution, 0.0, 1.0);
  check.range(path + ".ranges.risk_speed", r.least_risk_speed, r.most_risk_speed,
              bounds::min_risk_speed, bounds::max_risk_speed);
  check.not_negative(path + ".after_impact.deceleration_mps2", harm.after.deceleration_mps2,
                     bounds::deceleration_mps2);
  check.not_negative(path + ".after_impact.longest_s", harm.after.longest_s, bounds::after_s);
  if (harm.after.most_contacts < 1 || harm.after.most_contacts > bounds::contacts) {
    check.refuse(path + ".after_impact.most_contacts", "is out of range");
  }
  check.not_negative(path + ".least_struck_share", harm.least_struck_share, 1.0);
}

}  // namespace

Status check_harm(const HarmOptions& harm, const std::string& path) {
  Check check;
  check_harm(harm, path, check);
  return check.status;
}

Status check_scenario(const Scenario& scenario) {
  Check check;
  for (const ScenarioModel& model : scenario.models) {
    const double mass = model.mass_kg.value_or(limits::min_mass_kg);
    const std::string path = "models." + model.name + ".mass_kg";
    check.positive(path, mass, limits::max_mass_kg);
    if (mass < limits::min_mass_kg) check.refuse(path, "is too small");
  }
  check_ego(scenario, check);
  check_candidates(scenario, check);
  check_actors(scenario, check);
  check.positive("horizon_s", scenario.horizon_s, limits::horizon_s);
  check_harm(scenario.harm, "harm", check);
  check.positive("grip", scenario.grip, limits::max_grip);
  check.not_negative("crush.time_s", scenario.crush.time_s, limits::crush_time_s);
  check.not_negative("crush.depth_m", scenario.crush.depth_m.value_or(0.0), limits::crush_depth_m);
  return check.status;
}

}  // namespace crashrank::detail
