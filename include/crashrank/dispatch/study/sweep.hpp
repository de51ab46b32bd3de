#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/dispatch/policy.hpp"
#include "crashrank/dispatch/study/replay.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/tree/model.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace crashrank {

/// Which dispatches to compare: every policy at every depth, on the same queries in the same run.
struct SweepOptions {
  std::vector<std::uint32_t> depths;          ///< 1 to `max_distribution_depth`; empty: all of them
  std::vector<Policy> policies;               ///< empty: all of them
  std::uint32_t workers = 4;                  ///< threads, and cores of the replay
  std::uint32_t buffer = 8;                   ///< most jobs in a batch
  StoreMode store = StoreMode::private_copy;  ///< where cores read parts
  Kernel kernel = Kernel::scalar;             ///< what tests boxes and triangles
  std::size_t store_bytes = 0;                ///< per core; 0: no limit
  bool batch = false;        ///< all poses in one dispatch; else each alone, with empty stores
  std::uint32_t repeat = 5;  ///< measurements of each dispatch
  std::uint64_t seed = 1;    ///< of random choices
  /// Told after each depth: how many are done, of how many.
  std::function<void(std::size_t done, std::size_t total)> progress;
};

/// One policy at one depth. Means over the poses; of times, means of each pose's median. Where
/// cores ran out of memory only jobs, serial time and peak say something.
struct SweepRow {
  std::uint32_t depth = 0;             ///< distribution depth
  Policy policy = Policy::best_match;  ///< which job goes where
  double jobs = 0.0;               ///< that the queries have, whether or not all were worked off
  double seconds = 0.0;            ///< measured here, on so many processors as there are
  double serial_seconds = 0.0;     ///< the calling thread alone, in the same run
  double speedup = 0.0;            ///< serial seconds / seconds
  double replayed_seconds = 0.0;   ///< on as many virtual cores as there are workers
  double replayed_speedup = 0.0;   ///< serial seconds / replayed seconds
  double relative_transfer = 0.0;  ///< bytes sent / bytes of both models
  double replayed_relative_transfer = 0.0;  ///< the same of the replay
  double transferred_bytes = 0.0;           ///< of parts sent
  double peak_part_bytes = 0.0;             ///< most that a store held
  DispatchEnd end = DispatchEnd::ok;        ///< out_of_memory when it was for any pose
};

/// All rows and what they were measured on.
struct Sweep {
  std::vector<SweepRow> rows;    ///< by depth, then policy
  std::uint32_t processors = 0;  ///< of this machine
  VirtualMachine machine;        ///< of the replay, with the costs measured here
};

/// Runs it. Each depth is measured `repeat` times, serial, dispatched and recorded runs of all
/// policies by turns, so that a change in the machine's speed meets all alike. Every answer is
/// compared with the serial one. Errors: usage for options out of range; bad_input for empty trees;
/// internal when a dispatch failed or gave another answer.
CRASHRANK_API Result<Sweep> sweep(const Model& a, const Model& b, View<const Pose> poses,
                                  const SweepOptions& options);

}  // namespace crashrank
