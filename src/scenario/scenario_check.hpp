#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "scenario/refusals.hpp"

#include <string>

namespace crashrank::detail {

/// Whether a scenario, read or made by a program, holds numbers that can be computed with: the
/// ranges of `scenario_limits`, rigid poses, models that are there. The error names the key path.
Status check_scenario(const Scenario& scenario);
/// The same, adding to errors that reading it found: parts that could not be read have defaults.
void check_scenario(const Scenario& scenario, Refusals& refusals);

/// Whether the names of actors, and those of listed candidates, differ: they tell what an answer is
/// about. Those without one cannot be mistaken for each other. A part of `check_scenario`.
void check_names(const Scenario& scenario, Refusals& refusals);

/// Whether probabilities are positive and sum to 1, and whether futures name each actor once and
/// stand in place of predictions. A part of `check_scenario`.
void check_probabilities(const Scenario& scenario, Refusals& refusals);

/// Whether the road's areas are sound and its numbers in range. A part of `check_scenario`.
void check_road(const Road& road, Refusals& refusals);

/// Whether so many threads may share the work; 0 counts as 1. Errors: usage.
Status check_workers(unsigned workers);

/// Whether harm that a program made keeps to `harm_limits`. `path` goes before its keys.
Status check_harm(const HarmOptions& harm, const std::string& path);

}  // namespace crashrank::detail
