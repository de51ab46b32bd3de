#include "command.hpp"
#include "console.hpp"
#include "cost.hpp"
#include "engine.hpp"
#include "interrupt.hpp"
#include "json.hpp"
#include "mesh_arguments.hpp"
#include "options.hpp"
#include "poses.hpp"
#include "streams.hpp"
#include "tree_arguments.hpp"

#include "crashrank/collide/body_state.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/report/table.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/tree/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr OutputKind pair_list{"a list of pairs", "query,a,b\n"};

struct CollideArguments {
  std::string a;
  std::string b;
  MeshArguments mesh;
  SecondMeshArguments mesh_b;
  TreeArguments tree;
  EngineArguments engine;
  std::vector<std::string> poses;
  std::string poses_file;
  std::string pairs_file;
  int repeat = 1;
  bool any = false;
  bool json = false;
};

struct Body {
  Model model;
  double build_s = 0.0;
};

struct Query {
  Answer answer;  ///< `seconds` is the median of all runs
  double sort_seconds = 0.0;
  std::string hash;  ///< empty with --any, whose pair depends on the tree
  BodyState state = BodyState::separate;
};

/// States of queries. The surfaces of the bodies are found when the first query needs them.
class StateFinder {
public:
  StateFinder(const Model& a, const Model& b) : a_(a), b_(b) {}

  BodyState operator()(const Pose& pose, const CollideResult& result) {
    const bool near =
        !result.intersecting && boxes_may_touch(a_.tree.nodes[0].box, b_.tree.nodes[0].box,
                                                box_transform(a_.tree, b_.tree, pose));
    if (near && !known_) {
      solid_a_ = make_solid(a_.mesh);
      solid_b_ = make_solid(b_.mesh);
      known_ = true;
    }
    return body_state(a_, solid_a_, b_, solid_b_, pose, result);
  }

private:
  const Model& a_;
  const Model& b_;
  Solid solid_a_;
  Solid solid_b_;
  bool known_ = false;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Status check(const CollideArguments& options) {
  if (const Status single = one_standard_input({options.a, options.b, options.poses_file});
      !single) {
    return single.error();
  }
  if (options.json && is_standard(options.pairs_file)) {
    return make_error(ErrorCode::usage, "--json and --pairs - would both write standard output",
                      "give --pairs a file");
  }
  if (const Status engine = options.engine.check(); !engine) return engine.error();
  if (const Result<BuildOptions> build = options.tree.build_options(); !build) {
    return build.error();
  }
  for (const MeshArguments& mesh : {options.mesh, options.mesh_b.over(options.mesh)}) {
    if (const Result<ImportTransform> transform = mesh.transform(); !transform) {
      return transform.error();
    }
  }
  return Success{};
}

Result<Body> load_one(const std::string& path, const MeshArguments& mesh,
                      const CollideArguments& options) {
  Result<LoadedBody> loaded = load_body(path, mesh, options.tree, true);
  if (!loaded) return loaded.error();
  return Body{std::move(loaded->stored.model), loaded->build_s};
}

Result<std::vector<Pose>> load_poses(const CollideArguments& options) {
  std::vector<Pose> poses;
  for (const std::string& text : options.poses) {
    const Result<Pose> pose = parse_pose_option(text);
    if (!pose) return pose.error();
    poses.push_back(*pose);
  }
  if (!options.poses_file.empty()) {
    Result<std::vector<Pose>> more = read_poses(options.poses_file);
    if (!more) return more.error();
    poses.insert(poses.end(), more->begin(), more->end());
  }
  if (poses.empty()) poses.emplace_back();
  return poses;
}

/// Runs one query `repeat` times; `pairs` ends sorted.
Result<Query> ask(const Engine& engine, const Pose& pose, const CollideArguments& options,
                  std::vector<Pair>& pairs) {
  std::vector<double> seconds(static_cast<std::size_t>(options.repeat));
  Result<Answer> answer = Answer{};
  for (double& taken : seconds) {
    answer = engine(pose, options.any, pairs);
    if (!answer) return answer.error();
    taken = answer->seconds;
  }
  const auto middle = seconds.begin() + options.repeat / 2;
  std::nth_element(seconds.begin(), middle, seconds.end());
  Query query;
  query.answer = *answer;
  query.answer.seconds = *middle;
  const Clock::time_point start = Clock::now();
  std::sort(pairs.begin(), pairs.end());
  query.sort_seconds = seconds_since(start);
  if (!options.any) query.hash = pairs_hash(pairs);
  return query;
}

void write_pairs(OutputFile& out, std::size_t query, const std::vector<Pair>& pairs) {
  fmt::memory_buffer lines;
  for (const Pair& pair : pairs) {
    fmt::format_to(std::back_inserter(lines), "{},{},{}\n", query, pair.a, pair.b);
  }
  out.write(fmt::to_string(lines));
}

double predicted(const Query& query, const Cost& cost) {
  const CollideWork& work = query.answer.result.work;
  const double boxes = work.bv_tests > 0 ? static_cast<double>(work.bv_tests) * cost.cb_s : 0.0;
  const double triangles =
      work.primitive_tests > 0 ? static_cast<double>(work.primitive_tests) * cost.cp_s : 0.0;
  return boxes + triangles;
}

Json body_json(const std::string& file, const Body& body) {
  return {{"file", file},
          {"triangles", body.model.mesh.size()},
          {"nodes", body.model.tree.nodes.size()},
          {"depth", body.model.tree.depth},
          {"build_s", body.build_s}};
}

/// "scalar", or the vector unit in use.
std::string kernel_name(const EngineArguments& engine) {
  return engine.kernel == "scalar" ? "scalar" : vector_unit();
}

Json to_json(const CollideArguments& options, const Body& a, const Body& b,
             const std::vector<Query>& queries, const Cost& cost) {
  Json list = Json::array();
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Query& query = queries[i];
    list.push_back({{"index", i},
                    {"intersecting", query.answer.result.intersecting},
                    {"state", body_state_name(query.state)},
                    {"pairs", query.answer.result.pairs},
                    {"bv_tests", query.answer.result.work.bv_tests},
                    {"primitive_tests", query.answer.result.work.primitive_tests},
                    {"exact_tests", query.answer.result.work.exact_tests},
                    {"seconds", query.answer.seconds},
                    {"sort_seconds", query.sort_seconds},
                    {"predicted_seconds", predicted(query, cost)},
                    {"jobs", query.answer.jobs},
                    {"depth", query.answer.depth},
                    {"hash", options.any ? Json(nullptr) : Json(query.hash)}});
  }
  return {{"queries", std::move(list)},   {"cost", {{"Cb_s", cost.cb_s}, {"Cp_s", cost.cp_s}}},
          {"a", body_json(options.a, a)}, {"b", body_json(options.b, b)},
          {"split", options.tree.split},  {"frame", options.tree.frame},
          {"any", options.any},           {"repeat", options.repeat}};
}

/// NaN where there was nothing to tell it from.
std::string time_us(double seconds) {
  return std::isfinite(seconds) ? fmt::format("{:.2f}", seconds * 1e6) : "-";
}

std::string cost_text(const Cost& cost) {
  if (!std::isfinite(cost.cb_s)) return "Cb and Cp cannot be computed from so few tests";
  std::string boxes = fmt::format("Cb = {:.2f} ns a box test", cost.cb_s * 1e9);
  if (!std::isfinite(cost.cp_s)) return boxes;
  return boxes + fmt::format(", Cp = {:.2f} ns a triangle test", cost.cp_s * 1e9);
}

std::string to_text(const CollideArguments& options, const std::vector<Query>& queries,
                    const Cost& cost) {
  Table table({{"query", true},
               {"state"},
               {"pairs", true},
               {"Nb", true},
               {"Np", true},
               {"measured us", true},
               {"Nb Cb + Np Cp us", true},
               {"hash"}});
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Query& query = queries[i];
    table.add_row({std::to_string(i), body_state_name(query.state),
                   std::to_string(query.answer.result.pairs),
                   std::to_string(query.answer.result.work.bv_tests),
                   std::to_string(query.answer.result.work.primitive_tests),
                   time_us(query.answer.seconds), time_us(predicted(query, cost)), query.hash});
  }
  return table.text(colours_wanted()) +
         fmt::format("{}, measured here ({}).\n", cost_text(cost), kernel_name(options.engine));
}

Interruption interrupted_after(const CollideArguments& options, const Body& a, const Body& b,
                               const std::vector<Query>& queries, std::size_t all,
                               const Cost& cost) {
  Interruption known;
  known.message = fmt::format("{} of {} queries are answered", queries.size(), all);
  if (!options.pairs_file.empty()) known.message += "; the list of pairs is not written";
  if (queries.empty() || is_standard(options.pairs_file)) return known;
  known.answer = options.json ? json_text(to_json(options, a, b, queries, cost))
                              : to_text(options, queries, cost);
  return known;
}

int run(const CollideArguments& options) {
  if (const Status sound = check(options); !sound) return fail(sound.error());
  const std::vector<std::string> inputs{options.a, options.b, options.poses_file};
  if (const Status sound = can_be_written(options.pairs_file, pair_list, inputs); !sound) {
    return fail(sound.error());
  }
  const Result<std::vector<Pose>> poses = load_poses(options);
  if (!poses) return fail(poses.error());
  const Result<Body> a = load_one(options.a, options.mesh, options);
  if (!a) return fail(a.error());
  const Result<Body> b = load_one(options.b, options.mesh_b.over(options.mesh), options);
  if (!b) return fail(b.error());
  std::optional<OutputFile> pairs_out;
  if (!options.pairs_file.empty()) {
    Result<OutputFile> out = OutputFile::open(options.pairs_file, pair_list);
    if (!out) return fail(out.error());
    pairs_out = std::move(*out);
    pairs_out->write(std::string(pair_list.begins));
  }

  const Result<Engine> engine = make_engine(options.engine, a->model, b->model);
  if (!engine) return fail(engine.error());
  const Cost cost = measure_cost(*engine, a->model, b->model);
  std::vector<Pair> pairs;
  StateFinder state(a->model, b->model);
  std::vector<Query> queries;
  queries.reserve(poses->size());
  {
    Progress progress("colliding", poses->size());
    std::mutex mutex;
    const PartialAnswer partial([&] {
      const std::lock_guard<std::mutex> lock(mutex);
      return interrupted_after(options, *a, *b, queries, poses->size(), cost);
    });
    for (const Pose& pose : *poses) {
      Result<Query> query = ask(*engine, pose, options, pairs);
      if (!query) return fail(query.error());
      query->state = state(pose, query->answer.result);
      if (pairs_out) write_pairs(*pairs_out, queries.size(), pairs);
      const std::lock_guard<std::mutex> lock(mutex);
      queries.push_back(*query);
      progress.update(queries.size());
    }
  }
  if (pairs_out) {
    if (const Status closed = pairs_out->close(); !closed) return fail(closed.error());
  }
  if (options.json) {
    print_json(to_json(options, *a, *b, queries, cost));
  } else if (!is_standard(options.pairs_file)) {
    print(to_text(options, queries, cost));
  }
  return exit_done;
}

constexpr const char* collide_epilogue =
    R"(B stands at each pose in A's frame: R = Rz(yaw) Ry(pitch) Rx(roll), then the translation.
A triangle's number is its place in the file. hash is the first 16 hex digits of SHA-256 over the
sorted pairs as little-endian int32. state: separate, intersecting, a_inside_b, b_inside_a, or
unknown_open: within the bounds of a surface that is not closed. seconds runs from the call to all pairs in the buffer, unsorted.

Examples:
  crashrank collide car.obj truck.glb --pose 4.2,0.3,0,180,0,0
  crashrank collide car.obj pole.stl --poses poses.txt --repeat 20 --pairs pairs.csv --json)";

}  // namespace

void add_collide(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CollideArguments>();
  CLI::App* command =
      app.add_subcommand("collide", "Find the triangles of two bodies that touch, exactly");
  add_file(*command, "A", options->a, "Mesh or model file of body A; - is standard input")
      ->required();
  add_file(*command, "B", options->b, "Mesh or model file of body B")->required();
  command
      ->add_option("--pose", options->poses,
                   "x,y,z,yaw_deg,pitch_deg,roll_deg of B in A, m and degrees; may be repeated")
      ->type_name("SIX")
      ->type_size(1)
      ->allow_extra_args(false);
  add_file(*command, "--poses", options->poses_file,
           "File with one row-major 4x4 matrix of B in A a line; - is standard input");
  command->add_flag("--any", options->any,
                    "Stop at the first pair found; one thread does, whatever --workers");
  add_count(*command, "--repeat", options->repeat,
            "Runs of each query, of which the median time counts", 1, 1'000'000);
  add_file(*command, "--pairs", options->pairs_file,
           "Write the pairs as CSV query,a,b, sorted; - is standard output");
  command->add_flag("--json", options->json, "Answer in JSON");
  options->engine.add_to(*command);
  options->tree.add_to(*command);
  options->mesh.add_to(*command);
  options->mesh_b.add_to(*command);
  command->footer(collide_epilogue);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace crashrank::cli
