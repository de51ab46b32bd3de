#include "crashrank/dispatch/dispatcher.hpp"

#include "dispatch/choose_depth.hpp"
#include "dispatch/core.hpp"
#include "dispatch/crew.hpp"
#include "dispatch/estimate_work.hpp"
#include "dispatch/find_jobs.hpp"
#include "dispatch/holdings.hpp"
#include "dispatch/placer.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace crashrank {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Status check(View<const DispatchQuery> queries, const DispatchOptions& options) {
  if (options.depth > max_distribution_depth) {
    return make_error(ErrorCode::usage, "the distribution depth is 16 at most");
  }
  if (options.buffer < 1 || options.buffer > 65536) {
    return make_error(ErrorCode::usage, "a buffer holds 1 to 65536 jobs");
  }
  if (options.kernel == Kernel::fast && options.store == StoreMode::private_copy) {
    return make_error(ErrorCode::usage, "the fast kernel reads shared trees",
                      "choose shared stores, or the scalar kernel");
  }
  for (const DispatchQuery& query : queries) {
    if (query.a == nullptr || query.b == nullptr) {
      return make_error(ErrorCode::usage, "a query needs the part indices of two models");
    }
    if (options.kernel == Kernel::fast &&
        (query.a->model() == nullptr || query.b->model() == nullptr)) {
      return make_error(ErrorCode::usage, "the fast kernel needs part indices made from models");
    }
  }
  return Success{};
}

}  // namespace

struct Dispatcher::State {
  explicit State(WorkerPool started)
      : pool(std::move(started)),
        processors(std::max(1U, std::thread::hardware_concurrency())),
        cores(std::size_t{pool.size()} + 1),
        filling(pool.size()) {}

  WorkerPool pool;
  std::uint32_t processors;
  std::vector<detail::Core> cores;  ///< of the workers, then the calling thread's
  detail::Holdings holdings;
  std::vector<TreeView> trees;       ///< by body
  std::vector<const Model*> models;  ///< by body, for the vector engine; else empty
  std::vector<NodePair> stack;
  std::vector<std::pair<Policy, std::unique_ptr<PlacementPolicy>>> policies;
  std::atomic<bool> stop{false};
  std::vector<detail::QueryFrame> frames;  ///< by query, as far as their jobs were looked for
  std::vector<WaitingJob> waiting;
  std::vector<detail::FoundJob> waiting_found;
  CollideWork work;  ///< the main thread's
  bool measure = false;
  double aside_seconds = 0.0;  ///< measured: sending and waiting, which a replay charges itself
  bool holdings_valid = false;
  StoreMode holdings_mode = StoreMode::shared;

  /// Which of a core's two batches is being filled, and whether it is still to be emptied first.
  struct Filling {
    std::uint32_t batch = 0;
    bool stale = true;
  };
  std::vector<Filling> filling;

  // What Placer asks of cores.
  std::uint32_t outstanding(std::uint32_t core) const noexcept { return pool.outstanding(core); }
  std::uint32_t seen() const noexcept { return pool.finished_tasks(); }
  void wait(std::uint32_t seen) noexcept {
    const double before = measure ? detail::clock_seconds() : 0.0;
    pool.wait_beyond(seen);
    if (measure) aside_seconds += detail::clock_seconds() - before;
  }

  void fetch(std::uint32_t core, std::uint32_t body, std::uint32_t node) {
    const IndexedNode& part = holdings.index(body).nodes()[node];
    open_batch(core).fetches.push_back({trees[body], part.tree_node, part.below, part.slots});
  }

  void append(std::uint32_t core, const detail::FoundJob& found) {
    detail::Batch& batch = open_batch(core);
    if (batch.frames.empty() || batch.frames.back().query != found.query) {
      batch.frames.push_back(frames[found.query]);
    }
    detail::Job job;
    job.query = found.query;
    job.frame = static_cast<std::uint32_t>(batch.frames.size() - 1);
    job.number = static_cast<std::uint32_t>(found.number);
    job.part_a = found.body_a;
    job.part_b = found.body_b;
    job.start = {holdings.index(found.body_a).nodes()[found.node_a].tree_node,
                 holdings.index(found.body_b).nodes()[found.node_b].tree_node};
    if (cores[core].private_parts) {
      locate(core, found.body_a, found.node_a, job.part_a, job.start.a);
      locate(core, found.body_b, found.node_b, job.part_b, job.start.b);
    }
    batch.jobs.push_back(job);
  }

  void send(std::uint32_t core) noexcept {
    const double before = measure ? detail::clock_seconds() : 0.0;
    pool.post(core, {[](void* context, std::uint32_t) {
                       const detail::Batch& batch = *static_cast<const detail::Batch*>(context);
                       batch.core->run(batch);
                     },
                     &open_batch(core)});
    filling[core].batch ^= 1U;
    filling[core].stale = true;
    if (measure) aside_seconds += detail::clock_seconds() - before;
  }

  void run_here(const detail::FoundJob& found) {
    const double before = measure ? detail::clock_seconds() : 0.0;
    detail::Job job;
    job.query = found.query;
    job.number = static_cast<std::uint32_t>(found.number);
    job.part_a = found.body_a;
    job.part_b = found.body_b;
    job.start = {holdings.index(found.body_a).nodes()[found.node_a].tree_node,
                 holdings.index(found.body_b).nodes()[found.node_b].tree_node};
    cores.back().run_measured(job, frames[found.query], trees);
    if (measure) aside_seconds += detail::clock_seconds() - before;
  }

  bool recall(std::uint32_t core) {
    WorkerPool::Task task;
    if (!pool.recall(core, task)) return false;
    cores.back().run(*static_cast<const detail::Batch*>(task.context));
    return true;
  }

  void prepare(View<const DispatchQuery> queries, PairLists& pairs, const DispatchOptions& options,
               std::uint32_t depth);
  DispatchEnd distribute(View<const DispatchQuery> queries, const DispatchOptions& options,
                         const detail::Crew& crew, const detail::TreeCut& cut, double begun,
                         DispatchReport& report);
  DispatchEnd run_alone(View<const DispatchQuery> queries, const DispatchOptions& options);
  void record(DispatchRecording& recording) const;

  PlacementPolicy& policy(Policy which) {
    for (auto& [known, policy] : policies) {
      if (known == which) return *policy;
    }
    policies.emplace_back(which, make_policy(which));
    return *policies.back().second;
  }

  /// Workers sleep no more until the dispatch is over, unless it keeps them waiting for long.
  void wake(std::uint32_t workers) noexcept {
    pool.set_spin(detail::crew_spin_s);
    for (std::uint32_t worker = 0; worker < workers; ++worker) pool.rouse(worker);
  }

private:
  detail::Batch& open_batch(std::uint32_t core) noexcept {
    detail::Batch& batch = cores[core].batches[filling[core].batch];
    if (filling[core].stale) batch.clear();
    filling[core].stale = false;
    return batch;
  }

  /// Where the core finds a node in its own store.
  void locate(std::uint32_t core, std::uint32_t body, std::uint32_t node, std::uint32_t& part,
              std::uint32_t& start) const {
    const detail::Holdings::Place place = holdings.place(core, body, node);
    const IndexedNode& sent = holdings.index(body).nodes()[place.sent_node];
    part = place.number;
    start = detail::copied_node(sent.tree_node, sent.below, start);
  }
};

void Dispatcher::State::prepare(View<const DispatchQuery> queries, PairLists& pairs,
                                const DispatchOptions& options, std::uint32_t depth) {
  const bool copies = options.store == StoreMode::private_copy;
  if (!(options.keep_parts && holdings_valid && holdings_mode == options.store)) {
    holdings.begin(std::max(1U, pool.size()));
    for (detail::Core& core : cores) core.store.clear();
  }
  holdings_valid = false;
  holdings_mode = options.store;
  std::size_t stack_size = 0;
  for (const DispatchQuery& query : queries) {
    holdings.body(*query.a, depth);
    holdings.body(*query.b, depth);
    stack_size =
        std::max(stack_size, traversal_stack_size(query.a->tree_depth(), query.b->tree_depth()));
  }
  trees.clear();
  models.clear();
  for (std::uint32_t body = 0; body < holdings.bodies(); ++body) {
    trees.push_back(view_of(holdings.index(body).tree()));
    if (options.kernel == Kernel::fast) models.push_back(holdings.index(body).model());
  }
  pairs.begin(cores.size(), queries.size());
  stop.store(false, std::memory_order_relaxed);
  work = {};
  for (std::size_t i = 0; i < cores.size(); ++i) {
    detail::Core& core = cores[i];
    core.number = static_cast<std::uint32_t>(i);
    core.private_parts = copies && i < pool.size();
    core.shared_trees = trees;
    core.models = models;
    core.cancel = options.cancel;
    core.stop = &stop;
    core.found = &pairs.found_[i];
    if (core.stack.size() < stack_size) core.stack.resize(stack_size);
    core.work = {};
    core.measure = measure;
    core.job_times.clear();
    core.batch_times.clear();
    if (i == pool.size()) continue;
    for (detail::Batch& batch : core.batches) {
      batch.core = &core;
      batch.reserve(options.buffer);
    }
    filling[i] = {};
  }
}

DispatchEnd Dispatcher::State::distribute(View<const DispatchQuery> queries,
                                          const DispatchOptions& options, const detail::Crew& crew,
                                          const detail::TreeCut& cut, double begun,
                                          DispatchReport& report) {
  PlacementPolicy& chosen = policy(options.policy);
  chosen.begin(crew.workers, options.seed);
  const bool copies = options.store == StoreMode::private_copy;
  const float seconds_per_work = detail::seconds_per_work(options.kernel);
  if (measure) options.recording->seconds_per_work = seconds_per_work;
  detail::Placer<State> placer(*this, holdings, chosen, crew.workers,
                               {options.buffer, options.store_bytes, options.queue_bytes, copies,
                                crew.caller, seconds_per_work},
                               waiting, waiting_found);
  double last = measure ? detail::clock_seconds() : 0.0;
  if (measure) options.recording->begin_seconds = last - begun;
  aside_seconds = 0.0;
  const bool estimates = chosen.window() > 1;
  const std::uint32_t whole = chosen.whole_triangles();
  const float enough_work = cut.job_seconds / seconds_per_work;
  DispatchEnd end = DispatchEnd::ok;
  detail::FoundJob job;
  frames.clear();
  for (std::size_t i = 0; i < queries.size() && end == DispatchEnd::ok; ++i) {
    const DispatchQuery& query = queries[i];
    const auto number = static_cast<std::uint32_t>(i);
    frames.push_back(
        {number, query.b_in_a, box_transform(query.a->frame(), query.b->frame(), query.b_in_a)});
    const BoxTransform to = frames.back().to;
    const detail::WorkEstimate estimate(to);
    job.query = number;
    job.body_a = holdings.body(*query.a, report.depth);
    job.body_b = holdings.body(*query.b, report.depth);
    const auto take = [&](std::uint32_t node_a, std::uint32_t node_b) {
      if (pool.failed()) return false;
      if (options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed)) {
        end = DispatchEnd::cancelled;
        return false;
      }
      job.node_a = node_a;
      job.node_b = node_b;
      if (estimates) {
        job.work = estimate(query.a->nodes()[node_a], query.b->nodes()[node_b]);
      }
      const bool placed = placer.add(job);
      ++job.number;
      if (!placed) {
        end = DispatchEnd::out_of_memory;
        return false;
      }
      if (measure) {
        const double now = detail::clock_seconds();
        options.recording->jobs.push_back({number, job.body_a, job.body_b, node_a, node_b, 0, 0,
                                           job.work, now - last - aside_seconds, 0.0});
        last = now;
        aside_seconds = 0.0;
      }
      return true;
    };
    const auto enough = [&](const IndexedNode& a, const IndexedNode& b) {
      return enough_work > 0.0F && estimate(a, b) <= enough_work;
    };
    const bool done =
        detail::find_jobs(*query.a, *query.b, to, report.depth, whole, stack, work, enough, take);
    if (!done) break;
  }
  if (end == DispatchEnd::ok && !pool.failed() && !placer.finish()) {
    end = DispatchEnd::out_of_memory;
  }
  if (end != DispatchEnd::ok || pool.failed()) stop.store(true, std::memory_order_relaxed);
  pool.wait_all();
  if (end == DispatchEnd::ok && options.cancel != nullptr &&
      options.cancel->load(std::memory_order_relaxed)) {
    end = DispatchEnd::cancelled;  // a worker may have skipped jobs
  }
  report.jobs = placer.placed();
  report.batches = placer.batches();
  report.transferred_bytes = placer.transferred_bytes();
  report.peak_queue_bytes = placer.peak_queue_bytes();
  return end;
}

DispatchEnd Dispatcher::State::run_alone(View<const DispatchQuery> queries,
                                         const DispatchOptions& options) {
  detail::Core& core = cores.back();
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed)) {
      return DispatchEnd::cancelled;
    }
    const DispatchQuery& query = queries[i];
    detail::Job job;
    job.query = static_cast<std::uint32_t>(i);
    job.part_a = holdings.body(*query.a, 0);
    job.part_b = holdings.body(*query.b, 0);
    const detail::QueryFrame frame{job.query, query.b_in_a,
                                   box_transform(query.a->frame(), query.b->frame(), query.b_in_a)};
    core.run(job, frame, trees);
  }
  return DispatchEnd::ok;
}

void Dispatcher::State::record(DispatchRecording& recording) const {
  recording.cores = pool.size();
  recording.bodies.clear();
  for (std::uint32_t body = 0; body < holdings.bodies(); ++body) {
    recording.bodies.push_back(&holdings.index(body));
  }
  recording.batches.clear();
  for (const detail::Core& core : cores) {
    for (const detail::JobTime& time : core.job_times) {
      if (time.number >= recording.jobs.size()) continue;  // a budget ended it there
      RecordedJob& job = recording.jobs[time.number];
      job.core = core.number;
      job.pairs = time.pairs;
      job.run_seconds = time.seconds;
    }
    for (const detail::BatchTime& time : core.batch_times) {
      recording.batches.push_back({core.number, time.jobs, time.parts, time.bytes, time.seconds});
    }
  }
}

Dispatcher::Dispatcher(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Dispatcher::Dispatcher(Dispatcher&& other) noexcept = default;
Dispatcher& Dispatcher::operator=(Dispatcher&& other) noexcept = default;
Dispatcher::~Dispatcher() = default;

Result<Dispatcher> Dispatcher::start(const PoolOptions& options) {
  Result<WorkerPool> pool = WorkerPool::start(options);
  if (!pool) return pool.error();
  return Dispatcher(std::make_unique<State>(std::move(*pool)));
}

WorkerPool& Dispatcher::pool() noexcept { return state_->pool; }

void Dispatcher::forget_parts() {
  state_->holdings_valid = false;
  for (detail::Core& core : state_->cores) core.store.release();
}

Result<DispatchReport> Dispatcher::run(View<const DispatchQuery> queries, PairLists& pairs,
                                       const DispatchOptions& options) {
  if (Status status = check(queries, options); !status) return status.error();
  State& state = *state_;
  DispatchReport report;
  try {
    const Clock::time_point start = Clock::now();
    const bool measure = options.recording != nullptr;
    state.measure = measure;
    double begun = measure ? detail::clock_seconds() : 0.0;
    detail::TreeCut cut;
    cut.depth = options.depth;
    if (options.depth == auto_depth) {
      // Parts of many sizes would be copied again and again.
      const bool by_work =
          options.store == StoreMode::shared && state.policy(options.policy).caller_works();
      cut = detail::choose_cut(queries, state.pool.size(), options, by_work);
    }
    report.depth = cut.depth;
    const bool here = state.pool.size() == 0 || report.depth == auto_depth;
    if (here) report.depth = auto_depth;
    if (measure) options.recording->jobs.clear();
    detail::Crew crew;
    if (!here) {
      crew = detail::crew_for(state.policy(options.policy), state.pool.size(), state.processors,
                              options.caller_works);
      const double before = measure ? detail::clock_seconds() : 0.0;
      if (crew.awake) state.wake(crew.workers);
      if (measure) begun += detail::clock_seconds() - before;  // a replay charges it itself
    }
    state.prepare(queries, pairs, options, report.depth);
    report.end = here ? state.run_alone(queries, options)
                      : state.distribute(queries, options, crew, cut, begun, report);
    state.pool.set_spin(-1.0);
    const double finishing = measure ? detail::clock_seconds() : 0.0;
    pairs.finish();
    if (measure) options.recording->finish_seconds = detail::clock_seconds() - finishing;
    report.seconds = seconds_since(start);
    if (Status status = state.pool.take_failure(); !status) return status.error();
    state.holdings_valid = report.end == DispatchEnd::ok;
    report.work = state.work;
    for (const detail::Core& core : state.cores) report.work += core.work;
    for (std::uint32_t i = 0; i < state.pool.size(); ++i) {
      report.peak_part_bytes = std::max(report.peak_part_bytes, state.holdings.bytes(i));
    }
    for (std::uint32_t body = 0; body < state.holdings.bodies(); ++body) {
      report.model_bytes += state.holdings.index(body).model_bytes();
    }
    if (measure) {
      options.recording->depth = report.depth;
      state.record(*options.recording);
    }
    if (options.sorted) {
      const Clock::time_point sorting = Clock::now();
      pairs.begin_sort();
      if (Status status = state.pool.for_each(
              queries.size(), [&](std::size_t query, std::uint32_t) { pairs.sort_query(query); });
          !status) {
        return status.error();
      }
      pairs.end_sort();
      report.sort_seconds = seconds_since(sorting);
    }
    return report;
  } catch (const std::exception& error) {
    state.stop.store(true, std::memory_order_relaxed);
    state.pool.wait_all();
    state.pool.set_spin(-1.0);
    static_cast<void>(state.pool.take_failure());
    return make_error(ErrorCode::internal,
                      std::string("the dispatch could not be carried out: ") + error.what());
  }
}

}  // namespace crashrank
