#include "command.hpp"
#include "console.hpp"
#include "engine.hpp"
#include "interrupt.hpp"
#include "json.hpp"
#include "mesh_arguments.hpp"
#include "options.hpp"
#include "poses.hpp"
#include "streams.hpp"
#include "sweep_plot.hpp"
#include "tree_arguments.hpp"

#include "crashrank/dispatch/study/study.hpp"
#include "crashrank/internal/report/table.hpp"
#include "crashrank/model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

struct SweepArguments {
  std::string a;
  std::string b;
  MeshArguments mesh;
  SecondMeshArguments mesh_b;
  TreeArguments tree;
  std::string poses_file;
  std::string depths = "1:16";
  std::string policies = "all";
  std::string store = "private";
  std::string kernel = "scalar";
  std::string plot;
  std::uint32_t workers = 4;
  std::uint32_t buffer = 8;
  std::size_t memory = 0;
  std::uint32_t repeat = 5;
  bool batch = false;
  bool json = false;
  bool csv = false;
};

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::optional<std::uint32_t> whole_number(const std::string& text) {
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  return number;
}

/// "1:16", "8", or a list of such, separated by commas.
Result<std::vector<std::uint32_t>> parse_depths(const std::string& text) {
  std::vector<std::uint32_t> depths;
  for (const std::string& part : split(text, ',')) {
    const std::vector<std::string> ends = split(part, ':');
    const std::optional<std::uint32_t> first = whole_number(ends.front());
    const std::optional<std::uint32_t> last = whole_number(ends.back());
    if (ends.size() > 2 || !first || !last || *first < 1 || *first > *last ||
        *last > max_distribution_depth) {
      return make_error(ErrorCode::usage, "--depths: '" + part + "' is no depth or range of depths",
                        "write FIRST:LAST or a list, 1 to 16");
    }
    for (std::uint32_t depth = *first; depth <= *last; ++depth) depths.push_back(depth);
  }
  std::sort(depths.begin(), depths.end());
  depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
  return depths;
}

Result<std::vector<Policy>> parse_policies(const std::string& text) {
  std::vector<Policy> policies;
  if (text == "all") return policies;
  for (const std::string& name : split(text, ',')) {
    const Result<Policy> policy = policy_from_name(name);
    if (!policy) return policy.error();
    if (std::find(policies.begin(), policies.end(), *policy) == policies.end()) {
      policies.push_back(*policy);
    }
  }
  return policies;
}

Result<SweepOptions> sweep_options(const SweepArguments& options) {
  if (const Status single = one_standard_input({options.a, options.b, options.poses_file});
      !single) {
    return single.error();
  }
  if (options.json && options.csv) {
    return make_error(ErrorCode::usage, "--json and --csv exclude each other");
  }
  if (is_standard(options.plot)) {
    return make_error(ErrorCode::usage, "--plot needs a file: the rows go to standard output");
  }
  SweepOptions how;
  const Result<std::vector<std::uint32_t>> depths = parse_depths(options.depths);
  if (!depths) return depths.error();
  how.depths = *depths;
  const Result<std::vector<Policy>> policies = parse_policies(options.policies);
  if (!policies) return policies.error();
  how.policies = *policies;
  how.workers = options.workers;
  how.buffer = options.buffer;
  how.store = options.store == "shared" ? StoreMode::shared : StoreMode::private_copy;
  how.kernel = options.kernel == "fast" ? Kernel::fast : Kernel::scalar;
  if (how.kernel == Kernel::fast && how.store == StoreMode::private_copy) {
    return make_error(ErrorCode::usage, "--kernel fast reads shared trees",
                      "give --store shared, or --kernel scalar");
  }
  how.store_bytes = options.memory;
  how.batch = options.batch;
  how.repeat = options.repeat;
  return how;
}

Result<Model> load_one(const std::string& path, const MeshArguments& mesh,
                       const SweepArguments& options) {
  Result<LoadedBody> loaded = load_body(path, mesh, options.tree, true);
  if (!loaded) return loaded.error();
  return std::move(loaded->stored.model);
}

const char* status_of(const SweepRow& row) {
  return row.end == DispatchEnd::out_of_memory ? "out_of_memory" : "ok";
}

/// What a run that was cut short took says nothing.
Json measured(const SweepRow& row, double value) {
  return row.end == DispatchEnd::ok ? Json(value) : Json(nullptr);
}

/// Where no job was handed out nothing was sped up.
bool has_speedup(const SweepRow& row) { return row.end == DispatchEnd::ok && row.jobs > 0.0; }

/// Threads cannot speed up more than the processors that they run on, nor virtual cores more than
/// their number: what does is an effect of measuring.
bool exceeds_cores(const SweepRow& row, const Sweep& sweep) {
  const std::uint32_t threads = sweep.machine.processors + 1;  // the calling thread works, too
  return has_speedup(row) &&
         (row.speedup > std::min(sweep.processors, threads) || row.replayed_speedup > threads);
}

constexpr const char* excess_note =
    "more than the number of processors: serial and dispatched runs had other speeds of the "
    "machine or other caches; raise --repeat";

Json speedup_json(const SweepRow& row, double value) {
  return has_speedup(row) ? Json(value) : Json(nullptr);
}

Json to_json(const SweepRow& row, const Sweep& sweep) {
  return {{"depth", row.depth},
          {"policy", policy_name(row.policy)},
          {"jobs", row.jobs},
          {"seconds", measured(row, row.seconds)},
          {"serial_seconds", row.serial_seconds},
          {"speedup", speedup_json(row, row.speedup)},
          {"replayed_seconds", measured(row, row.replayed_seconds)},
          {"replayed_speedup", speedup_json(row, row.replayed_speedup)},
          {"speedup_note", exceeds_cores(row, sweep) ? Json(excess_note) : Json(nullptr)},
          {"relative_transfer", measured(row, row.relative_transfer)},
          {"replayed_relative_transfer", measured(row, row.replayed_relative_transfer)},
          {"transferred_bytes", measured(row, row.transferred_bytes)},
          {"peak_part_bytes", row.peak_part_bytes},
          {"status", status_of(row)}};
}

Json to_json(const SweepArguments& options, const Sweep& sweep) {
  Json rows = Json::array();
  for (const SweepRow& row : sweep.rows) rows.push_back(to_json(row, sweep));
  const VirtualMachine& machine = sweep.machine;
  return {{"rows", std::move(rows)},
          {"a", options.a},
          {"b", options.b},
          {"workers", options.workers},
          {"processors", sweep.processors},
          {"buffer", options.buffer},
          {"store", options.store},
          {"kernel", options.kernel},
          {"batch", options.batch},
          {"repeat", options.repeat},
          {"replay",
           {{"processors", machine.processors},
            {"send_s", machine.send_s},
            {"wake_s", machine.wake_s},
            {"main_wake_s", machine.main_wake_s},
            {"copy_part_s", machine.copy_part_s},
            {"copy_bytes_per_s", machine.copy_bytes_per_s}}}};
}

/// The rows alone, columns as the JSON's; empty cells where that has null.
std::string to_csv(const Sweep& sweep) {
  std::string text;
  for (const SweepRow& row : sweep.rows) {
    const Json cells = to_json(row, sweep);
    if (text.empty()) {
      for (const auto& [name, value] : cells.items()) text += (text.empty() ? "" : ",") + name;
      text += '\n';
    }
    std::string line;
    for (const auto& [name, value] : cells.items()) {
      if (name != "depth") line += ',';
      if (value.is_string()) {
        line += value.get<std::string>();
      } else if (!value.is_null()) {
        line += value.dump();
      }
    }
    text += line + '\n';
  }
  return text;
}

std::string to_text(const SweepArguments& options, const Sweep& sweep) {
  Table table({{"depth", true},
               {"policy"},
               {"jobs", true},
               {"serial us", true},
               {"us", true},
               {"speedup", true},
               {"replayed", true},
               {"transfer", true},
               {"replayed", true},
               {"status"}});
  const auto cell = [](const SweepRow& row, double value, int digits) {
    return row.end == DispatchEnd::ok ? fmt::format("{:.{}f}", value, digits) : std::string("-");
  };
  const auto speedup = [&](const SweepRow& row, double value) {
    if (!has_speedup(row)) return std::string("-");
    return fmt::format("{:.2f}{}", value, exceeds_cores(row, sweep) ? "*" : "");
  };
  bool excess = false;
  for (const SweepRow& row : sweep.rows) {
    excess = excess || exceeds_cores(row, sweep);
    table.add_row({std::to_string(row.depth), policy_name(row.policy),
                   fmt::format("{:.0f}", row.jobs), fmt::format("{:.1f}", row.serial_seconds * 1e6),
                   cell(row, row.seconds * 1e6, 1), speedup(row, row.speedup),
                   speedup(row, row.replayed_speedup), cell(row, row.relative_transfer, 3),
                   cell(row, row.replayed_relative_transfer, 3), status_of(row)});
  }
  return table.text(colours_wanted()) + (excess ? fmt::format("* {}\n", excess_note) : "") +
         fmt::format("{} workers on {} processors; replayed on {} virtual cores.\n",
                     options.workers, sweep.processors, options.workers);
}

int run(const SweepArguments& options) {
  Result<SweepOptions> how = sweep_options(options);
  if (!how) return fail(how.error());
  for (const MeshArguments& mesh : {options.mesh, options.mesh_b.over(options.mesh)}) {
    if (const Result<ImportTransform> transform = mesh.transform(); !transform) {
      return fail(transform.error());
    }
  }
  const std::vector<std::string> inputs{options.a, options.b, options.poses_file};
  if (const Status sound = can_be_written(options.plot, svg_picture, inputs); !sound) {
    return fail(sound.error());
  }
  const Result<std::vector<Pose>> poses = read_poses(options.poses_file);
  if (!poses) return fail(poses.error());
  const Result<Model> a = load_one(options.a, options.mesh, options);
  if (!a) return fail(a.error());
  const Result<Model> b = load_one(options.b, options.mesh_b.over(options.mesh), options);
  if (!b) return fail(b.error());
  Result<Sweep> swept = Sweep{};
  {
    Progress progress("sweeping", how->depths.size());
    std::atomic<std::size_t> depths_done{0};
    how->progress = [&](std::size_t done, std::size_t) {
      progress.update(done);
      depths_done = done;
    };
    const PartialAnswer partial([&] {
      return Interruption{{},
                          fmt::format("{} of {} depths are measured; rows are complete after "
                                      "the last one, so name fewer with --depths",
                                      depths_done.load(), how->depths.size())};
    });
    swept = sweep(*a, *b, *poses, *how);
  }
  if (!swept) return fail(swept.error());
  if (!options.plot.empty()) {
    Result<OutputFile> out = OutputFile::open(options.plot, svg_picture);
    if (!out) return fail(out.error());
    const auto name = [](const std::string& path) {
      return std::filesystem::path(path).filename().string();
    };
    const std::string title = fmt::format(
        "{} and {}, {} poses{}, {} stores, {} kernel", name(options.a), name(options.b),
        poses->size(), options.batch ? " in one dispatch" : "", options.store, options.kernel);
    out->write(sweep_plot(*swept, title, options.workers));
    if (const Status closed = out->close(); !closed) return fail(closed.error());
  }
  if (options.json) {
    print_json(to_json(options, *swept));
  } else if (options.csv) {
    print(to_csv(*swept));
  } else {
    print(to_text(options, *swept));
  }
  return exit_done;
}

constexpr const char* sweep_epilogue =
    R"(Every pose is a query of its own with empty stores; --batch makes them one dispatch. A row's
numbers are means over the poses. serial_seconds is measured at each depth, in turn with the
dispatches that it is compared with. A row without jobs has no speedup; one above the number of
processors is marked with the reason (speedup_note in JSON). speedup is measured here; replayed_speedup is that of the recorded
jobs on as many virtual cores as workers, with wake-ups and copying charged as measured. A row whose
cores ran out of memory has status out_of_memory, null (in CSV nothing) for what was cut short, and
is a gap in the plot; the exit code is 0 all the same.

Examples:
  crashrank sweep car.obj car.obj --poses poses.txt --plot sweep.svg
  crashrank sweep a.obj b.obj --poses poses.txt --batch --store shared --depths 2:8 --json)";

}  // namespace

void add_sweep(CLI::App& app, Action& action) {
  const auto options = std::make_shared<SweepArguments>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Compare the policies that hand a query's node pairs to cores, depth by depth");
  add_file(*command, "A", options->a, "Mesh or model file of body A; - is standard input")
      ->required();
  add_file(*command, "B", options->b, "Mesh or model file of body B")->required();
  add_file(*command, "--poses", options->poses_file,
           "File with one row-major 4x4 matrix of B in A a line; - is standard input")
      ->required();
  command
      ->add_option("--depths", options->depths,
                   "Distribution depths, FIRST:LAST or a list [1 to 16, default 1:16]")
      ->type_name("LIST");
  command
      ->add_option(
          "--policies", options->policies,
          "all, or a list with commas of " + listed_with_or(policy_names()) + " [default all]")
      ->type_name("LIST");
  add_count(*command, "--workers", options->workers, "Worker threads, and virtual cores", 1,
            max_workers);
  add_count(*command, "--buffer", options->buffer, "Jobs that are sent to a core together", 1,
            65536);
  add_choice(*command, "--store", options->store, "Cores copy parts (private) or do not (shared)",
             {"private", "shared"});
  add_count(*command, "--memory", options->memory, "Bytes of each core's store, 0 for no limit", 0,
            999'999'999'999'999'999U);
  command->add_flag("--batch", options->batch, "All poses in one dispatch");
  add_choice(*command, "--kernel", options->kernel, "Engine that works on the jobs",
             {"scalar", "fast"});
  add_count(*command, "--repeat", options->repeat, "Measurements, of which the median counts", 1,
            10000);
  add_file(*command, "--plot", options->plot, "Draw the curves into this SVG file");
  command->add_flag("--json", options->json, "Answer in JSON");
  command->add_flag("--csv", options->csv, "Answer in CSV");
  options->tree.add_to(*command);
  options->mesh.add_to(*command);
  options->mesh_b.add_to(*command);
  command->footer(sweep_epilogue);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
