#include "command.hpp"
#include "console.hpp"
#include "crash_test_pairs.hpp"
#include "crash_test_rig.hpp"
#include "crash_test_rows.hpp"
#include "interrupt.hpp"
#include "json.hpp"
#include "options.hpp"
#include "scenario_file.hpp"
#include "streams.hpp"
#include "validate_pairs.hpp"

#include "crashrank/internal/report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

struct ValidateArguments {
  std::string rows;
  std::string car;
  std::string plot;
  bool json = false;
  bool boxes = false;

  const char* shape() const { return boxes ? "boxes" : "meshes"; }
};

int fail_in(const std::string& file, Error error) {
  if (error.file.empty()) error.file = file;
  return fail(error);
}

/// Result of one row.
struct Outcome {
  Crash crash;
  const BodyOutcome& car() const { return crash.severity.ego; }
  double delta_v_mps() const { return car().delta_v_mps; }
  double yaw_rate_dps() const { return car().yaw_rate_change_radps * (180.0 / std::numbers::pi); }
};

/// Of as many rows as have been run, which an interruption asks for.
struct Outcomes {
  std::mutex mutex;
  std::vector<Outcome> list;
};

Status run_row(const RigCar& car, const CrashTestRow& row, RigShape shape, Progress& progress,
               Outcomes& outcomes) {
  Result<Crash> crash = run_crash_test(car, row.test, shape);
  if (!crash) return crash.error();
  const std::lock_guard<std::mutex> lock(outcomes.mutex);
  outcomes.list.push_back({std::move(*crash)});
  progress.advance();
  return Success{};
}

TestErrors errors_of(const std::vector<CrashTestRow>& rows, const std::vector<Outcome>& outcomes) {
  TestErrors errors;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    errors.add_delta_v(outcomes[i].delta_v_mps(), rows[i].measured_delta_v_mps);
    errors.add_yaw_rate(outcomes[i].yaw_rate_dps(), rows[i].measured_yaw_rate_dps);
  }
  errors.finish();
  return errors;
}

Json row_json(const CrashTestRow& row, const Outcome& outcome) {
  const ContactSeverity& severity = outcome.crash.severity;
  Json entry{{"id", row.test.id},
             {"delta_v_mps", outcome.delta_v_mps()},
             {"delta_v_x_mps", outcome.car().delta_v_x_mps},
             {"delta_v_y_mps", outcome.car().delta_v_y_mps},
             {"yaw_rate_dps", outcome.yaw_rate_dps()},
             {"slides", severity.slides},
             {"collides", outcome.crash.acts},
             {"pdof_deg", outcome.car().pdof_deg},
             {"duration_s", severity.duration_s},
             {"dissipated_j", severity.dissipated_j},
             {"deepest_m", outcome.car().crush_m}};
  if (row.measured_delta_v_mps) entry["measured_delta_v_mps"] = *row.measured_delta_v_mps;
  if (row.measured_yaw_rate_dps) entry["measured_yaw_rate_dps"] = *row.measured_yaw_rate_dps;
  return entry;
}

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
  constexpr std::array<const char*, 5> names{"wall", "flat", "pole", "deformable", "full"};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const CrashTestRow& row = rows[i];
    const Outcome& o = outcomes[i];
    std::string barrier = names.at(static_cast<std::size_t>(row.test.barrier));
    if (row.test.barrier != Barrier::full) {
      barrier +=
          fmt::format(" r {:.0f} mm, {:.0f} %", 1e3 * row.test.radius_m, 1e2 * row.test.overlap);
    }
    table.add_row({row.test.id, barrier, measured_text(row.measured_delta_v_mps, kmh_per_mps),
                   fmt::format("{:.1f}", kmh_per_mps * o.delta_v_mps()),
                   relative_error_text(o.delta_v_mps(), row.measured_delta_v_mps),
                   fmt::format("{:.1f}", kmh_per_mps * boxes[i].delta_v_mps()),
                   relative_error_text(boxes[i].delta_v_mps(), row.measured_delta_v_mps),
                   measured_text(row.measured_yaw_rate_dps, 1.0),
                   fmt::format("{:.0f}", std::round(o.yaw_rate_dps()) + 0.0),
                   relative_error_text(o.yaw_rate_dps(), row.measured_yaw_rate_dps),
                   fmt::format("{:.0f}", std::round(boxes[i].yaw_rate_dps()) + 0.0),
                   o.crash.severity.slides ? "yes" : "no"});
  }
  std::string text = table.text(colours_wanted());
  text += errors_of(rows, outcomes).text("meshes");
  text += errors_of(rows, boxes).text("their boxes");
  return text;
}

std::string barriers_text(const ValidateArguments& options, const std::vector<CrashTestRow>& rows,
                          const std::vector<Outcome>& outcomes, const std::vector<Outcome>& boxes) {
  if (!options.json) return table_text(rows, outcomes, boxes);
  Json entries = Json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) entries.push_back(row_json(rows[i], outcomes[i]));
  Json document{{"rows", std::move(entries)}};
  document["shape"] = options.shape();
  document.update(errors_of(rows, outcomes).json());
  return json_text(document);
}

template <class T> std::vector<T> first_of(const std::vector<T>& all, std::size_t count) {
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

ComparedShape compare_barriers(const std::vector<CrashTestRow>& rows,
                               const std::vector<Outcome>& outcomes, const std::string& shape) {
  ComparedShape compared{shape, {}, {}};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    compared.add(rows[i].test.id, outcomes[i].delta_v_mps(), rows[i].measured_delta_v_mps,
                 outcomes[i].yaw_rate_dps(), rows[i].measured_yaw_rate_dps);
  }
  return compared;
}

Status write_plot(const ValidateArguments& options, const std::vector<ComparedShape>& shapes) {
  if (options.plot.empty()) return Success{};
  Result<OutputFile> out = OutputFile::open(options.plot, svg_picture);
  if (!out) return out.error();
  out->write(validate_plot("Crash tests of " + shown_name(options.rows), shapes));
  return out->close();
}

template <class T> bool is_measured(const T& row) {
  return row.measured_delta_v_mps || row.measured_yaw_rate_dps;
}

int run_barriers(const ValidateArguments& options, const RigCar& car,
                 const std::vector<CrashTestRow>& rows) {
  const bool both = !options.json && !options.boxes;
  Progress progress("crashing", rows.size() * (both ? 2 : 1));
  Outcomes outcomes;
  Outcomes boxes;
  const PartialAnswer partial([&] {
    const std::lock_guard<std::mutex> lock(outcomes.mutex);
    const std::lock_guard<std::mutex> lock_boxes(boxes.mutex);
    const std::size_t done = both ? boxes.list.size() : outcomes.list.size();
    Interruption known{{}, fmt::format("{} of {} tests are complete", done, rows.size())};
    if (done == 0) return known;
    known.answer = barriers_text(options, first_of(rows, done), first_of(outcomes.list, done),
                                 first_of(both ? boxes.list : outcomes.list, done));
    return known;
  });
  const RigShape shape = options.boxes ? RigShape::boxes : RigShape::meshes;
  for (const CrashTestRow& row : rows) {
    if (Status run = run_row(car, row, shape, progress, outcomes); !run) return fail(run.error());
    if (!both) continue;
    if (Status run = run_row(car, row, RigShape::boxes, progress, boxes); !run) {
      return fail(run.error());
    }
  }
  std::vector<ComparedShape> shapes{compare_barriers(rows, outcomes.list, options.shape())};
  if (both) shapes.push_back(compare_barriers(rows, boxes.list, "boxes"));
  if (const Status written = write_plot(options, shapes); !written) return fail(written.error());
  print(barriers_text(options, rows, outcomes.list, both ? boxes.list : outcomes.list));
  return exit_done;
}

std::string pairs_answer(const ValidateArguments& options, const std::vector<PairTest>& tests,
                         const std::vector<PairOutcome>& outcomes) {
  if (!options.json) return pairs_text(tests, outcomes);
  Json document = pairs_json(tests, outcomes);
  document["shape"] = options.shape();
  return json_text(document);
}

int run_pairs(const ValidateArguments& options, const RigCar& car,
              const std::vector<PairTest>& tests) {
  const RigShape shape = options.boxes ? RigShape::boxes : RigShape::meshes;
  Progress progress("crashing", tests.size());
  std::mutex mutex;
  std::vector<PairOutcome> outcomes;
  const PartialAnswer partial([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    Interruption known{{},
                       fmt::format("{} of {} tests are complete", outcomes.size(), tests.size())};
    if (outcomes.empty()) return known;
    known.answer = pairs_answer(options, first_of(tests, outcomes.size()), outcomes);
    return known;
  });
  for (const PairTest& test : tests) {
    Result<PairOutcome> outcome = run_pair_test(car, test, shape);
    if (!outcome) return fail_in(options.rows, outcome.error());
    const std::lock_guard<std::mutex> lock(mutex);
    outcomes.push_back(std::move(*outcome));
    progress.advance();
  }
  if (const Status written = write_plot(options, {compare_pairs(tests, outcomes, options.shape())});
      !written) {
    return fail(written.error());
  }
  print(pairs_answer(options, tests, outcomes));
  return exit_done;
}

int run(const ValidateArguments& options) {
  if (is_standard(options.plot)) {
    return fail(
        make_error(ErrorCode::usage, "--plot needs a file: the answer goes to standard output"));
  }
  constexpr std::size_t most_bytes = std::size_t{16} << 20U;
  const Result<std::string> text = read_text(options.rows, most_bytes);
  if (!text) return fail(text.error());
  const Result<TestTable> table = TestTable::parse(*text);
  if (!table) return fail_in(options.rows, table.error());
  const bool pairs = is_pair_table(*table);
  Result<std::vector<CrashTestRow>> rows = std::vector<CrashTestRow>();
  Result<std::vector<PairTest>> tests = std::vector<PairTest>();
  if (pairs) {
    tests = read_pair_rows(*table);
  } else {
    rows = read_barrier_rows(*table);
  }
  if (!tests) return fail_in(options.rows, tests.error());
  if (!rows) return fail_in(options.rows, rows.error());
  const bool can_be_drawn = std::any_of(rows->begin(), rows->end(), is_measured<CrashTestRow>) ||
                            std::any_of(tests->begin(), tests->end(), [](const PairTest& test) {
                              return is_measured(test.cars[0]) || is_measured(test.cars[1]);
                            });
  if (!options.plot.empty() && !can_be_drawn) {
    return fail_in(options.rows,
                   make_error(ErrorCode::bad_input, "no row has a value for --plot to compare with",
                              "fill in a column measured_..., or leave out --plot"));
  }
  std::string path = options.car;
  if (path.empty()) {
    const Result<std::string> found = find_rig_car();
    if (!found) return fail(found.error());
    path = *found;
  }
  if (const Status sound = can_be_written(options.plot, svg_picture, {options.rows, path});
      !sound) {
    return fail(sound.error());
  }
  const Result<RigCar> car = load_rig_car(path);
  if (!car) return fail(car.error());
  return pairs ? run_pairs(options, *car, *tests) : run_barriers(options, *car, *rows);
}

constexpr const char* validate_epilogue =
    R"(A car mesh is stretched to each row's size and mass and crashed: first contact of the meshes, then
the contact as `rank` simulates it, with one set of parameters for all rows. Values in columns
measured_... are compared with. The columns decide between two kinds of ROWS.csv:

Crashes into a barrier:
id,length_m,width_m,height_m,wheelbase_m,mass_kg,izz_kgm2,barrier,radius_m,overlap,speed_mps
(izz_kgm2 may be empty; barrier is wall, flat, pole or deformable, on the car's left, or full, a
wall over the whole width), measured_delta_v_mps, measured_yaw_rate_dps. Vectors are in the car's
axes before the crash: a car that is stopped has a negative delta_v_x_mps.

Crashes between two cars: id, and for N = 1 and 2
lengthN_m,widthN_m,heightN_m,wheelbaseN_m,rear_overhangN_m,massN_kg,izzN_kgm2,
cg_ahead_of_rear_axleN_m,xN_m,yN_m,headingN_deg,speedN_mps (izzN_kgm2 may be empty; position of
the centre of mass at first contact or before), measured_delta_vN_mps, measured_yaw_rateN_dps.
Yaw to the left is positive.

Examples:
  crashrank validate data/validation/small_overlap.csv --plot small_overlap.svg
  crashrank validate data/validation/car_to_car.csv --json)";

}  // namespace

void add_validate(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ValidateArguments>();
  CLI::App* command = app.add_subcommand("validate", "Simulate measured crash tests from meshes");
  add_file(*command, "ROWS", options->rows, "Table of tests; - is standard input")->required();
  add_file(*command, "--car", options->car,
           "Mesh of the car, listed in models.json beside it [default: the shipped saloon]");
  command->add_flag("--json", options->json, "Answer in JSON");
  add_file(*command, "--plot", options->plot,
           "Draw simulated over measured values into this SVG file, a panel a quantity, with the "
           "lines of equality and of 20 % more and less");
  command->add_flag("--boxes", options->boxes, "Replace both bodies by their bounding boxes");
  command->footer(validate_epilogue);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
