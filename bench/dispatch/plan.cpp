#include "common.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace crashrank::bench {

namespace {

struct Link {
  const char* name;
  double bytes_per_s;
  double latency_s;
};

/// From one package to separate controllers in a vehicle: parts copied from shared memory, PCI
/// Express, and the Ethernets that vehicles carry.
constexpr Link links[] = {{"memory", 0.0, 0.0},
                          {"8 GB/s, 1 us", 8e9, 1e-6},
                          {"10 Gbit/s, 10 us", 1.25e9, 10e-6},
                          {"1 Gbit/s, 50 us", 0.125e9, 50e-6}};

struct Best {
  double seconds = 0.0;
  std::uint32_t depth = 0;
  Policy policy = Policy::best_match;
  double transfer = 0.0;
};

}  // namespace

/// Best policy and depth for 4 to 64 cores and links of given speed, for one query (means over the
/// poses) and for all poses in one dispatch. Private stores, scalar kernel.
void plan(const Scene& scene) {
  const std::vector<DispatchQuery> queries = scene.queries(Kernel::scalar);
  Dispatcher here = start(0);
  Dispatcher one = start(1);
  VirtualMachine machine;
  if (!measure_waking(one.pool(), machine).ok()) give_up("waking could not be measured");
  machine.spin_s = 0.0;
  std::printf(
      "what   cores link                serial us   best us speedup depth policy"
      "            transfer\n");
  for (const bool batch : {false, true}) {
    std::vector<View<const DispatchQuery>> asked;
    if (batch) {
      asked.emplace_back(queries);
    } else {
      for (const DispatchQuery& query : queries) asked.emplace_back(&query, 1);
    }
    PairLists pairs;
    double serial = 0.0;
    for (const DispatchQuery& query : queries) {
      double smallest = 1e9;
      for (int i = 0; i < 9; ++i) {
        smallest = std::min(smallest, run(here, {&query, 1}, pairs, {}).seconds);
      }
      serial += smallest / static_cast<double>(asked.size());
    }
    constexpr std::uint32_t deepest = 13;
    std::vector<std::vector<DispatchRecording>> recordings(deepest + 1);
    for (std::uint32_t depth = 1; depth <= deepest; ++depth) {
      DispatchOptions options;
      options.depth = depth;
      options.store = StoreMode::private_copy;
      for (const View<const DispatchQuery> query : asked) {
        recordings[depth].push_back(record(one, query, options, batch ? 3 : 9));
      }
    }
    fit_copying(recordings[8], machine);
    for (const std::uint32_t cores : {4U, 8U, 16U, 64U}) {
      for (const Link& link : links) {
        Best best;
        for (std::uint32_t depth = 1; depth <= deepest; ++depth) {
          for (const Policy policy : all_policies()) {
            ReplayOptions how;
            how.policy = policy;
            how.store = StoreMode::private_copy;
            how.machine = machine;
            how.machine.processors = cores;
            how.machine.workers = cores;
            how.machine.link_bytes_per_s = link.bytes_per_s;
            how.machine.link_latency_s = link.latency_s;
            double seconds = 0.0;
            double transfer = 0.0;
            for (const DispatchRecording& recording : recordings[depth]) {
              const ReplayReport report = replayed(recording, how);
              seconds += report.seconds / static_cast<double>(asked.size());
              transfer += report.relative_transfer / static_cast<double>(asked.size());
            }
            if (best.depth == 0 || seconds < best.seconds) {
              best = {seconds, depth, policy, transfer};
            }
          }
        }
        std::printf("%-6s %5u %-18s %10.1f %9.1f %7.2f %5u %-16s %9.3f\n",
                    batch ? "batch" : "single", cores, link.name, serial * 1e6, best.seconds * 1e6,
                    serial / best.seconds, best.depth, policy_name(best.policy), best.transfer);
      }
    }
  }
}

}  // namespace crashrank::bench
