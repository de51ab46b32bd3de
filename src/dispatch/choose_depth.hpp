#pragma once

#include "crashrank/dispatch/dispatcher.hpp"

#include <cstdint>

namespace crashrank::detail {

/// How far trees are cut.
struct TreeCut {
  std::uint32_t depth = auto_depth;  ///< `auto_depth`: the calling thread does all
  float job_seconds = 0.0F;  ///< a pair of nodes that takes no longer is not cut; 0: all are
};

/// How to cut trees for these queries on so many workers; the calling thread does all where it is
/// done before sharing out could pay. `by_work`: jobs may stand at any depth.
TreeCut choose_cut(View<const DispatchQuery> queries, std::uint32_t workers,
                   const DispatchOptions& options, bool by_work) noexcept;

}  // namespace crashrank::detail
