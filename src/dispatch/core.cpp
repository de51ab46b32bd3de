#include "dispatch/core.hpp"

#include <ctime>

namespace crashrank::detail {

double thread_seconds() noexcept {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void Core::run(const Batch& batch) {
  double last = measure ? thread_seconds() : 0.0;
  const auto lap = [&last] {
    const double now = thread_seconds();
    const double took = now - last;
    last = now;
    return took;
  };
  std::uint64_t bytes = 0;
  for (const Fetch& fetch : batch.fetches) {
    store.copy(fetch);
    bytes += fetch.bytes();
  }
  if (measure) {
    batch_times.push_back({static_cast<std::uint32_t>(batch.jobs.size()), bytes, lap()});
  }
  const View<const TreeView> parts = private_parts ? store.parts() : shared_trees;
  for (const Job& job : batch.jobs) {
    if (ended()) return;
    const std::size_t before = found->pairs.size();
    run(job, batch.frames[job.frame], parts);
    if (measure) {
      job_times.push_back(
          {job.number, static_cast<std::uint32_t>(found->pairs.size() - before), lap()});
    }
  }
}

void Core::run(const Job& job, const QueryFrame& frame, View<const TreeView> parts) {
  const TreeView& a = parts[job.part_a];
  const TreeView& b = parts[job.part_b];
  std::vector<Pair>& pairs = found->pairs;
  const std::size_t first = pairs.size();
  traverse(a, b, frame.to, job.start, View<NodePair>(stack), work,
           [&](const Node& leaf_a, const Node& leaf_b) {
             return collide_leaves(a, leaf_a, b, leaf_b, frame.b_in_a, work, [&](Pair pair) {
               pairs.push_back(pair);
               return true;
             });
           });
  if (pairs.size() == first) return;
  if (!found->runs.empty() && found->runs.back().query == job.query) {
    found->runs.back().count = pairs.size() - found->runs.back().first;
  } else {
    found->runs.push_back({job.query, number, first, pairs.size() - first});
  }
}

}  // namespace crashrank::detail
