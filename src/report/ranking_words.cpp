#include "report/ranking_words.hpp"

#include "report/score_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace crashrank::detail {
namespace {

std::string quoted(const RankResult& result, std::size_t place) {
  return "“" + result.candidates[result.ranking[place].candidate].name + "”";
}

const char* what_counts(Measure measure) {
  switch (measure) {
    case Measure::polygons:
      return "damaged triangles of all bodies";
    case Measure::area:
      return "damaged surface of all bodies";
    case Measure::delta_v:
      return "the own vehicle's change of velocity";
    case Measure::energy:
      return "energy turned into damage";
    case Measure::intrusion:
      return "depth of the crush in passengers' cages";
    case Measure::harm:
      return "people hurt, as weighted";
    case Measure::closing_energy:
      break;
  }
  return "kinetic energy that the crash could turn into damage";
}

double damaged_area_m2(const CandidateResult& ranked) {
  double area = ranked.ego.area_m2;
  for (const Contact& contact : ranked.contacts) area += contact.other.area_m2;
  return area;
}

// Where another measure would see the two the other way round, a reader should know.
std::string other_view(const RankResult& result, const CandidateResult& first,
                       const CandidateResult& second) {
  if (first.contacts.empty() || second.contacts.empty()) return {};
  const double first_speed = first.contacts.front().closing_speed_mps;
  const double second_speed = second.contacts.front().closing_speed_mps;
  if (first_speed > second_speed) {
    return fmt::format(" Its closing speed is the higher one, though: {:.1f} m/s against {:.1f}.",
                       first_speed, second_speed);
  }
  if (result.measure != Measure::area && damaged_area_m2(first) > damaged_area_m2(second)) {
    return fmt::format(
        " By damaged area it would be the other way round: {:.2f} m² against {:.2f}.",
        damaged_area_m2(first), damaged_area_m2(second));
  }
  return {};
}

/// Which tie-break decides between equal scores; the two are not tied.
std::string tie_words(const CandidateResult& first, const CandidateResult& second) {
  if (first.collides != second.collides) return "it touches nothing";
  if (!first.collides) return "it passes everything with more than a hair's breadth";
  const Contact& p = first.contacts.front();
  const Contact& q = second.contacts.front();
  if (p.time_of_impact_s != q.time_of_impact_s) {
    return fmt::format("its first contact is later, {:.3f} s against {:.3f} s", p.time_of_impact_s,
                       q.time_of_impact_s);
  }
  return fmt::format("its closing speed is lower, {:.2f} m/s against {:.2f} m/s",
                     p.closing_speed_mps, q.closing_speed_mps);
}

}  // namespace

const char* const overlap_meaning =
    "what is deep inside the other body at the start exerts no force but counts as crush, "
    "intrusion "
    "and damage, so that severity and score are unreliable";

std::string contact_name(const Scenario& scenario, const Contact& contact) {
  return scenario.actors[contact.actor].name +
         (begins_in_contact(contact) ? " (overlaps at start)" : "");
}

std::string score_words(const CandidateResult& ranked, const std::string& score, Measure measure) {
  const std::string interval = interval_text(ranked);
  return score + " " + measure_unit(measure) + (interval.empty() ? "" : " (" + interval + ")");
}

std::string outcome_words(const Scenario& scenario, const CandidateResult& ranked) {
  if (ranked.contacts.empty() && !ranked.score) return "has not been looked at to the end";
  if (ranked.contacts.empty()) {
    return fmt::format("touches nothing within {:.1f} s{}", scenario.horizon_s,
                       ranked.grazes.empty() ? "" : ", but grazes");
  }
  const Contact& first = ranked.contacts.front();
  std::string text =
      fmt::format("hits {} after {:.2f} s at {:.1f} m/s", scenario.actors[first.actor].name,
                  first.time_of_impact_s, first.closing_speed_mps);
  if (begins_in_contact(first)) {
    text = fmt::format("overlaps {} at the start, closing at {:.1f} m/s",
                       scenario.actors[first.actor].name, first.closing_speed_mps);
  }
  for (std::size_t i = 1; i < ranked.contacts.size(); ++i) {
    text += (i + 1 == ranked.contacts.size() ? " and " : ", ") +
            scenario.actors[ranked.contacts[i].actor].name;
  }
  return text;
}

std::string reason_words(const Scenario& scenario, const RankResult& result,
                         const std::vector<std::string>& scores, std::size_t place) {
  const CandidateResult& first = result.ranking[place];
  const CandidateResult& second = result.ranking[place + 1];
  const std::string first_score = score_words(first, scores[place], result.measure);
  const std::string second_score = score_words(second, scores[place + 1], result.measure);
  std::string text = quoted(result, place) + " " + outcome_words(scenario, first) + "; " +
                     quoted(result, place + 1) + " " + outcome_words(scenario, second) + ". ";
  if (!first.score || !second.score) {
    return text + "Not both scores are known: the order is the best guess within the intervals.";
  }
  if (first.place == second.place) {
    return text + fmt::format(
                      "Both score {} and agree in every tie-break: they are tied in place "
                      "{}.",
                      first_score, first.place);
  }
  if (*first.score == *second.score) {
    return text + fmt::format("Both score {}; the first is placed before because {}.", first_score,
                              tie_words(first, second));
  }
  text += fmt::format("What counts here is the {}: {} against {}", what_counts(result.measure),
                      first_score, second_score);
  if (*first.score > 0.0 && first.separable) {
    text += ", " + fixed_text(100.0 * (*second.score / *first.score - 1.0), 0) + " % more";
  }
  if (!first.separable && first.overtaken > separable_share) {
    text += fmt::format(
        ". The two are not separable: in {:.0f} % of {} samples of what is not known their order "
        "turns round",
        100.0 * first.overtaken, range_sample_count(result));
  } else if (!first.separable) {
    text +=
        ". The two are not separable: simulated with half the steps or 1 mm aside, their order may "
        "turn round";
  }
  return text + "." + other_view(result, first, second);
}

}  // namespace crashrank::detail
