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
#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/report/ranking.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <atomic>
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

/// Time for the first answer, and for its explanation, s: with the page it is there within a second
/// of a save. A design choice.
constexpr double first_answer_s = 0.15;

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

  /// Whether a file has changed; looks ten times a second at most, and says no between. `next_look`
  /// is this function's own.
  bool has_changed(std::atomic<std::int64_t>& next_look) const {
    constexpr std::chrono::steady_clock::duration pause = std::chrono::milliseconds(100);
    const std::int64_t now = std::chrono::steady_clock::now().time_since_epoch().count();
    std::int64_t due = next_look;
    if (now < due || !next_look.compare_exchange_strong(due, now + pause.count())) return false;
    return stamps_of(files) != stamps;
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

/// Reads the scenario, with the models of `known` if they are the same; `watched` becomes the files
/// that this depends on, also after an error.
Result<Shown> read_anew(const ViewArguments& options,
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
  return shown;
}

class Viewer {
public:
  Viewer(const ViewArguments& options, PageServer server)
      : options_(options), server_(std::move(server)) {}

  /// Publishes the report of the files as they are now: a first answer where the whole one takes
  /// longer, and then that, unless the files change before it is there.
  Status show_anew() {
    Result<Shown> next = read_anew(options_, shown_.loaded, watched_);
    if (!next) return next.error();
    const View<const Model> models(next->loaded->models);
    RankOptions how;
    how.workers = options_.workers;
    RankBudget soon;
    soon.deadline_s = first_answer_s;
    Result<RankResult> first = rank_within(next->scenario, models, how, soon, first_answer_s);
    if (!first) return in_scenario(first.error());
    if (!first->complete) {
      shown_ = *next;
      shown_.ranked = std::move(*first);
      publish({});
    }
    how.records_motion = candidate_count(next->scenario) <= most_played_candidates;
    Progress progress("ranking");
    std::atomic<std::int64_t> next_look{0};
    how.on_progress = [&](std::size_t evaluated, std::size_t candidates) {
      progress.update(evaluated, candidates);
      return !is_interrupted() && !watched_.has_changed(next_look);
    };
    Result<RankResult> whole = rank(next->scenario, models, how);
    if (!whole) return in_scenario(whole.error());
    if (!whole->complete) return Success{};
    shown_ = std::move(*next);
    shown_.ranked = std::move(*whole);
    publish({});
    return Success{};
  }

  /// Publishes what was ranked last, with a line above it: an error of newer files, or nothing.
  void publish(std::string notice) {
    HtmlReportOptions page;
    page.still = false;
    page.served_version = server_.next_version();
    page.notice = std::move(notice);
    server_.publish(html_report(shown_.scenario, shown_.loaded->models, shown_.ranked, page));
    if (is_announced_) return;
    is_announced_ = true;
    print(server_.url() + "\n");
    std::fflush(stdout);
  }

  /// Waits for a change of the files; false after an interruption.
  bool wait() const { return watched_.wait(); }

private:
  Error in_scenario(Error error) const {
    if (error.file.empty()) error.file = options_.scenario;
    return error;
  }

  const ViewArguments& options_;
  PageServer server_;
  Watched watched_;
  Shown shown_;
  bool is_announced_ = false;
};

int run(const ViewArguments& options) {
  if (is_standard(options.scenario)) {
    return fail(make_error(ErrorCode::usage, "standard input cannot be ranked anew",
                           "name a scenario file"));
  }
  const EndsItself ends_itself;
  Result<PageServer> server = PageServer::start(options.port);
  if (!server) return fail(server.error());
  Viewer viewer(options, std::move(*server));
  const Status first = viewer.show_anew();
  if (is_interrupted()) return exit_done;
  if (!first) return fail(first.error());
  while (viewer.wait()) {
    const Status shown = viewer.show_anew();
    if (is_interrupted()) break;
    if (shown) continue;
    fail(shown.error());
    viewer.publish(shown.error().message() + " (below: the report before this error)");
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
      "file that it names is\nsaved, and the page reloads itself. Where the whole ranking takes "
      "longer, a first answer is\nshown until it is there. While the scenario has an error, the "
      "page shows it above the last\nreport; an error at the start ends the command, with the "
      "exit code of rank.\n\n"
      "Example:\n  crashrank view scenario.json --port 8000");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
