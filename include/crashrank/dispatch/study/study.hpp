#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/dispatch/policy.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/model/model.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace crashrank {

/// One recorded job: its query, its parts and its times. Seconds are of the steady clock, read
/// by the thread that did the work: `keep_smaller` of repeated recordings leaves out what other
/// programs on the machine took meanwhile.
struct RecordedJob {
  std::uint32_t query = 0;   ///< which query
  std::uint32_t body_a = 0;  ///< index in `DispatchRecording::bodies`
  std::uint32_t body_b = 0;  ///< index into the bodies
  std::uint32_t node_a = 0;  ///< index in that body's PartIndex
  std::uint32_t node_b = 0;  ///< its part
  std::uint32_t core = 0;    ///< as many as there are workers: the calling thread
  std::uint32_t pairs = 0;   ///< found
  float work = 0.0F;         ///< as estimated before it was done, in triangles to look at
  double find_seconds =
      0.0;                   ///< main thread, from the job before this one to the end of placing it
  double run_seconds = 0.0;  ///< core, without copying parts
};

/// One recorded batch, per core in order.
struct RecordedBatch {
  std::uint32_t core = 0;          ///< the core that ran it
  std::uint32_t jobs = 0;          ///< in it
  std::uint32_t copied_parts = 0;  ///< that the core had not
  std::uint64_t copied_bytes = 0;  ///< of those
  double copy_seconds = 0.0;       ///< that took, s
};

/// Record of a dispatch, in the order in which the main thread found the jobs.
struct DispatchRecording {
  std::uint32_t depth = 0;               ///< distribution depth
  std::uint32_t cores = 0;               ///< number of them
  std::vector<const PartIndex*> bodies;  ///< of the queries
  std::vector<RecordedJob> jobs;         ///< in the order found
  std::vector<RecordedBatch> batches;    ///< in the order sent
  float seconds_per_work = 0.0F;         ///< of estimated work, as the dispatch took it to be
  double begin_seconds = 0.0;            ///< main thread, before it looked for the first job
  double finish_seconds = 0.0;           ///< main thread, after the last batch was done
};

/// Keeps, for every job and batch, the smaller of the times of two recordings of the same dispatch.
/// Jobs are found in the same order every time; batches are the same with one worker only, and are
/// left alone where their number differs. Returns false, and does nothing, where the jobs differ.
CRASHRANK_API bool keep_smaller(DispatchRecording& best, const DispatchRecording& again);

/// The machine on which recorded jobs are replayed. Seconds and bytes per second.
///
/// Model. The main thread and the workers are threads on `processors` equal processors. A thread
/// that has something to do takes a free processor, or waits in line for one; it keeps it until it
/// has nothing to do, or for `slice_s` when others are in line. The main thread finds and places
/// jobs in the recorded order, each at the time recorded for it, decides by the same code as the
/// real one, waits as the real one when all cores are claimed, and works off jobs where the real
/// one would. Posting a batch costs it `post_s`; a batch costs its core `batch_s`, the copying of
/// its parts, at `copy_part_s` a part and `copy_bytes_per_s`, and its jobs' recorded times. Sending
/// to a core that has had nothing to do for longer than `spin_s` costs the main thread `send_s`
/// more, and the core starts `wake_s` later; a main thread that waited longer than `spin_s` goes on
/// `main_wake_s` after a batch was done, and waking it costs that core `send_s`. Where every thread
/// has a processor, workers are woken before the first job is looked for and spin until the end, as
/// in a real dispatch. With a link, copying costs the core nothing, but every batch (parts and
/// jobs) passes one link, first come first served, and arrives `link_latency_s` later; results
/// (pairs) go back over a second such link, and the main thread learns of a finished batch that
/// much later. Not modelled: caches and memory that cores share, beyond what the recorded times
/// hold, and what else the machine does.
struct VirtualMachine {
  std::uint32_t processors = 4;   ///< virtual ones
  std::uint32_t workers = 4;      ///< threads beside the main one
  double spin_s = 0.0;            ///< idle before sleep, s
  double post_s = 0.1e-6;         ///< to post a batch, s
  double send_s = 2e-6;           ///< to hand a batch over, s
  double wake_s = 8e-6;           ///< to wake a worker, s
  double main_wake_s = 10e-6;     ///< to wake the main thread, s
  double batch_s = 0.3e-6;        ///< for each batch on its core, s
  double slice_s = 3e-3;          ///< of processor time when others wait, s
  bool awake_at_start = false;    ///< workers still spin when the dispatch begins
  double copy_part_s = 50e-9;     ///< for each part copied, s
  double copy_bytes_per_s = 8e9;  ///< bytes copied in a second
  double link_bytes_per_s = 0.0;  ///< 0: cores copy from shared memory themselves
  double link_latency_s = 0.0;    ///< one way, s
};

/// Measures what waking threads costs on this machine, on an idle pool of at least one worker:
/// medians of 200 tries; about 0.1 s. Fills the pool's side of `machine` (spin, post, send and wake
/// times). Errors as `WorkerPool::take_failure`.
CRASHRANK_API Status measure_waking(WorkerPool& pool, VirtualMachine& machine);

/// Sets the copying times of `machine` to those that fit the batches of private recordings best
/// (least squares); leaves them alone where nothing was copied.
CRASHRANK_API void fit_copying(View<const DispatchRecording> recordings, VirtualMachine& machine);

/// What is replayed, and how.
struct ReplayOptions {
  Policy policy = Policy::best_match;   ///< which job goes where
  StoreMode store = StoreMode::shared;  ///< where cores read parts
  std::uint32_t buffer = 8;             ///< most jobs in a batch
  std::size_t store_bytes = 0;          ///< budget of a store; 0: none
  std::size_t queue_bytes = 0;          ///< budget of what waits; 0: none
  std::uint64_t seed = 1;               ///< of random choices
  bool caller_works = true;             ///< as DispatchOptions has it
  VirtualMachine machine;               ///< on what
};

/// Result of a replay.
struct ReplayReport {
  DispatchEnd end = DispatchEnd::ok;    ///< how it ended
  double seconds = 0.0;                 ///< from the call to all pairs there
  std::uint64_t jobs = 0;               ///< pairs of parts
  std::uint64_t batches = 0;            ///< sent en masse
  std::uint64_t transferred_bytes = 0;  ///< of parts sent
  std::uint64_t peak_part_bytes = 0;    ///< most that a store held
  double main_seconds = 0.0;            ///< main thread at work
  double idle_seconds = 0.0;            ///< workers without a batch, summed over them
  double relative_transfer = 0.0;       ///< bytes sent / bytes of both models
};

/// Replays a recording on a virtual machine, under any policy. The part indices that the recording
/// names have to exist still. O(jobs · workers). Errors: usage for numbers out of range or an empty
/// recording; throws nothing.
CRASHRANK_API Result<ReplayReport> replay(const DispatchRecording& recording,
                                          const ReplayOptions& options);

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
  /// Called after each depth with the numbers of those done and of all.
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
/// policies by turns, so that a change in the machine's speed affects all alike. Every answer is
/// compared with the serial one. Errors: usage for options out of range; bad_input for empty trees;
/// internal when a dispatch failed or gave another answer.
CRASHRANK_API Result<Sweep> sweep(const Model& a, const Model& b, View<const Pose> poses,
                                  const SweepOptions& options);

}  // namespace crashrank
