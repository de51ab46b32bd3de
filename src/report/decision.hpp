#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// What a page says first, for people who know nothing of rankings. Names as they are.
struct Decision {
  std::string sentence;              ///< what to do, and what comes of it
  std::string next;                  ///< what else there was; empty if nothing was
  bool is_clear = false;             ///< the first touches nothing in any future
  std::vector<std::string> sure;     ///< how sure the first place is, sentences
  std::vector<std::string> against;  ///< what speaks against the first, sentences
};

/// `scores` are those of `score_texts`. The ranking has at least one row.
Decision decision_of(const Scenario& scenario, const RankResult& result,
                     const std::vector<std::string>& scores);

/// The manoeuvre in words: the name of a listed one, "brake hard and steer slightly left" of a
/// generated one.
std::string plain_manoeuvre(const Scenario& scenario, const Candidate& candidate);

/// A probability as people count it: "about 2 in 100", "fewer than 1 in 1000", "no chance".
std::string chance_words(double probability);

/// Probability that at least one of the people comes to the outcome of the risk model.
double chance_of_any(const CandidateResult& ranked);

/// "seriously hurt", "killed".
const char* outcome_participle(RiskModel model);

}  // namespace crashrank::detail
