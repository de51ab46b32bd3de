#include "common.hpp"
#include "crashrank/dispatch/study/study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace crashrank::bench {

namespace {

struct Case {
  bool batch = false;
  StoreMode store = StoreMode::shared;
  std::uint32_t depth = 0;
  Policy policy = Policy::best_match;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const bool batch : {false, true}) {
    for (const StoreMode store : {StoreMode::shared, StoreMode::private_copy}) {
      for (const std::uint32_t depth : {5U, 8U, 10U}) {
        for (const Policy policy : all_policies()) cases.push_back({batch, store, depth, policy});
      }
    }
  }
  return cases;
}

DispatchOptions options_of(const Case& what) {
  DispatchOptions options;
  options.depth = what.depth;
  options.policy = what.policy;
  options.store = what.store;
  return options;
}

/// One case, turn by turn.
struct Tally {
  std::vector<double> measured;             ///< seconds on two real cores
  std::vector<std::vector<double>> errors;  ///< by machine: replayed over measured, less one
};

/// Real and recorded runs by turns through all cases, so that whatever else the host does meets all
/// cases, and both sides of a comparison.
std::vector<Tally> play(Dispatcher& one, Dispatcher& two, View<const DispatchQuery> queries,
                        View<const Case> cases, View<const VirtualMachine> machines, int turns) {
  std::vector<Tally> tallies(cases.size());
  PairLists pairs;
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const DispatchOptions options = options_of(cases[i]);
      const std::size_t at_once = cases[i].batch ? queries.size() : 1;
      double measured = 0.0;
      std::vector<double> predicted(machines.size(), 0.0);
      for (std::size_t first = 0; first < queries.size(); first += at_once) {
        const View<const DispatchQuery> asked(queries.data() + first, at_once);
        measured += run(two, asked, pairs, options).seconds;
        const DispatchRecording recording = record(one, asked, options, 1);
        for (std::size_t m = 0; m < machines.size(); ++m) {
          ReplayOptions how;
          how.policy = options.policy;
          how.store = options.store;
          how.machine = machines[m];
          predicted[m] += replayed(recording, how).seconds;
        }
      }
      Tally& tally = tallies[i];
      tally.errors.resize(machines.size());
      tally.measured.push_back(measured);
      for (std::size_t m = 0; m < machines.size(); ++m) {
        tally.errors[m].push_back(predicted[m] / measured - 1.0);
      }
    }
  }
  return tallies;
}

/// Waking as measured; copying and the cost of a batch as they fit the first half of the poses.
VirtualMachine fitted(Dispatcher& one, Dispatcher& two, View<const DispatchQuery> queries) {
  VirtualMachine machine;
  machine.processors = 2;
  machine.workers = 2;
  if (!measure_waking(two.pool(), machine).ok()) give_up("waking could not be measured");
  std::vector<DispatchRecording> recordings;
  for (const Case& what : all_cases()) {
    if (what.store != StoreMode::private_copy || what.batch) continue;
    for (const DispatchQuery& query : queries) {
      recordings.push_back(record(one, {&query, 1}, options_of(what), 1));
    }
  }
  fit_copying(recordings, machine);
  std::vector<VirtualMachine> machines;
  for (int step = 0; step <= 10; ++step) {
    machine.batch_s = 0.5e-6 * step;
    machines.push_back(machine);
  }
  double best = std::numeric_limits<double>::infinity();
  const std::vector<Case> cases = all_cases();
  const std::vector<Tally> tallies = play(one, two, queries, cases, machines, 9);
  for (std::size_t m = 0; m < machines.size(); ++m) {
    double sum = 0.0;
    for (const Tally& tally : tallies) sum += std::abs(median(tally.errors[m]));
    if (sum >= best) continue;
    best = sum;
    machine = machines[m];
  }
  return machine;
}

}  // namespace

/// Replayed on two virtual cores against measured on two real ones. Costs are fitted on the first
/// half of the poses, times compared on the second half, alone and in one dispatch.
void validate(const Scene& scene) {
  const std::vector<DispatchQuery> queries = scene.queries(Kernel::scalar);
  const std::size_t half = queries.size() / 2;
  const View<const DispatchQuery> known(queries.data(), half);
  const View<const DispatchQuery> unknown(queries.data() + half, queries.size() - half);
  Dispatcher one = start(1);
  Dispatcher two = start(2);
  const VirtualMachine machine = fitted(one, two, known);
  std::printf(
      "post %.2f us, send %.2f us, wake %.2f us, main wake %.2f us, batch %.1f us, copy %.0f ns a "
      "part and %.2f GB/s\n",
      machine.post_s * 1e6, machine.send_s * 1e6, machine.wake_s * 1e6, machine.main_wake_s * 1e6,
      machine.batch_s * 1e6, machine.copy_part_s * 1e9, machine.copy_bytes_per_s * 1e-9);
  std::printf("what   store   depth policy            measured us   error\n");
  std::vector<double> errors;
  const std::vector<Case> cases = all_cases();
  const std::vector<Tally> tallies = play(one, two, unknown, cases, {&machine, 1}, 25);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& what = cases[i];
    errors.push_back(median(tallies[i].errors[0]));
    std::printf("%-6s %-7s %5u %-16s %12.1f %+6.1f%%\n", what.batch ? "batch" : "single",
                store_name(what.store), what.depth, policy_name(what.policy),
                median(tallies[i].measured) * 1e6, 100.0 * errors.back());
  }
  std::vector<double> sizes;
  for (const double error : errors) sizes.push_back(std::abs(error));
  std::sort(sizes.begin(), sizes.end());
  const auto near = std::count_if(sizes.begin(), sizes.end(), [](double x) { return x <= 0.1; });
  std::printf(
      "median error %+.1f%%; of sizes: median %.1f%%, 90%% quantile %.1f%%, largest %.1f%%; "
      "%td of %zu within 10%%\n",
      100.0 * median(errors), 100.0 * median(sizes), 100.0 * sizes[sizes.size() * 9 / 10],
      100.0 * sizes.back(), near, sizes.size());
}

}  // namespace crashrank::bench
