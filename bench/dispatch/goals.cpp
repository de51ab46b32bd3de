#include "common.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <thread>
#include <vector>

namespace crashrank::bench {

namespace {

struct Timed {
  double serial = 0.0;
  double smallest_serial = 0.0;  ///< sum of every query's smallest
  double shared_out = 0.0;
};

/// Serial and dispatched by turns, medians.
Timed by_turns(Dispatcher& here, Dispatcher& many, View<const DispatchQuery> queries,
               const DispatchOptions& options, int turns) {
  PairLists pairs;
  std::vector<double> serial;
  std::vector<double> shared_out;
  DispatchOptions alone;
  alone.kernel = options.kernel;
  std::vector<double> smallest(queries.size(), 1e9);
  for (int i = 0; i < turns; ++i) {
    double sum = 0.0;
    std::size_t expected = 0;
    for (std::size_t q = 0; q < queries.size(); ++q) {
      const double seconds = run(here, {&queries[q], 1}, pairs, alone).seconds;
      smallest[q] = std::min(smallest[q], seconds);
      sum += seconds;
      expected += pairs.total();
    }
    serial.push_back(sum);
    shared_out.push_back(run(many, queries, pairs, options).seconds);
    if (pairs.total() != expected) give_up("answers differ");
  }
  return {median(serial), std::accumulate(smallest.begin(), smallest.end(), 0.0),
          median(shared_out)};
}

void table(const Scene& scene, Kernel kernel, StoreMode store, bool batch) {
  const std::vector<DispatchQuery> queries = scene.queries(kernel);
  std::vector<View<const DispatchQuery>> asked;
  if (batch) {
    asked.emplace_back(queries);
  } else {
    for (const DispatchQuery& query : queries) asked.emplace_back(&query, 1);
  }
  Dispatcher here = start(0);
  Dispatcher one = start(1);
  Dispatcher two = start(2);
  VirtualMachine machine;
  if (!measure_waking(one.pool(), machine).ok()) give_up("waking could not be measured");
  machine.spin_s = 0.0;
  for (std::uint32_t depth = batch ? 1 : 4; depth <= (batch ? 8U : 12U); ++depth) {
    DispatchOptions options;
    options.depth = depth;
    options.kernel = kernel;
    options.store = store;
    double measured = 0.0;
    double four = 0.0;
    double serial = 0.0;
    double transfer = 0.0;
    for (const View<const DispatchQuery> query : asked) {
      const Timed timed = by_turns(here, two, query, options, batch ? 9 : 15);
      const DispatchRecording recording = record(one, query, options, batch ? 5 : 15);
      ReplayOptions how;
      how.policy = options.policy;
      how.store = store;
      how.machine = machine;
      fit_copying({&recording, 1}, how.machine);
      const ReplayReport report = replayed(recording, how);
      const double share = 1.0 / static_cast<double>(asked.size());
      measured += share * timed.serial / timed.shared_out;
      four += share * timed.smallest_serial / report.seconds;
      serial += share * timed.serial;
      transfer += share * report.relative_transfer;
    }
    std::printf("%-6s %-7s %-6s %5u %12.1f %10.2f %12.2f %10.3f\n", kernel_name(kernel),
                store_name(store), batch ? "batch" : "single", depth, serial * 1e6, measured, four,
                transfer);
  }
}

}  // namespace

void goals(const Scene& scene) {
  std::printf("%zu and %zu triangles, %zu poses, %u processors\n", scene.a.mesh.size(),
              scene.b.mesh.size(), scene.poses.size(), std::thread::hardware_concurrency());
  std::printf("kernel store   what   depth    serial us  2 workers  4 replayed   transfer\n");
  for (const bool batch : {true, false}) {
    table(scene, Kernel::fast, StoreMode::shared, batch);
    table(scene, Kernel::scalar, StoreMode::shared, batch);
    table(scene, Kernel::scalar, StoreMode::private_copy, batch);
  }
  // With the depth left to the dispatcher and four workers: never much slower than alone.
  Dispatcher here = start(0);
  Dispatcher four = start(4);
  for (const Kernel kernel : {Kernel::fast, Kernel::scalar}) {
    const std::vector<DispatchQuery> queries = scene.queries(kernel);
    DispatchOptions options;
    options.kernel = kernel;
    std::vector<double> ratios;
    for (const DispatchQuery& query : queries) {
      const Timed timed = by_turns(here, four, {&query, 1}, options, 31);
      ratios.push_back(timed.shared_out / timed.serial);
    }
    std::printf("auto depth, four workers, one %s query: %.3f of the time without (median)\n",
                kernel_name(kernel), median(ratios));
  }
}

}  // namespace crashrank::bench
