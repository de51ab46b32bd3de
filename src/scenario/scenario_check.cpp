#include "scenario/scenario_check.hpp"

#include "crashrank/dispatch/worker_pool.hpp"
#include "scenario/key_ranges.hpp"
#include "scenario/motion_check.hpp"

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

namespace limits = scenario_limits;

using ranges::rad_per_deg;
// Conversion from degrees and back rounds.
constexpr double rounding = 1.0 - 1e-12;

class Check {
public:
  explicit Check(Refusals& refusals) : refusals_(refusals) {}

  bool goes_on() const { return refusals_.goes_on(); }
  Refusals& refusals() { return refusals_; }

  /// `unit`: what a number as scenarios have it is multiplied by to be the library's.
  void within(const std::string& path, double number, NumberRange range, double unit = 1.0) {
    const double stated = number / unit;
    if (!std::isfinite(number)) {
      refuse(path, "is not a finite number", give_one_in(range));
    } else if (!range.holds(stated) && !range.holds(stated * rounding)) {
      refuse(path, out_of_range(stated), give_one_in(range));
    }
  }

  void both_within(const std::string& path, double least, double most, NumberRange range) {
    within(path, least, range);
    within(path, most, range);
    if (least > most) refuse(path, "begins above its end", "give the lower end first");
  }

  void pose(const std::string& path, const Pose& pose) {
    if (!(rigidity_error(pose) <= max_rigidity_error)) {
      refuse(path, "is not a rigid pose", "give a rotation, without scale or mirror");
    }
    for (const auto& [axis, key] :
         {std::pair(0, ".x_m"), std::pair(1, ".y_m"), std::pair(2, ".z_m")}) {
      within(path + key, pose.translation[axis], ranges::position);
    }
  }

  void uncertainty(const std::string& path, const StateUncertainty& errors) {
    within(path + ".position_m", errors.position_m, ranges::position_error);
    within(path + ".heading_deg", errors.heading_rad, ranges::heading_error, rad_per_deg);
    within(path + ".speed_mps", errors.speed_mps, ranges::speed_error);
  }

  void poses(const std::string& path, const std::vector<TimedPose>& poses) {
    for (std::size_t i = 0; i < poses.size() && goes_on(); ++i) {
      const std::string at = path + "[" + std::to_string(i) + "]";
      within(at + ".t_s", poses[i].time_s, ranges::pose_time);
      pose(at, poses[i].pose);
    }
  }

  void refuse(const std::string& path, std::string reason, std::string remedy) {
    refusals_.add(Error{ErrorCode::bad_input, {}, path, std::move(reason), std::move(remedy)});
  }

private:
  Refusals& refusals_;
};

template <class Named>
void check_names(const std::vector<Named>& named, const char* path, Check& check) {
  std::set<std::string> taken;
  for (std::size_t i = 0; i < named.size(); ++i) {
    if (named[i].name.empty() || taken.insert(named[i].name).second) continue;
    check.refuse(std::string(path) + "[" + std::to_string(i) + "].name",
                 "is taken by an earlier one", "choose another name");
  }
}

void check_models(const Scenario& scenario, Check& check) {
  for (const ScenarioModel& model : scenario.models) {
    const std::string path = "models." + model.name;
    if (model.mass_kg) {
      check.within(path + ".mass_kg", *model.mass_kg, ranges::mass);
    }
    if (model.center_of_mass_m) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        check.within(path + ".center_of_mass_m[" + std::to_string(i) + "]",
                     (*model.center_of_mass_m)[i], ranges::position);
      }
    }
    if (model.yaw_inertia_kgm2) {
      check.within(path + ".yaw_inertia_kgm2", *model.yaw_inertia_kgm2, ranges::yaw_inertia);
    }
    check.within(path + ".stiffness", model.stiffness, ranges::stiffness);
    if (model.box_m) {
      if (!model.mesh.empty() || !model.path.empty()) {
        check.refuse(path + ".mesh", "is given together with box", "keep one of them");
      }
      for (Eigen::Index i = 0; i < 3; ++i) {
        check.within(path + ".box[" + std::to_string(i) + "]", (*model.box_m)[i], ranges::box_side);
      }
    }
    if (model.honeycomb) {
      const Honeycomb& h = *model.honeycomb;
      check.within(path + ".honeycomb.pressure_pa", h.pressure_pa, ranges::honeycomb_pressure);
      check.within(path + ".honeycomb.depth_m", h.depth_m, ranges::honeycomb_size);
      check.within(path + ".honeycomb.high_m", h.high_m, ranges::honeycomb_size);
      check.within(path + ".honeycomb.low_m", h.low_m, ranges::honeycomb_low);
      if (!(h.low_m < h.high_m)) {
        check.refuse(path + ".honeycomb.low_m", "is not below high_m", "give the lower end");
      }
    }
    if (model.breakaway) {
      // What does not break the foot is infinite.
      const Breakaway& foot = *model.breakaway;
      if (std::isfinite(foot.force_n) || !std::isfinite(foot.moment_nm)) {
        check.within(path + ".breakaway.force_n", foot.force_n, ranges::breakaway);
      }
      if (!std::isinf(foot.moment_nm)) {
        check.within(path + ".breakaway.moment_nm", foot.moment_nm, ranges::breakaway);
      }
    }
    check.within(path + ".deflection_m", model.deflection_m, ranges::deflection);
    if (model.deflection_force_n) {
      check.within(path + ".deflection_force_n", *model.deflection_force_n, ranges::breakaway);
    }
  }
}

void check_ego(const Scenario& scenario, Check& check) {
  const ScenarioEgo& ego = scenario.ego;
  if (ego.model >= scenario.models.size()) {
    check.refuse("ego.model", "is not among the models", "add the model first");
  }
  check.pose("ego.pose", ego.pose);
  check.within("ego.speed_mps", ego.speed_mps, ranges::speed);
  check.within("ego.yaw_rate_dps", ego.yaw_rate_radps, ranges::yaw_rate, rad_per_deg);
  check.within("ego.max_acceleration_mps2", ego.max_acceleration_mps2, ranges::max_acceleration);
  check.within("ego.max_steering_deg", ego.max_steering_rad, ranges::max_steering, rad_per_deg);
  check.within("ego.max_steering_rate_dps", ego.max_steering_rate_radps, ranges::max_steering_rate,
               rad_per_deg);
  if (ego.max_deceleration_mps2) {
    check.within("ego.max_deceleration_mps2", *ego.max_deceleration_mps2, ranges::max_deceleration);
  }
  if (ego.wheelbase_m) {
    check.within("ego.wheelbase_m", *ego.wheelbase_m, ranges::wheelbase);
  }
  check.within("ego.occupants", ego.occupants.value_or(0.0), ranges::occupants);
  check.uncertainty("ego.uncertainty", ego.uncertainty);
}

void check_candidates(const Scenario& scenario, Check& check) {
  for (std::size_t i = 0; i < scenario.listed.size() && check.goes_on(); ++i) {
    const ListedCandidate& candidate = scenario.listed[i];
    const std::string path = ranges::indexed("candidates.listed", i);
    const std::size_t before = check.refusals().errors().size();
    check.within(path + ".acceleration_mps2", candidate.acceleration_mps2, ranges::acceleration);
    check.within(path + ".steering_deg", candidate.steering_rad.value_or(0.0), ranges::steering,
                 rad_per_deg);
    check.within(path + ".yaw_rate_dps", candidate.yaw_rate_radps.value_or(0.0), ranges::yaw_rate,
                 rad_per_deg);
    check.poses(path + ".poses", candidate.poses);
    if (candidate.poses.empty()) continue;
    if (!begins_at(candidate.poses.front().pose, scenario.ego.pose)) {
      check.refuse(path + ".poses[0]",
                   "is more than 1 m or 30 degrees from the ego's pose, where every manoeuvre "
                   "begins",
                   "write the poses in the frame of the ego's pose");
    }
    // It may stand in a table, where an index tells little.
    for (std::size_t k = before; k < check.refusals().errors().size(); ++k) {
      check.refusals().errors()[k].place += " of '" + candidate.name + "'";
    }
  }
  if (!scenario.grid) {
    if (scenario.listed.empty() && !scenario.add_straight_braking) {
      check.refuse("candidates", "leaves no manoeuvre to rank",
                   "list one, name a table, or set grid or add_straight_braking to true");
    }
    return;
  }
  const CandidateGrid& grid = *scenario.grid;
  if (grid.accelerations < 1 || grid.accelerations > limits::grid_side || grid.steerings < 1 ||
      grid.steerings > limits::grid_side) {
    check.refuse("candidates.grid", "is empty or too fine",
                 "let each side have 1 to " + std::to_string(limits::grid_side));
  }
}

void check_motion(const std::string& path, const ActorMotion& motion, Check& check) {
  check.pose(path + ".pose", motion.pose);
  check.within(path + ".speed_mps", motion.speed_mps, ranges::speed);
  check.within(path + ".acceleration_mps2", motion.acceleration_mps2, ranges::acceleration);
  check.within(path + ".yaw_rate_dps", motion.yaw_rate_radps, ranges::yaw_rate, rad_per_deg);
  check.poses(path + ".poses", motion.poses);
}

void check_actors(const Scenario& scenario, Check& check) {
  for (std::size_t i = 0; i < scenario.actors.size() && check.goes_on(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    const std::string path = "actors[" + std::to_string(i) + "]";
    if (actor.model >= scenario.models.size()) {
      check.refuse(path + ".model", "is not among the models", "add the model first");
    }
    check_motion(path, actor, check);
    check.within(path + ".occupants", actor.occupants.value_or(0.0), ranges::occupants);
    check.within(path + ".existence_probability", actor.existence_probability, ranges::existence);
    check.uncertainty(path + ".perception", actor.perception);
    for (std::size_t k = 0; k < actor.predictions.size() && check.goes_on(); ++k) {
      check_motion(path + "." + ranges::indexed("predictions", k), actor.predictions[k], check);
    }
  }
}

void check_futures(const Scenario& scenario, Check& check) {
  for (std::size_t i = 0; i < scenario.futures.size() && check.goes_on(); ++i) {
    for (const FutureMotion& moved : scenario.futures[i].motions) {
      const std::string path = ranges::indexed("futures", i) + ".motions";
      check_motion(path + "." + scenario.actors[moved.actor].name, moved.motion, check);
    }
  }
}

void check_risk(const RiskMeasure& risk, Check& check) {
  const bool has_level = risk.kind == RiskKind::cvar || risk.kind == RiskKind::quantile;
  if (has_level && !(risk.level > 0.0 && risk.level < 1.0)) {
    check.refuse("risk", "has a level of " + number_text(risk.level),
                 "give one above 0 and below 1");
  }
}

template <class Weighted>
void check_sum(const std::vector<Weighted>& weighted, const std::string& path, Check& check) {
  if (weighted.empty()) return;
  double sum = 0.0;
  for (std::size_t i = 0; i < weighted.size(); ++i) {
    check.within(path + "[" + std::to_string(i) + "].probability", weighted[i].probability,
                 ranges::probability);
    sum += weighted[i].probability;
  }
  if (std::abs(sum - 1.0) > limits::probability_sum) {
    check.refuse(path, "has probabilities that sum to " + number_text(sum), "let them sum to 1");
  }
}

void check_harm(const HarmOptions& harm, const std::string& path, Check& check) {
  const HarmWeights& w = harm.weights;
  check.within(path + ".weights.ego_occupant", w.ego_occupant, ranges::weight);
  check.within(path + ".weights.other_occupant", w.other_occupant, ranges::weight);
  check.within(path + ".weights.pedestrian", w.pedestrian, ranges::weight);
  check.within(path + ".weights.cyclist", w.cyclist, ranges::weight);
  check.within(path + ".weights.motorcyclist", w.motorcyclist, ranges::weight);
  check.within(path + ".weights.property_per_mj", w.property_per_mj, ranges::weight);
  check.within(path + ".people.ego", w.people_in_ego, ranges::people);
  check.within(path + ".people.car", w.people_in_car, ranges::people);
  check.within(path + ".people.truck", w.people_in_truck, ranges::people);
  check.within(path + ".people.bus", w.people_in_bus, ranges::people);
  check.within(path + ".pedestrian.age_years", harm.pedestrian.age_years.value_or(0.0),
               ranges::age);
  check.within(path + ".pedestrian.male_share", harm.pedestrian.male_share.value_or(0.0),
               ranges::share);
  check.within(path + ".friction", harm.friction, ranges::friction);
  const HarmRanges& r = harm.ranges;
  check.both_within(path + ".ranges.friction", r.least_friction, r.most_friction, ranges::friction);
  check.both_within(path + ".ranges.strength", r.least_strength, r.most_strength, ranges::strength);
  check.both_within(path + ".ranges.restitution", r.least_restitution, r.most_restitution,
                    ranges::restitution);
  check.both_within(path + ".ranges.risk_speed", r.least_risk_speed, r.most_risk_speed,
                    ranges::risk_speed);
  check.within(path + ".step", harm.step, ranges::step);
  check.within(path + ".least_struck_share", harm.least_struck_share, ranges::share);
}

void check_road(const Road& road, Check& check) {
  std::size_t corners = 0;
  for (const Area& area : road.drivable) {
    corners += area.outer.size();
    for (const auto& hole : area.holes) corners += hole.size();
  }
  if (corners > road_limits::corners || road.drivable.size() > road_limits::areas) {
    check.refuse("road.drivable",
                 "has more than " + std::to_string(road_limits::corners) + " corners or " +
                     std::to_string(road_limits::areas) + " areas",
                 "simplify it");
  }
  for (std::size_t i = 0; i < road.drivable.size() && check.goes_on(); ++i) {
    const Status sound = check_area(road.drivable[i], "road." + ranges::indexed("drivable", i));
    if (!sound) check.refusals().add(sound.error());
  }
  check.within("road.off_road.harm_per_leaving", road.harm_per_leaving, ranges::harm_per_leaving);
  if (road.off_road_grip) {
    check.within("road.off_road.grip", *road.off_road_grip, ranges::grip);
  }
}

}  // namespace

void check_road(const Road& road, Refusals& refusals) {
  Check check(refusals);
  check_road(road, check);
}

Status check_harm(const HarmOptions& harm, const std::string& path) {
  Refusals refusals;
  Check check(refusals);
  check_harm(harm, path, check);
  return refusals.status();
}

Status check_workers(unsigned workers) {
  if (workers <= max_workers) return Success{};
  return make_error(ErrorCode::usage, "there are " + std::to_string(workers) + " workers",
                    "let at most " + std::to_string(max_workers) + " share the work");
}

void check_names(const Scenario& scenario, Refusals& refusals) {
  Check check(refusals);
  check_names(scenario.listed, "candidates.listed", check);
  check_names(scenario.actors, "actors", check);
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    if (scenario.actors[i].name != "ego") continue;
    check.refuse(ranges::indexed("actors", i) + ".name",
                 "is 'ego', which is the deciding vehicle wherever bodies are named",
                 "choose another name");
  }
}

void check_probabilities(const Scenario& scenario, Refusals& refusals) {
  Check check(refusals);
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    const std::string path = ranges::indexed("actors", i);
    if (actor.predictions.size() > limits::predictions) {
      check.refuse(path + ".predictions", "has more than " + std::to_string(limits::predictions),
                   "keep the likeliest");
    }
    check_sum(actor.predictions, path + ".predictions", check);
    const bool uncertain = !actor.predictions.empty() || actor.existence_probability != 1.0;
    if (uncertain && !scenario.futures.empty()) {
      const bool predicted = !actor.predictions.empty();
      check.refuse(path + (predicted ? ".predictions" : ".existence_probability"),
                   "is given together with futures", "keep one of them");
    }
  }
  if (scenario.futures.size() > limits::futures) {
    check.refuse("futures", "are more than " + std::to_string(limits::futures),
                 "keep the likeliest");
  }
  check_sum(scenario.futures, "futures", check);
  for (std::size_t i = 0; i < scenario.futures.size(); ++i) {
    std::set<std::size_t> moved;
    for (const FutureMotion& each : scenario.futures[i].motions) {
      const std::string path = ranges::indexed("futures", i) + ".motions";
      if (each.actor >= scenario.actors.size()) {
        check.refuse(path, "names an actor that is not there", "use indices of actors");
      } else if (!moved.insert(each.actor).second) {
        check.refuse(path, "moves '" + scenario.actors[each.actor].name + "' twice",
                     "keep one motion");
      }
    }
    for (const std::size_t actor : scenario.futures[i].absent) {
      const std::string path = ranges::indexed("futures", i) + ".absent";
      if (actor >= scenario.actors.size()) {
        check.refuse(path, "names an actor that is not there", "use indices of actors");
      } else if (!moved.insert(actor).second) {
        check.refuse(path,
                     "names '" + scenario.actors[actor].name + "', which moves or is named before",
                     "say once what becomes of it");
      }
    }
  }
}

Status check_scenario(const Scenario& scenario) {
  Refusals refusals;
  check_scenario(scenario, refusals);
  return refusals.status();
}

void check_scenario(const Scenario& scenario, Refusals& refusals) {
  check_names(scenario, refusals);
  check_probabilities(scenario, refusals);
  if (!refusals.goes_on()) return;
  Check check(refusals);
  check_models(scenario, check);
  check_ego(scenario, check);
  check_candidates(scenario, check);
  check_actors(scenario, check);
  check_futures(scenario, check);
  check_risk(scenario.risk, check);
  check_road(scenario.road, check);
  check.within("horizon_s", scenario.horizon_s, ranges::horizon);
  check_harm(scenario.harm, "harm", check);
  check.within("grip", scenario.grip, ranges::grip);
}

}  // namespace crashrank::detail
