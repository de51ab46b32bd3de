#include "mesh_arguments.hpp"

#include "console.hpp"
#include "numbers.hpp"
#include "streams.hpp"

#include "crashrank/report/escape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace crashrank::cli {
namespace {

constexpr std::array<std::pair<const char*, Axis>, 6> axis_names{{{"+x", Axis::plus_x},
                                                                  {"-x", Axis::minus_x},
                                                                  {"+y", Axis::plus_y},
                                                                  {"-y", Axis::minus_y},
                                                                  {"+z", Axis::plus_z},
                                                                  {"-z", Axis::minus_z}}};

/// Names what the user knows in place of the file that standard input was kept in.
void name_standard_input(std::string& text, const std::string& path) {
  const std::string shown = "standard input";
  for (std::size_t at = 0; (at = text.find(path, at)) != std::string::npos; at += shown.size()) {
    text.replace(at, path.size(), shown);
  }
}

/// "+x", "-x", "x" and so on.
std::optional<Axis> parse_axis(std::string text) {
  if (text.size() == 1) text.insert(0, 1, '+');
  for (const auto& [name, axis] : axis_names) {
    if (text == name) return axis;
  }
  return std::nullopt;
}

}  // namespace

void MeshArguments::add_to(CLI::App& command) {
  const std::string group = "Meshes";
  command.add_option("--scale", scale, "Metres per file unit (default 1)")->group(group);
  command.add_option("--up", up, "The file's axis that points up (default +z)")->group(group);
  command.add_option("--forward", forward, "The file's axis that points forward (default +x)")
      ->group(group);
  command
      .add_option("--origin", origin, "Point x,y,z in m, after turning and scaling, that becomes 0")
      ->group(group);
  command.add_option("--format", format, "What standard input holds: obj, stl, ply, off, glb ...")
      ->group(group);
}

Result<ImportTransform> MeshArguments::transform() const {
  ImportTransform made;
  made.scale = scale;
  if (!std::isfinite(scale) || scale <= 0.0) {
    return make_error(ErrorCode::usage, "--scale has to be a number above 0",
                      "give metres per file unit, such as 0.001 for millimetres");
  }
  const std::optional<Axis> up_axis = parse_axis(up);
  const std::optional<Axis> forward_axis = parse_axis(forward);
  if (!up_axis || !forward_axis) {
    const std::string option = up_axis ? "--forward " + forward : "--up " + up;
    return make_error(ErrorCode::usage, option + ": is no axis", "give +x, -x, +y, -y, +z or -z");
  }
  if (static_cast<int>(*up_axis) / 2 == static_cast<int>(*forward_axis) / 2) {
    return make_error(ErrorCode::usage,
                      "--up " + up + " and --forward " + forward + " are the same axis",
                      "name both when one of them is not the default");
  }
  made.up = *up_axis;
  made.forward = *forward_axis;
  const std::optional<std::vector<double>> point = parse_numbers(origin);
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!point || point->size() != 3 || !std::all_of(point->begin(), point->end(), finite)) {
    return make_error(ErrorCode::usage, "--origin " + origin + ": needs three numbers",
                      "write x,y,z in metres");
  }
  made.origin_m = Eigen::Vector3d((*point)[0], (*point)[1], (*point)[2]);
  return made;
}

Result<ImportedMesh> load_mesh(const std::string& path, const MeshArguments& arguments, bool tell) {
  Result<ImportTransform> transform = arguments.transform();
  if (!transform) return transform.error();
  ImportOptions options;
  options.transform = *transform;
  std::optional<StandardInputFile> received;
  if (is_standard(path)) {
    if (arguments.format.empty()) {
      return make_error(ErrorCode::usage, "standard input has no name to tell its format from",
                        "give --format, such as --format obj");
    }
    Result<StandardInputFile> file =
        StandardInputFile::receive(options.limits.file_bytes, escape_file_name(arguments.format));
    if (!file) return file.error();
    received = std::move(*file);
  }
  Result<ImportedMesh> imported = import_mesh(received ? received->path() : path, options);
  const std::string shown = received ? "standard input" : path;
  if (!imported) {
    Error error = imported.error();
    error.file = shown;
    if (received) {
      for (std::string* text : {&error.place, &error.reason, &error.remedy}) {
        name_standard_input(*text, received->path());
      }
    }
    return error;
  }
  if (received) {
    for (std::string& warning : imported->warnings) name_standard_input(warning, received->path());
  }
  if (tell) {
    for (const std::string& warning : imported->warnings) warn(shown, warning);
  }
  return imported;
}

Status one_standard_input(const std::vector<std::string>& inputs) {
  if (std::count_if(inputs.begin(), inputs.end(), is_standard) <= 1) return Success{};
  return make_error(ErrorCode::usage, "- stands for standard input and can be given once only");
}

}  // namespace crashrank::cli
