#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/collide/collide.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"
#include "dispatch/part_store.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Where B stands for the jobs of one query.
struct QueryFrame {
  std::uint32_t query = 0;
  Pose b_in_a;
  BoxTransform to;
};

/// A pair of nodes to search, in trees or in copied parts of trees.
struct Job {
  std::uint32_t query = 0;
  std::uint32_t frame = 0;   ///< of the batch
  std::uint32_t part_a = 0;  ///< number in the core's store, or of the body where trees are shared
  std::uint32_t part_b = 0;
  NodePair start;            ///< within those
  std::uint32_t number = 0;  ///< in the order found
};

/// What is sent to a core en masse: parts to copy first, then jobs, with the poses they need.
struct Batch {
  struct Core* core = nullptr;  ///< that it is sent to
  std::vector<Fetch> fetches;
  std::vector<QueryFrame> frames;
  std::vector<Job> jobs;

  void clear() noexcept {
    fetches.clear();
    frames.clear();
    jobs.clear();
  }
  /// Room for as many jobs as a batch usually takes.
  void reserve(std::uint32_t buffer) {
    const std::size_t room = std::min(buffer, 64U);
    fetches.reserve(2 * room);
    frames.reserve(room);
    jobs.reserve(room);
  }
};

/// What measuring a job and a batch gives; see DispatchRecording.
struct JobTime {
  std::uint32_t number = 0;
  std::uint32_t pairs = 0;
  double seconds = 0.0;
};
struct BatchTime {
  std::uint32_t jobs = 0;
  std::uint32_t parts = 0;
  std::uint64_t bytes = 0;
  double seconds = 0.0;
};

/// A worker's side of the dispatch: its store, its stack, its results. Between batches the main
/// thread may touch it; while a batch is out only the worker does.
struct alignas(64) Core {
  PartStore store;
  bool private_parts = false;
  View<const TreeView> shared_trees;  ///< by body, where trees are shared
  View<const Model* const> models;    ///< by body, for the vector engine; else empty
  const std::atomic<bool>* cancel = nullptr;
  const std::atomic<bool>* stop = nullptr;  ///< set when the rest of the dispatch is of no use
  FoundPairs* found = nullptr;
  std::vector<NodePair> stack;
  ModelWorkspace workspace;          ///< of the vector engine
  std::vector<Pair> pairs_of_a_job;  ///< of the vector engine
  CollideWork work;
  bool measure = false;
  std::vector<JobTime> job_times;
  std::vector<BatchTime> batch_times;
  std::uint32_t number = 0;
  std::array<Batch, 2> batches;  ///< the main thread fills one while the other is out

  /// Copies a batch's parts, then works off its jobs. Throws std::bad_alloc.
  void run(const Batch& batch);
  /// Searches one pair of nodes below `parts`, and measures it where that is wanted.
  void run_measured(const Job& job, const QueryFrame& frame, View<const TreeView> parts);
  /// Searches one pair of nodes below `parts`.
  void run(const Job& job, const QueryFrame& frame, View<const TreeView> parts);

private:
  void search(const Job& job, const QueryFrame& frame, View<const TreeView> parts);
  void search_fast(const Job& job, const QueryFrame& frame);
  bool ended() const noexcept {
    return stop->load(std::memory_order_relaxed) ||
           (cancel != nullptr && cancel->load(std::memory_order_relaxed));
  }
};

/// The steady clock, s. The clock of a thread's processor time would not count other programs, but
/// takes longer to read than a small job takes to do.
inline double clock_seconds() noexcept {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace crashrank::detail
