#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/internal/dispatch/found_pairs.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// All pairs of many queries, where the workers wrote them: the caller's buffers, kept between
/// dispatches so that a warm one allocates nothing. A query's pairs lie in a few runs, each
/// written by one worker; `for_each_run` reads them without copying.
class CRASHRANK_API PairLists {
public:
  /// Number of queries.
  std::size_t queries() const noexcept { return counts_.size(); }
  /// Pairs of one query.
  std::size_t count(std::size_t query) const noexcept { return counts_[query]; }
  /// Pairs of all queries.
  std::size_t total() const noexcept;

  /// Calls `use(View<const Pair>)` for each run of a query's pairs, in no particular order.
  template <class Use> void for_each_run(std::size_t query, Use&& use) const {
    for (std::size_t i = first_run_[query]; i < first_run_[query + 1]; ++i) {
      const detail::PairRun& run = runs_[i];
      use(View<const Pair>(found_[run.worker].pairs.data() + run.first, run.count));
    }
  }

  /// Copies a query's pairs into `pairs`, which is cleared first.
  void gather(std::size_t query, std::vector<Pair>& pairs) const;
  /// The same, sorted by a, then b.
  void gather_sorted(std::size_t query, std::vector<Pair>& pairs) const;

private:
  friend class Dispatcher;

  void begin(std::size_t workers, std::size_t queries);
  /// Orders the workers' runs by query.
  void finish();
  /// Makes room for all pairs in one more buffer, a run for each query, into which `sort_query`
  /// copies and sorts; safe from one thread a query. `end_sort` makes that buffer the lists.
  void begin_sort();
  void sort_query(std::size_t query);
  void end_sort();

  std::vector<detail::FoundPairs> found_;
  std::vector<detail::PairRun> runs_;
  std::vector<std::size_t> first_run_;
  std::vector<std::size_t> counts_;
  std::vector<detail::PairRun> sorted_runs_;
};

}  // namespace crashrank
