#pragma once

#include "crashrank/rank/rank.hpp"
#include "crashrank/rank/scenario.hpp"

#include <string>

namespace crashrank::cli {

/// Warns, on standard error, of what makes places of an answer doubtful: contacts faster than the
/// crash model reaches, and listed manoeuvres beyond the grip. `file` is the scenario's.
void warn_of_doubts(const std::string& file, const Scenario& scenario, const RankResult& ranked);

}  // namespace crashrank::cli
