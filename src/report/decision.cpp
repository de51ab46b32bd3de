#include "report/decision.hpp"

#include "report/manoeuvre_words.hpp"
#include "report/ranking_words.hpp"
#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

namespace crashrank::detail {
namespace {

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

std::string with_full_stop(const std::string& text) {
  std::string sentence = capitalised(text);
  if (!sentence.empty() && sentence.back() != '.') sentence += '.';
  return sentence;
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
  constexpr double none = 0.01;
  if (std::abs(share) < none) return "straight on";
  const std::string how = std::abs(share) > hard     ? "hard "
                          : std::abs(share) > slight ? ""
                                                     : "slightly ";
  return "steer " + how + (share > 0.0 ? "left" : "right");
}

class Words {
public:
  Words(const Scenario& scenario, const RankResult& result, const std::vector<std::string>& scores)
      : scenario_(scenario), result_(result), scores_(scores) {}

  std::string manoeuvre(std::size_t row) const {
    return plain_manoeuvre(scenario_, result_.candidates[result_.ranking[row].candidate]);
  }

  /// What comes of a row: "about 2 in 100 that somebody is seriously hurt".
  std::string outcome(std::size_t row, bool is_short) const {
    const CandidateResult& ranked = result_.ranking[row];
    if (!ranked.feasible) return "the vehicle cannot follow it";
    if (is_clear(ranked)) return "no crash";
    if (result_.measure == Measure::harm && ranked.score && !ranked.people.empty()) {
      return chance_words(chance_of_any(ranked)) +
             (is_short
                  ? ""
                  : fmt::format(" that somebody is {}", outcome_participle(result_.harm.model)));
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

  std::string next() const {
    const std::size_t rows = result_.ranking.size();
    if (rows < 2) return "It is the only candidate.";
    const bool is_tied = result_.ranking[1].place == result_.ranking[0].place;
    std::string text = fmt::format("{}, {}: {}", is_tied ? "Just as good" : "The next best",
                                   manoeuvre(1), outcome(1, true));
    if (rows > 2) {
      text += fmt::format("; the worst of {}, {}: {}", rows, manoeuvre(rows - 1),
                          outcome(rows - 1, true));
    }
    return text + ".";
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
    if (!result_.samples.empty() && result_.ranking.size() > 1 && first.sharing == 1) {
      lines.push_back(stability(first));
    }
    const std::string interval = interval_text(first);
    if (!interval.empty()) {
      lines.push_back(
          fmt::format("With all that is not known its {} is {} {}; the upper end is "
                      "the worst case.",
                      measure_name(result_.measure), interval, measure_unit(result_.measure)));
    }
    if (const std::string other = other_order_words(result_); !other.empty()) {
      lines.push_back(with_full_stop(other));
    }
    return lines;
  }

  std::vector<std::string> against() const {
    const CandidateResult& first = result_.ranking.front();
    std::vector<std::string> lines;
    constexpr double near_limit = 0.95;
    if (!first.feasible) {
      lines.push_back("The vehicle cannot follow it: it " + demand_words(first.demand) + ".");
    } else if (first.score && first.demand.greatest() > near_limit) {
      lines.push_back("It leaves nothing in hand: it " + demand_words(first.demand) + ".");
    }
    if (first.leaves_road) {
      const std::string probability = leaving_probability(first);
      lines.push_back("It " + leaving_words(first) +
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
  std::string stability(const CandidateResult& first) const {
    const std::size_t samples = range_sample_count(result_);
    const CandidateResult& second = result_.ranking[1];
    if (first.score && first.score == second.score && second.feasible) {
      return "The next best scores alike; this one is first because " +
             tie_words(scenario_, first, second) + ".";
    }
    if (first.separable) {
      return fmt::format(
          "The first place is clear: in {} of {} combinations of what is not known "
          "the next best would be better.",
          std::lround(first.overtaken * static_cast<double>(samples)), samples);
    }
    if (first.overtaken > separable_share) {
      return fmt::format(
          "Not clear from the next best: it would be better in {} of {} "
          "combinations of what is not known.",
          std::lround(first.overtaken * static_cast<double>(samples)), samples);
    }
    return first.within_sampling_error
               ? "Not clear from the next best: another sample of futures may reverse the order."
               : "Not clear from the next best: the difference is within the accuracy of the "
                 "simulation.";
  }

  const Scenario& scenario_;
  const RankResult& result_;
  const std::vector<std::string>& scores_;
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
  const double across = candidate.curvature_per_m * speed * speed / most_mps2;
  return pace_words(along) + (std::abs(across) < 0.01 ? ", " : " and ") + way_words(across);
}

std::string chance_words(double probability) {
  constexpr double seldom = 0.0005;
  constexpr double rare = 0.0095;
  constexpr double nearly_all = 0.995;
  if (!(probability > 0.0)) return "no chance";
  if (probability < seldom) return "fewer than 1 in 1000";
  if (probability < rare) return fmt::format("about {:.0f} in 1000", 1e3 * probability);
  if (probability < nearly_all) return fmt::format("about {:.0f} in 100", 1e2 * probability);
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
  return {words.sentence(), words.next(), is_clear(result.ranking.front()), words.sure(),
          words.against()};
}

}  // namespace crashrank::detail
