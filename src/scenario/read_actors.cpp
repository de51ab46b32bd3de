#include "scenario/read_actors.hpp"

#include "scenario/key_ranges.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace crashrank::detail {

using namespace ranges;
using nlohmann::json;

namespace {

Pose read_pose_members(const JsonObject& object) {
  const Eigen::Vector3d translation(object.number("x_m", position, 0.0),
                                    object.number("y_m", position, 0.0),
                                    object.number("z_m", position, 0.0));
  return pose_from_angles(translation, rad_per_deg * object.number("yaw_deg", angle, 0.0),
                          rad_per_deg * object.number("pitch_deg", angle, 0.0),
                          rad_per_deg * object.number("roll_deg", angle, 0.0));
}

/// `otherwise` has the pose and speed of a motion that states none.
ActorMotion read_motion(const JsonObject& object, const ActorMotion& otherwise = {}) {
  ActorMotion motion;
  motion.pose = object.has("pose") ? read_pose(object) : otherwise.pose;
  motion.speed_mps = object.number("speed_mps", speed, otherwise.speed_mps);
  motion.acceleration_mps2 = object.number("acceleration_mps2", acceleration, 0.0);
  motion.yaw_rate_radps = rad_per_deg * object.number("yaw_rate_dps", yaw_rate, 0.0);
  motion.poses = read_poses(object);
  if (!object.has("poses")) return motion;
  for (const char* key : {"pose", "speed_mps", "acceleration_mps2", "yaw_rate_dps"}) {
    if (object.has(key)) object.refuse(key, "is given together with poses", "keep one of them");
  }
  return motion;
}

double read_probability(const JsonObject& object) {
  object.require("probability");
  return object.number("probability", ranges::probability, 1.0);
}

void read_predictions(const JsonObject& object, ScenarioActor& actor) {
  const json* const predictions = object.array("predictions", 1, limits::predictions);
  if (predictions == nullptr) return;
  for (const char* key : {"poses", "acceleration_mps2", "yaw_rate_dps"}) {
    if (object.has(key)) {
      object.refuse(key, "is given together with predictions",
                    "keep one of them; pose and speed_mps may stand beside predictions");
    }
  }
  for (std::size_t i = 0; i < predictions->size() && object.refusals().goes_on(); ++i) {
    const JsonObject each(
        (*predictions)[i], object.path_of(indexed("predictions", i).c_str()), object.refusals(),
        {"probability", "pose", "speed_mps", "acceleration_mps2", "yaw_rate_dps", "poses"});
    Prediction prediction;
    static_cast<ActorMotion&>(prediction) = read_motion(each, actor);
    prediction.probability = read_probability(each);
    actor.predictions.push_back(std::move(prediction));
  }
}

ScenarioActor read_actor(const JsonObject& root, const json& value, const std::string& path,
                         const std::vector<ScenarioModel>& models) {
  const JsonObject object(
      value, path, root.refusals(),
      {"name", "model", "pose", "speed_mps", "acceleration_mps2", "yaw_rate_dps", "poses",
       "occupants", "predictions", "existence_probability", "perception", "note"});
  require_version_2(root, object, {"predictions", "existence_probability", "perception"});
  ScenarioActor actor;
  object.require("name");
  actor.name = object.name("name", limits::name_characters);
  actor.model = read_model_name(object, models);
  static_cast<ActorMotion&>(actor) = read_motion(object);
  actor.occupants = object.optional_number("occupants", occupants);
  read_predictions(object, actor);
  actor.existence_probability = object.number("existence_probability", existence, 1.0);
  actor.perception = read_uncertainty(object, "perception");
  return actor;
}

/// Index of the actor of that name; after a refusal, without one, their number.
std::size_t actor_named(const JsonObject& object, const char* key, const std::string& name,
                        const std::vector<ScenarioActor>& actors) {
  const auto actor = std::find_if(actors.begin(), actors.end(),
                                  [&name](const ScenarioActor& each) { return each.name == name; });
  if (actor == actors.end()) {
    object.refuse(key, "names '" + name + "', which is not an actor", "use the names of actors");
  }
  return static_cast<std::size_t>(actor - actors.begin());
}

void read_absent(const JsonObject& object, const std::vector<ScenarioActor>& actors,
                 JointFuture& future) {
  const json* const names = object.array("absent", 1, limits::actors);
  if (names == nullptr) return;
  for (const json& name : *names) {
    if (!name.is_string()) {
      object.refuse("absent", "holds something that is no name", "use the names of actors");
      return;
    }
    future.absent.push_back(
        actor_named(object, "absent", name.get_ref<const std::string&>(), actors));
    if (!object.refusals().goes_on()) return;
  }
}

JointFuture read_future(const JsonObject& object, const std::vector<ScenarioActor>& actors) {
  JointFuture future;
  future.probability = read_probability(object);
  object.require("motions");
  if (!object.has("motions")) return future;
  const json& motions = object.at("motions");
  if (!motions.is_object()) {
    object.refuse("motions", "is not an object", "write it as {\"ACTOR\": {...}}");
    return future;
  }
  for (const auto& [name, value] : motions.items()) {
    const std::size_t actor = actor_named(object, "motions", name, actors);
    if (actor == actors.size()) return future;
    const JsonObject motion(value, object.path_of(("motions." + name).c_str()), object.refusals(),
                            {"pose", "speed_mps", "acceleration_mps2", "yaw_rate_dps", "poses"});
    future.motions.push_back({actor, read_motion(motion)});
  }
  read_absent(object, actors, future);
  return future;
}

}  // namespace

Pose read_pose(const JsonObject& parent) {
  if (!parent.has("pose")) return {};
  const JsonObject object(parent.at("pose"), parent.path_of("pose"), parent.refusals(),
                          {"x_m", "y_m", "z_m", "yaw_deg", "pitch_deg", "roll_deg"});
  return read_pose_members(object);
}

std::vector<TimedPose> read_poses(const JsonObject& parent) {
  std::vector<TimedPose> poses;
  const json* array = parent.array("poses", 1, limits::poses);
  if (array == nullptr) return poses;
  poses.reserve(array->size());
  for (std::size_t i = 0; i < array->size(); ++i) {
    const JsonObject object((*array)[i], parent.path_of(indexed("poses", i).c_str()),
                            parent.refusals(),
                            {"t_s", "x_m", "y_m", "z_m", "yaw_deg", "pitch_deg", "roll_deg"});
    object.require("t_s");
    const double time = object.number("t_s", pose_time, 0.0);
    if (poses.empty() ? time != 0.0 : time <= poses.back().time_s) {
      object.refuse("t_s", poses.empty() ? "the first pose is not at time 0" : "does not rise",
                    "start at 0 and let times rise from pose to pose");
    }
    poses.push_back({time, read_pose_members(object)});
    if (!parent.refusals().goes_on()) break;
  }
  return poses;
}

std::size_t read_model_name(const JsonObject& object, const std::vector<ScenarioModel>& models) {
  object.require("model");
  const std::string name = object.name("model", limits::name_characters);
  if (models.empty()) return 0;  // which is an error of its own
  std::string known;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i].name == name) return i;
    if (i < 10) known += (known.empty() ? "" : ", ") + models[i].name;
  }
  object.refuse("model", "'" + name + "' is not among the models", "the models are " + known);
  return 0;
}

StateUncertainty read_uncertainty(const JsonObject& parent, const char* key) {
  if (!parent.has(key)) return {};
  const JsonObject object(parent.at(key), parent.path_of(key), parent.refusals(),
                          {"position_m", "heading_deg", "speed_mps"});
  return {object.number("position_m", position_error, 0.0),
          rad_per_deg * object.number("heading_deg", heading_error, 0.0),
          object.number("speed_mps", speed_error, 0.0)};
}

void require_version_2(const JsonObject& root, const JsonObject& object,
                       std::initializer_list<const char*> keys) {
  if (root.has("scenario_version") && root.at("scenario_version") == 2) return;
  for (const char* const key : keys) {
    if (!object.has(key)) continue;
    object.refuse(key, "belongs to version 2 of the format", "set scenario_version to 2");
  }
}

void read_actors(const JsonObject& root, Scenario& scenario) {
  const json* const actors = root.array("actors", 0, limits::actors);
  if (actors == nullptr) return;
  scenario.actors.reserve(actors->size());
  for (std::size_t i = 0; i < actors->size() && root.refusals().goes_on(); ++i) {
    scenario.actors.push_back(
        read_actor(root, (*actors)[i], indexed("actors", i), scenario.models));
  }
}

void read_futures(const JsonObject& root, Scenario& scenario) {
  require_version_2(root, root, {"futures", "risk"});
  if (const json* const futures = root.array("futures", 1, limits::futures)) {
    for (std::size_t i = 0; i < futures->size() && root.refusals().goes_on(); ++i) {
      const JsonObject future((*futures)[i], indexed("futures", i), root.refusals(),
                              {"probability", "motions", "absent"});
      scenario.futures.push_back(read_future(future, scenario.actors));
    }
  }
  if (!root.has("risk")) return;
  const Result<RiskMeasure> risk = risk_from_name(root.text("risk", limits::name_characters));
  if (risk) {
    scenario.risk = *risk;
  } else {
    root.refuse("risk", risk.error().reason, risk.error().remedy);
  }
}

}  // namespace crashrank::detail
