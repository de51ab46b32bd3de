#include "common.hpp"
#include "crashrank/dispatch/study/study.hpp"

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

/// A machine, a depth and a policy, turn by turn.
struct Choice {
  std::uint32_t cores = 0;
  const Link* link = nullptr;
  std::uint32_t depth = 0;
  Policy policy = Policy::best_match;
  std::vector<double> seconds;
  double transfer = 0.0;
};

std::vector<Choice> all_choices() {
  constexpr std::uint32_t deepest = 13;
  std::vector<Choice> choices;
  for (std::uint32_t depth = 1; depth <= deepest; ++depth) {
    for (const std::uint32_t cores : {4U, 8U, 16U, 64U}) {
      for (const Link& link : links) {
        for (const Policy policy : all_policies()) {
          choices.push_back({cores, &link, depth, policy, {}, 0.0});
        }
      }
    }
  }
  return choices;
}

DispatchOptions copying_at(std::uint32_t depth) {
  DispatchOptions options;
  options.depth = depth;
  options.store = StoreMode::private_copy;
  return options;
}

/// Replays what one worker just did on the machine of every choice of that depth.
void replay_all(const DispatchRecording& recording, const VirtualMachine& machine, double share,
                View<Choice> choices) {
  for (Choice& choice : choices) {
    if (choice.depth != recording.depth) continue;
    ReplayOptions how;
    how.policy = choice.policy;
    how.store = StoreMode::private_copy;
    how.machine = machine;
    how.machine.processors = choice.cores;
    how.machine.workers = choice.cores;
    how.machine.link_bytes_per_s = choice.link->bytes_per_s;
    how.machine.link_latency_s = choice.link->latency_s;
    const ReplayReport report = replayed(recording, how);
    choice.seconds.back() += report.seconds * share;
    choice.transfer += report.relative_transfer * share;
  }
}

}  // namespace

/// Best policy and depth for 4 to 64 cores and links of given speed, for one query (means over the
/// poses) and for all poses in one dispatch. Private stores, scalar kernel; medians over turns.
void plan(const Scene& scene) {
  const std::vector<DispatchQuery> queries = scene.queries(Kernel::scalar);
  Dispatcher here = start(0);
  Dispatcher one = start(1);
  VirtualMachine machine;
  if (!measure_waking(one.pool(), machine).ok()) give_up("waking could not be measured");
  machine.spin_s = 0.0;
  const DispatchRecording known = record(one, queries, copying_at(8), 1);
  fit_copying({&known, 1}, machine);
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
    const double share = 1.0 / static_cast<double>(asked.size());
    PairLists pairs;
    std::vector<Choice> choices = all_choices();
    std::vector<double> serial;
    constexpr int turns = 3;
    for (int turn = 0; turn < turns; ++turn) {
      double seconds = 0.0;
      for (const DispatchQuery& query : queries) {
        seconds += run(here, {&query, 1}, pairs, {}).seconds * share;
      }
      serial.push_back(seconds);
      for (Choice& choice : choices) choice.seconds.push_back(0.0);
      for (std::uint32_t depth = 1; depth <= choices.back().depth; ++depth) {
        for (const View<const DispatchQuery> together : asked) {
          replay_all(record(one, together, copying_at(depth), 1), machine, share, choices);
        }
      }
    }
    for (const std::uint32_t cores : {4U, 8U, 16U, 64U}) {
      for (const Link& link : links) {
        const Choice* best = nullptr;
        for (const Choice& choice : choices) {
          if (choice.cores != cores || choice.link != &link) continue;
          if (best == nullptr || median(choice.seconds) < median(best->seconds)) best = &choice;
        }
        std::printf("%-6s %5u %-18s %10.1f %9.1f %7.2f %5u %-16s %9.3f\n",
                    batch ? "batch" : "single", cores, link.name, median(serial) * 1e6,
                    median(best->seconds) * 1e6, median(serial) / median(best->seconds),
                    best->depth, policy_name(best->policy), best->transfer / turns);
      }
    }
  }
}

}  // namespace crashrank::bench
