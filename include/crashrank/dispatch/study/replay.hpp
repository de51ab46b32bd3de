#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/dispatch/dispatcher.hpp"
#include "crashrank/dispatch/policy.hpp"
#include "crashrank/dispatch/study/recording.hpp"
#include "crashrank/internal/base/export.hpp"

#include <cstddef>
#include <cstdint>

namespace crashrank {

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
/// (pairs) go back over a second such link, and the main thread hears of a finished batch that much
/// later. Not modelled: caches and memory that cores share, beyond what the recorded times hold,
/// and what else the machine does.
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

/// What a replay came to.
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

}  // namespace crashrank
