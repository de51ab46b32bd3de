#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/rank/rank.hpp"
#include "rank/scene.hpp"

namespace crashrank::detail {

/// Evaluates all of `result.candidates` into `result.ranking`, in the same order, on
/// `options.workers` threads. Simulations are shared out candidate by candidate. The damage queries
/// of every 16 candidates a thread form one dispatch, in which the part indices of the ego serve
/// all candidates. If the system refuses threads, the calling thread does all the work. Sets
/// `needs_left_out` if any worker sets Scratch::needs_left_out.
///
/// Errors: usage for a depth out of range; internal if a worker failed.
Status evaluate_on_workers(const Scene& scene, const RankOptions& options, RankResult& result,
                           bool& needs_left_out);

}  // namespace crashrank::detail
