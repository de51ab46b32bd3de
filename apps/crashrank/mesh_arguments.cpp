#include "mesh_arguments.hpp"

#include "console.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "streams.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "crashrank/tree/build.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

namespace crashrank::cli {
namespace {

/// Farther off, no earthly mesh has its vertices.
constexpr double max_origin_m = 1e7;

/// Names what the user knows in place of the file that standard input was kept in.
void name_standard_input(std::string& text, const std::string& path) {
  const std::string shown = "standard input";
  for (std::size_t at = 0; (at = text.find(path, at)) != std::string::npos; at += shown.size()) {
    text.replace(at, path.size(), shown);
  }
}

/// As options take them.
std::vector<std::string> axes() {
  std::vector<std::string> names;
  names.reserve(6);
  for (int i = 0; i < 6; ++i) names.emplace_back(axis_name(static_cast<Axis>(i)));
  return names;
}

/// Checked by `transform`, which takes "x" for "+x".
void add_axis(CLI::App& command, const std::string& name, std::string& axis,
              const std::string& what) {
  command.add_option(name, axis, what)
      ->type_name(fmt::format("{}", fmt::join(axes(), "|")))
      ->group("Meshes");
}

}  // namespace

void MeshArguments::add_to(CLI::App& command) {
  const std::string group = "Meshes";
  command
      .add_option("--scale", scale,
                  fmt::format("Metres per file unit [{:g} to {:g}, default {:g}]",
                              scenario_limits::min_scale, scenario_limits::max_scale, scale))
      ->type_name("NUMBER")
      ->group(group)
      ->check(one_number("metres per file unit, such as 0.001"));
  add_axis(command, "--up", up, "The file's axis that points up [default " + up + "]");
  add_axis(command, "--forward", forward,
           "The file's axis that points forward [default " + forward + "]");
  command
      .add_option("--origin", origin,
                  "Point in m, after turning and scaling, that becomes 0 [default " + origin + "]")
      ->type_name("X,Y,Z")
      ->group(group);
  command.add_option("--format", format, "What standard input holds: obj, stl, ply, off, glb ...")
      ->type_name("NAME")
      ->group(group);
}

void SecondMeshArguments::add_to(CLI::App& command) {
  const std::string group = "Meshes";
  command.add_option("--scale-b", scale, "The same for body B alone [default as --scale]")
      ->type_name("NUMBER")
      ->group(group)
      ->check(one_number("metres per file unit, such as 0.001"));
  add_axis(command, "--up-b", up, "The same for body B alone [default as --up]");
  add_axis(command, "--forward-b", forward, "The same for body B alone [default as --forward]");
}

MeshArguments SecondMeshArguments::over(const MeshArguments& first) const {
  MeshArguments second = first;
  if (!scale && up.empty() && forward.empty()) return second;
  second.suffix = "-b";
  if (scale) second.scale = *scale;
  if (!up.empty()) second.up = up;
  if (!forward.empty()) second.forward = forward;
  return second;
}

Result<ImportTransform> MeshArguments::transform() const {
  ImportTransform made;
  made.scale = scale;
  if (!(scale >= scenario_limits::min_scale && scale <= scenario_limits::max_scale)) {
    return make_error(ErrorCode::usage, "--scale" + suffix + " has to be a number from 1e-6 to 1e6",
                      "give metres per file unit, such as 0.001 for millimetres");
  }
  const Result<Axis> up_axis = axis_from_name(up);
  const Result<Axis> forward_axis = axis_from_name(forward);
  if (!up_axis || !forward_axis) {
    const std::string option =
        up_axis ? "--forward" + suffix + " " + forward : "--up" + suffix + " " + up;
    return make_error(ErrorCode::usage, option + ": is no axis",
                      "give " + listed_with_or(axes()) + ", or x, y or z");
  }
  if (static_cast<int>(*up_axis) / 2 == static_cast<int>(*forward_axis) / 2) {
    return make_error(ErrorCode::usage,
                      "--up" + suffix + " " + up + " and --forward" + suffix + " " + forward +
                          " are the same axis",
                      "name both when one of them is not the default");
  }
  made.up = *up_axis;
  made.forward = *forward_axis;
  const std::optional<std::vector<double>> point = parse_numbers(origin);
  const auto finite = [](double x) { return std::isfinite(x); };
  if (point && !std::all_of(point->begin(), point->end(), finite)) {
    return make_error(ErrorCode::usage,
                      "--origin " + origin + ": holds a number that is not finite",
                      "write x,y,z in metres");
  }
  if (!point || point->size() != 3) {
    return make_error(ErrorCode::usage, "--origin " + origin + ": needs three numbers",
                      "write x,y,z in metres");
  }
  made.origin_m = Eigen::Vector3d((*point)[0], (*point)[1], (*point)[2]);
  if (made.origin_m.cwiseAbs().maxCoeff() > max_origin_m) {
    return make_error(ErrorCode::usage, "--origin " + origin + ": lies farther than 1e7 m",
                      "give metres, after turning and scaling");
  }
  return made;
}

bool MeshArguments::given() const {
  const MeshArguments none;
  return scale != none.scale || up != none.up || forward != none.forward || origin != none.origin;
}

namespace {

/// Where a mesh's bytes are: its file, or one that standard input was written to.
class Source {
public:
  /// Where `models` says that model files are welcome, one on standard input needs no --format.
  static Result<Source> of(const std::string& path, const MeshArguments& arguments, bool models) {
    Source source;
    source.path_ = path;
    if (!is_standard(path)) return source;
    const Error unknown = make_error(
        ErrorCode::usage, "standard input has no file name, whose extension selects the format",
        "give --format, such as --format obj");
    const bool named = !arguments.format.empty();
    if (!named && !models) return unknown;
    Result<StandardInputFile> file = StandardInputFile::receive(
        ImportLimits{}.file_bytes, named ? escape_file_name(arguments.format) : "unnamed");
    if (!file) return file.error();
    source.received_ = std::move(*file);
    if (!named && !is_model_file(source.path())) return unknown;
    return source;
  }

  bool received() const { return received_.has_value(); }
  const std::string& path() const { return received_ ? received_->path() : path_; }
  std::string shown() const { return received_ ? "standard input" : path_; }

private:
  std::string path_;
  std::optional<StandardInputFile> received_;
};

Result<ImportedMesh> import_from(const Source& source, const MeshArguments& arguments, bool tell) {
  Result<ImportTransform> transform = arguments.transform();
  if (!transform) return transform.error();
  ImportOptions options;
  options.transform = *transform;
  const std::string shown = source.shown();
  const Progress progress("reading " + escape_terminal(shown));
  Result<ImportedMesh> imported = import_mesh(source.path(), options);
  if (!imported) {
    Error error = imported.error();
    error.file = shown;
    if (source.received()) {
      for (std::string* text : {&error.place, &error.reason, &error.remedy}) {
        name_standard_input(*text, source.path());
      }
    }
    return error;
  }
  if (source.received()) {
    for (std::string& warning : imported->warnings) name_standard_input(warning, source.path());
  }
  if (tell) {
    for (const std::string& warning : imported->warnings) warn(shown, warning);
  }
  return imported;
}

Error of_file(Error error, const std::string& file) {
  error.file = file;
  return error;
}

}  // namespace

Result<ImportedMesh> load_mesh(const std::string& path, const MeshArguments& arguments, bool tell) {
  const Result<Source> source = Source::of(path, arguments, false);
  if (!source) return source.error();
  return import_from(*source, arguments, tell);
}

Result<MeshOrModel> load_mesh_or_model(const std::string& path, const MeshArguments& arguments) {
  const Result<Source> source = Source::of(path, arguments, true);
  if (!source) return source.error();
  MeshOrModel read;
  if (!is_model_file(source->path())) {
    Result<ImportedMesh> imported = import_from(*source, arguments, false);
    if (!imported) return imported.error();
    read.mesh = std::move(*imported);
    return read;
  }
  if (arguments.given()) {
    return of_file(
        make_error(ErrorCode::usage, "a model file is in body coordinates already",
                   "give --scale, --up, --forward and --origin when its mesh is compiled"),
        source->shown());
  }
  Result<LoadedModel> loaded = load_model(source->path());
  if (!loaded) return of_file(loaded.error(), source->shown());
  read.model = std::move(*loaded);
  return read;
}

Result<LoadedBody> load_body(const std::string& path, const MeshArguments& arguments,
                             const TreeArguments& trees, bool tell) {
  const Result<Source> source = Source::of(path, arguments, true);
  if (!source) return source.error();
  LoadedBody body;
  if (is_model_file(source->path())) {
    if (arguments.given() || trees.given()) {
      return of_file(make_error(ErrorCode::usage, "a model file has its frame and trees already",
                                "give --scale, --up, --forward, --origin, --split and --frame when "
                                "its mesh is compiled"),
                     source->shown());
    }
    Result<LoadedModel> loaded = load_model(source->path());
    if (!loaded) return of_file(loaded.error(), source->shown());
    body.stored = std::move(loaded->stored);
    return body;
  }
  Result<ImportedMesh> imported = import_from(*source, arguments, tell);
  if (!imported) return imported.error();
  const Result<BuildOptions> build = trees.build_options();
  if (!build) return build.error();
  body.stored.transform = *arguments.transform();
  const Progress progress("building trees of " + escape_terminal(source->shown()));
  const auto start = std::chrono::steady_clock::now();
  Result<Model> model = make_model(std::move(imported->mesh), *build);
  body.build_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!model) return of_file(model.error(), source->shown());
  body.stored.model = std::move(*model);
  return body;
}

Status one_standard_input(const std::vector<std::string>& inputs) {
  if (std::count_if(inputs.begin(), inputs.end(), is_standard) <= 1) return Success{};
  return make_error(ErrorCode::usage, "- stands for standard input and can be given once only");
}

}  // namespace crashrank::cli
