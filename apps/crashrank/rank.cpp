#include "command.hpp"
#include "console.hpp"
#include "damage_folder.hpp"
#include "engine.hpp"
#include "interrupt.hpp"
#include "mesh_arguments.hpp"
#include "options.hpp"
#include "scenario_file.hpp"
#include "streams.hpp"
#include "tree_arguments.hpp"

#include "crashrank/model/model.hpp"
#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/report/ranking.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "crashrank/tree/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

constexpr OutputKind html_page{"an HTML page", "<!DOCTYPE html"};
constexpr OutputKind animation_file{"a GLB file", "glTF"};

struct RankArguments {
  std::string scenario;
  std::string measure;
  std::string risk_model;
  std::string risk;
  std::string infeasible = "demote";
  std::string order = "score";
  std::size_t futures = RankOptions{}.sampled_futures;
  std::string profile;
  std::string damage_folder;
  std::size_t damage_top = 5;
  std::string report;
  std::string animation;
  std::string mcap;
  std::size_t top = 20;
  unsigned workers = std::clamp(std::thread::hardware_concurrency(), 1U, max_workers);
  std::string policy = "late-match";
  std::string depth = "auto";
  bool json = false;
  bool motion = false;
  bool smooth = false;
  double deadline_ms = std::numeric_limits<double>::infinity();
  std::uint64_t work_budget = std::numeric_limits<std::uint64_t>::max();
  bool first_place = false;
  bool engine_given = false;  ///< --policy or --depth
  TreeArguments tree;

  bool bounded() const {
    return std::isfinite(deadline_ms) || first_place ||
           work_budget != std::numeric_limits<std::uint64_t>::max();
  }
  std::vector<std::string> allowed_folders;
};

Result<Scenario> read_scenario(const RankArguments& options) {
  ScenarioPaths paths;
  paths.allowed_folders = options.allowed_folders;
  if (!is_standard(options.scenario)) {
    Result<Scenario> scenario = load_scenario_file(options.scenario, paths);
    if (!scenario && load_profile_file(options.scenario, {})) {
      return Error{ErrorCode::bad_input,
                   options.scenario,
                   {},
                   "is a profile, not a scenario",
                   "name a scenario, and this file with --profile"};
    }
    return scenario;
  }
  const Result<std::string> text = read_text("-", scenario_limits::file_bytes);
  if (!text) return text.error();
  return load_scenario(*text, "standard input", paths);
}

bool is_scenario(const std::string& path) {
  const Result<std::string> text = read_text(path, scenario_limits::file_bytes);
  return text && parse_scenario(*text, path);
}

/// The scenario's own, the profile over it, the command line over both.
Result<HarmOptions> read_harm(const RankArguments& options, const Scenario& scenario) {
  HarmOptions harm = scenario.harm;
  if (!options.profile.empty()) {
    const Result<HarmOptions> profile = load_profile_file(options.profile, harm);
    if (!profile && is_scenario(options.profile)) {
      return Error{ErrorCode::bad_input,
                   options.profile,
                   {},
                   "is a scenario, not a profile",
                   "name it without --profile; a profile is a file after data/profile.schema.json"};
    }
    if (!profile) return profile.error();
    harm = *profile;
  }
  if (!options.risk_model.empty()) {
    const Result<RiskModel> model = risk_model_from_name(options.risk_model);
    if (!model) return model.error();
    harm.model = *model;
  }
  return harm;
}

Status write_file(const std::string& path, const OutputKind& kind, const std::string& content) {
  Result<OutputFile> file = OutputFile::open(path, kind);
  if (!file) return file.error();
  file->write(content);
  return file->close();
}

Status write_animation(const RankArguments& options, const Scenario& scenario,
                       const std::vector<Model>& models, const RankResult& ranked) {
  const Result<std::string> made = ranking_animation(scenario, models, ranked);
  return made ? write_file(options.animation, animation_file, *made) : Status(made.error());
}

RankBudget budget_of(const RankArguments& options) {
  RankBudget budget;
  budget.deadline_s = 1e-3 * options.deadline_ms;
  budget.work = options.work_budget;
  budget.first_place_only = options.first_place;
  return budget;
}

/// Says what is to be warned of in the options and the end of the ranking, and adds it.
void warn_of_end(const RankArguments& options, const RankResult& ranked, bool answered,
                 std::vector<std::string>& warnings) {
  const std::size_t before = warnings.size();
  if (options.engine_given && options.bounded()) {
    warnings.emplace_back("--policy and --depth have no part in an answer within a budget");
  }
  if (!answered) {
    warnings.push_back(why_partial(ranked, options.bounded()));
  }
  for (std::size_t i = before; i < warnings.size(); ++i) warn("", warnings[i]);
}

/// Motions are recorded for the JSON answer and the animation, and not by the search that ends
/// early.
Status check_motion(const RankArguments& options) {
  if (options.motion && !options.json) {
    return make_error(ErrorCode::usage, "--motion is part of the JSON answer alone",
                      "add --json, or leave out --motion");
  }
  if ((options.motion || !options.animation.empty()) && options.bounded()) {
    const std::string option = options.motion ? "--motion" : "--animation";
    return make_error(ErrorCode::usage, option + " is not recorded by an answer within a budget",
                      "leave out --deadline-ms, --work-budget and --first-place, or " + option);
  }
  return Success{};
}

/// An answer within a budget has no motion to play, nor has one of too many candidates.
bool is_played(const RankArguments& options, const Scenario& scenario) {
  return !options.bounded() && candidate_count(scenario) <= most_played_candidates;
}

/// Whether the files could be written, before the work for them is begun.
Status check_files(const RankArguments& options, const std::vector<std::string>& inputs) {
  if (Status sound = can_be_written(options.report, html_page, inputs, options.damage_folder);
      !sound) {
    return sound;
  }
  if (same_place(options.animation, options.report)) {
    return Error{ErrorCode::usage,
                 options.animation,
                 {},
                 "is the file of --report",
                 "name another file with --animation"};
  }
  return can_be_written(options.animation, animation_file, inputs, options.damage_folder);
}

int run(const RankArguments& options) {
  if (const Status sound = check_motion(options); !sound) return fail(sound.error());
  if (!options.mcap.empty()) {
    return fail(make_error(ErrorCode::usage, "--mcap is written by the Python package",
                           "pip install '.[mcap]' in the folder of the source, then python -m "
                           "crashrank rank SCENARIO --mcap OUT.mcap"));
  }
  if (options.json && is_standard(options.report)) {
    return fail(make_error(ErrorCode::usage,
                           "--json and --report - would both write standard output",
                           "give --report a file"));
  }
  RankOptions how;
  how.workers = options.workers;
  const Result<Policy> policy = policy_from_name(options.policy);
  if (!policy) return fail(policy.error());
  how.policy = *policy;
  const Result<std::uint32_t> depth = depth_from_text(options.depth);
  if (!depth) return fail(depth.error());
  how.depth = *depth;
  if (!options.measure.empty()) {
    const Result<Measure> measure = measure_from_name(options.measure);
    if (!measure) return fail(measure.error());
    how.measure = *measure;
  }
  if (!options.risk.empty()) {
    Result<RiskMeasure> risk = risk_from_name(options.risk);
    if (!risk) {
      risk.error().reason = "--risk: " + risk.error().reason;
      return fail(risk.error());
    }
    how.risk = *risk;
  }
  how.sampled_futures = options.futures;
  const Result<Infeasible> infeasible = infeasible_from_name(options.infeasible);
  if (!infeasible) return fail(infeasible.error());
  how.infeasible = *infeasible;
  const Result<RankOrder> order = order_from_name(options.order);
  if (!order) return fail(order.error());
  how.order = *order;
  how.smooth = options.smooth;
  // The table alone shows no more.
  const bool in_full = options.json || !options.report.empty() || !options.damage_folder.empty();
  if (!in_full && options.top > 0) how.damaged_places = options.top;
  if (const Result<BuildOptions> build = options.tree.build_options(); !build) {
    return fail(build.error());
  }
  Result<Scenario> scenario = read_scenario(options);
  if (!scenario) return fail(name_allow(scenario.error()));
  const Result<HarmOptions> harm = read_harm(options, *scenario);
  if (!harm) return fail(harm.error());
  how.harm = *harm;
  const bool is_shown = !options.report.empty() || !options.animation.empty();
  const bool can_play = is_played(options, *scenario);
  if (!options.animation.empty() && !can_play) {
    return fail(Error{ErrorCode::limit_exceeded,
                      shown_name(options.scenario),
                      {},
                      fmt::format("has more than {} candidates, whose motion --animation would "
                                  "have to record",
                                  most_played_candidates),
                      "list fewer candidates or make the grid coarser"});
  }
  how.records_motion = options.motion || (is_shown && can_play);
  // Where the answer goes is seen to before the work.
  std::vector<std::string> inputs{options.scenario, options.profile};
  for (const ScenarioModel& model : scenario->models) inputs.push_back(model.path);
  if (const Status sound = check_files(options, inputs); !sound) return fail(sound.error());
  inputs.push_back(options.animation);  // nor may a file of --damage replace it
  DamageOptions damage{options.damage_folder, options.damage_top, inputs, options.report};
  damage.workers = options.workers;
  if (!options.damage_folder.empty()) {
    if (const Status sound = check_damage_folder(damage); !sound) return fail(sound.error());
  }
  const std::string scenario_file = shown_name(options.scenario);
  std::vector<std::string> warnings;
  const Result<std::vector<Model>> models =
      load_models(*scenario, scenario_file, options.tree, warnings);
  if (!models) return fail(models.error());
  const auto text_of = [&](const RankResult& result, std::vector<std::string> more) {
    if (options.json) return ranking_json(*scenario, *models, result, more);
    // A page on standard output stands alone.
    if (is_standard(options.report)) return std::string();
    RankingTextOptions text;
    text.top = options.top;
    text.colours = colours_wanted();
    text.width = terminal_width();
    return ranking_text(*scenario, *models, result, text);
  };
  auto ends_itself = std::make_optional<EndsItself>();
  Result<RankResult> ranked = [&] {
    Progress progress("ranking");
    how.on_progress = [&](std::size_t evaluated, std::size_t candidates) {
      progress.update(evaluated, candidates);
      return !is_interrupted();
    };
    return options.bounded() ? rank_within(*scenario, *models, how, budget_of(options))
                             : rank(*scenario, *models, how);
  }();
  if (!ranked) {
    Error error = ranked.error();
    if (error.file.empty()) error.file = scenario_file;
    return fail(error);
  }
  ranked->has_motion = options.motion;  // what the page plays is no part of the JSON answer
  if (is_interrupted()) {
    warnings.push_back(ranking_progress(*ranked));
    if (is_shown || !options.damage_folder.empty()) {
      warnings.back() += "; files of --damage, --animation and --report are not written";
    }
    print(text_of(*ranked, warnings));
    say("interrupted: " + warnings.back());
    return exit_budget;
  }
  ends_itself.reset();
  const bool answered = ranked->complete || (options.first_place && ranked->proved);
  const PartialAnswer partial([&, so_far = warnings] {
    return Interruption{text_of(*ranked, so_far),
                        "the ranking is complete, files of --damage, --animation and --report are "
                        "missing"};
  });
  if (!options.damage_folder.empty()) {
    const Status written = write_damage(damage, *scenario, *models, *ranked);
    if (!written) return fail(written.error());
  }
  if (!options.animation.empty()) {
    const Status written = write_animation(options, *scenario, *models, *ranked);
    if (!written) return fail(written.error());
  }
  if (!options.report.empty()) {
    const Progress progress("writing the report");
    const Status written =
        write_file(options.report, html_page, html_report(*scenario, *models, *ranked));
    if (!written) return fail(written.error());
  }
  warn_of_end(options, *ranked, answered, warnings);
  print(text_of(*ranked, warnings));
  for (const std::string& doubt : ranking_doubts(*scenario, *models, *ranked)) {
    warn(scenario_file, doubt);
  }
  return answered ? exit_done : exit_budget;
}

constexpr const char* rank_epilogue =
    R"(Least harmful first. The scenario's format is data/scenario.schema.json. Meshes and model files have to lie in the
scenario's folder or below, or below a folder above it that holds a file named crashrank.root.

Examples:
  crashrank rank scenario.json
  crashrank rank scenario.json --measure closing-energy --json --damage out
  crashrank rank scenario.json --profile weights.json
  crashrank rank scenario.json --report report.html --animation winner.glb
  crashrank rank scenario.json --deadline-ms 20 --workers 2)";

}  // namespace

void add_rank(CLI::App& app, Action& action) {
  const auto options = std::make_shared<RankArguments>();
  CLI::App* command =
      app.add_subcommand("rank", "Rank the crashes that a scenario leaves, least harmful first");
  add_file(*command, "SCENARIO", options->scenario,
           "Scenario file; - is standard input, its meshes then relative to this folder")
      ->required();
  add_choice(*command, "--measure", options->measure, "What is compared",
             {"harm", "delta-v", "energy", "intrusion", "polygons", "area", "closing-energy"},
             "as the scenario says, else harm");
  add_choice(*command, "--risk-model", options->risk_model, "Curves that harm is counted with",
             {"tum", "malliaris-monfort", "malliaris-rosen", "joksch-monfort"},
             "as the scenario says, else tum");
  command
      ->add_option("--risk", options->risk,
                   "How the scores of several futures become one: expected, worst, cvar:X or "
                   "quantile:X with X above 0 and below 1 [default: as the scenario says, else "
                   "expected]")
      ->type_name("RISK");
  add_count(*command, "--futures", options->futures,
            "Futures that are drawn where combinations of predictions are more than 1024 or "
            "positions, headings or speeds have errors",
            1, max_sampled_futures);
  add_choice(
      *command, "--infeasible", options->infeasible,
      "What becomes of manoeuvres beyond grip, engine, brakes or steering: behind all others, "
      "left out, or ranked like all others",
      {"demote", "drop", "keep"});
  add_choice(*command, "--order", options->order,
             "What orders the candidates: the score, or the upper end of its interval; upper needs "
             "an answer without a deadline or budget",
             {"score", "upper"});
  command->add_flag("--smooth", options->smooth,
                    "Score by the mean over small errors of every state (5 cm, 0.2 degrees, 0.1 "
                    "m/s where none are stated), so that no centimetre decides; takes 16 times as "
                    "long, and says where it turns the order");
  add_file(*command, "--profile", options->profile,
           "Weights of harm and ranges of uncertain parameters: a file after "
           "data/profile.schema.json, which overrides the scenario");
  command->add_flag("--json", options->json, "Answer in JSON, every candidate");
  command->add_flag(
      "--motion", options->motion,
      "With --json and without a deadline: the simulated motion of every body that is "
      "hit, in the likeliest future");
  add_count(*command, "--top", options->top, "Candidates in the table, 0 for all", 0, 1'000'000);
  add_count(*command, "--workers", options->workers,
            "Threads that share the work; the answer is the same", 1, max_workers,
            "as many as there are processors");
  command
      ->add_option(
          "--deadline-ms", options->deadline_ms,
          "Answer within this time, in what is known by then; counted from the call, "
          "meshes and trees being ready; ranges of what is not known are varied after it, and of a "
          "complete answer alone; polygons and area end the candidate that they have begun "
          "[0 to 1e9, default: none]")
      ->type_name("MS")
      ->check(number_from(0.0, 1e9, "milliseconds"));
  add_count(*command, "--work-budget", options->work_budget,
            "Answer in what is known after this many tests of boxes, triangles and facets; the "
            "same on every machine",
            0, 999'999'999'999'999'999U, "none");
  command->add_flag(
      "--first-place", options->first_place,
      "Look closer only at those that can still be first, and answer when that is proved");
  const CLI::Option* const policy = add_choice(*command, "--policy", options->policy,
                                               "How a job finds its worker", policy_names());
  const CLI::Option* const depth = add_depth(*command, options->depth);
  // An unset variable of a script must not lose the answer, and a folder is no stream.
  const CLI::Validator named(
      [](const std::string& text) {
        return text.empty() || text == "-" ? "'" + text + "' names no folder" : std::string();
      },
      "", "named");
  command
      ->add_option("--damage", options->damage_folder,
                   "Folder for GLB, PLY and PNG of the bodies with their damage in red")
      ->type_name("FOLDER")
      ->check(named);
  add_file(*command, "--report", options->report,
           "HTML page with the decision, the scene as it moves, and all candidates; - is standard "
           "output, without the table")
      ->check([](const std::string& text) {
        return text.empty() ? std::string("names no file") : std::string();
      });
  add_file(*command, "--animation", options->animation,
           "GLB file (glTF 2.0 binary) for Blender and other viewers: what the report plays of the "
           "winner, all bodies with whole meshes, as linear key frames of one animation; metres, "
           "seconds, without damage; for up to 1000 candidates and without a deadline")
      ->check([](const std::string& text) {
        return is_standard(text) ? std::string("needs a file: the answer goes to standard output")
                                 : std::string();
      });
  add_file(*command, "--mcap", options->mcap,
           "The scene of the report for Foxglove, and a layout beside it; by the Python package's "
           "crashrank alone");
  add_count(*command, "--damage-top", options->damage_top,
            "Colliding candidates written there, best first, 0 for all", 0, 1'000'000);
  add_allowed_folders(*command, options->allowed_folders);
  options->tree.add_to(*command);
  command->footer(rank_epilogue);
  command->callback([options, policy, depth, &action] {
    options->engine_given = policy->count() > 0 || depth->count() > 0;
    action = [options] { return run(*options); };
  });
}

}  // namespace crashrank::cli
