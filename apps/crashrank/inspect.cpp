#include "command.hpp"
#include "console.hpp"
#include "json.hpp"
#include "mesh_arguments.hpp"

#include "crashrank/mesh/import.hpp"
#include "crashrank/report/escape.hpp"
#include "crashrank/report/table.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

struct Options {
  std::vector<std::string> files;
  bool json = false;
  MeshArguments mesh;
};

Json to_json(const std::string& file, const ImportedMesh& imported) {
  const TriangleMesh& mesh = imported.mesh;
  const MeshQuality& quality = imported.quality;
  Json parts = Json::array();
  for (const Part& part : mesh.parts) {
    parts.push_back({{"name", part.name}, {"triangles", part.triangle_count}});
  }
  const Eigen::Vector3d& extent = quality.extent_m;
  return {{"file", file},
          {"triangles", mesh.size()},
          {"vertices", mesh.vertices.size()},
          {"parts", std::move(parts)},
          {"extent_m", {extent.x(), extent.y(), extent.z()}},
          {"area_m2", quality.area_m2},
          {"degenerate_triangles", quality.degenerate_triangles},
          {"duplicate_triangles", quality.duplicate_triangles},
          {"dropped_triangles", imported.dropped_triangles},
          {"non_finite_vertices", quality.non_finite_vertices},
          {"watertight", quality.watertight},
          {"warnings", imported.warnings}};
}

std::string to_text(const std::string& file, const ImportedMesh& imported, bool colours) {
  const TriangleMesh& mesh = imported.mesh;
  const MeshQuality& quality = imported.quality;
  std::string text =
      fmt::format("{}\n  {} triangles, {} vertices, {:.4g} x {:.4g} x {:.4g} m, {:.4g} m2, {}\n",
                  escape_terminal(file), mesh.size(), mesh.vertices.size(), quality.extent_m.x(),
                  quality.extent_m.y(), quality.extent_m.z(), quality.area_m2,
                  quality.watertight ? "watertight" : "not watertight");
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

int run(const Options& options) {
  if (const Status single = one_standard_input(options.files); !single) return fail(single.error());
  int code = exit_done;
  Json files = Json::array();
  for (const std::string& file : options.files) {
    Result<ImportedMesh> imported = load_mesh(file, options.mesh, false);
    if (!imported) {
      // The others are still worth their answer; the first failure decides the exit code.
      const int failed = fail(imported.error());
      if (code == exit_done) code = failed;
      if (failed == exit_usage) return failed;
      continue;
    }
    if (options.json) {
      files.push_back(to_json(file, *imported));
    } else {
      print(to_text(file, *imported, colours_wanted()));
    }
  }
  if (options.json) print_json({{"files", std::move(files)}});
  return code;
}

}  // namespace

void add_inspect(CLI::App& app, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("inspect", "Look a mesh file over before trusting it");
  command->add_option("MESH", options->files, "Mesh files; - is standard input")->required();
  command->add_flag("--json", options->json, "Answer in JSON");
  options->mesh.add_to(*command);
  command->footer("Example:\n  crashrank inspect car.obj --scale 0.001 --up +y --forward -z");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
