#include "common.hpp"
#include "crashrank/dispatch/study/study.hpp"
#include "crashrank/internal/collide/box_test.hpp"
#include "crashrank/internal/collide/traverse.hpp"
#include "dispatch/core.hpp"
#include "dispatch/find_jobs.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

namespace crashrank::bench {

/// What the main thread spends on a job beside finding it: the recorded time of finding and placing
/// less the time of the same descent alone, a job.
void overhead(const Scene& scene) {
  const std::vector<DispatchQuery> queries = scene.queries(Kernel::scalar);
  Dispatcher one = start(1);
  std::printf("depth  jobs      descent ns/job  with placing, ns/job by policy\n");
  for (std::uint32_t depth = 4; depth <= 14; depth += 2) {
    double alone = std::numeric_limits<double>::infinity();
    std::vector<NodePair> stack;
    std::size_t jobs = 0;
    for (int turn = 0; turn < 15; ++turn) {
      jobs = 0;
      CollideWork work;
      const double before = detail::clock_seconds();
      for (const DispatchQuery& query : queries) {
        const BoxTransform to = box_transform(query.a->frame(), query.b->frame(), query.b_in_a);
        detail::find_jobs(
            *query.a, *query.b, to, depth, 0, stack, work,
            [](const IndexedNode&, const IndexedNode&) { return false; },
            [&](std::uint32_t, std::uint32_t) {
              ++jobs;
              return true;
            });
      }
      alone = std::min(alone, detail::clock_seconds() - before);
    }
    const double per_job = 1e9 / static_cast<double>(jobs);
    std::printf("%5u %6zu %15.0f ", depth, jobs, alone * per_job);
    for (const Policy policy : all_policies()) {
      DispatchOptions options;
      options.depth = depth;
      options.policy = policy;
      const DispatchRecording recording = record(one, queries, options, 15);
      double found = 0.0;
      for (const RecordedJob& job : recording.jobs) found += job.find_seconds;
      std::printf(" %s %.0f", policy_name(policy), found * per_job);
    }
    std::printf("\n");
  }
}

}  // namespace crashrank::bench
