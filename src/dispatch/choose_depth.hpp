#pragma once

#include "crashrank/dispatch/dispatcher.hpp"

#include <cstdint>

namespace crashrank::detail {

/// The distribution depth for these queries on so many workers; `auto_depth` where the calling
/// thread is done before workers could have been woken.
std::uint32_t choose_depth(View<const DispatchQuery> queries, std::uint32_t workers) noexcept;

}  // namespace crashrank::detail
