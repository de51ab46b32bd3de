#pragma once

#include "crashrank/rank/rank.hpp"

#include <string>
#include <vector>

namespace crashrank::detail {

/// Most significant digits of a printed score: what differs by less prints alike.
inline constexpr int most_score_digits = 9;

/// The scores of a ranking as text, one for each row; an interval where the score is not known.
///
/// Digits of a score: up to the first that its interval leaves open, five where nothing is open. At
/// least one, so that only 0 prints as 0; and as many more, up to `most_score_digits`, as keep the
/// printed numbers in the order of the scores: a lower score never prints as the higher number, and
/// different scores do not print alike. Equal scores print alike.
std::vector<std::string> score_texts(const RankResult& result);

/// A number with that many decimals; one significant digit where those would show a number other
/// than 0 as 0.
std::string fixed_text(double value, int decimals);

/// Harm in persons with two digits; what rounds to less than 0.0001 is not written out.
std::string harm_text(double persons);

/// A probability in whole percent; "<1 %" and ">99 %" where 0 or 100 would say that it is certain.
std::string percent_text(double probability);

/// "at 12.4 m/s" as people say it, "at 45 km/h"; what stands in quotes is a name and stays.
std::string in_kmh(const std::string& text);

/// The interval, ends rounded outwards to that digit: "0.1 to 0.4"; empty where it is a point.
std::string interval_text(const CandidateResult& ranked);

/// The places it may have: "2", "1-3".
std::string places_text(const CandidateResult& ranked);

/// "2", "2 tied".
std::string place_text(const CandidateResult& ranked);

/// Candidates among the first `shown` rows that are tied, and neighbours whose order is not
/// certain, one sentence each, names as they are: "rank 1: 3 candidates are tied (a, b, c)", "rank
/// 2 and 3 not separable (the order reverses in 38 % of 129 samples)". Neighbours in a row have one
/// for each reason: "rank 2 to 5 not separable from the next (...)".
std::vector<std::string> not_separable_words(const RankResult& result, std::size_t shown);

/// Options of the harm: model, every weight, numbers of people, ranges. Lines without a break.
std::vector<std::string> harm_words(const HarmOptions& harm);

}  // namespace crashrank::detail
