#include "command.hpp"
#include "console.hpp"
#include "json.hpp"
#include "mesh_arguments.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "scenario_file.hpp"
#include "streams.hpp"
#include "vehicle_reading.hpp"

#include "base/nearest_word.hpp"
#include "crashrank/mesh/properties.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "crashrank/vehicle/box_body.hpp"
#include "crashrank/vehicle/vehicle.hpp"
#include "report/orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr OutputKind scenario_file{"a scenario", "{"};
constexpr double ego_speed_mps = 14.0;

struct NewArguments {
  std::string ego;
  std::vector<std::string> actors;
  std::string output;
  bool force = false;
};

/// A body as the command line names it: its shape, and x, y, heading and perhaps speed.
struct Placed {
  std::string shape;
  std::vector<double> place;
};

/// A shape of the scenario.
struct Shape {
  std::string name;                   ///< of its model
  std::optional<double> wheelbase_m;  ///< where the mesh shows its axles
};

/// In the order of the kinds.
std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(BodyKind::building); ++i) {
    names.emplace_back(body_kind_name(static_cast<BodyKind>(i)));
  }
  return names;
}

std::optional<BodyKind> kind_named(const std::string& name) {
  const std::vector<std::string> names = kind_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<BodyKind>(found - names.begin());
}

Result<Placed> parse_placed(const std::string& text, const std::string& option, bool needs_place) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos && !needs_place) return Placed{text, {0.0, 0.0, 0.0}};
  const std::optional<std::vector<double>> numbers =
      at == std::string::npos ? std::nullopt : parse_numbers(text.substr(at + 1));
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!numbers || numbers->size() < 3 || numbers->size() > 4 ||
      !std::all_of(numbers->begin(), numbers->end(), finite)) {
    return make_error(ErrorCode::usage, option + " " + text + ": has no X,Y,HEADING",
                      "write BODY@X,Y,HEADING or BODY@X,Y,HEADING,SPEED in m, degrees and m/s");
  }
  return Placed{text.substr(0, at), *numbers};
}

double rounded(double value) { return std::round(1e3 * value) / 1e3; }

/// `entry` becomes that of the scenario's models, as below.
Result<Shape> box_shape(const std::string& text, BodyKind kind, const std::vector<double>& size,
                        Json& entry) {
  if (Result<TriangleMesh> made = make_box_body(kind, {size[0], size[1], size[2]}); !made) {
    made.error().place = text;
    made.error().code = ErrorCode::usage;
    return made.error();
  }
  Shape shape;
  shape.name = body_kind_name(kind);
  entry = {{"note",
            "No mesh: the usual shape of its kind, stretched to length, width and height. Name "
            "a mesh in place of box where there is one. Other keys: mass_kg, origin_m."},
           {"box", size},
           {"kind", body_kind_name(kind)}};
  say(fmt::format("{}: a {} of {:g} x {:g} x {:g} m without mesh", text, body_kind_name(kind),
                  size[0], size[1], size[2]));
  return shape;
}

Result<Shape> mesh_shape(const std::string& file, std::optional<BodyKind> stated,
                         const fs::path& folder, Json& entry) {
  if (is_standard(file)) {
    return make_error(ErrorCode::usage, "a scenario names its meshes, and - is no name",
                      "give the mesh's file");
  }
  Result<MeshOrModel> read = load_mesh_or_model(file, {});
  if (!read) return read.error();
  TriangleMesh& mesh = read->model ? read->model->stored.model.mesh : read->mesh.mesh;
  const std::string stem = fs::path(file).stem().string();
  const detail::MeshReading reading =
      detail::guess_reading(mesh, {}, !read->model && detail::is_gltf_file(file));
  const BodyKind kind = stated.value_or(guess_kind(
      stem, reading.scale * mesh.bounds().extent().cast<double>(), detail::has_wheels(mesh)));
  Shape shape;
  shape.name = stem.substr(0, scenario_limits::name_characters);
  ImportTransform guess;
  if (!read->model) {
    SeenAxles axles;
    const Result<ImportTransform> guessed = guess_transform(mesh, kind, reading, axles);
    if (!guessed) return guessed.error();
    guess = *guessed;
    if (axles.wheelbase_m > 0.0) shape.wheelbase_m = axles.wheelbase_m;
  }
  std::error_code ignored;
  fs::path path = fs::relative(file, folder, ignored);
  if (path.empty()) path = fs::absolute(file, ignored);
  entry = {{"note",
            "kind decides mass, strength and risk curves unless mass_kg and others state them. "
            "scale, up, forward and origin_m say how the file is read: metres per unit, its "
            "axes, and the point that becomes the origin (for vehicles on the ground below the "
            "rear axle). They are guessed."},
           {"mesh", path.string()},
           {"kind", body_kind_name(kind)}};
  const Vector3d extent = mesh.bounds().extent().cast<double>();
  std::string said =
      fmt::format("a {}{} of {:.4g} x {:.4g} x {:.4g} m", stated ? "" : "probably a ",
                  body_kind_name(kind), extent.x(), extent.y(), extent.z());
  said.erase(0, stated ? 0 : 2);
  if (!read->model) {
    entry["scale"] = guess.scale;
    entry["up"] = axis_name(guess.up);
    entry["forward"] = axis_name(guess.forward);
    const Vector3d& o = guess.origin_m;
    entry["origin_m"] = {o.x(), o.y(), o.z()};
    said += ", read with " + options_text(guess);
    if (drives(kind)) {
      said += fmt::format(", guessed by {}{}", reading.shown_by,
                          reading.front_known
                              ? ""
                              : "; which end is the front it does not show: look at it with "
                                "inspect --picture");
    }
    if (drives(kind) && !reading.size_doubt().empty()) warn(file, reading.size_doubt());
    for (const std::string& warning : assess(mesh).warnings) warn(file, warning);
  }
  if (const double mass_kg = guess_mass_kg(kind, mesh); std::isfinite(mass_kg)) {
    said += fmt::format("; {:.0f} kg unless mass_kg says more", mass_kg);
  }
  say(file + ": " + said);
  return shape;
}

/// Shapes of a scenario, each once.
class Shapes {
public:
  explicit Shapes(fs::path folder) : folder_(std::move(folder)) {}

  Result<Shape> find(const std::string& text) {
    const auto known = by_text_.find(text);
    if (known != by_text_.end()) return known->second;
    const std::size_t colon = text.find(':');
    const std::optional<BodyKind> kind = kind_named(text.substr(0, colon));
    const std::string rest = kind && colon != std::string::npos ? text.substr(colon + 1) : text;
    const auto numbers = kind ? parse_numbers(rest) : std::nullopt;
    if (!kind && colon != std::string::npos && parse_numbers(text.substr(colon + 1))) {
      const std::vector<std::string> kinds = kind_names();
      const std::string meant = detail::nearest_word(text.substr(0, colon), kinds);
      return make_error(ErrorCode::usage,
                        text + ": '" + text.substr(0, colon) + "' is no kind of body",
                        (meant.empty() ? "" : "did you mean '" + meant + "'? The kinds are ") +
                            listed_with_or(kinds));
    }
    if (kind && (rest == text || (numbers && numbers->size() != 3))) {
      return make_error(ErrorCode::usage, text + ": has no length, width and height",
                        "write KIND:L,W,H in m, such as car:4.5,1.8,1.5, or KIND:FILE");
    }
    Json entry;
    Result<Shape> shape =
        numbers ? box_shape(text, *kind, *numbers, entry) : mesh_shape(rest, kind, folder_, entry);
    if (!shape) return shape.error();
    const std::string wish = shape->name;
    for (int i = 2; models_.contains(shape->name); ++i) shape->name = wish + fmt::format(" {}", i);
    models_[shape->name] = std::move(entry);
    by_text_[text] = *shape;
    return shape;
  }

  const Json& models() const { return models_; }

private:
  fs::path folder_;
  std::map<std::string, Shape> by_text_;
  Json models_ = Json::object();
};

Json pose_json(const std::vector<double>& place) {
  return {{"x_m", place[0]}, {"y_m", place[1]}, {"yaw_deg", place[2]}};
}

/// Until the ego has come twice as far as the farthest body, from 4 to 10 s.
double horizon_s(const Placed& ego, double speed_mps, const std::vector<Placed>& actors) {
  double farthest_m = 0.0;
  for (const Placed& actor : actors) {
    farthest_m = std::max(farthest_m,
                          std::hypot(actor.place[0] - ego.place[0], actor.place[1] - ego.place[1]));
  }
  return std::clamp(std::ceil(2.0 * farthest_m / std::max(std::abs(speed_mps), 1.0)), 4.0, 10.0);
}

Json ego_json(const Shape& shape, const Placed& ego, double speed_mps) {
  Json made{{"note",
             "The vehicle that decides, at time 0: pose of its origin (x forward, y left, degrees "
             "counter-clockwise) and speed along its axis. Other keys: yaw_rate_dps, occupants, "
             "max_acceleration_mps2, max_deceleration_mps2, max_steering_deg."},
            {"model", shape.name},
            {"pose", pose_json(ego.place)},
            {"speed_mps", speed_mps}};
  if (shape.wheelbase_m) made["wheelbase_m"] = rounded(*shape.wheelbase_m);
  return made;
}

Json actor_json(const std::string& name, const Shape& shape, const Placed& actor) {
  return {
      {"note",
       "A body that can be hit. It keeps its speed; acceleration_mps2, yaw_rate_dps, timed poses "
       "or predictions with probabilities say more."},
      {"name", name},
      {"model", shape.name},
      {"pose", pose_json(actor.place)},
      {"speed_mps", actor.place.size() > 3 ? actor.place[3] : 0.0}};
}

Result<Json> make_scenario(const NewArguments& options, const fs::path& folder) {
  const Result<Placed> ego = parse_placed(options.ego, "--ego", false);
  if (!ego) return ego.error();
  std::vector<Placed> placed;
  for (const std::string& text : options.actors) {
    Result<Placed> actor = parse_placed(text, "--actor", true);
    if (!actor) return actor.error();
    placed.push_back(std::move(*actor));
  }
  Shapes shapes(folder);
  const Result<Shape> own = shapes.find(ego->shape);
  if (!own) return own.error();
  const double speed_mps = ego->place.size() > 3 ? ego->place[3] : ego_speed_mps;
  Json actors = Json::array();
  std::map<std::string, int> names{{"ego", 1}};
  for (const Placed& actor : placed) {
    const Result<Shape> shape = shapes.find(actor.shape);
    if (!shape) return shape.error();
    const int number = ++names[shape->name];
    actors.push_back(actor_json(
        number == 1 ? shape->name : fmt::format("{} {}", shape->name, number), *shape, actor));
  }
  return Json{
      {"scenario_version", 2},
      {"note",
       "Lengths are metres, speeds m/s, angles degrees; data/scenario.schema.json has every key. "
       "crashrank check finds errors in this file, crashrank rank ranks its manoeuvres."},
      {"models", shapes.models()},
      {"ego", ego_json(*own, *ego, speed_mps)},
      {"candidates",
       {{"note",
         "The manoeuvres to compare: a grid of levels of braking, speeding up and steering within "
         "the grip, and full braking straight ahead. listed writes out others, table names a file "
         "of a planner's poses."},
        {"grid", {{"accelerations", 15}, {"steerings", 15}}},
        {"add_straight_braking", true}}},
      {"actors", std::move(actors)},
      {"horizon_s", horizon_s(*ego, speed_mps, placed)},
      {"measure", "harm"},
      {"grip", 0.8}};
}

int run(const NewArguments& options) {
  const bool to_stream = is_standard(options.output);
  std::error_code ignored;
  if (!to_stream && !options.force && fs::exists(fs::symlink_status(options.output, ignored))) {
    Error error = make_error(ErrorCode::usage, "is there already",
                             "choose another name, or replace it with --force");
    error.file = options.output;
    return fail(error);
  }
  if (const Status sound = can_be_written(options.output, scenario_file, {}); !sound) {
    return fail(sound.error());
  }
  const fs::path folder = fs::absolute(to_stream ? "x" : options.output, ignored).parent_path();
  const Result<Json> scenario = make_scenario(options, folder);
  if (!scenario) return fail(scenario.error());
  const std::string text = json_text(*scenario);
  const std::string file = to_stream ? "standard input" : options.output;
  for (const Error& error : check_scenario(text, file).errors) {
    // The file is as wanted where only its meshes lie elsewhere: rank takes --allow.
    if (error.place.find(".mesh") == std::string::npos) return fail(error);
    warn("", name_allow(error).message());
  }
  Result<OutputFile> out = OutputFile::open(options.output, scenario_file);
  if (!out) return fail(out.error());
  out->write(text);
  if (const Status written = out->close(); !written) return fail(written.error());
  return exit_done;
}

}  // namespace

void add_new(CLI::App& app, Action& action) {
  const auto options = std::make_shared<NewArguments>();
  CLI::App* command =
      app.add_subcommand("new", "Write a scenario from meshes or boxes and their positions");
  command
      ->add_option(
          "--ego", options->ego,
          "The deciding vehicle: a mesh or model file, KIND:FILE, or KIND:L,W,H for a body "
          "without mesh (m), with @X,Y,HEADING[,SPEED] after it (m, degrees, m/s) "
          "[default @0,0,0,14]")
      ->type_name("BODY")
      ->required();
  command
      ->add_option("--actor", options->actors,
                   "A body that can be hit, written alike, its position needed, its speed 0 if not "
                   "given; may be repeated")
      ->type_name("BODY@X,Y,HEADING")
      ->type_size(1)
      ->allow_extra_args(false);
  add_file(*command, "-o,--output", options->output,
           "Scenario file that is written; - is standard output")
      ->required();
  command->add_flag("--force", options->force, "Replace a scenario that is there");
  command->footer(
      "Kind, scale, axes and origin are guessed from name and size, said, and written with notes.\n"
      "KIND: car, truck, bus, motorcycle, bicycle, pedestrian, barrier, pole, building.\n\n"
      "Examples:\n"
      "  crashrank new --ego car.obj --actor truck.glb@40,3.5,180 -o first.json\n"
      "  crashrank new --ego car:4.6,1.8,1.5@0,0,0,20 --actor pedestrian:0.6,0.5,1.75@25,0,90 "
      "-o first.json");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
