#include "engine.hpp"

#include "options.hpp"

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/dispatch/dispatcher.hpp"

#include <charconv>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace crashrank::cli {
namespace {

using Clock = std::chrono::steady_clock;

bool is_kernel(const std::string& name) { return name == "fast" || name == "scalar"; }

/// The calling thread does all.
Engine serial_engine(bool fast, const Model& a, const Model& b) {
  const auto workspace = std::make_shared<ModelWorkspace>();
  workspace->prepare(a, b);
  return [fast, &a, &b, workspace](const Pose& pose, bool any,
                                   std::vector<Pair>& pairs) -> Result<Answer> {
    CollideOptions how;
    how.any = any;
    Answer answer;
    const Clock::time_point start = Clock::now();
    answer.result = fast ? collide(a, b, pose, pairs, *workspace, how)
                         : collide(a.tree, b.tree, pose, pairs, workspace->scalar, how);
    answer.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return answer;
  };
}

struct Workers {
  Dispatcher dispatcher;
  PartIndex a;
  PartIndex b;
  PairLists lists;
};

template <class Source>
Result<std::shared_ptr<Workers>> start(std::uint32_t count, const Source& a, const Source& b) {
  PoolOptions pool;
  pool.workers = count;
  Result<Dispatcher> dispatcher = Dispatcher::start(pool);
  if (!dispatcher) return dispatcher.error();
  Result<PartIndex> index_a = PartIndex::make(a);
  if (!index_a) return index_a.error();
  Result<PartIndex> index_b = PartIndex::make(b);
  if (!index_b) return index_b.error();
  return std::shared_ptr<Workers>(
      new Workers{std::move(*dispatcher), std::move(*index_a), std::move(*index_b), {}});
}

}  // namespace

Result<std::uint32_t> depth_from_text(const std::string& text) {
  if (text == "auto") return auto_depth;
  std::uint32_t depth = 0;
  const char* end = text.data() + text.size();
  const std::from_chars_result read = std::from_chars(text.data(), end, depth);
  if (read.ec != std::errc{} || read.ptr != end || depth < 1 || depth > max_distribution_depth) {
    return make_error(ErrorCode::usage, "--depth " + text + ": is no distribution depth",
                      "give a number from 1 to 16, or auto");
  }
  return depth;
}

std::vector<std::string> policy_names() {
  std::vector<std::string> names;
  for (const Policy policy : all_policies()) names.emplace_back(policy_name(policy));
  return names;
}

CLI::Option* add_depth(CLI::App& command, std::string& depth) {
  return command
      .add_option("--depth", depth,
                  "Distribution depth at which trees are cut, or auto [1 to 16, default auto]")
      ->type_name("N");
}

void EngineArguments::add_to(CLI::App& command) {
  const std::string group = "Engine";
  add_choice(command, "--kernel", kernel, "The vector unit of this processor (fast) or scalar",
             {"fast", "scalar"})
      ->group(group);
  add_count(command, "--workers", workers,
            "Threads that share a query; without them the calling thread does all", 1, max_workers,
            "none")
      ->group(group);
  add_choice(command, "--policy", policy, "How a job finds its worker", policy_names())
      ->group(group);
  add_depth(command, depth)->group(group);
}

Status EngineArguments::check() const {
  if (!is_kernel(kernel)) {
    return make_error(ErrorCode::usage, "--kernel " + kernel + ": is no kernel",
                      "give fast or scalar");
  }
  const Result<std::uint32_t> cut = depth_from_text(depth);
  if (!cut) return cut.error();
  const Result<Policy> known = policy_from_name(policy);
  if (!known) return known.error();
  return Success{};
}

Result<Engine> make_engine(const EngineArguments& arguments, const Model& a, const Model& b) {
  if (Status sound = arguments.check(); !sound) return sound.error();
  const bool fast = arguments.kernel == "fast";
  if (arguments.workers == 0) return serial_engine(fast, a, b);
  const Result<std::shared_ptr<Workers>> started =
      fast ? start(arguments.workers, a, b) : start(arguments.workers, a.tree, b.tree);
  if (!started) return started.error();
  const std::shared_ptr<Workers>& workers = *started;
  DispatchOptions how;
  how.policy = *policy_from_name(arguments.policy);
  how.depth = *depth_from_text(arguments.depth);
  how.kernel = fast ? Kernel::fast : Kernel::scalar;
  // Whether anything touches is known before a worker could be woken.
  const Engine alone = serial_engine(fast, a, b);
  return Engine([workers, how, alone](const Pose& pose, bool any,
                                      std::vector<Pair>& pairs) -> Result<Answer> {
    if (any) return alone(pose, any, pairs);
    const DispatchQuery query{&workers->a, &workers->b, pose};
    Result<DispatchReport> report = workers->dispatcher.run({&query, 1}, workers->lists, how);
    if (!report) return report.error();
    if (report->end != DispatchEnd::ok) {
      return make_error(ErrorCode::out_of_budget, "the workers ran out of memory");
    }
    workers->lists.gather(0, pairs);
    Answer answer;
    answer.result.pairs = pairs.size();
    answer.result.intersecting = !pairs.empty();
    answer.result.work = report->work;
    answer.seconds = report->seconds;
    answer.jobs = report->jobs;
    answer.depth = report->depth;
    return answer;
  });
}

}  // namespace crashrank::cli
