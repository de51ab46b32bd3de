#pragma once

#include "interrupt.hpp"

#include "crashrank/rank/rank.hpp"
#include "crashrank/rank/ranker.hpp"
#include "crashrank/rank/scenario.hpp"
#include "crashrank/tree/model.hpp"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace crashrank::cli {

/// What an interruption of a ranking prints: bounds on every candidate's score, found in a moment
/// while the ranking goes on. Its Ranker is prepared by a thread of its own, once the ranking has
/// taken so long that an interruption is likely.
class QuickAnswer {
public:
  using Print = std::function<std::string(const RankResult&)>;

  /// All have to outlive it.
  QuickAnswer(const Scenario& scenario, const std::vector<Model>& models, const RankOptions& how,
              Print print);
  ~QuickAnswer();
  QuickAnswer(const QuickAnswer&) = delete;
  QuickAnswer& operator=(const QuickAnswer&) = delete;

  /// For PartialAnswer.
  Interruption tell();

private:
  void prepare();

  const Scenario& scenario_;
  const std::vector<Model>& models_;
  RankOptions how_;
  Print print_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_over_ = false;
  std::vector<Candidate> candidates_;
  std::optional<Ranker> ranker_;  ///< from when it is ready
  std::thread thread_;
};

}  // namespace crashrank::cli
