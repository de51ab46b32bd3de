#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// A row of the ranking that a page sets beside the first.
struct Choice {
  std::size_t row = 0;    ///< of the ranking
  std::string role;       ///< "best", "next best", "best braking straight on", "worst of 225"
  std::string manoeuvre;  ///< see `plain_manoeuvre`, with figures where others are called alike
  std::string outcome;    ///< "about 2 in 100", or the score with its unit
};

/// What a page says first, for people who know nothing of rankings. Names as they are.
struct Decision {
  std::string sentence;              ///< what to do, and what comes of it
  std::vector<Choice> choices;       ///< the first, the next best, one that is unlike, the worst
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

/// A probability as people count it, always of a hundred so that two compare: "2 in 100",
/// "0.9 in 100", "under 0.1 in 100", "nearly certain", "no chance".
std::string chance_words(double probability);

/// Probability that at least one of the people comes to the outcome of the risk model.
double chance_of_any(const CandidateResult& ranked);

/// "seriously hurt", "killed".
const char* outcome_participle(RiskModel model);

}  // namespace crashrank::detail
