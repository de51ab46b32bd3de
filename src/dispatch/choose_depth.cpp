#include "dispatch/choose_depth.hpp"

#include <algorithm>

namespace crashrank::detail {

std::uint32_t choose_depth(View<const DispatchQuery> queries, std::uint32_t workers) noexcept {
  if (workers == 0) return auto_depth;
  std::size_t bytes = 0;
  std::size_t largest = 0;
  for (const DispatchQuery& query : queries) {
    const std::size_t both = query.a->model_bytes() + query.b->model_bytes();
    bytes += both;
    largest = std::max(largest, both);
  }
  // Two cars of 10,000 triangles are 1.2 MB: below two megabytes in all, waking workers takes
  // longer than the query.
  if (bytes < (std::size_t{2} << 20U)) return auto_depth;
  std::uint32_t depth = 3;
  for (std::size_t size = std::size_t{1} << 16U; size < largest; size <<= 2U) ++depth;
  return std::min(depth, max_distribution_depth);
}

}  // namespace crashrank::detail
