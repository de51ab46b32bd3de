#include "common.hpp"
#include "crashrank/dispatch/study/study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

namespace crashrank::bench {

/// What jobs of one estimate take: quantiles by powers of two of estimated work, over the jobs of
/// all poses at depths 1 to 12.
void estimates(const Scene& scene) {
  Dispatcher one = start(1);
  std::printf("kernel work at least    jobs   p10 us   p50 us   p90 us\n");
  for (const Kernel kernel : {Kernel::fast, Kernel::scalar}) {
    const std::vector<DispatchQuery> queries = scene.queries(kernel);
    std::map<int, std::vector<double>> seconds;
    for (std::uint32_t depth = 1; depth <= 12; ++depth) {
      DispatchOptions options;
      options.depth = depth;
      options.kernel = kernel;
      for (const RecordedJob& job : record(one, queries, options, 5).jobs) {
        seconds[static_cast<int>(std::log2(job.work))].push_back(job.run_seconds);
      }
    }
    for (auto& [bucket, times] : seconds) {
      std::sort(times.begin(), times.end());
      const auto quantile = [&times = times](double q) {
        return 1e6 * times[static_cast<std::size_t>(q * static_cast<double>(times.size() - 1))];
      };
      std::printf("%-6s %12.0f %7zu %8.2f %8.2f %8.2f\n", kernel_name(kernel), std::exp2(bucket),
                  times.size(), quantile(0.1), quantile(0.5), quantile(0.9));
    }
  }
}

}  // namespace crashrank::bench
