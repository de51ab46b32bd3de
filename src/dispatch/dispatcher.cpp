#include "crashrank/dispatch/dispatcher.hpp"

#include "dispatch/choose_depth.hpp"
#include "dispatch/crew.hpp"
#include "dispatch/dispatcher_state.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

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
    return make_error(ErrorCode::internal, std::string("the dispatch failed: ") + error.what());
  }
}

}  // namespace crashrank
