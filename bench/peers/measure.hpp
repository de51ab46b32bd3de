#pragma once

#include "bench/workload.hpp"
#include "peer.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace peers {

using bench::Regime;
using bench::regime_count;
using bench::regime_names;
using bench::Workload;

/// What is asked of a peer.
enum class Mode {
  all,     ///< all pairs, one pose repeated
  any,     ///< yes or no, one pose repeated
  cycled,  ///< all pairs, the poses one after the other, as a planner asks
};
inline constexpr std::array<const char*, 3> mode_names{"all", "any", "all, cycled"};

/// One line of the result.
struct Row {
  std::string workload;
  std::size_t triangles = 0;
  Regime regime = Regime::deep;
  Mode mode = Mode::all;
  std::string peer;
  double microseconds = 0.0;  ///< a query; least of the repeats, median over the poses
  std::uint64_t pairs = 0;    ///< over all poses, each once; of `any`: poses answered yes
  std::uint64_t missed = 0;   ///< against crashrank's exact answer
  std::uint64_t invented = 0;
};

struct MeasureOptions {
  int rounds = 2;                    ///< each round visits every pose and, at each pose, every peer
  double budget_s = 0.01;            ///< spent repeating one query, at least one repeat
  std::vector<std::string> regimes;  ///< measure only these; empty: all
  std::vector<std::string> modes;
  bool progress = false;
};

/// Prepares every peer for the workload and measures them side by side: at each pose one peer after
/// the other, so that whatever disturbs the machine disturbs all alike.
std::vector<Row> measure(const Workload& workload, std::vector<std::unique_ptr<Peer>>& peers,
                         const MeasureOptions& options);

}  // namespace peers
