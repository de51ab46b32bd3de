#pragma once

#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <string>

namespace crashrank::detail {

/// An HTML table of all contacts of a candidate by their begins, those between others included:
/// both names, time, closing speed, and each body's delta-v of the contact's event; under `harm`
/// the harm as well. Names are escaped.
std::string contact_table(const Scenario& scenario, Measure measure, const CandidateResult& ranked);

}  // namespace crashrank::detail
