#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "scenario/refusals.hpp"

#include <string>

namespace crashrank::detail {

/// A scenario, and what its text leaves to another file.
struct ParsedScenario {
  Scenario scenario;
  std::string candidate_table;  ///< as the text names it; empty: none
};

/// `parse_scenario` of a text that may name a table of candidates.
Result<ParsedScenario> parse_scenario_text(const std::string& text, const std::string& file);

/// The same as far as it can be read; errors are without the file.
ParsedScenario parse_scenario_text(const std::string& text, const std::string& file,
                                   Refusals& refusals);

}  // namespace crashrank::detail
