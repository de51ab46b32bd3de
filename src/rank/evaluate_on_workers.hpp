#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/rank/rank.hpp"
#include "rank/scene.hpp"

namespace crashrank::detail {

/// Evaluates all of `result.candidates` into `result.ranking`, in the same order, on
/// `options.workers` threads. Contacts are looked for candidate by candidate; the damage
/// queries of every 16 candidates a thread are one dispatch, in which parts of the ego serve all of
/// them. Where the system
/// refuses threads the calling one does all. `needs_left_out` becomes true as Scratch's does.
/// Errors: usage for a depth out of range; internal when a worker failed.
Status evaluate_on_workers(const Scene& scene, const RankOptions& options, RankResult& result,
                           bool& needs_left_out);

}  // namespace crashrank::detail
