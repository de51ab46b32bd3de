#include "dispatch/choose_depth.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

TreeCut choose_cut(View<const DispatchQuery> queries, std::uint32_t workers,
                   const DispatchOptions& options, bool by_work) noexcept {
  TreeCut cut;
  if (workers == 0) return cut;
  double triangles = 0.0;
  for (const DispatchQuery& query : queries) {
    triangles +=
        static_cast<double>(query.a->tree().triangles.size() + query.b->tree().triangles.size());
  }
  // Two cars of 10,000 triangles that crash take the scalar kernel about 100 us and the fast one a
  // quarter of that. Below, waking workers eats what they save.
  const bool fast = options.kernel == Kernel::fast;
  const double worth_it = fast ? 160e3 : 40e3;
  if (!(triangles > worth_it)) return cut;
  if (by_work) {
    // A dozen jobs a thread even out at the end; smaller ones cost more to send. Before, a
    // job may take half of what each thread's share of all later queries is.
    const double seconds = triangles * (fast ? 0.8e-9 : 4.5e-9);
    const double sharers = std::max(4U, workers + 1);
    // Many queries need not be cut deeply, and a depth has a cost: the table of parts by core.
    const double deepest = 12.0 - std::log2(static_cast<double>(queries.size()));
    cut.depth = static_cast<std::uint32_t>(std::clamp(std::round(deepest), 5.0, 12.0));
    cut.job_seconds = static_cast<float>(std::clamp(seconds / (12.0 * sharers), 3e-6, 20e-6));
    cut.per_later_query_seconds =
        static_cast<float>(seconds / (2.0 * sharers * static_cast<double>(queries.size())));
    return cut;
  }
  // One query wants some ten jobs a core: depths 8 and 10 or 11 for two cars of 10,000 and of
  // 60,000 triangles. Jobs grow by about half with every depth, and in proportion to the queries,
  // which need not be cut finely when there are many.
  const auto count = static_cast<double>(queries.size());
  const double depth = std::log2(triangles / count) - 6.3 - 1.7 * std::log2(count);
  const double least = options.store == StoreMode::private_copy ? 5.0 : 3.0;
  cut.depth = static_cast<std::uint32_t>(std::clamp(std::round(depth), least, 12.0));
  return cut;
}

}  // namespace crashrank::detail
