#pragma once

#include "crashrank/dispatch/part_index.hpp"
#include "crashrank/internal/base/export.hpp"

#include <cstdint>
#include <vector>

namespace crashrank {

/// One job as it went: where it came from and what it took. Seconds are of the steady clock, read
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

/// A batch as it went, per core in order.
struct RecordedBatch {
  std::uint32_t core = 0;          ///< who did it
  std::uint32_t jobs = 0;          ///< in it
  std::uint32_t copied_parts = 0;  ///< that the core had not
  std::uint64_t copied_bytes = 0;  ///< of those
  double copy_seconds = 0.0;       ///< that took, s
};

/// What a dispatch did, in the order in which the main thread found the jobs.
struct DispatchRecording {
  std::uint32_t depth = 0;               ///< distribution depth
  std::uint32_t cores = 0;               ///< number of them
  std::vector<const PartIndex*> bodies;  ///< met by the queries
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

}  // namespace crashrank
