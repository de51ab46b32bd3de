#include "crashrank/scenario/scenario.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "scenario/candidate_table.hpp"
#include "scenario/json_object.hpp"
#include "scenario/motion_check.hpp"
#include "scenario/scenario_check.hpp"
#include "scenario/scenario_parse.hpp"
#include "scenario/text_file.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace crashrank {
namespace {

namespace fs = std::filesystem;

constexpr const char* root_marker = "crashrank.root";

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end() || (std::next(end) == folder.end() && end->empty());
}

// In a folder that all users may write to, a marker does not show the owner's intent.
bool anybody_writes(const fs::path& folder) {
  std::error_code error;
  const fs::perms permissions = fs::status(folder, error).permissions();
  return error || (permissions & fs::perms::others_write) != fs::perms::none;
}

// The folder that owns a scenario's files: the nearest one, itself or above, that says so, or else
// its own.
fs::path owning_folder(const fs::path& folder) {
  std::error_code ignored;
  for (fs::path at = folder;; at = at.parent_path()) {
    if (fs::exists(at / root_marker, ignored) && !anybody_writes(at)) return at;
    if (at == at.parent_path()) return folder;
  }
}

Result<std::string> resolve(const std::string& scenario_file, const std::string& mesh,
                            const ScenarioPaths& paths) {
  std::error_code error;
  const fs::path folder =
      fs::weakly_canonical(fs::absolute(scenario_file, error).parent_path(), error);
  if (error) {
    return Error{
        ErrorCode::not_found, scenario_file, {}, "its folder cannot be reached", "check the path"};
  }
  const fs::path path = fs::weakly_canonical(folder / mesh, error);
  if (error) {
    return Error{ErrorCode::bad_input,
                 scenario_file,
                 {},
                 "the path \"" + mesh + "\" cannot be followed: " + error.message(),
                 "check it, and the permissions of the folders on the way"};
  }
  const fs::path owner = owning_folder(folder);
  if (is_below(path, owner)) return path.string();
  for (const std::string& allowed : paths.allowed_folders) {
    const fs::path root = fs::weakly_canonical(fs::absolute(allowed, error), error);
    if (!error && is_below(path, root)) return path.string();
  }
  return Error{ErrorCode::bad_input,
               scenario_file,
               {},
               "\"" + mesh + "\" lies outside the scenario's folder " + owner.string(),
               "copy it there, put an empty file named crashrank.root into the folder that holds "
               "both, or allow its folder when calling"};
}

Status read_table(const std::string& table, const std::string& file, const ScenarioPaths& paths,
                  std::vector<ListedCandidate>& listed) {
  Result<std::string> path = resolve(file, table, paths);
  if (!path) {
    path.error().place = "candidates.table";
    return path.error();
  }
  const Result<std::string> text = detail::read_text_file(*path, scenario_limits::table_bytes,
                                                          "name a table of comma-separated values");
  if (!text) {
    Error error = text.error();
    error.place = "candidates.table of " + file;
    return error;
  }
  return detail::add_candidate_table(*text, *path, listed);
}

/// Finds the mesh of each model that has one.
void resolve_meshes(const std::string& file, const ScenarioPaths& paths, Scenario& scenario,
                    detail::Refusals& refusals) {
  for (ScenarioModel& model : scenario.models) {
    if (model.mesh.empty()) continue;
    Result<std::string> path = resolve(file, model.mesh, paths);
    if (path) {
      model.path = std::move(*path);
      continue;
    }
    path.error().place = "models." + model.name + ".mesh";
    refusals.add(path.error());
  }
}

Result<Scenario> load(const std::string& text, const std::string& file,
                      const ScenarioPaths& paths) {
  Result<detail::ParsedScenario> parsed = detail::parse_scenario_text(text, file);
  if (!parsed) return parsed.error();
  Scenario& scenario = parsed->scenario;
  detail::Refusals refusals;
  resolve_meshes(file, paths, scenario, refusals);
  if (!refusals.ok()) return refusals.errors().front();
  if (!parsed->candidate_table.empty()) {
    const Status read = read_table(parsed->candidate_table, file, paths, scenario.listed);
    if (!read.ok()) return read.error();
  }
  return std::move(scenario);
}

/// Motions that no body has; those of candidates are seen with the ego's mesh.
void check_motions(const Scenario& scenario, detail::Refusals& refusals) {
  const auto check = [&](const ActorMotion& motion, const std::string& place) {
    const Result<Motion> made = make_motion(motion, place);
    const char* const fault = made ? detail::motion_fault(*made, scenario.horizon_s) : nullptr;
    if (!made) refusals.add(made.error());
    if (fault != nullptr) refusals.add(detail::refused_motion(place, "its motion", fault));
  };
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    const std::string place = "actors[" + std::to_string(i) + "]";
    const ScenarioActor& actor = scenario.actors[i];
    if (actor.predictions.empty()) check(actor, place);
    for (std::size_t k = 0; k < actor.predictions.size(); ++k) {
      check(actor.predictions[k], place + ".predictions[" + std::to_string(k) + "]");
    }
  }
  for (std::size_t i = 0; i < scenario.futures.size(); ++i) {
    for (const FutureMotion& moved : scenario.futures[i].motions) {
      check(moved.motion,
            "futures[" + std::to_string(i) + "].motions." + scenario.actors[moved.actor].name);
    }
  }
}

CheckedScenario check(const std::string& text, const std::string& file,
                      const ScenarioPaths& paths) {
  detail::Refusals refusals(true);
  detail::ParsedScenario parsed = detail::parse_scenario_text(text, file, refusals);
  Scenario& scenario = parsed.scenario;
  resolve_meshes(file, paths, scenario, refusals);
  if (!parsed.candidate_table.empty()) {
    const Status read = read_table(parsed.candidate_table, file, paths, scenario.listed);
    if (!read) refusals.add(read.error());
  }
  // Without models every body would be refused once more.
  if (!scenario.models.empty()) {
    detail::check_scenario(scenario, refusals);
    check_motions(scenario, refusals);
  }
  CheckedScenario checked;
  for (const Error& error : refusals.errors()) {
    checked.errors.push_back(detail::error_in_file(error.file.empty() ? file : error.file, error));
  }
  checked.scenario = std::move(scenario);
  return checked;
}

Result<Scenario> read_and_load(const std::string& file, const ScenarioPaths& paths) {
  const Result<std::string> text =
      detail::read_text_file(file, scenario_limits::file_bytes, "name a scenario in JSON");
  if (!text) return text.error();
  return load(*text, file, paths);
}

}  // namespace

Result<std::string> resolve_mesh_path(const std::string& scenario_file, const std::string& mesh,
                                      const ScenarioPaths& paths) {
  return detail::guarded([&] { return resolve(scenario_file, mesh, paths); });
}

Result<Scenario> load_scenario(const std::string& text, const std::string& file,
                               const ScenarioPaths& paths) {
  return detail::guarded([&] { return load(text, file, paths); });
}

CheckedScenario check_scenario(const std::string& text, const std::string& file,
                               const ScenarioPaths& paths) {
  const Result<CheckedScenario> checked =
      detail::guarded([&]() -> Result<CheckedScenario> { return check(text, file, paths); });
  if (checked) return *checked;
  return {{}, {checked.error()}};
}

Result<Scenario> load_scenario_file(const std::string& file, const ScenarioPaths& paths) {
  return detail::guarded([&] { return read_and_load(file, paths); });
}

}  // namespace crashrank
