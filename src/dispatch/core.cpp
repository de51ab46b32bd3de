#include "dispatch/core.hpp"
#include "crashrank/internal/collide/traverse.hpp"

namespace crashrank::detail {

void Core::run(const Batch& batch) {
  const double begun = measure ? clock_seconds() : 0.0;
  std::uint64_t bytes = 0;
  for (const Fetch& fetch : batch.fetches) {
    store.copy(fetch);
    bytes += fetch.bytes();
  }
  if (measure) {
    batch_times.push_back({static_cast<std::uint32_t>(batch.jobs.size()),
                           static_cast<std::uint32_t>(batch.fetches.size()), bytes,
                           clock_seconds() - begun});
  }
  const View<const TreeView> parts = private_parts ? store.parts() : shared_trees;
  for (const Job& job : batch.jobs) {
    if (ended()) return;
    run_measured(job, batch.frames[job.frame], parts);
  }
}

void Core::run_measured(const Job& job, const QueryFrame& frame, View<const TreeView> parts) {
  if (!measure) {
    run(job, frame, parts);
    return;
  }
  const double begun = clock_seconds();
  const std::size_t before = found->pairs.size();
  run(job, frame, parts);
  const auto pairs = static_cast<std::uint32_t>(found->pairs.size() - before);
  job_times.push_back({job.number, pairs, clock_seconds() - begun});
}

void Core::run(const Job& job, const QueryFrame& frame, View<const TreeView> parts) {
  const std::size_t first = found->pairs.size();
  if (models.empty()) {
    search(job, frame, parts);
  } else {
    search_fast(job, frame);
  }
  const std::size_t last = found->pairs.size();
  if (last == first) return;
  if (!found->runs.empty() && found->runs.back().query == job.query) {
    found->runs.back().count = last - found->runs.back().first;
  } else {
    found->runs.push_back({job.query, number, first, last - first});
  }
}

void Core::search(const Job& job, const QueryFrame& frame, View<const TreeView> parts) {
  const TreeView& a = parts[job.part_a];
  const TreeView& b = parts[job.part_b];
  traverse(a, b, frame.to, job.start, View<NodePair>(stack), work,
           [&](const Node& leaf_a, const Node& leaf_b) {
             return collide_leaves(a, leaf_a, b, leaf_b, frame.b_in_a, work, [&](Pair pair) {
               found->pairs.push_back(pair);
               return true;
             });
           });
}

void Core::search_fast(const Job& job, const QueryFrame& frame) {
  // The engine clears what it fills: straight into the results while those are empty, which a lone
  // query's always are.
  const bool direct = found->pairs.empty();
  std::vector<Pair>& pairs = direct ? found->pairs : pairs_of_a_job;
  work += collide(*models[job.part_a], job.start.a, *models[job.part_b], job.start.b, frame.b_in_a,
                  pairs, workspace)
              .work;
  if (!direct) found->pairs.insert(found->pairs.end(), pairs.begin(), pairs.end());
}

}  // namespace crashrank::detail
