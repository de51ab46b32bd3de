#include "command.hpp"
#include "console.hpp"
#include "json.hpp"
#include "mesh_arguments.hpp"
#include "streams.hpp"
#include "tree_arguments.hpp"

#include "crashrank/rank/scenario.hpp"
#include "crashrank/report/escape.hpp"
#include "crashrank/tree/model_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace crashrank::cli {
namespace {

using namespace std::string_view_literals;

constexpr OutputKind model_file{"a model file",
                                "\x93"
                                "CRM\r\n\x1a\n"sv};

struct Options {
  std::string mesh_file;
  std::string output;
  std::optional<double> mass_kg;
  bool force = false;
  bool json = false;
  MeshArguments mesh;
  TreeArguments tree;
};

Status check_options(const Options& options) {
  if (is_standard(options.output)) {
    return make_error(ErrorCode::usage, "a model is written to a file, not to standard output",
                      "name one with -o");
  }
  if (options.mass_kg && !(*options.mass_kg >= scenario_limits::min_mass_kg &&
                           *options.mass_kg <= scenario_limits::max_mass_kg)) {
    return make_error(ErrorCode::usage,
                      fmt::format("--mass-kg has to be a number from {} to {}",
                                  scenario_limits::min_mass_kg, scenario_limits::max_mass_kg),
                      "leave it out where the mass is not known");
  }
  std::error_code ignored;
  if (std::filesystem::exists(options.output, ignored) &&
      !std::filesystem::is_regular_file(options.output, ignored)) {
    return make_error(ErrorCode::usage, "-o " + options.output + ": is a folder or device",
                      "name another file");
  }
  // A model file that is compiled again, with another mass, may take its own place.
  std::vector<std::string> inputs;
  const std::string mesh = is_standard(options.mesh_file) ? "/dev/stdin" : options.mesh_file;
  if (!is_model_file(mesh)) inputs.push_back(mesh);
  return can_be_written(options.output, model_file, inputs);
}

int run(const Options& options) {
  if (const Status sound = check_options(options); !sound) return fail(sound.error());
  Result<LoadedBody> body = load_body(options.mesh_file, options.mesh, options.tree, true);
  if (!body) return fail(body.error());
  StoredModel& stored = body->stored;
  // Compiling a model file writes it again, perhaps with another mass.
  const double known_mass = stored.mass.mass_kg;
  stored.mass = shell_properties(stored.model.mesh);
  stored.mass.mass_kg = options.mass_kg.value_or(known_mass);
  if (Status saved = save_model(stored, options.output, options.force); !saved) {
    Error error = saved.error();
    if (error.code == ErrorCode::usage && !options.force) {
      error.remedy = "name another file, or give --force";
    }
    return fail(error);
  }
  // What was written is what counts.
  const Result<LoadedModel> written = load_model(options.output);
  if (!written) return fail(written.error());
  const ModelFileFacts& facts = written->facts;
  const std::string checksum = fmt::format("{:08x}", facts.checksum);
  const std::size_t triangles = written->stored.model.mesh.size();
  if (options.json) {
    print_json({{"model", options.output},
                {"version", facts.version},
                {"bytes", facts.bytes},
                {"checksum", checksum},
                {"triangles", triangles}});
  } else {
    print(fmt::format("{}: {} triangles, {} bytes, version {}, checksum {}\n",
                      escape_terminal(options.output), triangles, facts.bytes, facts.version,
                      checksum));
  }
  return exit_done;
}

}  // namespace

void add_compile(CLI::App& app, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "compile", "Write a mesh and its trees as one checked file that loads at once");
  command->add_option("MESH", options->mesh_file, "Mesh or model file; - is standard input")
      ->required();
  command->add_option("-o,--output", options->output, "The model file to write")->required();
  command->add_option("--mass-kg", options->mass_kg,
                      "Mass of the body; scenarios that give none then use it");
  command->add_flag("--force", options->force, "Replace a file of that name");
  command->add_flag("--json", options->json, "Answer in JSON");
  options->mesh.add_to(*command);
  options->tree.add_to(*command);
  command->footer(
      "A model file stands wherever a mesh does, and needs no importer.\n\n"
      "Example:\n  crashrank compile car.obj --scale 0.001 -o car.crm");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
