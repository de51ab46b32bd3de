#include "dispatch/dispatcher_state.hpp"
#include "crashrank/dispatch/study/study.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"

#include "dispatch/estimate_work.hpp"
#include "dispatch/find_jobs.hpp"

namespace crashrank {

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
    const float enough_work = cut.longest_job_seconds(queries.size() - 1 - i) / seconds_per_work;
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

}  // namespace crashrank
