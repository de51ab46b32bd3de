#include "command.hpp"
#include "console.hpp"
#include "interrupt.hpp"
#include "json.hpp"
#include "mesh_arguments.hpp"
#include "options.hpp"
#include "profile_picture.hpp"
#include "streams.hpp"
#include "vehicle_reading.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "crashrank/internal/report/table.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/report/ranking.hpp"
#include "crashrank/vehicle/vehicle.hpp"
#include "report/orientation.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

struct InspectArguments {
  std::vector<std::string> files;
  bool json = false;
  std::string profile;
  std::string picture;
  MeshArguments mesh;
};

/// What a model file is beside its mesh.
struct Compiled {
  ModelFileFacts facts;
  StoredModel stored;
};

Json or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json or_null(const std::optional<Eigen::Vector3d>& point) {
  return point ? Json{point->x(), point->y(), point->z()} : Json(nullptr);
}

Json to_json(const Compiled& compiled) {
  const Model& model = compiled.stored.model;
  const ShellProperties& mass = compiled.stored.mass;
  const StatedMass& stated = compiled.stored.stated;
  const ImportTransform& transform = compiled.stored.transform;
  return {{"version", compiled.facts.version},
          {"bytes", compiled.facts.bytes},
          {"checksum", fmt::format("{:08x}", compiled.facts.checksum)},
          {"tree_nodes", model.tree.nodes.size()},
          {"tree_depth", model.tree.depth},
          {"tree_frame", model.tree.axes_are_world ? "world" : "gaussian"},
          {"wide_nodes", model.wide.nodes.size()},
          {"clusters", model.wide.clusters.size()},
          {"mass_kg", or_null(stated.mass_kg)},
          {"center_of_mass_m", or_null(stated.center_of_mass_m)},
          {"yaw_inertia_kgm2", or_null(stated.yaw_inertia_kgm2)},
          {"volume_m3", mass.volume_m3},
          {"center_m", {mass.center_m.x(), mass.center_m.y(), mass.center_m.z()}},
          {"inertia_per_kg_m2", mass.inertia_per_kg_m2},
          {"scale", transform.scale},
          {"up", axis_name(transform.up)},
          {"forward", axis_name(transform.forward)},
          {"origin_m", {transform.origin_m.x(), transform.origin_m.y(), transform.origin_m.z()}}};
}

std::string to_text(const Compiled& compiled) {
  const Model& model = compiled.stored.model;
  std::string text = fmt::format(
      "  model file version {}, {} bytes, checksum {:08x}\n"
      "  {} nodes, {} deep, along the {} axes; {} wide nodes, {} clusters\n",
      compiled.facts.version, compiled.facts.bytes, compiled.facts.checksum,
      model.tree.nodes.size(), model.tree.depth, model.tree.axes_are_world ? "body's" : "Gaussian",
      model.wide.nodes.size(), model.wide.clusters.size());
  const StatedMass& stated = compiled.stored.stated;
  if (stated.mass_kg) text += fmt::format("  {:.6g} kg\n", *stated.mass_kg);
  if (stated.center_of_mass_m) {
    const Eigen::Vector3d& center = *stated.center_of_mass_m;
    text += fmt::format("  centre of mass at ({:.6g}, {:.6g}, {:.6g}) m\n", center.x(), center.y(),
                        center.z());
  }
  if (stated.yaw_inertia_kgm2) {
    text += fmt::format("  yaw inertia {:.6g} kg m2\n", *stated.yaw_inertia_kgm2);
  }
  return text;
}

/// How a mesh will be used as a body: as the options say, or as guessed where none are given and it
/// seems turned or out of scale.
struct Use {
  BodyKind kind = BodyKind::car;
  detail::MeshReading reading;
  std::string hint;           ///< how to read it, if it could be a vehicle and is not read so
  bool guessed = false;       ///< `mesh` is not the one that was read, but that of the hint
  bool vehicle = false;       ///< of a vehicle's kind, size and axes
  bool moved = false;         ///< the proposed origin differs from that of the options
  ImportTransform transform;  ///< from the file, the proposed origin included
  SeenAxles axles;            ///< of a vehicle, with x before the origin is moved
  TriangleMesh mesh;          ///< turned and moved, if guessed
};

/// What a person would do with a mesh that could be a vehicle and seems turned or out of scale;
/// empty for others. `model_file`: its frame cannot be changed by options here.
std::string reading_hint(const ImportedMesh& imported, const Use& use,
                         const ImportTransform& transform, bool model_file) {
  constexpr double longest_m = 60.0;
  const Eigen::Vector3d& extent_m = imported.quality.extent_m;
  const detail::MeshReading& reading = use.reading;
  const double factor = reading.scale / transform.scale;
  const bool could_be = detail::has_wheels(imported.mesh) || extent_m.maxCoeff() > longest_m ||
                        reading.has_scale_of(transform);
  if (!could_be || !drives(use.kind) || !detail::has_vehicle_size(factor * extent_m)) return {};
  if (reading.has_axes_of(transform) && reading.has_scale_of(transform)) return {};
  return fmt::format("if this is a vehicle, {} with {}, guessed by {}{}",
                     model_file ? "compile its mesh again" : "read it", reading.options(),
                     reading.shown_by,
                     reading.front_known ? "" : " (or with the opposite of that --forward)");
}

Result<Use> use_of(const std::string& file, const ImportedMesh& imported,
                   const ImportTransform& transform, bool may_guess, bool model_file) {
  const Eigen::Vector3d& extent_m = imported.quality.extent_m;
  Use use;
  use.transform = transform;
  use.reading = detail::guess_reading(imported.mesh, transform, detail::is_gltf_file(file));
  use.kind =
      guess_kind(std::filesystem::path(file).stem().string(),
                 use.reading.scale / transform.scale * extent_m, detail::has_wheels(imported.mesh));
  use.hint = reading_hint(imported, use, transform, model_file);
  use.guessed = may_guess && !use.hint.empty();
  use.vehicle =
      use.guessed || (use.hint.empty() && drives(use.kind) && detail::has_vehicle_size(extent_m));
  if (use.guessed) {
    use.mesh = imported.mesh;
    Result<ImportTransform> guess = guess_transform(use.mesh, use.kind, use.reading, use.axles);
    if (!guess) return guess.error();
    use.transform = *guess;
    const Eigen::Vector3f origin = guess->origin_m.cast<float>();
    for (Eigen::Vector3f& vertex : use.mesh.vertices) vertex -= origin;
  } else if (use.vehicle) {
    use.axles = find_axles(imported.mesh, use.kind);
    use.transform.origin_m += guess_origin(imported.mesh, use.axles);
  }
  use.moved = use.transform.origin_m != transform.origin_m;
  return use;
}

Json to_json(const Use& use) {
  if (!use.vehicle) return nullptr;
  const Eigen::Vector3d& origin = use.transform.origin_m;
  return {{"kind", body_kind_name(use.kind)},
          {"guessed", use.guessed},
          {"scale", use.transform.scale},
          {"up", axis_name(use.transform.up)},
          {"forward", axis_name(use.transform.forward)},
          {"front_known", use.reading.front_known},
          {"origin_m", {origin.x(), origin.y(), origin.z()}},
          {"rear_axle_x_m", use.axles.rear_x_m},
          {"wheelbase_m", use.axles.wheelbase_m},
          {"axles_seen", use.axles.by_wheels}};
}

std::string to_text(const Use& use) {
  if (!use.vehicle) return {};
  const Eigen::Vector3d& origin = use.transform.origin_m;
  return fmt::format("  rear axle{} at x = {:.3g} m, wheelbase {:.3g} m, {}; {}\n",
                     use.guessed ? ", so read," : "", use.axles.rear_x_m, use.axles.wheelbase_m,
                     use.axles.by_wheels ? "as its wheels show" : "where it usually is",
                     use.moved ? fmt::format("--origin {:g},{:g},{:g} puts the origin below it",
                                             origin.x(), origin.y(), origin.z())
                               : "the origin is near it");
}

Json to_json(const std::string& file, const ImportedMesh& imported, const Use& use) {
  const TriangleMesh& mesh = imported.mesh;
  const MeshQuality& quality = imported.quality;
  Json parts = Json::array();
  for (const Part& part : mesh.parts) {
    parts.push_back({{"name", part.name}, {"triangles", part.triangle_count}});
  }
  const Eigen::Vector3d& extent = quality.extent_m;
  const Box bounds = mesh.bounds();
  return {{"file", file},
          {"triangles", mesh.size()},
          {"vertices", mesh.vertices.size()},
          {"parts", std::move(parts)},
          {"extent_m", {extent.x(), extent.y(), extent.z()}},
          {"min_m", {bounds.min.x(), bounds.min.y(), bounds.min.z()}},
          {"max_m", {bounds.max.x(), bounds.max.y(), bounds.max.z()}},
          {"orientation_hint", use.hint.empty() ? Json(nullptr) : Json(use.hint)},
          {"vehicle", to_json(use)},
          {"area_m2", quality.area_m2},
          {"degenerate_triangles", quality.degenerate_triangles},
          {"duplicate_triangles", quality.duplicate_triangles},
          {"dropped_triangles", imported.dropped_triangles},
          {"non_finite_vertices", quality.non_finite_vertices},
          {"watertight", quality.watertight},
          {"warnings", imported.warnings}};
}

std::string to_text(const std::string& file, const ImportedMesh& imported, const Use& use,
                    bool colours) {
  const TriangleMesh& mesh = imported.mesh;
  const MeshQuality& quality = imported.quality;
  std::string text =
      fmt::format("{}\n  {} triangles, {} vertices, {:.4g} x {:.4g} x {:.4g} m, {:.4g} m2, {}\n",
                  escape_terminal(file), mesh.size(), mesh.vertices.size(), quality.extent_m.x(),
                  quality.extent_m.y(), quality.extent_m.z(), quality.area_m2,
                  quality.watertight ? "watertight" : "not watertight");
  const Box bounds = mesh.bounds();
  text += fmt::format("  x {:.4g} to {:.4g}, y {:.4g} to {:.4g}, z {:.4g} to {:.4g} m\n",
                      bounds.min.x(), bounds.max.x(), bounds.min.y(), bounds.max.y(),
                      bounds.min.z(), bounds.max.z());
  if (!use.hint.empty()) text += "  hint: " + use.hint + "\n";
  text += to_text(use);
  text += fmt::format("  {} degenerate, {} duplicate, {} dropped triangles\n",
                      quality.degenerate_triangles, quality.duplicate_triangles,
                      imported.dropped_triangles);
  for (const std::string& warning : imported.warnings) {
    text += "  warning: " + escape_terminal(warning) + "\n";
  }
  Table parts({{"  part"}, {"triangles", true}});
  for (const Part& part : mesh.parts) {
    parts.add_row({"  " + part.name, std::to_string(part.triangle_count)});
  }
  return text + parts.text(colours);
}

/// The outlines of a mesh, or those stored in its model.
Result<std::shared_ptr<const Profile>> profile_of(const std::string& mesh_file,
                                                  const TriangleMesh& mesh,
                                                  const std::optional<Compiled>& compiled) {
  if (compiled && compiled->stored.model.profile) return compiled->stored.model.profile;
  Result<Profile> made = make_profile(mesh);
  if (!made) {
    made.error().file = mesh_file;
    return made.error();
  }
  return std::make_shared<const Profile>(std::move(*made));
}

/// A mesh file, or the mesh of a model file.
Result<ImportedMesh> look_at(const std::string& file, const MeshArguments& arguments,
                             std::optional<Compiled>& compiled) {
  Result<MeshOrModel> read = load_mesh_or_model(file, arguments);
  if (!read) return read.error();
  if (!read->model) return std::move(read->mesh);
  LoadedModel& loaded = *read->model;
  ImportedMesh mesh;
  mesh.mesh = loaded.stored.model.mesh;
  mesh.quality = assess(mesh.mesh);
  mesh.warnings = mesh.quality.warnings;
  compiled = Compiled{loaded.facts, std::move(loaded.stored)};
  return mesh;
}

Status write_picture(const std::string& path, const OutputKind& kind, const std::string& content) {
  Result<OutputFile> out = OutputFile::open(path, kind);
  if (!out) return out.error();
  out->write(content);
  return out->close();
}

/// Three views of the mesh as it will be used, with the rear axle of vehicles that show wheels.
Status draw_picture_of(const ImportedMesh& imported, const Use& use, const ImportTransform* given,
                       const std::string& path) {
  ThreeViewOptions options;
  options.caption = use.guessed ? "as guessed: " + options_text(use.transform) : "as read";
  if (given != nullptr) options.caption = "as given: " + options_text(*given);
  if (use.guessed && !use.reading.front_known) options.caption += ", front not known";
  if (use.axles.by_wheels) {
    options.rear_axle_x_m = use.axles.rear_x_m - (use.guessed ? use.transform.origin_m.x() : 0.0);
  }
  const Result<Image> image = draw_three_views(use.guessed ? use.mesh : imported.mesh, options);
  if (!image) return image.error();
  const Result<std::string> bytes = png(*image);
  return bytes ? write_picture(path, png_picture, *bytes) : Status(bytes.error());
}

/// Whether a picture that an option asks for can be drawn and written.
Status check_picture(const std::string& option, const std::string& path, const OutputKind& kind,
                     const std::vector<std::string>& files) {
  if (path.empty()) return Success{};
  if (files.size() != 1) {
    return make_error(ErrorCode::usage, option + " draws one mesh, so it needs exactly one MESH");
  }
  if (is_standard(path)) {
    return make_error(ErrorCode::usage,
                      option + " needs a file: the answer goes to standard output");
  }
  return can_be_written(path, kind, files);
}

Status check_pictures(const InspectArguments& options) {
  if (same_place(options.profile, options.picture)) {
    return make_error(ErrorCode::usage, "--profile and --picture name the same file",
                      "name two files");
  }
  const Status sound = check_picture("--profile", options.profile, svg_picture, options.files);
  return sound ? check_picture("--picture", options.picture, png_picture, options.files) : sound;
}

int run(const InspectArguments& options) {
  if (const Status sound = check_pictures(options); !sound) return fail(sound.error());
  if (const Status single = one_standard_input(options.files); !single) return fail(single.error());
  int code = exit_done;
  Json files = Json::array();
  std::mutex mutex;
  const PartialAnswer partial([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    Interruption known{{},
                       fmt::format("{} of {} files are read", files.size(), options.files.size())};
    if (options.json) known.answer = json_text({{"files", files}});
    return known;
  });
  for (const std::string& file : options.files) {
    std::optional<Compiled> compiled;
    Result<ImportedMesh> imported = look_at(file, options.mesh, compiled);
    if (!imported) {
      // The others are still worth their answer; the first failure decides the exit code.
      const int failed = fail(imported.error());
      if (code == exit_done) code = failed;
      if (failed == exit_usage) return failed;
      continue;
    }
    const ImportTransform transform =
        compiled ? compiled->stored.transform : *options.mesh.transform();
    const bool given = !compiled && options.mesh.given();
    const Result<Use> use =
        use_of(file, *imported, transform, !compiled && !given, compiled.has_value());
    if (!use) return fail(use.error());
    const auto profile = profile_of(file, imported->mesh, compiled);
    if (!options.profile.empty()) {
      const auto drawn_profile = use->guessed ? profile_of(file, use->mesh, compiled) : profile;
      if (!drawn_profile) return fail(drawn_profile.error());
      const std::string name = std::filesystem::path(file).filename().string();
      const Status drawn =
          write_picture(options.profile, svg_picture, profile_picture(**drawn_profile, name));
      if (!drawn) return fail(drawn.error());
    }
    const std::string odd = profile ? profile_warning(**profile, imported->mesh) : std::string();
    if (!odd.empty()) imported->warnings.push_back(odd);
    const std::string small = drives(use->kind) ? use->reading.size_doubt() : std::string();
    if (!small.empty()) imported->warnings.push_back(small);
    if (!options.picture.empty()) {
      const Status drawn =
          draw_picture_of(*imported, *use, given ? &transform : nullptr, options.picture);
      if (!drawn) return fail(drawn.error());
    }
    if (options.json) {
      const std::lock_guard<std::mutex> lock(mutex);
      files.push_back(to_json(file, *imported, *use));
      if (compiled) files.back()["model"] = to_json(*compiled);
    } else {
      print(to_text(file, *imported, *use, colours_wanted()));
      if (compiled) print(to_text(*compiled));
    }
  }
  if (options.json) print_json({{"files", files}});
  return code;
}

}  // namespace

void add_inspect(CLI::App& app, Action& action) {
  const auto options = std::make_shared<InspectArguments>();
  CLI::App* command =
      app.add_subcommand("inspect", "Look a mesh or model file over before trusting it");
  command->add_option("MESH", options->files, "Mesh or model files; - is standard input")
      ->type_name("FILE")
      ->required();
  command->add_flag("--json", options->json, "Answer in JSON");
  add_file(
      *command, "--profile", options->profile,
      "Draw the outlines that a crash sees, by height, into this SVG file, of the same reading "
      "as --picture");
  add_file(*command, "--picture", options->picture,
           "Draw the mesh as it will be used, read with the options given or else as guessed, with "
           "axes, ground and rear axle, into this PNG file");
  options->mesh.add_to(*command);
  command->footer(
      "Examples:\n  crashrank inspect car.obj --scale 0.001 --up +y --forward -z\n"
      "  crashrank inspect car.obj --profile outlines.svg --picture car.png");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
