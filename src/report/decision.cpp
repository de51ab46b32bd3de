#include "report/decision.hpp"

#include "report/manoeuvre_words.hpp"
#include "report/ranking_words.hpp"
#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace crashrank::detail {
namespace {

constexpr double no_share_across = 0.01;

/// What steering takes of the grip, left positive.
double share_across(const Scenario& scenario, const Candidate& candidate) {
  const double speed = scenario.ego.speed_mps;
  return candidate.curvature_per_m * speed * speed / (scenario.grip * standard_gravity_mps2);
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

/// Which way a generated manoeuvre leads: -1 to the right, 0 straight on, 1 to the left.
std::optional<int> side_of(const Scenario& scenario, const Candidate& candidate) {
  if (candidate.origin != CandidateOrigin::grid) return std::nullopt;
  const double share = share_across(scenario, candidate);
  return std::abs(share) < no_share_across ? 0 : share > 0.0 ? 1 : -1;
}

/// "about 2 in 100"
std::string about(std::string chance) {
  return chance[0] >= '0' && chance[0] <= '9' ? "about " + chance : chance;
}

bool is_clear(const CandidateResult& ranked) {
  return ranked.score && !ranked.collides && ranked.collision_probability == 0.0 &&
         ranked.grazes.empty();
}

/// "hold speed", "brake hard".
std::string pace_words(double share) {
  constexpr double hard = 0.7;
  constexpr double gentle = 0.3;
  constexpr double none = 0.03;
  if (std::abs(share) < none) return "keep the speed";
  const std::string how = std::abs(share) > hard     ? " hard"
                          : std::abs(share) > gentle ? ""
                                                     : " gently";
  return (share < 0.0 ? "brake" : "speed up") + how;
}

/// "straight on", "steer slightly left".
std::string way_words(double share) {
  constexpr double hard = 0.7;
  constexpr double slight = 0.3;
  if (std::abs(share) < no_share_across) return "straight on";
  const std::string how = std::abs(share) > hard     ? "hard "
                          : std::abs(share) > slight ? ""
                                                     : "slightly ";
  return "steer " + how + (share > 0.0 ? "left" : "right");
}

/// The figures of a generated manoeuvre: " (4.35 m/s², 0.41° left)".
std::string figures(const Candidate& candidate) {
  if (candidate.origin != CandidateOrigin::grid) return {};
  std::string name = candidate.name.substr(0, candidate.name.rfind(" ("));
  for (const auto& [from, to] : {std::pair("brake ", ""), std::pair("speed up ", ""),
                                 std::pair(" m/s2", "\u00a0m/s²"), std::pair(" deg ", "°\u00a0")}) {
    const std::size_t at = name.find(from);
    if (at != std::string::npos) name.replace(at, std::strlen(from), to);
  }
  return " (" + name + ")";
}

/// Whether a candidate brakes in its lane.
bool brakes_straight(const Scenario& scenario, const Candidate& candidate) {
  const double forward = scenario.ego.speed_mps < 0.0 ? -1.0 : 1.0;
  return candidate.acceleration_mps2 * forward < 0.0 &&
         std::abs(share_across(scenario, candidate)) < no_share_across;
}

class Words {
public:
  Words(const Scenario& scenario, const RankResult& result, const std::vector<std::string>& scores)
      : scenario_(scenario), result_(result), scores_(scores) {
    count_wins();
    choose();
  }

  std::string manoeuvre(std::size_t row) const { return plain_manoeuvre(scenario_, of(row)); }

  /// With its figures where another that the decision names is called alike.
  std::string told_apart(std::size_t row) const {
    const std::string words = manoeuvre(row);
    const auto is_alike = [&](std::size_t other) {
      return other != row && manoeuvre(other) == words;
    };
    const bool is_alone = !(rival_ && is_alike(*rival_)) &&
                          std::none_of(chosen_.begin(), chosen_.end(),
                                       [&](const auto& choice) { return is_alike(choice.first); });
    return is_alone ? words : words + figures(of(row));
  }

  /// What comes of a row: "about 2 in 100 that somebody is seriously hurt".
  std::string outcome(std::size_t row, bool is_short) const {
    const CandidateResult& ranked = result_.ranking[row];
    if (!ranked.feasible) return "the vehicle cannot follow it";
    if (is_clear(ranked)) return "no crash";
    if (result_.measure == Measure::harm && ranked.score && !ranked.people.empty()) {
      const std::string chance = about(chance_words(chance_of_any(ranked)));
      return is_short ? chance
                      : fmt::format("{} that somebody is {}", chance,
                                    outcome_participle(result_.harm.model));
    }
    const std::string score = scores_[row] + " " + measure_unit(result_.measure);
    return is_short ? score : score + " (" + measure_meaning(result_.measure) + ")";
  }

  std::string sentence() const {
    const CandidateResult& first = result_.ranking.front();
    const std::string doubt = result_.proved ? "" : "Best guess so far: ";
    const std::string what = doubt.empty() ? capitalised(manoeuvre(0)) : doubt + manoeuvre(0);
    if (!is_clear(first)) return what + ": " + outcome(0, false) + ".";
    std::string text = doubt.empty() ? "No crash needed: " + manoeuvre(0) : what;
    text += " touches nothing";
    if (first.nearest) {
      text += fmt::format(" and stays {:.1f} m away from {}", *first.least_distance_m,
                          scenario_.actors[*first.nearest].name);
    }
    return text + ".";
  }

  std::vector<Choice> choices() const {
    std::vector<Choice> all;
    for (const auto& [row, role] : chosen_) {
      all.push_back({row, role, told_apart(row), outcome(row, true)});
    }
    return all;
  }

  std::vector<std::string> sure() const {
    const CandidateResult& first = result_.ranking.front();
    std::vector<std::string> lines;
    if (!result_.proved) {
      std::string line = "The first place is not proved; still in the race: ";
      constexpr std::size_t shown = 8;
      const std::size_t named = std::min(shown, result_.in_race.size());
      for (std::size_t i = 0; i < named; ++i) {
        line += (i > 0 ? ", " : "") + result_.candidates[result_.in_race[i]].name;
      }
      if (named < result_.in_race.size()) {
        line += fmt::format(" and {} more", result_.in_race.size() - named);
      }
      lines.push_back(line + ".");
    }
    if (first.sharing > 1) {
      lines.push_back(
          fmt::format("{} candidates share the first place: nothing that is known "
                      "tells them apart.",
                      first.sharing));
    }
    if (!wins_.empty()) lines.push_back(stability(first));
    const std::string interval = interval_text(first);
    if (!interval.empty()) {
      lines.push_back(
          fmt::format("With all that is not known, its {} ({}) is {} {}; the upper end is the "
                      "worst case.",
                      measure_name(result_.measure), measure_meaning(result_.measure), interval,
                      measure_unit(result_.measure)));
    }
    if (const std::string other = other_order_words(result_); !other.empty()) {
      lines.push_back(other + ".");
    }
    return lines;
  }

  std::vector<std::string> against() const {
    const CandidateResult& first = result_.ranking.front();
    std::vector<std::string> lines;
    if (const std::string crash = crash_words(first); !crash.empty()) lines.push_back(crash);
    constexpr double often = 0.1;
    if (result_.ranking.size() > 1 && (!first.separable || lost() > often)) {
      // Another may be before the first more often than the next is.
      const std::size_t other = rival_.value_or(1);
      lines.push_back(fmt::format("{} as good: {}, {}.", first.sharing > 1 ? "Just" : "Nearly",
                                  told_apart(other), outcome(other, true)));
    }
    constexpr double near_limit = 0.95;
    if (!first.feasible) {
      lines.push_back("The vehicle cannot follow it: it " + demand_words(first.demand) + ".");
    } else if (first.score && first.demand.greatest() > near_limit) {
      lines.push_back("It leaves nothing in hand: it " + demand_words(first.demand) + ".");
    }
    if (first.leaves_road) {
      const std::string probability = leaving_probability(first);
      lines.push_back("It " + in_kmh(leaving_words(first)) +
                      (probability.empty() ? "." : ", with a probability of " + probability + "."));
    }
    if (first.imminent) {
      lines.push_back(fmt::format("It is {:.2f} s from a crash with {} when the look-ahead ends.",
                                  *first.time_to_collision_s,
                                  scenario_.actors[*first.imminent].name));
    }
    if (!first.grazes.empty()) {
      lines.push_back(fmt::format("It grazes {}.", scenario_.actors[first.grazes[0].actor].name));
    }
    return lines;
  }

private:
  const Candidate& of(std::size_t row) const {
    return result_.candidates[result_.ranking[row].candidate];
  }

  /// "It still crashes into lorry at 31 km/h, then hits pole."; empty where no crash is known.
  std::string crash_words(const CandidateResult& ranked) const {
    if (ranked.first_touch || !ranked.contacts.empty()) {
      const bool is_known = !ranked.contacts.empty();
      const double speed_mps = is_known ? ranked.contacts.front().closing_speed_mps
                                        : ranked.first_touch->closing_speed_mps;
      std::string words = fmt::format("It still {} {} at {:.0f} km/h",
                                      is_brush(ranked) ? "glances off" : "crashes into",
                                      is_known ? contact_name(scenario_, ranked.contacts.front())
                                               : scenario_.actors[ranked.first_touch->actor].name,
                                      3.6 * speed_mps);
      const std::vector<std::size_t> hit = hit_actors(ranked);
      for (std::size_t i = 1; i < hit.size(); ++i) {
        words += (i == 1 ? ", then hits " : ", ") + scenario_.actors[hit[i]].name;
      }
      return words + ".";
    }
    if (!(ranked.collision_probability > 0.0)) return {};
    return "It still crashes with a probability of " + percent_text(ranked.collision_probability) +
           ".";
  }

  /// The rows that are set beside each other, and what each is.
  void choose() {
    const std::vector<CandidateResult>& rows = result_.ranking;
    const auto add = [&](std::size_t row, std::string role) {
      chosen_.emplace_back(row, std::move(role));
    };
    add(0, rows.size() < 2 ? "the only one" : "best");
    if (rows.size() > 1) add(1, rows[1].place == rows[0].place ? "just as good" : "next best");
    // What everybody asks first, and, of a grid, whose neighbours are much alike, the best that
    // leads elsewhere.
    const auto side = [&](std::size_t row) { return side_of(scenario_, of(row)); };
    std::size_t braking = 0;
    while (braking < rows.size() &&
           !(rows[braking].feasible && brakes_straight(scenario_, of(braking)))) {
      ++braking;
    }
    const bool goes_straight = side(0) == 0 && rows.size() > 1 && side(1) == 0;
    if (braking > 1 && braking + 1 < rows.size()) add(braking, "best braking straight on");
    for (std::size_t row = 2; row + 1 < rows.size() && goes_straight; ++row) {
      if (!side(row) || side(row) == 0 || !rows[row].feasible) continue;
      add(row, *side(row) > 0 ? "best to the left" : "best to the right");
      break;
    }
    if (rows.size() > 2) add(rows.size() - 1, fmt::format("worst of {}", rows.size()));
  }

  /// How often each row would be first, over the samples of what is not known.
  void count_wins() {
    const std::vector<CandidateResult>& rows = result_.ranking;
    const std::size_t samples = range_sample_count(result_);
    if (result_.samples.empty() || rows.size() < 2 || rows.front().sharing > 1 ||
        rows.front().sample_scores.size() < samples) {
      return;
    }
    wins_.assign(rows.size(), 0);
    for (std::size_t i = 0; i < samples; ++i) {
      std::size_t best = 0;
      for (std::size_t row = 1; row < rows.size(); ++row) {
        if (!rows[row].feasible || rows[row].sample_scores.size() <= i) continue;
        if (rows[row].sample_scores[i] < rows[best].sample_scores[i]) best = row;
      }
      ++wins_[best];
    }
    rival_ =
        static_cast<std::size_t>(std::max_element(wins_.begin() + 1, wins_.end()) - wins_.begin());
    if (wins_[*rival_] == 0) rival_.reset();
  }

  /// Share of the samples in which the first row is not first.
  double lost() const {
    if (wins_.empty()) return 0.0;
    const auto samples = static_cast<double>(range_sample_count(result_));
    return 1.0 - static_cast<double>(wins_[0]) / samples;
  }

  std::string stability(const CandidateResult& first) const {
    const std::size_t samples = range_sample_count(result_);
    const CandidateResult& second = result_.ranking[1];
    if (first.score && first.score == second.score && second.feasible) {
      return "The next best scores alike; this one is first because " +
             tie_words(scenario_, first, second) + ".";
    }
    std::string text =
        fmt::format("It is first in {} {} trials in which friction, strengths and risk curves vary",
                    wins_[0] == samples ? "all" : fmt::format("{} of", wins_[0]), samples);
    if (rival_) {
      text += fmt::format("; in {}{} it is “{}”, here in place {}",
                          wins_[0] + wins_[*rival_] == samples ? "the other " : "", wins_[*rival_],
                          told_apart(*rival_), result_.ranking[*rival_].place);
    }
    if (first.separable || first.overtaken > separable_share) return text + ".";
    return text + (first.within_sampling_error
                       ? ". Another sample of futures may put the next best before it."
                       : ". The next best is within the accuracy of the simulation.");
  }

  const Scenario& scenario_;
  const RankResult& result_;
  const std::vector<std::string>& scores_;
  std::vector<std::size_t> wins_;     ///< by row; empty where it is not known
  std::optional<std::size_t> rival_;  ///< the row that is first most often but for the first
  std::vector<std::pair<std::size_t, std::string>> chosen_;  ///< rows and their roles
};

}  // namespace

std::string plain_manoeuvre(const Scenario& scenario, const Candidate& candidate) {
  if (candidate.origin != CandidateOrigin::grid) return candidate.name;
  const double most_mps2 = scenario.grip * standard_gravity_mps2;
  const double speed = scenario.ego.speed_mps;
  const double forward = speed < 0.0 ? -1.0 : 1.0;
  const double strongest_mps2 = candidate.acceleration_mps2 * forward > 0.0
                                    ? std::min(most_mps2, scenario.ego.max_acceleration_mps2)
                                    : most_mps2;
  const double along =
      strongest_mps2 > 0.0 ? candidate.acceleration_mps2 * forward / strongest_mps2 : 0.0;
  const double across = share_across(scenario, candidate);
  return pace_words(along) + (std::abs(across) < no_share_across ? ", " : " and ") +
         way_words(across);
}

std::string chance_words(double probability) {
  constexpr double seldom = 0.0005;
  constexpr double rare = 0.0095;
  constexpr double nearly_all = 0.995;
  if (!(probability > 0.0)) return "no chance";
  if (probability < seldom) return "under 0.1 in 100";
  if (probability < rare) return fmt::format("{:.1f} in 100", 1e2 * probability);
  if (probability < nearly_all) return fmt::format("{:.0f} in 100", 1e2 * probability);
  return "nearly certain";
}

double chance_of_any(const CandidateResult& ranked) {
  double nobody = 1.0;
  for (const PersonRisk& risk : ranked.people) {
    nobody *= std::pow(1.0 - std::clamp(risk.probability, 0.0, 1.0), risk.persons);
  }
  return 1.0 - nobody;
}

const char* outcome_participle(RiskModel model) {
  return std::string_view(risk_outcome(model)) == "death" ? "killed" : "seriously hurt";
}

Decision decision_of(const Scenario& scenario, const RankResult& result,
                     const std::vector<std::string>& scores) {
  const Words words(scenario, result, scores);
  return {words.sentence(), words.choices(), is_clear(result.ranking.front()), words.sure(),
          words.against()};
}

}  // namespace crashrank::detail
