#include "common.hpp"
#include "crashrank/dispatch/study/study.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace crashrank::bench {

namespace {

DispatchOptions with(Kernel kernel, StoreMode store, std::uint32_t depth) {
  DispatchOptions options;
  options.depth = depth;
  options.kernel = kernel;
  options.store = store;
  return options;
}

/// One depth, by turns.
struct Depth {
  std::uint32_t depth = auto_depth;
  std::vector<double> seconds;  ///< on two real processors
  std::vector<double> two;      ///< speedups there
  std::vector<double> four;     ///< speedups of replays of the turn's recording
  std::vector<double> jobs;
  std::vector<double> work;   ///< all jobs' seconds
  std::vector<double> found;  ///< seconds of finding and placing
  double transfer = 0.0;
};

void table(const Scene& scene, Kernel kernel, StoreMode store, bool batch, double spin_s) {
  const std::vector<DispatchQuery> queries = scene.queries(kernel);
  std::vector<View<const DispatchQuery>> asked;
  if (batch) {
    asked.emplace_back(queries);
  } else {
    for (std::size_t i = 0; i < queries.size(); i += 6) asked.emplace_back(&queries[i], 1);
  }
  Dispatcher here = start(0);
  Dispatcher one = start(1, spin_s);
  Dispatcher two = start(2, spin_s);
  VirtualMachine machine;
  if (!measure_waking(one.pool(), machine).ok()) give_up("waking could not be measured");
  machine.spin_s = spin_s;
  machine.awake_at_start = spin_s > 0.0;
  const DispatchRecording first = record(one, asked[0], with(kernel, store, batch ? 6 : 8), 1);
  fit_copying({&first, 1}, machine);

  std::vector<Depth> depths(1);
  for (std::uint32_t depth = batch ? 1 : 4; depth <= (batch ? 8U : 12U); ++depth) {
    depths.emplace_back().depth = depth;
  }
  std::vector<double> serial_seconds;
  PairLists pairs;
  for (int turn = 0; turn < (batch ? 9 : 25); ++turn) {
    double serial = 0.0;
    std::size_t expected = 0;
    for (const View<const DispatchQuery> together : asked) {
      for (const DispatchQuery& query : together) {
        serial += run(here, {&query, 1}, pairs, with(kernel, store, auto_depth)).seconds;
        expected += pairs.total();
      }
    }
    serial_seconds.push_back(serial);
    for (Depth& at : depths) {
      const DispatchOptions options = with(kernel, store, at.depth);
      double measured = 0.0;
      double four = 0.0;
      double work = 0.0;
      double found = 0.0;
      std::size_t jobs = 0;
      std::size_t answer = 0;
      at.transfer = 0.0;
      for (const View<const DispatchQuery> together : asked) {
        measured += run(two, together, pairs, options).seconds;
        answer += pairs.total();
        const DispatchRecording recording = record(one, together, options, 1);
        if (recording.jobs.empty()) {  // left to the calling thread
          four += run(here, together, pairs, options).seconds;
          continue;
        }
        ReplayOptions how;
        how.policy = options.policy;
        how.store = store;
        how.machine = machine;
        const ReplayReport report = replayed(recording, how);
        four += report.seconds;
        at.transfer += report.relative_transfer / static_cast<double>(asked.size());
        jobs += recording.jobs.size();
        for (const RecordedJob& job : recording.jobs) {
          work += job.run_seconds;
          found += job.find_seconds;
        }
      }
      if (answer != expected) give_up("answers differ");
      at.seconds.push_back(measured);
      at.two.push_back(serial / measured);
      at.four.push_back(serial / four);
      at.jobs.push_back(static_cast<double>(jobs));
      at.work.push_back(work);
      at.found.push_back(found);
    }
  }
  const double share = 1e6 / static_cast<double>(asked.size());
  const char* const what = batch ? "batch" : spin_s > 0.0 ? "awake" : "single";
  double best = std::numeric_limits<double>::infinity();
  double best_four = 0.0;
  for (const Depth& at : depths) {
    const std::string depth = at.depth == auto_depth ? "auto" : std::to_string(at.depth);
    std::printf("%-6s %-7s %-6s %5s %11.1f %9.2f %10.2f %9.3f %8.0f %10.1f %10.1f\n",
                kernel_name(kernel), store_name(store), what, depth.c_str(),
                median(serial_seconds) * share, median(at.two), median(at.four), at.transfer,
                median(at.jobs) * share * 1e-6, median(at.work) * share, median(at.found) * share);
    if (at.depth == auto_depth) continue;
    best = std::min(best, median(at.seconds));
    best_four = std::max(best_four, median(at.four));
  }
  std::printf(
      "%s %s %s: auto takes %.3f of the time at the best depth on two processors, %.3f replayed\n",
      kernel_name(kernel), store_name(store), what, median(depths[0].seconds) / best,
      best_four / median(depths[0].four));
}

/// A query with the depth left to the dispatcher and four workers, over the time without.
double auto_over_alone(Dispatcher& here, Dispatcher& four, const DispatchQuery& query,
                       Kernel kernel) {
  PairLists pairs;
  std::vector<double> ratios;
  for (int turn = 0; turn < 31; ++turn) {
    const DispatchOptions options = with(kernel, StoreMode::shared, auto_depth);
    const double alone = run(here, {&query, 1}, pairs, options).seconds;
    ratios.push_back(run(four, {&query, 1}, pairs, options).seconds / alone);
  }
  return median(ratios);
}

}  // namespace

void goals(const Scene& scene) {
  std::printf("%zu and %zu triangles, %zu poses, %u processors\n", scene.a.mesh.size(),
              scene.b.mesh.size(), scene.poses.size(), std::thread::hardware_concurrency());
  std::printf(
      "kernel store   what   depth   serial us two real 4 replayed  transfer     jobs    work us"
      "    find us\n");
  table(scene, Kernel::fast, StoreMode::shared, true, 0.0);
  table(scene, Kernel::scalar, StoreMode::shared, true, 0.0);
  table(scene, Kernel::scalar, StoreMode::private_copy, true, 0.0);
  table(scene, Kernel::fast, StoreMode::shared, false, 0.0);
  table(scene, Kernel::fast, StoreMode::shared, false, 1e-3);
  table(scene, Kernel::scalar, StoreMode::shared, false, 0.0);
  table(scene, Kernel::scalar, StoreMode::private_copy, false, 0.0);
  // With the depth left to the dispatcher and four workers: never much slower than alone.
  Dispatcher here = start(0);
  Dispatcher four = start(4);
  for (const Kernel kernel : {Kernel::fast, Kernel::scalar}) {
    std::vector<double> ratios;
    for (const DispatchQuery& query : scene.queries(kernel)) {
      ratios.push_back(auto_over_alone(here, four, query, kernel));
    }
    std::printf("auto depth, four workers, one %s query: %.3f of the time without (median)\n",
                kernel_name(kernel), median(ratios));
  }
}

}  // namespace crashrank::bench
