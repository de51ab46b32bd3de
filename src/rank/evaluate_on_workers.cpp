#include "rank/evaluate_on_workers.hpp"

#include "crashrank/dispatch/dispatcher.hpp"
#include "rank/evaluate.hpp"
#include "rank/progress.hpp"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

namespace crashrank::detail {
namespace {

/// Candidates for each thread whose pairs are held at a time: enough to keep all threads busy, few
/// enough that memory does not grow with the scenario and that a cancelled ranking returns soon.
constexpr std::size_t candidates_per_worker = 16;

/// Largest distribution depth if the dispatcher chooses the depth.
constexpr std::uint32_t auto_deepest = 12;

Result<Dispatcher> start_dispatcher(unsigned workers) {
  PoolOptions pool;
  pool.workers = std::min(workers, max_workers);
  Result<Dispatcher> started = Dispatcher::start(pool);
  if (started) return started;
  pool.workers = 0;
  return Dispatcher::start(pool);
}

/// Part indices of the models in use, each made once.
class PartIndices {
public:
  explicit PartIndices(std::uint32_t deepest) : deepest_(deepest) {}

  Result<const PartIndex*> of(const Model& model) {
    for (const PartIndex& index : indices_) {
      if (index.model() == &model) return &index;
    }
    Result<PartIndex> made = PartIndex::make(model, deepest_);
    if (!made) return made.error();
    indices_.push_back(std::move(*made));
    return &indices_.back();
  }

private:
  std::uint32_t deepest_;
  std::deque<PartIndex> indices_;  ///< a deque keeps the addresses valid
};

}  // namespace

Status evaluate_on_workers(const Scene& scene, const RankOptions& options, RankResult& result,
                           std::vector<char>& needed) {
  if (options.depth > max_distribution_depth) {
    return make_error(ErrorCode::usage, "the distribution depth is 16 at most");
  }
  Result<Dispatcher> dispatcher = start_dispatcher(options.workers);
  if (!dispatcher) return dispatcher.error();
  WorkerPool& pool = dispatcher->pool();
  const std::uint32_t deepest = options.depth == auto_depth ? auto_deepest : options.depth;
  PartIndices indices_a(deepest);
  PartIndices indices_b(deepest);  // a model can be used on both sides of a query
  DispatchOptions how;
  how.policy = options.policy;
  how.depth = options.depth;
  how.kernel = Kernel::fast;

  RankProgress progress(options, result.candidates.size());
  std::vector<Scratch> scratch(std::max(1U, pool.size()));
  for (Scratch& own : scratch) progress.attach_to(own);
  std::vector<RankWork> work(scratch.size());
  const std::size_t batch_candidates = candidates_per_worker * scratch.size();
  std::vector<SimulatedCandidate> simulated;
  std::vector<std::size_t> first_query;
  std::vector<DispatchQuery> queries;
  PairLists lists;
  for (std::size_t begin = 0; begin < result.candidates.size(); begin += batch_candidates) {
    const std::size_t count = std::min(batch_candidates, result.candidates.size() - begin);
    simulated.clear();
    simulated.resize(count);
    Status done = pool.for_each(count, [&](std::size_t i, std::uint32_t worker) {
      simulated[i] =
          simulate_candidate(scene, result.candidates[begin + i], scratch[worker], work[worker]);
      if (simulated[i].decided) progress.advance();
    });
    if (!done) return done;

    queries.clear();
    first_query.clear();
    const auto add_queries = [&](const DamagePlan& plan) -> Status {
      for (const DamagePath& path : plan.paths) {
        const Result<const PartIndex*> a = indices_a.of(*body_of(scene, plan.query.a).model);
        if (!a) return a.error();
        const Result<const PartIndex*> b = indices_b.of(*scene.actors[path.actor].model);
        if (!b) return b.error();
        for (std::size_t i = plan.first_pose; i < path.poses.size(); ++i) {
          queries.push_back({*a, *b, path.poses[i]});
        }
      }
      return Success{};
    };
    for (const SimulatedCandidate& found : simulated) {
      first_query.push_back(queries.size());
      for (const SimulatedOutcome& outcome : found.outcomes) {
        for (const DamagePlan& plan : outcome.plans) {
          if (Status added = add_queries(plan); !added) return added;
        }
      }
    }
    const Result<DispatchReport> report = dispatcher->run(queries, lists, how);
    if (!report) return report.error();
    result.work.damage += report->work;

    done = pool.for_each(count, [&](std::size_t i, std::uint32_t worker) {
      result.ranking[begin + i] =
          finish(scene, result.candidates[begin + i], std::move(simulated[i]),
                 {&lists, first_query[i]}, scratch[worker], work[worker]);
    });
    if (!done) return done;
  }
  for (const RankWork& spent : work) result.work += spent;
  for (const Scratch& own : scratch) own.add_needed(needed);
  return Success{};
}

}  // namespace crashrank::detail
