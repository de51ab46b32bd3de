#include "quick_answer.hpp"

#include "crashrank/rank/candidate.hpp"

#include <chrono>
#include <limits>
#include <system_error>
#include <utility>

namespace crashrank::cli {

QuickAnswer::QuickAnswer(const Scenario& scenario, const std::vector<Model>& models,
                         const RankOptions& how, Print print)
    : scenario_(scenario), models_(models), how_(how), print_(std::move(print)) {
  how_.workers = 1;  // the ranking has the others
  try {
    thread_ = std::thread([this] { prepare(); });
  } catch (const std::system_error&) {
    // The system refuses threads: an interruption knows nothing.
  }
}

QuickAnswer::~QuickAnswer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  ended_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void QuickAnswer::prepare() {
  constexpr std::chrono::milliseconds patience(700);
  {
    std::unique_lock<std::mutex> lock(mutex_);
    if (ended_.wait_for(lock, patience, [this] { return is_over_; })) return;
  }
  const double length_m = models_[scenario_.ego.model].mesh.bounds().extent().x();
  Result<std::vector<Candidate>> candidates = make_candidates(scenario_, length_m);
  if (!candidates) return;
  RankerOptions options;
  options.rank = how_;
  options.limits.candidates = candidates->size();
  options.limits.actors = scenario_.actors.size();
  options.limits.triangles = std::numeric_limits<std::size_t>::max();
  Result<Ranker> ranker = Ranker::prepare(scenario_, models_, options);
  if (!ranker) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  candidates_ = std::move(*candidates);
  ranker_.emplace(std::move(*ranker));
}

Interruption QuickAnswer::tell() {
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock || !ranker_) return {{}, "nothing is known yet"};
  RankBudget budget;
  budget.deadline_s = 0.05;
  RankerAnswer answer = ranker_->rank(candidates_, budget);
  // To describe a contact takes its simulation: the bounds have to do, equal where a score is
  // known.
  std::vector<RankedCandidate> bounds(answer.ranking.begin(), answer.ranking.end());
  for (RankedCandidate& candidate : bounds) candidate.known = false;
  answer.ranking = bounds;
  answer.complete = false;
  const Result<RankResult> result = ranker_->explain(candidates_, answer);
  if (!result) return {{}, "nothing is known yet"};
  return {print_(*result), "a partial answer, bounds on the scores alone"};
}

}  // namespace crashrank::cli
