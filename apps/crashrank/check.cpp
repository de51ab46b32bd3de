#include "command.hpp"
#include "console.hpp"
#include "json.hpp"
#include "options.hpp"
#include "scenario_file.hpp"
#include "streams.hpp"

#include "crashrank/rank/rank.hpp"
#include "crashrank/report/ranking.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "crashrank/scenario/scenario_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

struct CheckArguments {
  std::string scenario;
  std::string plan;
  bool json = false;
  std::vector<std::string> allowed_folders;
};

/// What is wrong with a scenario and what is doubtful.
struct Findings {
  std::vector<Error> errors;
  std::vector<std::string> warnings;
  std::size_t candidates = 0;
};

/// Reads the models that the scenario names; those that cannot be read are left out.
std::vector<Model> read_models(Scenario& scenario, const std::string& file, Findings& found) {
  ScenarioModelOptions how;
  how.scenario = file;
  std::vector<Model> models;
  Progress progress("reading meshes", scenario.models.size());
  for (ScenarioModel& wanted : scenario.models) {
    progress.advance();
    if (wanted.path.empty() && !wanted.box_m) continue;  // refused before
    Result<LoadedScenarioModel> read = load_scenario_model(wanted, how);
    if (!read) {
      found.errors.push_back(read.error());
      continue;
    }
    for (const std::string& warning : read->warnings) {
      found.warnings.push_back(wanted.path + ": " + warning);
    }
    add_stated_mass(read->stated, wanted);
    models.push_back(std::move(read->model));
  }
  return models;
}

/// What only ranking finds, without the samples of its intervals.
void rank_once(const Scenario& scenario, const std::vector<Model>& models, const std::string& file,
               Findings& found) {
  RankOptions how;
  how.workers = std::clamp(std::thread::hardware_concurrency(), 1U, max_workers);
  how.harm = scenario.harm;
  how.harm->intervals = false;
  Progress progress("ranking");
  how.on_progress = [&](std::size_t evaluated, std::size_t candidates) {
    progress.update(evaluated, candidates);
    return true;
  };
  const Result<RankResult> ranked = rank(scenario, models, how);
  if (!ranked) {
    found.errors.push_back(ranked.error());
    if (found.errors.back().file.empty()) found.errors.back().file = file;
    return;
  }
  found.candidates = ranked->candidates.size();
  for (const std::string& doubt : ranking_doubts(scenario, models, *ranked)) {
    found.warnings.push_back(fmt::format("{}: {}", file, doubt));
  }
}

Json to_json(const std::string& file, const Findings& found) {
  Json errors = Json::array();
  for (const Error& error : found.errors) {
    errors.push_back({{"file", error.file},
                      {"place", error.place},
                      {"reason", error.reason},
                      {"remedy", error.remedy}});
  }
  return {{"file", file}, {"errors", std::move(errors)}, {"warnings", found.warnings}};
}

int run(const CheckArguments& options) {
  if (is_standard(options.plan)) {
    return fail(
        make_error(ErrorCode::usage, "--plan needs a file: the answer goes to standard output"));
  }
  const Result<std::string> text = read_text(options.scenario, scenario_limits::file_bytes);
  if (!text) return fail(text.error());
  const std::string file = shown_name(options.scenario);
  CheckedScenario checked = check_scenario(*text, file, {options.allowed_folders});
  Scenario& scenario = checked.scenario;
  std::vector<std::string> inputs{options.scenario};
  for (const ScenarioModel& model : scenario.models) inputs.push_back(model.path);
  if (const Status sound = can_be_written(options.plan, svg_picture, inputs); !sound) {
    return fail(sound.error());
  }
  Findings found;
  for (Error& error : checked.errors) found.errors.push_back(name_allow(std::move(error)));
  const std::vector<Model> models = read_models(scenario, file, found);
  if (found.errors.empty() && !options.plan.empty()) {
    Result<OutputFile> out = OutputFile::open(options.plan, svg_picture);
    if (!out) return fail(out.error());
    out->write(scenario_plan(scenario, models));
    if (const Status written = out->close(); !written) return fail(written.error());
  }
  if (found.errors.empty()) rank_once(scenario, models, file, found);
  if (options.json) print_json(to_json(file, found));
  for (const std::string& warning : found.warnings) warn("", warning);
  int code = exit_done;
  for (const Error& error : found.errors) {
    const int failed = fail(error);
    if (code == exit_done) code = failed;
  }
  if (code == exit_done && !options.json) {
    const auto counted = [](std::size_t count, const char* what) {
      return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
    };
    print(fmt::format(
        "{}: no errors, {}; {}, {}\n", file, counted(found.warnings.size(), "warning"),
        counted(found.candidates, "candidate"), counted(scenario.actors.size(), "actor")));
  } else if (code != exit_done && !options.plan.empty()) {
    say("no plan is drawn of a scenario with errors");
  }
  return code;
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand(
      "check", "Find all errors of a scenario and what is doubtful, without an answer");
  add_file(*command, "SCENARIO", options->scenario,
           "Scenario file; - is standard input, its meshes then relative to this folder")
      ->required();
  command->add_flag("--json", options->json, "Answer in JSON");
  add_file(*command, "--plan", options->plan,
           "Draw bodies, ways of the actors and road at time 0 into this SVG file");
  add_allowed_folders(*command, options->allowed_folders);
  command->footer(
      "Each error names its key and a remedy; the exit code is that of rank: 3 where there is "
      "one.\n"
      "Of a key that is wrong, errors of what it holds show after it is mended.\n\n"
      "Example:\n  crashrank check scenario.json --plan plan.svg");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
