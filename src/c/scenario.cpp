#include "c/enums.hpp"
#include "c/handles.hpp"
#include "c/motions.hpp"
#include "c/sized.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

/// Hands a scenario out.
crashrank_status give(Result<Scenario> made, crashrank_scenario** scenario,
                      crashrank_error* error) {
  if (!made) return refuse(made.error(), error);
  *scenario = new crashrank_scenario{std::move(*made)};
  return CRASHRANK_OK;
}

/// Persons as the scenario has them: below 0 nothing is set.
std::optional<double> to_occupants(double persons) {
  return persons < 0.0 ? std::nullopt : std::optional<double>(persons);
}

}  // namespace

crashrank_status crashrank_scenario_load(const char* file, crashrank_scenario** scenario,
                                         crashrank_error* error) {
  if (const char* null = c::first_null({{"file", file}, {"scenario", scenario}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&] { return give(load_scenario_file(file), scenario, error); });
}

crashrank_status crashrank_scenario_create_from_text(const char* text, size_t length,
                                                     const char* name,
                                                     crashrank_scenario** scenario,
                                                     crashrank_error* error) {
  if (const char* null = c::first_null({{"text", text}, {"name", name}, {"scenario", scenario}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    if (length > scenario_limits::file_bytes) {
      return refuse(CRASHRANK_LIMIT_EXCEEDED, "a scenario has at most 16 MiB of text", error);
    }
    return give(parse_scenario(std::string(text, length), name), scenario, error);
  });
}

crashrank_status crashrank_scenario_create(const char* name, crashrank_scenario** scenario,
                                           crashrank_error* error) {
  if (const char* null = c::first_null({{"name", name}, {"scenario", scenario}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&] {
    Scenario made;
    made.name = name;
    made.grid.reset();
    made.add_straight_braking = false;
    return give(std::move(made), scenario, error);
  });
}

void crashrank_scenario_free(crashrank_scenario* scenario) { delete scenario; }

crashrank_status crashrank_scenario_add_model(crashrank_scenario* scenario, const char* name,
                                              crashrank_body_kind kind, double mass_kg,
                                              crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"name", name}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Result<BodyKind> known = c::from_c<BodyKind>(kind, "kind");
    if (!known) return refuse(known.error(), error);
    ScenarioModel model;
    model.name = name;
    model.kind = *known;
    if (mass_kg != 0.0) model.mass_kg = mass_kg;
    scenario->scenario.models.push_back(std::move(model));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_set_body(crashrank_scenario* scenario, size_t model,
                                             const crashrank_body* body, crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"body", body}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    if (model >= scenario->scenario.models.size()) {
      return refuse(CRASHRANK_USAGE, "the scenario has no such shape", error);
    }
    const Result<crashrank_body> given = c::read_sized("crashrank_body", *body);
    if (!given) return refuse(given.error(), error);
    ScenarioModel made = scenario->scenario.models[model];
    made.center_of_mass_m.reset();
    made.yaw_inertia_kgm2.reset();
    made.surface.reset();
    if (const double* center = given->center_of_mass_m; center != nullptr) {
      made.center_of_mass_m = Eigen::Vector3d(center[0], center[1], center[2]);
    }
    if (given->yaw_inertia_kgm2 != 0.0) made.yaw_inertia_kgm2 = given->yaw_inertia_kgm2;
    made.stiffness = given->stiffness != 0.0 ? given->stiffness : 1.0;
    made.breakaway.reset();
    if (given->breakaway_force_n != 0.0 || given->breakaway_moment_nm != 0.0) {
      const auto or_never = [](double load) {
        return load != 0.0 ? load : std::numeric_limits<double>::infinity();
      };
      made.breakaway =
          Breakaway{or_never(given->breakaway_force_n), or_never(given->breakaway_moment_nm)};
    }
    made.deflection_m = given->deflection_m;
    made.deflection_force_n.reset();
    if (given->deflection_force_n != 0.0) made.deflection_force_n = given->deflection_force_n;
    if (given->surface != 0) {
      const Result<Surface> surface = c::from_c<Surface>(given->surface, "crashrank_body.surface");
      if (!surface) return refuse(surface.error(), error);
      made.surface = *surface;
    }
    scenario->scenario.models[model] = std::move(made);
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_set_ego_occupants(crashrank_scenario* scenario, double persons,
                                                      crashrank_error* error) {
  if (scenario == nullptr) return refuse_null("scenario", error);
  scenario->scenario.ego.occupants = to_occupants(persons);
  return CRASHRANK_OK;
}

crashrank_status crashrank_scenario_set_actor_occupants(crashrank_scenario* scenario, size_t actor,
                                                        double persons, crashrank_error* error) {
  if (scenario == nullptr) return refuse_null("scenario", error);
  if (actor >= scenario->scenario.actors.size()) {
    return refuse(CRASHRANK_USAGE, "the scenario has no such actor", error);
  }
  scenario->scenario.actors[actor].occupants = to_occupants(persons);
  return CRASHRANK_OK;
}

crashrank_status crashrank_scenario_set_ego(crashrank_scenario* scenario, const crashrank_ego* ego,
                                            crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"ego", ego}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Result<crashrank_ego> given = c::read_sized("crashrank_ego", *ego);
    if (!given) return refuse(given.error(), error);
    const Result<Pose> pose = c::to_pose(given->pose, "crashrank_ego.pose");
    if (!pose) return refuse(pose.error(), error);
    ScenarioEgo made = scenario->scenario.ego;
    made.model = given->model;
    made.pose = *pose;
    made.speed_mps = given->speed_mps;
    made.yaw_rate_radps = given->yaw_rate_radps;
    made.wheelbase_m.reset();
    if (given->wheelbase_m != 0.0) made.wheelbase_m = given->wheelbase_m;
    scenario->scenario.ego = made;
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_add_actor(crashrank_scenario* scenario,
                                              const crashrank_actor* actor,
                                              crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"actor", actor}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Result<crashrank_actor> given = c::read_sized("crashrank_actor", *actor);
    if (!given) return refuse(given.error(), error);
    if (given->name == nullptr) return refuse_null("crashrank_actor.name", error);
    Result<ActorMotion> motion = c::to_motion(*given, "crashrank_actor");
    if (!motion) return refuse(motion.error(), error);
    ScenarioActor made;
    static_cast<ActorMotion&>(made) = std::move(*motion);
    made.name = given->name;
    made.model = given->model;
    scenario->scenario.actors.push_back(std::move(made));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_add_candidate(crashrank_scenario* scenario,
                                                  const crashrank_candidate* candidate,
                                                  crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"candidate", candidate}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Result<crashrank_candidate> given = c::read_sized("crashrank_candidate", *candidate);
    if (!given) return refuse(given.error(), error);
    if (given->name == nullptr) return refuse_null("crashrank_candidate.name", error);
    if (given->poses == nullptr && given->pose_count > 0) {
      return refuse_null("crashrank_candidate.poses", error);
    }
    Result<std::vector<TimedPose>> poses =
        c::to_poses(given->poses, given->pose_count, "crashrank_candidate.poses");
    if (!poses) return refuse(poses.error(), error);
    ListedCandidate made;
    made.name = given->name;
    made.acceleration_mps2 = given->acceleration_mps2;
    if (poses->empty()) made.steering_rad = given->steering_rad;
    made.poses = std::move(*poses);
    scenario->scenario.listed.push_back(std::move(made));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_set_grid(crashrank_scenario* scenario, size_t accelerations,
                                             size_t steerings, crashrank_error* error) {
  if (scenario == nullptr) return refuse_null("scenario", error);
  Scenario& changed = scenario->scenario;
  if (accelerations == 0 && steerings == 0) {
    changed.grid.reset();
    changed.add_straight_braking = false;
    return CRASHRANK_OK;
  }
  if (accelerations < 1 || steerings < 1 || accelerations > scenario_limits::grid_side ||
      steerings > scenario_limits::grid_side) {
    return refuse(CRASHRANK_USAGE, "a grid has 1 to 101 accelerations and steerings", error);
  }
  changed.grid = CandidateGrid{accelerations, steerings};
  changed.add_straight_braking = true;
  return CRASHRANK_OK;
}

crashrank_status crashrank_scenario_set_horizon(crashrank_scenario* scenario, double horizon_s,
                                                crashrank_error* error) {
  if (scenario == nullptr) return refuse_null("scenario", error);
  scenario->scenario.horizon_s = horizon_s;
  return CRASHRANK_OK;
}

crashrank_status crashrank_scenario_set_grip(crashrank_scenario* scenario, double grip,
                                             crashrank_error* error) {
  if (scenario == nullptr) return refuse_null("scenario", error);
  scenario->scenario.grip = grip;
  return CRASHRANK_OK;
}

size_t crashrank_scenario_model_count(const crashrank_scenario* scenario) {
  return scenario == nullptr ? 0 : scenario->scenario.models.size();
}

const char* crashrank_scenario_model_name(const crashrank_scenario* scenario, size_t index) {
  if (index >= crashrank_scenario_model_count(scenario)) return nullptr;
  return scenario->scenario.models[index].name.c_str();
}

const char* crashrank_scenario_model_path(const crashrank_scenario* scenario, size_t index) {
  if (index >= crashrank_scenario_model_count(scenario)) return nullptr;
  return scenario->scenario.models[index].path.c_str();
}
