#include "command.hpp"
#include "console.hpp"
#include "interrupt.hpp"
#include "json.hpp"
#include "options.hpp"
#include "page_server.hpp"
#include "scenario_file.hpp"
#include "streams.hpp"

#include "crashrank/mesh/profile.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/report/ranking.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

struct ViewArguments {
  std::string scenario;
  unsigned port = 0;
  unsigned workers = std::clamp(std::thread::hardware_concurrency(), 1U, max_workers);
  std::vector<std::string> allowed_folders;
};

/// Seconds and nanoseconds of a file's last change, size and inode; all 0 if it is not there.
using Stamp = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::uint64_t>;

std::vector<Stamp> stamps_of(const std::vector<std::string>& files) {
  std::vector<Stamp> stamps;
  for (const std::string& file : files) {
    struct stat is {};
    if (stat(file.c_str(), &is) != 0) is = {};
    stamps.emplace_back(is.st_mtim.tv_sec, is.st_mtim.tv_nsec, is.st_size, is.st_ino);
  }
  return stamps;
}

/// Files as they were before they were read.
struct Watched {
  std::vector<std::string> files;
  std::vector<Stamp> stamps;

  void add(const std::string& file) {
    files.push_back(file);
    stamps.push_back(stamps_of({file}).front());
  }

  /// Waits until a file has changed and stays as it is for a moment; false after an interruption.
  bool wait() const {
    constexpr std::chrono::milliseconds pause(50);
    std::vector<Stamp> before = stamps;
    while (!is_interrupted()) {
      std::this_thread::sleep_for(pause);
      std::vector<Stamp> now = stamps_of(files);
      if (now == before && now != stamps) return true;
      before = std::move(now);
    }
    return false;
  }
};

/// Models that serve until their files or their entries in the scenario change.
struct LoadedModels {
  std::string entries;                ///< "models" of the scenario file, as JSON
  std::vector<Stamp> stamps;          ///< of the scenario's files but the first
  std::vector<ScenarioModel> stated;  ///< with what model files state
  std::vector<Model> models;          ///< with outlines
};

/// What was ranked last without an error.
struct Shown {
  Scenario scenario;
  std::shared_ptr<const LoadedModels> loaded;
  RankResult ranked;
};

Result<std::shared_ptr<const LoadedModels>> load_anew(Scenario& scenario, const std::string& file,
                                                      LoadedModels loaded) {
  std::vector<std::string> warnings;
  Result<std::vector<Model>> models = load_models(scenario, file, {}, warnings);
  if (!models) return models.error();
  for (Model& model : *models) {
    if (model.profile) continue;
    Result<Profile> profile = make_profile(model.mesh);
    if (profile) model.profile = std::make_shared<const Profile>(std::move(*profile));
  }
  loaded.models = std::move(*models);
  loaded.stated = scenario.models;
  return std::make_shared<const LoadedModels>(std::move(loaded));
}

/// Reads and ranks the scenario, with the models of `known` if they are the same; `watched` becomes
/// the files that this depends on, also after an error.
Result<Shown> rank_anew(const ViewArguments& options,
                        const std::shared_ptr<const LoadedModels>& known, Watched& watched) {
  watched = {};
  watched.add(options.scenario);
  const Result<std::string> text = read_text(options.scenario, scenario_limits::file_bytes);
  if (!text) return text.error();
  Result<Scenario> scenario = load_scenario(*text, options.scenario, {options.allowed_folders});
  if (!scenario) return name_allow(scenario.error());
  for (const ScenarioModel& model : scenario->models) {
    if (!model.path.empty()) watched.add(model.path);
  }
  Shown shown;
  shown.scenario = std::move(*scenario);
  LoadedModels wanted;
  wanted.entries = Json::parse(*text).at("models").dump();
  wanted.stamps.assign(watched.stamps.begin() + 1, watched.stamps.end());
  if (known && known->entries == wanted.entries && known->stamps == wanted.stamps) {
    shown.scenario.models = known->stated;
    shown.loaded = known;
  } else {
    auto loaded = load_anew(shown.scenario, options.scenario, std::move(wanted));
    if (!loaded) return loaded.error();
    shown.loaded = std::move(*loaded);
  }
  RankOptions how;
  how.workers = options.workers;
  how.records_motion = candidate_count(shown.scenario) <= most_played_candidates;
  Progress progress("ranking");
  how.on_progress = [&](std::size_t evaluated, std::size_t candidates) {
    progress.update(evaluated, candidates);
    return !is_interrupted();
  };
  Result<RankResult> ranked = rank(shown.scenario, shown.loaded->models, how);
  if (!ranked) {
    Error error = ranked.error();
    if (error.file.empty()) error.file = options.scenario;
    return error;
  }
  shown.ranked = std::move(*ranked);
  return shown;
}

/// `notice` is an error of the scenario's newest version, or empty.
void publish(PageServer& server, const Shown& shown, std::string notice) {
  HtmlReportOptions page;
  page.still = false;
  page.served_version = server.next_version();
  page.notice = std::move(notice);
  server.publish(html_report(shown.scenario, shown.loaded->models, shown.ranked, page));
}

int run(const ViewArguments& options) {
  if (is_standard(options.scenario)) {
    return fail(make_error(ErrorCode::usage, "standard input cannot be ranked anew",
                           "name a scenario file"));
  }
  const EndsItself ends_itself;
  Result<PageServer> server = PageServer::start(options.port);
  if (!server) return fail(server.error());
  Watched watched;
  Result<Shown> shown = rank_anew(options, nullptr, watched);
  if (is_interrupted()) return exit_done;
  if (!shown) return fail(shown.error());
  publish(*server, *shown, {});
  print(server->url() + "\n");
  std::fflush(stdout);
  while (watched.wait()) {
    Result<Shown> next = rank_anew(options, shown->loaded, watched);
    if (is_interrupted()) break;
    std::string notice;
    if (next) {
      shown = std::move(next);
    } else {
      fail(next.error());
      notice = next.error().message() + " (below: the report before this error)";
    }
    publish(*server, *shown, std::move(notice));
  }
  return exit_done;
}

}  // namespace

void add_view(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand(
      "view", "Show the report of a scenario in a browser, anew whenever its files change");
  add_file(*command, "SCENARIO", options->scenario, "Scenario file")->required();
  add_count(*command, "--port", options->port, "Port of 127.0.0.1 that serves the page", 0, 65535,
            "0: a free one");
  add_count(*command, "--workers", options->workers,
            "Threads that share the work; the answer is the same", 1, max_workers,
            "as many as there are processors");
  add_allowed_folders(*command, options->allowed_folders);
  command->footer(
      "Prints the address of the page, which only this machine can reach, and ends with Ctrl-C, "
      "exit code 0.\nThe scenario is ranked as `crashrank rank` does when it or a mesh or model "
      "file that it names is\nsaved, and the page reloads itself. While the scenario has an error, "
      "the page shows it above the\nlast report; an error at the start ends the command, with the "
      "exit code of rank.\n\n"
      "Example:\n  crashrank view scenario.json --port 8000");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
