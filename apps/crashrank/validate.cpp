#include "command.hpp"
#include "console.hpp"
#include "crash_test_rig.hpp"
#include "crash_test_rows.hpp"
#include "json.hpp"
#include "streams.hpp"

#include "crashrank/mesh/import.hpp"
#include "crashrank/report/table.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kmh = 3.6;

struct Options {
  std::string rows;
  std::string car;
  bool json = false;
  bool boxes = false;
};

/// The shipped saloon: beside the program's data when installed, in a folder above the program or
/// the working folder otherwise.
Result<std::string> find_car() {
  constexpr const char* name = "models/sedan.obj";
  std::error_code error;
  std::vector<fs::path> starts;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error) starts.push_back(self.parent_path());
  const fs::path here = fs::current_path(error);
  if (!error) starts.push_back(here);
  for (const fs::path& start : starts) {
    for (fs::path folder = start;; folder = folder.parent_path()) {
      for (const char* data : {"data", "share/crashrank"}) {
        const fs::path path = folder / data / name;
        if (fs::is_regular_file(path, error)) return path.string();
      }
      if (folder == folder.parent_path()) break;
    }
  }
  return make_error(ErrorCode::not_found, "data/models/sedan.obj is not found",
                    "name a car with --car");
}

/// A car with its measures, which stand in models.json beside its mesh.
Result<RigCar> load_car(const std::string& path) {
  constexpr std::size_t most_bytes = std::size_t{4} << 20U;
  const fs::path list = fs::path(path).parent_path() / "models.json";
  const Result<std::string> text = read_text(list.string(), most_bytes);
  if (!text) return text.error();
  const auto refuse = [&](const std::string& reason) {
    Error error = make_error(ErrorCode::bad_input, reason, "see data/models/models.json");
    error.file = list.string();
    return error;
  };
  const Json document = Json::parse(*text, nullptr, false);
  if (!document.is_object() || !document.contains("models") || !document["models"].is_array()) {
    return refuse("is no list of models");
  }
  RigCar car;
  for (const Json& entry : document["models"]) {
    if (!entry.is_object() || entry.value("file", "") != fs::path(path).filename().string()) {
      continue;
    }
    car.wheelbase_m = entry.value("wheelbase_m", 0.0);
    car.width_m = entry.value("width_m", 0.0);
    if (!(car.wheelbase_m > 0.0) || !(car.width_m > 0.0)) break;
  }
  if (!(car.wheelbase_m > 0.0)) return refuse("has no measures of " + path);
  Result<ImportedMesh> imported = import_mesh(path, {});
  if (!imported) return imported.error();
  car.mesh = std::move(imported->mesh);
  return car;
}

/// What one row came to.
struct Outcome {
  ContactOutcome contact;
  double delta_v_mps() const { return contact.a.delta_v_mps.norm(); }
  double yaw_rate_dps() const {
    return contact.a.delta_yaw_rate_radps * (180.0 / std::numbers::pi);
  }
};

Result<std::vector<Outcome>> run_all(const RigCar& car, const std::vector<CrashTestRow>& rows,
                                     RigShape shape, Progress& progress, std::size_t done) {
  std::vector<Outcome> outcomes;
  for (const CrashTestRow& row : rows) {
    Result<ContactOutcome> contact = run_crash_test(car, row.test, shape);
    if (!contact) return contact.error();
    outcomes.push_back({*contact});
    progress.update(++done);
  }
  return outcomes;
}

/// Mean of |simulated − measured| / measured over the rows that were measured.
struct Errors {
  double delta_v = 0.0;
  double yaw_rate = 0.0;
  double worst_delta_v = 0.0;
  std::size_t delta_v_rows = 0;
  std::size_t yaw_rate_rows = 0;
};

double relative(double simulated, double measured) {
  return measured != 0.0 ? simulated / measured - 1.0 : 0.0;
}

Errors errors_of(const std::vector<CrashTestRow>& rows, const std::vector<Outcome>& outcomes) {
  Errors errors;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].measured_delta_v_mps) {
      const double off =
          std::abs(relative(outcomes[i].delta_v_mps(), *rows[i].measured_delta_v_mps));
      errors.delta_v += off;
      errors.worst_delta_v = std::max(errors.worst_delta_v, off);
      ++errors.delta_v_rows;
    }
    if (rows[i].measured_yaw_rate_dps) {
      errors.yaw_rate +=
          std::abs(relative(outcomes[i].yaw_rate_dps(), *rows[i].measured_yaw_rate_dps));
      ++errors.yaw_rate_rows;
    }
  }
  if (errors.delta_v_rows > 0) errors.delta_v /= static_cast<double>(errors.delta_v_rows);
  if (errors.yaw_rate_rows > 0) errors.yaw_rate /= static_cast<double>(errors.yaw_rate_rows);
  return errors;
}

Json errors_json(const Errors& errors) {
  const auto or_null = [](double value, std::size_t rows) {
    return rows > 0 ? Json(value) : Json(nullptr);
  };
  return {{"mean_delta_v_error", or_null(errors.delta_v, errors.delta_v_rows)},
          {"worst_delta_v_error", or_null(errors.worst_delta_v, errors.delta_v_rows)},
          {"mean_yaw_rate_error", or_null(errors.yaw_rate, errors.yaw_rate_rows)}};
}

Json row_json(const CrashTestRow& row, const Outcome& outcome) {
  const ContactOutcome& contact = outcome.contact;
  Json entry{{"id", row.test.id},
             {"delta_v_mps", outcome.delta_v_mps()},
             {"delta_v_x_mps", contact.a.delta_v_mps.x()},
             {"delta_v_y_mps", contact.a.delta_v_mps.y()},
             {"yaw_rate_dps", outcome.yaw_rate_dps()},
             {"slides", contact.slides},
             {"collides", contact.acts},
             {"pdof_deg", contact.a.pdof_deg},
             {"duration_s", contact.duration_s},
             {"dissipated_j", contact.dissipated_j},
             {"deepest_m", contact.a.crush_depth_m}};
  if (row.measured_delta_v_mps) entry["measured_delta_v_mps"] = *row.measured_delta_v_mps;
  if (row.measured_yaw_rate_dps) entry["measured_yaw_rate_dps"] = *row.measured_yaw_rate_dps;
  return entry;
}

std::string percent(double share) { return fmt::format("{:+.0f} %", 100.0 * share); }

std::string measured_text(const std::optional<double>& value, double scale) {
  return value ? fmt::format("{:.1f}", scale * *value) : std::string();
}

std::string table_text(const std::vector<CrashTestRow>& rows, const std::vector<Outcome>& outcomes,
                       const std::vector<Outcome>& boxes) {
  Table table({{"test"},
               {"barrier"},
               {"delta-v km/h: measured", true},
               {"meshes", true},
               {"error", true},
               {"boxes", true},
               {"error", true},
               {"yaw deg/s: measured", true},
               {"meshes", true},
               {"error", true},
               {"boxes", true},
               {"slides"}});
  constexpr std::array<const char*, 4> names{"wall", "flat", "pole", "deformable"};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const CrashTestRow& row = rows[i];
    const Outcome& o = outcomes[i];
    const auto off = [](double simulated, const std::optional<double>& measured) {
      return measured ? percent(relative(simulated, *measured)) : std::string();
    };
    const std::string barrier = fmt::format("{} r {:.0f} mm, {:.0f} %",
                                            names.at(static_cast<std::size_t>(row.test.barrier)),
                                            1e3 * row.test.radius_m, 1e2 * row.test.overlap);
    table.add_row(
        {row.test.id, barrier, measured_text(row.measured_delta_v_mps, kmh),
         fmt::format("{:.1f}", kmh * o.delta_v_mps()),
         off(o.delta_v_mps(), row.measured_delta_v_mps),
         fmt::format("{:.1f}", kmh * boxes[i].delta_v_mps()),
         off(boxes[i].delta_v_mps(), row.measured_delta_v_mps),
         measured_text(row.measured_yaw_rate_dps, 1.0), fmt::format("{:.0f}", o.yaw_rate_dps()),
         off(o.yaw_rate_dps(), row.measured_yaw_rate_dps),
         fmt::format("{:.0f}", boxes[i].yaw_rate_dps()), o.contact.slides ? "yes" : "no"});
  }
  std::string text = table.text(colours_wanted());
  const auto summary = [&](const char* what, const Errors& e) {
    if (e.delta_v_rows == 0) return;
    text += fmt::format("{}: |delta-v| off by {:.1f} % in the mean, {:.1f} % at worst", what,
                        100.0 * e.delta_v, 100.0 * e.worst_delta_v);
    if (e.yaw_rate_rows > 0) {
      text += fmt::format("; yaw rate by {:.1f} % in the mean", 100.0 * e.yaw_rate);
    }
    text += "\n";
  };
  summary("meshes", errors_of(rows, outcomes));
  summary("their boxes", errors_of(rows, boxes));
  return text;
}

int run(const Options& options) {
  constexpr std::size_t most_bytes = std::size_t{16} << 20U;
  const Result<std::string> text = read_text(options.rows, most_bytes);
  if (!text) return fail(text.error());
  const Result<std::vector<CrashTestRow>> rows = parse_crash_tests(*text);
  if (!rows) {
    Error error = rows.error();
    error.file = options.rows;
    return fail(error);
  }
  std::string path = options.car;
  if (path.empty()) {
    const Result<std::string> found = find_car();
    if (!found) return fail(found.error());
    path = *found;
  }
  const Result<RigCar> car = load_car(path);
  if (!car) return fail(car.error());

  const bool only_boxes = options.boxes;
  const bool both = !options.json && !only_boxes;
  Progress progress("crashing", rows->size() * (both ? 2 : 1));
  const Result<std::vector<Outcome>> outcomes =
      run_all(*car, *rows, only_boxes ? RigShape::boxes : RigShape::meshes, progress, 0);
  if (!outcomes) return fail(outcomes.error());
  if (options.json) {
    Json entries = Json::array();
    for (std::size_t i = 0; i < rows->size(); ++i) {
      entries.push_back(row_json((*rows)[i], (*outcomes)[i]));
    }
    Json document{{"rows", std::move(entries)}};
    document["shape"] = only_boxes ? "boxes" : "meshes";
    document.update(errors_json(errors_of(*rows, *outcomes)));
    print_json(document);
    return exit_done;
  }
  Result<std::vector<Outcome>> boxes =
      both ? run_all(*car, *rows, RigShape::boxes, progress, rows->size()) : outcomes;
  if (!boxes) return fail(boxes.error());
  print(table_text(*rows, *outcomes, *boxes));
  return exit_done;
}

constexpr const char* epilogue =
    R"(A car's mesh is stretched to each row's size and mass and driven into the barrier: first contact of
the meshes, then the crush phase, one set of parameters for all rows. Columns of ROWS.csv:
id,length_m,width_m,height_m,wheelbase_m,mass_kg,izz_kgm2,barrier,radius_m,overlap,speed_mps
(izz_kgm2 may be empty; barrier is wall, flat, pole or deformable, on the car's left). Columns
measured_delta_v_mps and measured_yaw_rate_dps are compared with. Vectors are in the car's axes
before the crash: a car that is stopped has a negative delta_v_x_mps; yaw to the left is positive.

Example:
  crashrank validate data/validation/small_overlap.csv)";

}  // namespace

void add_validate(CLI::App& app, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("validate", "Simulate measured crash tests from meshes");
  command->add_option("ROWS", options->rows, "Table of tests; - is standard input")->required();
  command->add_option("--car", options->car,
                      "Mesh of the car, listed in models.json beside it (default: the shipped "
                      "saloon)");
  command->add_flag("--json", options->json, "Answer in JSON");
  command->add_flag("--boxes", options->boxes, "Replace car and barrier by their boxes");
  command->footer(epilogue);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
