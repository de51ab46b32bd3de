#pragma once

#include "crashrank/dispatch/dispatcher.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace crashrank::detail {

/// How far trees are cut.
struct TreeCut {
  std::uint32_t depth = auto_depth;  ///< `auto_depth`: the calling thread does all
  float job_seconds = 0.0F;  ///< a pair of nodes that takes no longer is not cut; 0: all are
  float per_later_query_seconds = 0.0F;  ///< what that grows by for every query still to come

  /// The longest job of a query that `later` others follow. While much is still to come no thread
  /// has to wait for a long job, and a query that stays whole prepares once what each of its pieces
  /// would prepare again; towards the end short jobs let all finish together.
  float longest_job_seconds(std::size_t later) const noexcept {
    return std::max(job_seconds, per_later_query_seconds * static_cast<float>(later));
  }
};

/// How to cut trees for these queries on so many workers; the calling thread does all where it is
/// done before sharing out could pay. `by_work`: jobs may stand at any depth.
TreeCut choose_cut(View<const DispatchQuery> queries, std::uint32_t workers,
                   const DispatchOptions& options, bool by_work) noexcept;

}  // namespace crashrank::detail
