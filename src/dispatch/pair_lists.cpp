#include "crashrank/dispatch/dispatcher.hpp"

#include <algorithm>
#include <numeric>

namespace crashrank {

std::size_t PairLists::total() const noexcept {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

void PairLists::gather(std::size_t query, std::vector<Pair>& pairs) const {
  pairs.clear();
  pairs.reserve(count(query));
  for_each_run(query,
               [&](View<const Pair> run) { pairs.insert(pairs.end(), run.begin(), run.end()); });
}

void PairLists::gather_sorted(std::size_t query, std::vector<Pair>& pairs) const {
  gather(query, pairs);
  std::sort(pairs.begin(), pairs.end());
}

void PairLists::begin(std::size_t workers, std::size_t queries) {
  found_.resize(workers + 1);  // the last one is for sorting
  for (FoundPairs& found : found_) {
    found.pairs.clear();
    found.runs.clear();
  }
  runs_.clear();
  counts_.assign(queries, 0);
  first_run_.assign(queries + 1, 0);
}

void PairLists::finish() {
  std::size_t total = 0;
  for (const FoundPairs& found : found_) {
    for (const PairRun& run : found.runs) {
      counts_[run.query] += run.count;
      ++first_run_[run.query + 1];
    }
    total += found.runs.size();
  }
  std::partial_sum(first_run_.begin(), first_run_.end(), first_run_.begin());
  runs_.resize(total);
  for (const FoundPairs& found : found_) {
    for (const PairRun& run : found.runs) runs_[first_run_[run.query]++] = run;
  }
  // Each start has moved on to the next query's.
  std::copy_backward(first_run_.begin(), first_run_.end() - 1, first_run_.end());
  first_run_[0] = 0;
}

void PairLists::begin_sort() {
  const auto last = static_cast<std::uint32_t>(found_.size() - 1);
  found_[last].pairs.resize(total());
  sorted_runs_.clear();
  std::size_t first = 0;
  for (std::size_t query = 0; query < queries(); ++query) {
    sorted_runs_.push_back({static_cast<std::uint32_t>(query), last, first, counts_[query]});
    first += counts_[query];
  }
}

void PairLists::sort_query(std::size_t query) {
  const PairRun& sorted = sorted_runs_[query];
  Pair* const first = found_[sorted.worker].pairs.data() + sorted.first;
  Pair* to = first;
  for_each_run(query, [&](View<const Pair> run) { to = std::copy(run.begin(), run.end(), to); });
  std::sort(first, to);
}

void PairLists::end_sort() {
  runs_.swap(sorted_runs_);
  std::iota(first_run_.begin(), first_run_.end(), std::size_t{0});
}

}  // namespace crashrank
