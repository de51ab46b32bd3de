#include "rank/scene.hpp"

#include "crash/scene_run.hpp"
#include "crashrank/crash/injury.hpp"
#include "crashrank/internal/rank/harm.hpp"
#include "rank/join_fixed.hpp"
#include "rank/measure_table.hpp"
#include "scenario/motion_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

constexpr double slice_length_s = 0.25;
constexpr double max_slices = 64.0;
constexpr float infinity_f = std::numeric_limits<float>::infinity();

Body make_body(const Model& model, double mass_kg) {
  Body body;
  body.model = &model;
  body.mass_kg = mass_kg;
  const Box& root = model.tree.nodes.front().box;
  const Eigen::Vector3d low = root.min.cast<double>();
  const Eigen::Vector3d high = root.max.cast<double>();
  body.center_m = model.tree.axes * (0.5 * (low + high));
  body.half_axes_m = model.tree.axes * (0.5 * (high - low)).asDiagonal();
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                               (corner & 4) != 0 ? 1.0 : -1.0);
    const Eigen::Vector3d point = body.center_m + body.half_axes_m * sign;
    body.radius_m = std::max(body.radius_m, point.norm());
  }
  return body;
}

/// Adds to an error of a mesh the key that names it.
Error error_of_mesh(Error error, const ScenarioModel& model) {
  error.place = "models." + model.name + (model.box_m ? ".box" : ".mesh");
  if (!model.path.empty()) error.reason = model.path + " " + error.reason;
  return error;
}

/// A post needs the mass that it has when free, a rail has none.
Status check_fixed_thing(const ScenarioModel& model, double mass_kg) {
  const auto error = [&](const char* key, const char* reason, const char* remedy) {
    return Error{ErrorCode::bad_input, {}, "models." + model.name + key, reason, remedy};
  };
  if (model.breakaway && !std::isfinite(mass_kg)) {
    return error(".mass_kg", "is missing, but the body breaks away",
                 "give the mass of what breaks away");
  }
  if (model.deflection_m > 0.0 && std::isfinite(mass_kg)) {
    return error(".deflection_m", "belongs to a body with a mass", "leave out one of them");
  }
  return Success{};
}

Result<RankedBody> ranked_body(const Scenario& scenario, View<const Model> models,
                               std::size_t index) {
  if (index >= scenario.models.size()) {
    return make_error(ErrorCode::bad_input, "a body names a model that is not there",
                      "keep model indices below the number of models");
  }
  const ScenarioModel& model = scenario.models[index];
  if (models[index].tree.empty()) {
    return error_of_mesh(
        make_error(ErrorCode::bad_input, "has no triangle", "give it a mesh with a surface"),
        model);
  }
  const double mass_kg = model.mass_kg.value_or(guess_mass_kg(model.kind, models[index].mesh));
  if (Status possible = check_fixed_thing(model, mass_kg); !possible) return possible.error();
  return RankedBody{index, mass_kg, !model.mass_kg.has_value()};
}

/// Adds the place to an error of `describe_vehicle`: the key of the scenario if its value is wrong,
/// otherwise the mesh.
Error error_of_model(Error error, const ScenarioModel& model) {
  if (error.place == "centre of mass") {
    error.place = "models." + model.name + ".center_of_mass_m";
  } else if (error.place == "yaw inertia") {
    error.place = "models." + model.name + ".yaw_inertia_kgm2";
  } else {
    return error_of_mesh(std::move(error), model);
  }
  return error;
}

Result<Vehicle> vehicle_of(const ScenarioModel& model, const Model& shape) {
  VehicleFacts facts;
  facts.kind = model.kind;
  facts.mass_kg = model.mass_kg;
  facts.center_of_mass_m = model.center_of_mass_m;
  facts.yaw_inertia_kgm2 = model.yaw_inertia_kgm2;
  facts.stiffness = model.stiffness;
  facts.surface = model.surface;
  facts.honeycomb = model.honeycomb;
  facts.breakaway = model.breakaway;
  if (model.deflection_m > 0.0) {
    facts.deflection = Deflection{
        model.deflection_m, model.deflection_force_n.value_or(rail_force_n(model.deflection_m))};
  }
  Result<Vehicle> vehicle = describe_vehicle(shape.mesh, facts, shape.profile);
  if (!vehicle) return error_of_model(vehicle.error(), model);
  vehicle->leading_edge_m = leading_edge_m(shape.mesh);
  return vehicle;
}

/// The scenario with `small_errors` where the state of a moving body has none.
Scenario with_small_errors(Scenario scenario, const std::vector<Body>& actors) {
  if (!scenario.ego.uncertainty.any()) scenario.ego.uncertainty = small_errors;
  for (std::size_t i = 0; i < actors.size(); ++i) {
    StateUncertainty& own = scenario.actors[i].perception;
    if (!actors[i].vehicle->stands() && !own.any()) own = small_errors;
  }
  return scenario;
}

Result<Futures> make_futures(const Scenario& scenario, const std::vector<Body>& actors,
                             const RankOptions& options) {
  if (!options.smooth) return Futures::make(scenario, options.sampled_futures);
  Result<Futures> stated = Futures::make(scenario, options.sampled_futures);
  if (!stated) return stated;
  const std::size_t drawn = stated->summary.method == FutureMethod::certain
                                ? std::min(options.sampled_futures, smooth_futures)
                                : options.sampled_futures;
  Result<Futures> smoothed = Futures::make(with_small_errors(scenario, actors), drawn);
  if (smoothed) smoothed->summary.smooth = true;
  return smoothed;
}

/// Checks that fixed bodies have one pose without errors.
Status check_fixed(const Scene& scene, const Scenario& scenario) {
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    if (!scene.actors[i].vehicle->stands() || !actor.perception.any()) continue;
    return Error{ErrorCode::bad_input,
                 {},
                 actor_place(i, actor.name) + ".perception",
                 "belongs to a fixed body",
                 "state ego.uncertainty in its place, or give its model a mass"};
  }
  const std::vector<Plan>& plans = scene.futures.plans;
  for (std::size_t i = 1; i < plans.size(); ++i) {
    const std::size_t actor = plans[i].actor;
    if (plans[i - 1].actor != actor || !scene.actors[actor].vehicle->stands()) continue;
    return Error{ErrorCode::bad_input,
                 {},
                 actor_place(actor, scenario.actors[actor].name),
                 "has several motions, but it is fixed",
                 "give it one pose, or its model a mass"};
  }
  return Success{};
}

/// Sets the poses of the fixed bodies.
void set_fixed_poses(Scene& scene) {
  for (const Plan& plan : scene.futures.plans) {
    Body& body = scene.actors[plan.actor];
    if (!body.vehicle->movable()) body.fixed_pose = plan.motion.pose_at(0.0);
  }
}

}  // namespace

Box swept_box(const Body& body, const Motion& motion, double from_s, double until_s,
              double tolerance_m) {
  const double middle_s = 0.5 * (from_s + until_s);
  const Pose pose = motion.pose_at(middle_s);
  const Eigen::Vector3d center = pose.rotation * body.center_m + pose.translation;
  const Eigen::Vector3d half = (pose.rotation * body.half_axes_m).cwiseAbs().rowwise().sum();
  const double moved = std::max(motion.reach(body.radius_m, from_s, middle_s),
                                motion.reach(body.radius_m, middle_s, until_s));
  // Covers rotation matrices that are off by 1e-6 and the rounding of sums: a millionth of all
  // lengths.
  const double margin =
      moved + tolerance_m + 2e-6 * (1.0 + body.radius_m + center.cwiseAbs().maxCoeff());
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] =
        std::nextafter(static_cast<float>(center[axis] - half[axis] - margin), -infinity_f);
    box.max[axis] =
        std::nextafter(static_cast<float>(center[axis] + half[axis] + margin), infinity_f);
  }
  return box;
}

Result<Scene> make_scene(const Scenario& scenario, View<const Model> models,
                         const RankOptions& options, RankResult& result) {
  if (models.size() != scenario.models.size()) {
    return make_error(ErrorCode::usage,
                      "the scenario has " + std::to_string(scenario.models.size()) +
                          " models, not " + std::to_string(models.size()),
                      "give one for each, in the same order");
  }
  Scene scene;
  scene.measure = options.measure.value_or(scenario.measure);
  scene.harm = options.harm.value_or(scenario.harm);
  if (measure_row(scene.measure).has_samples && scene.harm.intervals) {
    scene.samples = harm_samples(scene.harm);
  }
  scene.nominal.friction = scene.harm.friction;
  scene.nominal.step = scene.harm.step;
  scene.nominal.model = scene.harm.model;
  scene.impact = options.impact;
  scene.impact.start_is_apart = false;
  scene.ego_start = scenario.ego.pose;

  const Result<RankedBody> ego = ranked_body(scenario, models, scenario.ego.model);
  if (!ego) return ego.error();
  result.ego = *ego;
  if (!std::isfinite(ego->mass_kg)) {
    const ScenarioModel& model = scenario.models[ego->model];
    return Error{
        ErrorCode::bad_input,
        {},
        "models." + model.name + ".mass_kg",
        std::string("is missing, and a ") + body_kind_name(model.kind) + " does not move by itself",
        "give the ego's model a mass"};
  }
  if (const ScenarioModel& model = scenario.models[ego->model]; model.breakaway) {
    return Error{ErrorCode::bad_input,
                 {},
                 "models." + model.name + ".breakaway",
                 "belongs to the ego, which moves",
                 "leave it out, or give the ego another model"};
  }
  scene.ego = make_body(models[ego->model], ego->mass_kg);
  // Cached by model: cutting the outlines takes milliseconds, and many actors share a model.
  std::vector<std::shared_ptr<const Vehicle>> described(models.size());
  std::vector<std::shared_ptr<const BodyOutline>> outlines(models.size());
  const auto describe = [&](std::size_t model, Body& body) -> Status {
    if (!described[model]) {
      Result<Vehicle> made = vehicle_of(scenario.models[model], models[model]);
      if (!made) return made.error();
      described[model] = std::make_shared<const Vehicle>(std::move(*made));
      outlines[model] = std::make_shared<const BodyOutline>(
          *described[model]->profile, described[model]->movable() ? &models[model].mesh : nullptr);
    }
    body.vehicle = described[model];
    body.outline = outlines[model];
    return Success{};
  };
  if (Status own = describe(ego->model, scene.ego); !own) return own.error();
  if (!scene.ego.vehicle->has_outline()) {
    return error_of_mesh(
        make_error(ErrorCode::bad_input,
                   "has no material between 0.1 and 4 m over its ground, but the ego needs it",
                   "check its scale, its up axis and its origin on the ground"),
        scenario.models[ego->model]);
  }
  scene.ego.footing = footing_of(*scene.ego.vehicle);
  scene.limits =
      ego_limits(scenario, static_cast<double>(models[ego->model].mesh.bounds().extent().x()),
                 scene.ego.vehicle->center_m,
                 scene.ego.vehicle->wheelbase_m > 0.0 ? scene.ego.vehicle->rear_axle_x_m
                                                      : std::numeric_limits<double>::quiet_NaN());
  scene.infeasible = options.infeasible;
  scene.records_motion = options.records_motion;
  scene.road = scenario.road;
  scene.grip = scenario.grip;
  scene.ego.occupants = scenario.ego.occupants;

  const auto make_actor = [&](std::size_t model) -> Result<EnteringBody> {
    const Result<RankedBody> ranked = ranked_body(scenario, models, model);
    if (!ranked) return ranked.error();
    EnteringBody made{make_body(models[model], ranked->mass_kg), *ranked};
    if (Status own = describe(model, made.body); !own) return own.error();
    made.ranked.has_outline = made.body.vehicle->has_outline();
    if (made.body.vehicle->movable() && made.ranked.has_outline) {
      made.body.footing = footing_of(*made.body.vehicle);
    }
    return made;
  };
  bool keeps_places = false;
  for (const ScenarioActor& actor : scenario.actors) {
    Result<EnteringBody> made = make_actor(actor.model);
    if (!made) return made.error();
    result.actors.push_back(made->ranked);
    scene.actors.push_back(std::move(made->body));
    scene.actors.back().occupants = actor.occupants;
    keeps_places = keeps_places || actor.existence_probability == 0.0;
  }
  for (std::size_t model = 0; keeps_places && model < models.size(); ++model) {
    Result<EnteringBody> made = make_actor(model);
    scene.entering.emplace_back();
    if (made && !made->body.vehicle->stands()) scene.entering.back() = std::move(*made);
  }

  Result<Futures> futures = make_futures(scenario, scene.actors, options);
  if (!futures) return futures.error();
  scene.futures = std::move(*futures);
  if (options.risk) scene.futures.summary.risk = *options.risk;
  result.futures = scene.futures.summary;
  if (Status one = check_fixed(scene, scenario); !one) return one.error();
  set_fixed_poses(scene);
  if (Status joined = join_fixed(scene); !joined) return joined.error();
  const auto slices =
      static_cast<int>(std::clamp(std::ceil(scenario.horizon_s / slice_length_s), 1.0, max_slices));
  for (int i = 0; i <= slices; ++i) {
    scene.slice_s.push_back(scenario.horizon_s * (static_cast<double>(i) / slices));
  }
  scene.slices.resize(scene.slice_s.size() - 1);
  for (BroadPhase& slice : scene.slices) slice.reserve(scene.futures.plans.size());
  scene.boxes.resize(scene.futures.plans.size());
  scene.apart_at_start.resize(scene.futures.plans.size());
  ImpactWorkspace workspace;
  update_plans(scene, workspace);
  return scene;
}

void update_plans(Scene& scene, ImpactWorkspace& workspace) {
  set_fixed_poses(scene);
  const std::vector<Plan>& plans = scene.futures.plans;
  scene.fastest_plan_mps = 0.0;
  for (const Plan& plan : plans) {
    const Body& actor = scene.actors[plan.actor];
    if (!actor.vehicle->movable() || !scene.futures.exists(plan.actor)) continue;
    const MotionBound bound =
        plan.motion.bound(0.0, scene.slice_s.back() + SceneOptions{}.longest_s);
    // Points rotate about the centre of mass, which is within one radius of the origin and within
    // two radii of any point.
    scene.fastest_plan_mps = std::max(scene.fastest_plan_mps,
                                      bound.speed_mps + 3.0 * actor.radius_m * bound.angular_radps);
  }
  for (std::size_t s = 0; s < scene.slices.size(); ++s) {
    for (std::size_t i = 0; i < plans.size(); ++i) {
      scene.boxes[i] = {};
      if (!scene.futures.exists(plans[i].actor)) continue;
      scene.boxes[i] = swept_box(scene.actors[plans[i].actor], plans[i].motion, scene.slice_s[s],
                                 scene.slice_s[s + 1], scene.impact.tolerance_m);
    }
    scene.slices[s].build(scene.boxes);
  }
  sample_trajectories(scene, scene.trajectories);
  std::fill(scene.apart_at_start.begin(), scene.apart_at_start.end(), char{1});
  const Motion at_rest = Motion::at_rest(scene.ego_start);
  const Box ego = swept_box(scene.ego, at_rest, 0.0, 0.0, scene.impact.tolerance_m);
  scene.work.box_tests += scene.slices.front().query(ego, [&](std::size_t i) {
    const Body& actor = scene.actors[plans[i].actor];
    const Impact impact = initial_state(scene.ego.model->tree, scene.ego_start, actor.model->tree,
                                        plans[i].motion.pose_at(0.0), workspace, scene.impact);
    scene.apart_at_start[i] = impact.state == ImpactState::none ? 1 : 0;
    scene.work.impact += impact.work;
  });
}

}  // namespace crashrank::detail
