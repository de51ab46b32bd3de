#include "common.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace crashrank::bench {

namespace {

/// Waking and copying as measured, with the first half of the poses.
VirtualMachine fitted(Dispatcher& one, Dispatcher& two, View<const DispatchQuery> queries) {
  VirtualMachine machine;
  machine.processors = 2;
  machine.workers = 2;
  if (!measure_waking(two.pool(), machine).ok()) give_up("waking could not be measured");
  std::vector<DispatchRecording> recordings;
  for (const std::uint32_t depth : {5U, 8U, 11U}) {
    DispatchOptions options;
    options.depth = depth;
    options.store = StoreMode::private_copy;
    for (const DispatchQuery& query : queries) {
      recordings.push_back(record(one, {&query, 1}, options, 9));
    }
  }
  fit_copying(recordings, machine);
  return machine;
}

}  // namespace

/// Replayed on two virtual cores against measured on two real ones. Costs are fitted on the first
/// half of the poses, times compared on the second half, alone and in one dispatch. Both are the
/// smallest of many runs, since other programs only ever add.
void validate(const Scene& scene) {
  const std::vector<DispatchQuery> queries = scene.queries(Kernel::scalar);
  const std::size_t half = queries.size() / 2;
  const View<const DispatchQuery> known(queries.data(), half);
  const View<const DispatchQuery> unknown(queries.data() + half, queries.size() - half);
  Dispatcher one = start(1);
  Dispatcher two = start(2);
  const VirtualMachine machine = fitted(one, two, known);
  std::printf("send %.2f us, wake %.2f us, main wake %.2f us, copy %.0f ns a part and %.2f GB/s\n",
              machine.send_s * 1e6, machine.wake_s * 1e6, machine.main_wake_s * 1e6,
              machine.copy_part_s * 1e9, machine.copy_bytes_per_s * 1e-9);
  std::printf("what   store   depth policy            measured us  replayed us   error\n");
  std::vector<double> errors;
  for (const bool batch : {false, true}) {
    for (const StoreMode store : {StoreMode::shared, StoreMode::private_copy}) {
      for (const std::uint32_t depth : {5U, 8U, 10U}) {
        for (const Policy policy : all_policies()) {
          DispatchOptions options;
          options.depth = depth;
          options.policy = policy;
          options.store = store;
          ReplayOptions how;
          how.policy = policy;
          how.store = store;
          how.machine = machine;
          double measured = 0.0;
          double predicted = 0.0;
          std::vector<View<const DispatchQuery>> asked;
          if (batch) {
            asked.push_back(unknown);
          } else {
            for (const DispatchQuery& query : unknown) asked.emplace_back(&query, 1);
          }
          PairLists pairs;
          for (const View<const DispatchQuery> query : asked) {
            double smallest = std::numeric_limits<double>::infinity();
            for (int i = 0; i < 60; ++i) {
              smallest = std::min(smallest, run(two, query, pairs, options).seconds);
            }
            measured += smallest;
            predicted += replayed(record(one, query, options, 15), how).seconds;
          }
          errors.push_back(predicted / measured - 1.0);
          std::printf("%-6s %-7s %5u %-16s %12.1f %12.1f %+6.1f%%\n", batch ? "batch" : "single",
                      store_name(store), depth, policy_name(policy), measured * 1e6,
                      predicted * 1e6, 100.0 * errors.back());
        }
      }
    }
  }
  std::vector<double> sizes;
  for (const double error : errors) sizes.push_back(std::abs(error));
  const auto near = std::count_if(sizes.begin(), sizes.end(), [](double x) { return x <= 0.1; });
  std::printf("median error %.1f%%, median of sizes %.1f%%, %td of %zu within 10%%\n",
              100.0 * median(errors), 100.0 * median(sizes), near, sizes.size());
}

}  // namespace crashrank::bench
