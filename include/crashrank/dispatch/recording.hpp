#pragma once

#include "crashrank/dispatch/part_index.hpp"

#include <cstdint>
#include <vector>

namespace crashrank {

/// One job as it went: where it came from and what it took. Seconds are processor time of the
/// thread that spent them, so other programs on the machine do not count.
struct RecordedJob {
  std::uint32_t query = 0;
  std::uint32_t body_a = 0;  ///< index in `DispatchRecording::bodies`
  std::uint32_t body_b = 0;
  std::uint32_t node_a = 0;  ///< index in that body's PartIndex
  std::uint32_t node_b = 0;
  std::uint32_t core = 0;
  std::uint32_t pairs = 0;
  double find_seconds =
      0.0;                   ///< main thread, from the job before this one to the end of placing it
  double run_seconds = 0.0;  ///< core, without copying parts
};

/// A batch as it went, per core in order.
struct RecordedBatch {
  std::uint32_t core = 0;
  std::uint32_t jobs = 0;
  std::uint64_t copied_bytes = 0;
  double copy_seconds = 0.0;
};

/// What a dispatch did, in the order in which the main thread found the jobs.
struct DispatchRecording {
  std::uint32_t depth = 0;
  std::uint32_t cores = 0;
  std::vector<const PartIndex*> bodies;
  std::vector<RecordedJob> jobs;
  std::vector<RecordedBatch> batches;
  double finish_seconds = 0.0;  ///< main thread, after the last job was done
};

}  // namespace crashrank
