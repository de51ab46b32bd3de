#include "crashrank/dispatch/study/study.hpp"

#include <algorithm>

namespace crashrank {

bool keep_smaller(DispatchRecording& best, const DispatchRecording& again) {
  const auto same = [](const RecordedJob& x, const RecordedJob& y) {
    return x.query == y.query && x.body_a == y.body_a && x.body_b == y.body_b &&
           x.node_a == y.node_a && x.node_b == y.node_b;
  };
  if (!std::equal(best.jobs.begin(), best.jobs.end(), again.jobs.begin(), again.jobs.end(), same)) {
    return false;
  }
  for (std::size_t i = 0; i < best.jobs.size(); ++i) {
    RecordedJob& job = best.jobs[i];
    job.find_seconds = std::min(job.find_seconds, again.jobs[i].find_seconds);
    job.run_seconds = std::min(job.run_seconds, again.jobs[i].run_seconds);
  }
  const auto alike = [](const RecordedBatch& x, const RecordedBatch& y) {
    return x.core == y.core && x.jobs == y.jobs && x.copied_bytes == y.copied_bytes;
  };
  if (std::equal(best.batches.begin(), best.batches.end(), again.batches.begin(),
                 again.batches.end(), alike)) {
    for (std::size_t i = 0; i < best.batches.size(); ++i) {
      best.batches[i].copy_seconds =
          std::min(best.batches[i].copy_seconds, again.batches[i].copy_seconds);
    }
  }
  best.begin_seconds = std::min(best.begin_seconds, again.begin_seconds);
  best.finish_seconds = std::min(best.finish_seconds, again.finish_seconds);
  return true;
}

}  // namespace crashrank
