#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/rank/rank.hpp"
#include "rank/scene.hpp"

#include <vector>

namespace crashrank::detail {

/// Evaluates all of `result.candidates` into `result.ranking`, in the same order, on
/// `options.workers` threads. Simulations are shared out candidate by candidate. The damage queries
/// of every 16 candidates a thread form one dispatch, in which the part indices of the ego serve
/// all candidates. If the system refuses threads, the calling thread does all the work. Sets
/// in `needed` what any worker sets in Scratch::needed.
///
/// Errors: usage for a depth out of range; internal if a worker failed.
Status evaluate_on_workers(const Scene& scene, const RankOptions& options, RankResult& result,
                           std::vector<char>& needed);

}  // namespace crashrank::detail
