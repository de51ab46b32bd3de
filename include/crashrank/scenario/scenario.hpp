#pragma once

#include "crashrank/base/area.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/internal/vehicle/strength.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/motion/motion.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "crashrank/vehicle/box_body.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

/// Where the ego may drive, and the cost of leaving that. Without areas the road is unlimited.
struct Road {
  std::vector<Area> drivable;           ///< world; a wheel outside all of them is off the road
  double harm_per_leaving = 0.0;        ///< added to the harm where the road is left, persons
  std::optional<double> off_road_grip;  ///< between tyre and ground beside it; absent: as on it

  /// False if the road is unlimited.
  bool ends() const noexcept { return !drivable.empty(); }
};

/// Bounds on what a road may ask for; the published schema states the same numbers.
namespace road_limits {
inline constexpr std::size_t areas = 1000;          ///< most
inline constexpr std::size_t holes = 1000;          ///< most of one area
inline constexpr std::size_t corners = 10'000;      ///< most of all areas together
inline constexpr double harm_per_leaving = 1000.0;  ///< most, persons
}  // namespace road_limits

/// A shape of a scenario; its mesh is read later.
struct ScenarioModel {
  std::string name;               ///< unique
  std::string mesh;               ///< as the scenario writes it
  std::string path;               ///< resolved path that `load_scenario` allowed, else empty
  BodyKind kind = BodyKind::car;  ///< what it is
  /// Length, width and height of its box, m, in place of a mesh: its shape is `make_box_body`, its
  /// origin on the ground below the rear axle (see `box_axles`), moved by `transform.origin_m`.
  std::optional<Eigen::Vector3d> box_m;
  /// Mass with all aboard, kg; absent: as its model file states, else guessed from kind and size.
  std::optional<double> mass_kg;
  ImportTransform transform;  ///< how its mesh is read
  /// Center of mass in body coordinates, m; absent: as its model file states, else estimated from
  /// kind and mesh.
  std::optional<Eigen::Vector3d> center_of_mass_m;
  /// Moment of inertia about the vertical axis through the center of mass, kg·m²; absent: as its
  /// model file states, else estimated from kind, mass and mesh.
  std::optional<double> yaw_inertia_kgm2;
  double stiffness = 1.0;              ///< crush strength, times the default of its kind
  std::optional<Surface> surface;      ///< outer material; absent: by kind
  std::optional<Honeycomb> honeycomb;  ///< crushable layer in place of the strength of its kind
  /// Load at which a fixed body breaks away; then it moves with its mass. Absent: it does not.
  std::optional<Breakaway> breakaway;
  double deflection_m = 0.0;  ///< how far a fixed body without mass gives way, m
  /// Force at which it gives way, N; absent: `rail_force_n`.
  std::optional<double> deflection_force_n;
};

/// Sets the mass, centre of mass and yaw inertia that a model file states where the scenario states
/// none: each of the three by itself, the scenario's first.
inline void add_stated_mass(const StatedMass& stated, ScenarioModel& model) {
  if (!model.mass_kg) model.mass_kg = stated.mass_kg;
  if (!model.center_of_mass_m) model.center_of_mass_m = stated.center_of_mass_m;
  if (!model.yaw_inertia_kgm2) model.yaw_inertia_kgm2 = stated.yaw_inertia_kgm2;
}

/// Standard deviations of the errors of a body's state at time 0: independent of each other and
/// normally distributed about what is stated. Each 0 or more.
struct StateUncertainty {
  double position_m = 0.0;   ///< of x and of y, world axes, m
  double heading_rad = 0.0;  ///< about the body's origin, rad
  double speed_mps = 0.0;    ///< along the forward axis of a body that moves, m/s

  /// Whether there is an error at all.
  bool any() const noexcept { return position_m > 0.0 || heading_rad > 0.0 || speed_mps > 0.0; }
  /// Whether all are the same.
  bool operator==(const StateUncertainty& other) const noexcept {
    return position_m == other.position_m && heading_rad == other.heading_rad &&
           speed_mps == other.speed_mps;
  }
};

/// The ego vehicle at time 0.
struct ScenarioEgo {
  std::size_t model = 0;               ///< index into Scenario::models
  Pose pose;                           ///< body to world at time 0
  double speed_mps = 0.0;              ///< along its forward axis; negative when reversing
  double yaw_rate_radps = 0.0;         ///< left positive
  std::optional<double> wheelbase_m;   ///< absent: `box_axles` of a box, 0.6 of a mesh's length
  double max_acceleration_mps2 = 3.0;  ///< of the engine, m/s²
  /// Of the brakes, m/s²; absent: they hold as much as the tyres.
  std::optional<double> max_deceleration_mps2;
  double max_steering_rad = 0.6108652381980153;  ///< 35 degrees
  /// Of the front wheels, rad/s. The default is that of the passenger cars of the CommonRoad
  /// vehicle models (Althoff, Koschi and Manzinger, IEEE Intelligent Vehicles 2017).
  double max_steering_rate_radps = 0.4;
  /// Persons in it, 0 allowed; absent: HarmWeights::people_in_ego.
  std::optional<double> occupants;
  /// Errors of its pose and speed relative to the stated ones; the same for all
  /// candidates.
  StateUncertainty uncertainty;
};

/// A motion as scenarios write it: from its pose with speed, acceleration and yaw rate, or through
/// timed poses when there are any.
struct ActorMotion {
  Pose pose;                       ///< body to world at time 0
  double speed_mps = 0.0;          ///< along its forward axis
  double acceleration_mps2 = 0.0;  ///< along its forward axis; against the speed it brakes
  double yaw_rate_radps = 0.0;     ///< held while it moves
  std::vector<TimedPose> poses;    ///< where there are any, they determine the whole motion
};

/// One of the motions that an actor may follow.
struct Prediction : ActorMotion {
  double probability = 1.0;  ///< above 0; those of an actor sum to 1
};

/// A body that can be hit, and its motion.
struct ScenarioActor : ActorMotion {
  std::string name;       ///< unique
  std::size_t model = 0;  ///< index into Scenario::models
  /// Persons in or on it, 0 allowed; absent: the number that HarmWeights has for its kind.
  std::optional<double> occupants;
  /// Motions that exclude each other, independent of those of other actors. Where there are any,
  /// the actor's own motion is not used.
  std::vector<Prediction> predictions;
  double existence_probability = 1.0;  ///< that it exists, [0, 1]
  /// Errors of perception on each of its motions. Not for fixed bodies.
  StateUncertainty perception;
};

/// The motion of an actor in a joint future.
struct FutureMotion {
  std::size_t actor = 0;  ///< index into Scenario::actors
  ActorMotion motion;     ///< replaces the actor's own
};

/// One joint future of all actors; those that it does not list keep their own motion.
struct JointFuture {
  double probability = 1.0;           ///< above 0; those of a scenario sum to 1
  std::vector<FutureMotion> motions;  ///< each actor at most once
  std::vector<std::size_t> absent;  ///< actors that do not exist in it, each once, none that moves
};

/// A manoeuvre written out: acceleration with steering or yaw rate, or timed poses when there are
/// any. With neither of the two the path keeps the ego's curvature, below 0.5 m/s its yaw rate.
struct ListedCandidate {
  std::string name;                      ///< unique
  double acceleration_mps2 = 0.0;        ///< along the forward axis; against the speed it brakes
  std::optional<double> steering_rad;    ///< of the road wheels, left positive
  std::optional<double> yaw_rate_radps;  ///< held while it moves
  std::vector<TimedPose> poses;          ///< begin within 1 m and 30 degrees of the ego's
};

/// Size of a generated grid of manoeuvres.
struct CandidateGrid {
  std::size_t accelerations = 15;  ///< levels between braking and speeding up
  std::size_t steerings = 15;      ///< levels between right and left
};

/// One moment of decision, all in SI units and radians. The format is data/scenario.schema.json;
/// predictions, existence, futures, risk, errors of states, road, braking and steering rate belong
/// to its version 2.
struct Scenario {
  std::string name;                                     ///< unique
  std::string description;                              ///< for people
  std::vector<ScenarioModel> models;                    ///< sorted by name
  ScenarioEgo ego;                                      ///< the deciding vehicle
  std::vector<ListedCandidate> listed;                  ///< manoeuvres written out
  std::optional<CandidateGrid> grid = CandidateGrid{};  ///< absent: none is generated
  bool add_straight_braking = true;                     ///< unless it is listed
  std::vector<ScenarioActor> actors;                    ///< bodies that can be hit
  double horizon_s = 4.0;                               ///< how far motions are followed, s
  Measure measure = Measure::harm;                      ///< what is compared
  HarmOptions harm;   ///< weights and ranges; the defaults where the file is silent
  double grip = 0.8;  ///< friction between tyre and road
  /// Joint futures, in place of predictions of single actors.
  std::vector<JointFuture> futures;
  RiskMeasure risk;  ///< how the scores of several futures become one
  Road road;         ///< where the ego may drive
  /// Key paths of the text that are accepted but change nothing, as "crush"; `parse_scenario` fills
  /// it, in the order of the schema.
  std::vector<std::string> keys_without_effect;
  /// Key paths of probabilities that the text lets sum to 1 within `written_probability_sum` only
  /// and that `parse_scenario` divided by their sum, as "actors[0].predictions".
  std::vector<std::string> normalised;
};

/// Whether an actor has predictions or may not exist, joint futures are listed, or the state of the
/// ego or an actor has errors.
CRASHRANK_API bool is_uncertain(const Scenario& scenario) noexcept;

/// The scenario in its likeliest future, without uncertainty or errors of states: every actor
/// follows its likeliest prediction, or its motion in the likeliest joint future. Equal predictions
/// of an actor count as one with the sum of their probabilities, and so do equal joint futures. Of
/// equally likely ones (within 1e-9) the order in which they are written does not decide: the actor
/// is the faster one at time 0, then the one that turns further to the left, then the one with the
/// greater coordinates x and y; then the same at 0.25, 1, 3, 10 and 100 s. Joint futures are
/// compared actor by actor, by name; a motion precedes absence. An actor whose absence is likelier
/// than each of its motions stays in the list with an existence probability of 0.
CRASHRANK_API Scenario likeliest_future(const Scenario& scenario);

/// Limits of a scenario; the published schema states the same numbers.
namespace scenario_limits {
inline constexpr std::size_t file_bytes = std::size_t{16} << 20;  ///< of the text
inline constexpr std::size_t table_bytes = std::size_t{1} << 26;  ///< of a table of candidates
inline constexpr std::size_t models = 256;                        ///< most
inline constexpr std::size_t actors = 1000;                       ///< most
inline constexpr std::size_t listed_candidates = 10'000;          ///< most
inline constexpr std::size_t grid_side = 101;                     ///< most levels of each
inline constexpr std::size_t poses = 10'000;                      ///< most of one motion
inline constexpr std::size_t predictions = 32;                    ///< most of one actor
inline constexpr std::size_t futures = 1000;                      ///< most joint ones
inline constexpr std::size_t name_characters = 128;               ///< most
inline constexpr std::size_t description_characters = 4000;       ///< most
inline constexpr std::size_t path_characters = 4096;              ///< most
inline constexpr double horizon_s = 60.0;                         ///< most, s
inline constexpr double position_m = 1e5;                         ///< most, each way, m
inline constexpr double angle_deg = 360.0;                        ///< most, each way
inline constexpr double speed_mps = 150.0;                        ///< most, each way, m/s
inline constexpr double position_error_m = 10.0;                  ///< most standard deviation, m
inline constexpr double heading_error_deg = 45.0;                 ///< most standard deviation
inline constexpr double speed_error_mps = 20.0;                   ///< most standard deviation, m/s
inline constexpr double fastest_mps = 300.0;       ///< most, of any motion within the horizon, m/s
inline constexpr double acceleration_mps2 = 50.0;  ///< most, each way, m/s²
inline constexpr double yaw_rate_dps = 720.0;      ///< most, each way
inline constexpr double steering_deg = 80.0;       ///< most, each way
inline constexpr double min_steering_rate_dps = 0.1;    ///< least limit
inline constexpr double max_steering_rate_dps = 720.0;  ///< most
inline constexpr double min_deceleration_mps2 = 0.1;    ///< least limit of the brakes, m/s²
inline constexpr double min_wheelbase_m = 0.1;          ///< m
inline constexpr double max_wheelbase_m = 30.0;         ///< m
inline constexpr double min_mass_kg = 0.1;              ///< kg
inline constexpr double max_mass_kg = 1e6;              ///< kg
inline constexpr double yaw_inertia_kgm2 = 1e9;         ///< most, kg·m²; above 0
inline constexpr double min_stiffness = 0.01;           ///< least factor
inline constexpr double max_stiffness = 100.0;          ///< most
inline constexpr double box_m = max_box_side_m;         ///< most side of a box, m; above 0
inline constexpr double honeycomb_pa = 1e9;             ///< most pressure, Pa; above 0
inline constexpr double honeycomb_m = 100.0;            ///< most depth or height, m
inline constexpr double breakaway = 1e9;                ///< most force, N, or moment, N·m; above 0
inline constexpr double deflection_m = 10.0;            ///< most deflection of a rail, m
inline constexpr double min_scale = 1e-6;               ///< metres per file unit
inline constexpr double max_scale = 1e6;                ///< metres per file unit
inline constexpr double min_grip = 0.01;                ///< least friction
inline constexpr double max_grip = 3.0;                 ///< most friction
inline constexpr double probability_sum = 1e-6;         ///< probabilities sum to 1 within this
/// those of a text within this: a planner rounds its confidences
inline constexpr double written_probability_sum = 0.01;
}  // namespace scenario_limits

/// Reads a scenario from its text; `file` names it in errors and is its name if the scenario has
/// none. Touches no file: `ScenarioModel::path` stays empty, and a table of candidates is
/// refused. Every error is bad_input or limit_exceeded and names the key path, as
/// "actors[2].speed_mps", or line and column where the text is no JSON. Linear in the text; safe
/// from any thread.
CRASHRANK_API Result<Scenario> parse_scenario(const std::string& text, const std::string& file);

/// Folders in which a scenario's files may lie besides the default ones.
struct ScenarioPaths {
  std::vector<std::string> allowed_folders;  ///< files may lie there, too
};

/// Finds where a mesh named by a scenario is, symbolic links followed. It has to lie in the
/// scenario's folder or below it; or, when a folder above that not everybody may write to holds a
/// file named `crashrank.root`, below the nearest such folder; or below an allowed one. So a
/// scenario that is not trusted reads only the files that came with it, and a project whose
/// scenarios share a folder of models declares it with one file. Errors: bad_input when it lies
/// elsewhere. Does not check that the mesh exists. `scenario_file` may
/// be a name that does not exist in a folder that does (text from a pipe).
CRASHRANK_API Result<std::string> resolve_mesh_path(const std::string& scenario_file,
                                                    const std::string& mesh,
                                                    const ScenarioPaths& paths = {});

/// `parse_scenario`, then `resolve_mesh_path` for each model. Reads the table of candidates that
/// the scenario names, which has to lie where its meshes may, to the end of `Scenario::listed`.
/// Reads no mesh: the caller does, with the importer or from compiled model files, in the order of
/// `Scenario::models`. Errors also: not_found, and those of the table with its line.
CRASHRANK_API Result<Scenario> load_scenario(const std::string& text, const std::string& file,
                                             const ScenarioPaths& paths = {});

/// A scenario as far as its text could be read, and what is wrong with it.
struct CheckedScenario {
  Scenario scenario;  ///< complete if there are no errors
  /// In the order of the text, at most 100. Of errors in one another's keys the first alone.
  std::vector<Error> errors;
};

/// `load_scenario`, and the checks of `rank` that need no mesh, that go on after an error.
CRASHRANK_API CheckedScenario check_scenario(const std::string& text, const std::string& file,
                                             const ScenarioPaths& paths = {});

/// Reads the file, at most `scenario_limits::file_bytes`, and loads it. Errors also: not_found.
CRASHRANK_API Result<Scenario> load_scenario_file(const std::string& file,
                                                  const ScenarioPaths& paths = {});

}  // namespace crashrank
