#include "rank_warnings.hpp"

#include "console.hpp"

#include "crashrank/crash/pulse.hpp"
#include "crashrank/rank/candidate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>

namespace crashrank::cli {
namespace {

void warn_of_speed(const std::string& file, const RankResult& ranked) {
  if (!needs_crash(ranked.measure)) return;
  const auto too_fast =
      std::count_if(ranked.ranking.begin(), ranked.ranking.end(), [](const CandidateResult& c) {
        return std::any_of(c.contacts.begin(), c.contacts.end(), [](const Contact& contact) {
          return contact.closing_speed_mps > fastest_pulse_mps;
        });
      });
  if (too_fast == 0) return;
  warn(file, fmt::format(
                 "{} somebody at more than {:g} m/s, where the crash model does not hold: "
                 "its scores fall as speed rises; rank by closing-energy",
                 too_fast == 1 ? "1 candidate meets" : fmt::format("{} candidates meet", too_fast),
                 fastest_pulse_mps));
}

void warn_of_grip(const std::string& file, const Scenario& scenario, const RankResult& ranked) {
  // The grid takes the whole grip, up to rounding.
  constexpr double whole = 1.001;
  std::size_t beyond = 0;
  std::string best;
  for (std::size_t place = 0; place < ranked.ranking.size(); ++place) {
    const CandidateResult& result = ranked.ranking[place];
    const Candidate& candidate = ranked.candidates[result.candidate];
    const double until_s =
        result.contacts.empty() ? scenario.horizon_s : result.contacts.front().time_of_impact_s;
    const std::optional<double> demand = grip_demand(candidate, scenario, until_s);
    if (!demand || *demand <= whole) continue;
    if (beyond++ == 0) {
      best = fmt::format("'{}', in place {}, takes {:.2f} times what there is", candidate.name,
                         place + 1, *demand);
    }
  }
  if (beyond == 0) return;
  warn(file, fmt::format("{} beyond the tyres' grip ({:g}), so that the car cannot follow: {}",
                         beyond == 1 ? "1 listed manoeuvre lies"
                                     : fmt::format("{} listed manoeuvres lie", beyond),
                         scenario.grip, best));
}

}  // namespace

void warn_of_doubts(const std::string& file, const Scenario& scenario, const RankResult& ranked) {
  warn_of_speed(file, ranked);
  warn_of_grip(file, scenario, ranked);
}

}  // namespace crashrank::cli
