#include "report/manoeuvre_words.hpp"

#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace crashrank::detail {
namespace {

std::string distance_words(const std::optional<double>& distance_m) {
  return distance_m ? fmt::format("{:.2f} m", *distance_m)
                    : fmt::format("over {:g} m", farthest_clearance_m);
}

std::string gap_words(const std::optional<double>& gap_s) {
  return gap_s ? fmt::format("{:.2f} s", *gap_s) : std::string("no crossing way");
}

/// "0.17 s before a crash"; the time to collision exists.
std::string before_crash(const CandidateResult& ranked) {
  return fmt::format("{:.2f} s before a crash", *ranked.time_to_collision_s);
}

/// "0.17 s from a crash with lorry"; the time to collision exists.
std::string from_crash(const Scenario& scenario, const CandidateResult& ranked) {
  return fmt::format("{:.2f} s from a crash with {}", *ranked.time_to_collision_s,
                     scenario.actors[*ranked.imminent].name);
}

}  // namespace

std::string demand_words(const ManoeuvreDemand& demand) {
  const std::array<std::pair<double, const char*>, 5> all{{
      {demand.grip, "the grip"},
      {demand.engine, "what the engine gives"},
      {demand.brakes, "what the brakes give"},
      {demand.steering, "the steering angle"},
      {demand.steering_rate, "the steering rate"},
  }};
  for (const auto& [share, what] : all) {
    if (share == demand.greatest()) return fmt::format("takes {:.2f} times {}", share, what);
  }
  return {};
}

std::string leaving_probability(const CandidateResult& ranked) {
  if (!ranked.leaves_road) return {};
  double probability = 0.0;
  for (const FutureOutcome& future : ranked.futures) {
    if (future.leaves_road) probability += future.probability;
  }
  // Without futures nothing is known of others than the likeliest; a sum of all may be 1 but for
  // rounding.
  const bool certain = ranked.futures.empty() || probability > 1.0 - 1e-9;
  return certain ? std::string() : percent_text(probability);
}

std::string leaving_words(const CandidateResult& ranked) {
  if (!ranked.leaves_road) return {};
  return fmt::format("leaves the road after {:.2f} s at {:.1f} m/s", ranked.leaves_road->time_s,
                     ranked.leaves_road->speed_mps);
}

bool leaves_in_likeliest(const CandidateResult& ranked) {
  return ranked.futures.empty() ? ranked.leaves_road.has_value()
                                : ranked.futures.front().leaves_road;
}

std::string passing_words(const Scenario& scenario, const CandidateResult& ranked) {
  if (!ranked.score && !ranked.searched) return "not known yet";
  std::string words = ranked.grazes.empty() ? "nothing" : "nothing, but grazes";
  // Both are 0 for a candidate that has a contact in another future.
  if (ranked.collision_probability > 0.0) return words;
  if (ranked.nearest) {
    words += fmt::format(", {:.2f} m from {}", *ranked.least_distance_m,
                         scenario.actors[*ranked.nearest].name);
  }
  if (ranked.soonest) {
    words += fmt::format(", {:.2f} s from {}", *ranked.least_time_gap_s,
                         scenario.actors[*ranked.soonest].name);
  }
  if (ranked.imminent) {
    words += fmt::format(", {} with {} at the horizon", before_crash(ranked),
                         scenario.actors[*ranked.imminent].name);
  }
  return words;
}

std::string manoeuvre_mark(const CandidateResult& ranked) {
  std::string mark;
  if (!ranked.feasible) mark = "cannot be followed";
  if (ranked.leaves_road) {
    const std::string probability = leaving_probability(ranked);
    mark += mark.empty() ? "off the road" : ", off the road";
    if (!probability.empty()) mark += " with " + probability;
  }
  if (ranked.imminent) mark += (mark.empty() ? "" : ", ") + before_crash(ranked);
  return mark;
}

std::string manoeuvre_words(const Scenario& scenario, const CandidateResult& ranked) {
  if (!ranked.score) return {};
  std::string words = "It " + demand_words(ranked.demand) + ".";
  if (!ranked.feasible) words += " The vehicle cannot follow it.";
  if (ranked.collides || ranked.collision_probability > 0.0) return words;
  words += fmt::format(" It stays {} from all others", distance_words(ranked.least_distance_m));
  if (ranked.nearest) {
    words += fmt::format(" (the nearest is {})", scenario.actors[*ranked.nearest].name);
  }
  if (ranked.soonest) {
    words += fmt::format(", and is {:.2f} s from {} at one place", *ranked.least_time_gap_s,
                         scenario.actors[*ranked.soonest].name);
  }
  if (ranked.at_horizon) {
    words +=
        fmt::format(", and is at {:.0f} km/h at the horizon", 3.6 * ranked.at_horizon->speed_mps);
  }
  words += ".";
  if (ranked.imminent) {
    words += " It is " + from_crash(scenario, ranked) +
             " at the horizon if all keep their velocities from there.";
  }
  return words;
}

std::string tie_words(const Scenario& scenario, const CandidateResult& first,
                      const CandidateResult& second) {
  if (first.futures.size() + second.futures.size() > 2 &&
      first.collision_probability != second.collision_probability) {
    return fmt::format("a collision is less probable, {:.3g} % against {:.3g} %",
                       100.0 * first.collision_probability, 100.0 * second.collision_probability);
  }
  if (first.collides != second.collides) return "it touches nothing";
  if (first.grazes.empty() != second.grazes.empty()) {
    return "it passes everything with more than a hair's breadth";
  }
  const auto differ = [](const std::optional<double>& p, const std::optional<double>& q,
                         double enough) {
    return std::round(100.0 * std::min(p.value_or(enough), enough)) !=
           std::round(100.0 * std::min(q.value_or(enough), enough));
  };
  if (second.imminent &&
      differ(first.time_to_collision_s, second.time_to_collision_s, imminent_crash_s)) {
    if (!first.imminent) {
      return "it is not " + from_crash(scenario, second) + " at the end of the horizon";
    }
    return fmt::format("it is further from a crash at the end of the horizon, {} against {}",
                       from_crash(scenario, first), from_crash(scenario, second));
  }
  if (first.leaves_road.has_value() != second.leaves_road.has_value()) {
    return "it stays on the road";
  }
  if (differ(first.least_distance_m, second.least_distance_m, enough_distance_m)) {
    return fmt::format("it stays further from all others, {} against {}",
                       distance_words(first.least_distance_m),
                       distance_words(second.least_distance_m));
  }
  if (differ(first.least_time_gap_s, second.least_time_gap_s, enough_time_gap_s)) {
    return fmt::format("it leaves more time between it and others at one place, {} against {}",
                       gap_words(first.least_time_gap_s), gap_words(second.least_time_gap_s));
  }
  if (!first.collides || first.contacts.empty() || second.contacts.empty()) {
    const double speed = first.at_horizon ? first.at_horizon->speed_mps : 0.0;
    const double other = second.at_horizon ? second.at_horizon->speed_mps : 0.0;
    return fmt::format("it is slower at the horizon, {:.2f} km/h against {:.2f} km/h", 3.6 * speed,
                       3.6 * other);
  }
  const Contact& p = first.contacts.front();
  const Contact& q = second.contacts.front();
  if (p.time_of_impact_s != q.time_of_impact_s) {
    return fmt::format("its first contact is later, {:.3f} s against {:.3f} s", p.time_of_impact_s,
                       q.time_of_impact_s);
  }
  return fmt::format("its closing speed is lower, {:.2f} km/h against {:.2f} km/h",
                     3.6 * p.closing_speed_mps, 3.6 * q.closing_speed_mps);
}

}  // namespace crashrank::detail
