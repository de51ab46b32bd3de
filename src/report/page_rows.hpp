#pragma once

#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// A row of the page's table. Names as they are.
struct PageRow {
  std::string place;      ///< "2"
  std::string bracket;    ///< "tied", "near" where the next may be better, else empty
  std::string name;       ///< the candidate's
  std::string manoeuvre;  ///< in words; the name of a listed one
  std::string score;      ///< as printed
  std::string interval;   ///< as printed; may be empty
  double value = 0.0;     ///< the length of its bar; the upper end where the score is not known
  double lowest = 0.0;    ///< of its interval
  double highest = 0.0;   ///< of its interval
  std::string contact;    ///< the first one: with whom, when, how fast
  double time_s = -1.0;   ///< of that contact; negative without
  std::string warnings;   ///< may be empty
};

/// What a row hits first, when and at which speed, and what then: by name, or `in_short` counted.
std::string contact_words(const Scenario& scenario, const CandidateResult& ranked, bool in_short);

PageRow page_row(const Scenario& scenario, const RankResult& result,
                 const std::vector<std::string>& scores, std::size_t place);

/// What a bar of full length stands for: the highest score.
double full_bar(const RankResult& result);

/// [place, bracket, name, manoeuvre, score, interval, value, lowest, highest, contact, time,
/// warnings], names escaped.
nlohmann::ordered_json row_json(const PageRow& row);

/// Places of the first rows in each sample, for a chart: {"names", "places": [[by sample]],
/// "groups": [[title, number of samples]]}; null without samples.
nlohmann::ordered_json stability_json(const RankResult& result);

}  // namespace crashrank::detail
