#pragma once

#include "crashrank/dispatch/dispatcher.hpp"

#include <cstdint>

namespace crashrank::detail {

/// The distribution depth for these queries on so many workers; `auto_depth` where the calling
/// thread is done before sharing out could pay.
std::uint32_t choose_depth(View<const DispatchQuery> queries, std::uint32_t workers,
                           const DispatchOptions& options) noexcept;

}  // namespace crashrank::detail
