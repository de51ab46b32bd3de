#include "dispatch/choose_depth.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

std::uint32_t choose_depth(View<const DispatchQuery> queries, std::uint32_t workers,
                           const DispatchOptions& options) noexcept {
  if (workers == 0) return auto_depth;
  double triangles = 0.0;
  for (const DispatchQuery& query : queries) {
    triangles +=
        static_cast<double>(query.a->tree().triangles.size() + query.b->tree().triangles.size());
  }
  // Two cars of 10,000 triangles that crash take the scalar kernel about 100 us and the fast one a
  // quarter of that. Below a few hundred microseconds, waking workers eats what they save.
  const double worth_it = options.kernel == Kernel::fast ? 160e3 : 40e3;
  if (!(triangles > worth_it)) return auto_depth;
  // One query wants some ten jobs a core: depths 8 and 10 or 11 for two cars of 10,000 and of
  // 60,000 triangles. Jobs grow by about half with every depth, and in proportion to the queries,
  // which need not be cut finely when there are many.
  const auto count = static_cast<double>(queries.size());
  const double depth = std::log2(triangles / count) - 6.3 - 1.7 * std::log2(count);
  const double least = options.store == StoreMode::private_copy ? 5.0 : 3.0;
  return static_cast<std::uint32_t>(std::clamp(std::round(depth), least, 12.0));
}

}  // namespace crashrank::detail
