#include "command.hpp"
#include "console.hpp"
#include "interrupt.hpp"
#include "json.hpp"
#include "mesh_arguments.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "profile_picture.hpp"
#include "streams.hpp"
#include "tree_arguments.hpp"

#include "crashrank/internal/report/escape.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
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

struct CompileArguments {
  std::string mesh_file;
  std::string output;
  std::optional<double> mass_kg;
  std::string center_of_mass_m;  ///< "x,y" or "x,y,z"; empty: not stated
  std::optional<double> yaw_inertia_kgm2;
  bool force = false;
  bool json = false;
  MeshArguments mesh;
  TreeArguments tree;
};

/// The two or three coordinates of a centre of mass. Errors: usage.
Result<std::vector<double>> parse_center(const std::string& text) {
  const auto refused = [&text](const std::string& found) {
    return make_error(
        ErrorCode::usage,
        "--center-of-mass-m " + text + ": " + found + ", but needs two or three finite numbers",
        "write x,y or x,y,z in metres, such as 1.5,0 or 1.5,0,0.55");
  };
  const std::optional<std::vector<double>> numbers = parse_numbers(text);
  if (!numbers) return refused("holds something else than numbers");
  if (numbers->size() < 2 || numbers->size() > 3) {
    return refused(
        fmt::format("has {} number{}", numbers->size(), numbers->size() == 1 ? "" : "s"));
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(numbers->begin(), numbers->end(), finite)) return refused("is not finite");
  return *numbers;
}

Status check_options(const CompileArguments& options) {
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
  if (options.yaw_inertia_kgm2 &&
      !(*options.yaw_inertia_kgm2 > 0.0 &&
        *options.yaw_inertia_kgm2 <= scenario_limits::yaw_inertia_kgm2)) {
    return make_error(ErrorCode::usage,
                      fmt::format("--yaw-inertia-kgm2 has to be a number above 0, at most {}",
                                  scenario_limits::yaw_inertia_kgm2),
                      "leave it out where the inertia is not known");
  }
  if (!options.center_of_mass_m.empty()) {
    const Result<std::vector<double>> center = parse_center(options.center_of_mass_m);
    if (!center) return center.error();
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

/// What the options state over what a model file that is compiled again does. Errors: usage;
/// bad_input where the body cannot have it.
Status state_mass(const CompileArguments& options, const Box& bounds, StatedMass& stated) {
  if (options.mass_kg) stated.mass_kg = options.mass_kg;
  if (options.yaw_inertia_kgm2) stated.yaw_inertia_kgm2 = options.yaw_inertia_kgm2;
  if (!options.center_of_mass_m.empty()) {
    const Result<std::vector<double>> center = parse_center(options.center_of_mass_m);
    if (!center) return center.error();
    // A height that is not given is the middle of the body's.
    const double height =
        center->size() == 3 ? center->back() : static_cast<double>(bounds.center().z());
    stated.center_of_mass_m = Eigen::Vector3d((*center)[0], (*center)[1], height);
  }
  Status status = check_stated_mass(stated, bounds);
  if (!status) status.error().file = options.mesh_file;
  return status;
}

/// What a model file that is compiled again states and the options do not replace.
StatedMass find_kept(const CompileArguments& options, StatedMass stated) {
  if (options.mass_kg) stated.mass_kg.reset();
  if (!options.center_of_mass_m.empty()) stated.center_of_mass_m.reset();
  if (options.yaw_inertia_kgm2) stated.yaw_inertia_kgm2.reset();
  return stated;
}

Json to_json(const StatedMass& kept) {
  Json document = Json::object();
  if (kept.mass_kg) document["mass_kg"] = *kept.mass_kg;
  if (const auto& center = kept.center_of_mass_m) {
    document["center_of_mass_m"] = {center->x(), center->y(), center->z()};
  }
  if (kept.yaw_inertia_kgm2) document["yaw_inertia_kgm2"] = *kept.yaw_inertia_kgm2;
  return document;
}

/// One line with the options that would replace it; empty where nothing was kept.
std::string to_text(const StatedMass& kept) {
  std::string values;
  if (kept.mass_kg) values += fmt::format(", {:.6g} kg (--mass-kg)", *kept.mass_kg);
  if (const auto& center = kept.center_of_mass_m) {
    values += fmt::format(", centre of mass at ({:.6g}, {:.6g}, {:.6g}) m (--center-of-mass-m)",
                          center->x(), center->y(), center->z());
  }
  if (kept.yaw_inertia_kgm2) {
    values +=
        fmt::format(", yaw inertia {:.6g} kg m2 (--yaw-inertia-kgm2)", *kept.yaw_inertia_kgm2);
  }
  if (values.empty()) return {};
  return "  kept from the input, as no option replaces it: " + values.substr(2) + "\n";
}

int run(const CompileArguments& options) {
  if (const Status sound = check_options(options); !sound) return fail(sound.error());
  const PartialAnswer partial([&] { return Interruption{{}, options.output + " is not written"}; });
  Result<LoadedBody> body = load_body(options.mesh_file, options.mesh, options.tree, true);
  if (!body) return fail(body.error());
  StoredModel& stored = body->stored;
  const StatedMass kept = find_kept(options, stored.stated);
  stored.mass = shell_properties(stored.model.mesh);
  if (const Status sound = state_mass(options, stored.model.mesh.bounds(), stored.stated); !sound) {
    return fail(sound.error());
  }
  // What save_model names its draft.
  const UnfinishedFile draft(fmt::format("{}.{}.0", options.output, ::getpid()));
  const Progress progress("writing " + escape_terminal(options.output));
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
  const Model& model = written->stored.model;
  const std::string odd =
      model.profile ? profile_warning(*model.profile, model.mesh) : std::string();
  if (!odd.empty()) {
    warn(options.mesh_file, odd);
  }
  const ModelFileFacts& facts = written->facts;
  const std::string checksum = fmt::format("{:08x}", facts.checksum);
  const std::size_t triangles = model.mesh.size();
  if (options.json) {
    print_json({{"model", options.output},
                {"version", facts.version},
                {"bytes", facts.bytes},
                {"checksum", checksum},
                {"triangles", triangles},
                {"kept", to_json(kept)}});
  } else {
    print(fmt::format("{}: {} triangles, {} bytes, version {}, checksum {}\n",
                      escape_terminal(options.output), triangles, facts.bytes, facts.version,
                      checksum) +
          to_text(kept));
  }
  return exit_done;
}

}  // namespace

void add_compile(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CompileArguments>();
  CLI::App* command = app.add_subcommand(
      "compile", "Write a mesh and its trees as one checked file that loads at once");
  add_file(*command, "MESH", options->mesh_file, "Mesh or model file; - is standard input")
      ->required();
  add_file(*command, "-o,--output", options->output, "The model file to write")->required();
  command
      ->add_option(
          "--mass-kg", options->mass_kg,
          fmt::format("Mass of the body; scenarios that give none then use it [{:g} to {:g} "
                      "kg, default: not stated]",
                      scenario_limits::min_mass_kg, scenario_limits::max_mass_kg))
      ->type_name("KG")
      ->check(one_number("kg, such as 1450"));
  command
      ->add_option("--center-of-mass-m", options->center_of_mass_m,
                   "Its centre of mass, x,y or x,y,z in body coordinates; likewise")
      ->type_name("X,Y,Z");
  command
      ->add_option(
          "--yaw-inertia-kgm2", options->yaw_inertia_kgm2,
          fmt::format("Its yaw inertia about the centre of mass; likewise [above 0, at most "
                      "{:g} kg m2]",
                      scenario_limits::yaw_inertia_kgm2))
      ->type_name("KGM2")
      ->check(one_number("kg m2, such as 2200"));
  command->add_flag("--force", options->force, "Replace a file of that name");
  command->add_flag("--json", options->json, "Answer in JSON");
  options->mesh.add_to(*command);
  options->tree.add_to(*command);
  command->footer(
      "A model file stands wherever a mesh does, and needs no importer. One that is compiled again "
      "keeps what it\nstates of the mass, unless an option replaces it.\n\n"
      "Example:\n  crashrank compile car.obj --scale 0.001 -o car.crm");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
