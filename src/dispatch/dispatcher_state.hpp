#pragma once

#include "base/hidden.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/dispatch/study/study.hpp"
#include "crashrank/internal/collide/traverse.hpp"
#include "dispatch/choose_depth.hpp"
#include "dispatch/core.hpp"
#include "dispatch/crew.hpp"
#include "dispatch/holdings.hpp"
#include "dispatch/placer.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace crashrank {

/// What a dispatcher keeps from run to run, and the real cores that its placer talks to.
struct CRASHRANK_HIDDEN Dispatcher::State {
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

}  // namespace crashrank
