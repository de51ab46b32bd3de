#include "report/ranking_words.hpp"

#include "crashrank/scenario/candidate.hpp"
#include "report/damage_summary.hpp"
#include "report/manoeuvre_words.hpp"
#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

std::string quoted(const RankResult& result, std::size_t place) {
  return "“" + result.candidates[result.ranking[place].candidate].name + "”";
}

double damaged_area_m2(const Scenario& scenario, View<const Model> models,
                       const CandidateResult& ranked) {
  return ranked.ego.area_m2 + summary_of_others(scenario, models, ranked).area_m2;
}

// Where another measure would see the two the other way round, and its figures differ as they are
// written, a reader should know.
std::string other_view(const Scenario& scenario, View<const Model> models, const RankResult& result,
                       const CandidateResult& first, const CandidateResult& second) {
  if (first.contacts.empty() || second.contacts.empty()) return {};
  const double first_speed = first.contacts.front().closing_speed_mps;
  const double second_speed = second.contacts.front().closing_speed_mps;
  if (first_speed > second_speed + 0.1) {
    return fmt::format(" Its closing speed is the higher one, though: {:.0f} km/h against {:.0f}.",
                       3.6 * first_speed, 3.6 * second_speed);
  }
  const double first_m2 = damaged_area_m2(scenario, models, first);
  const double second_m2 = damaged_area_m2(scenario, models, second);
  if (result.measure != Measure::area && first_m2 > second_m2 + 0.01) {
    return fmt::format(
        " By damaged area{} it would be the other way round: {:.2f} m² against {:.2f}.",
        first.futures.size() > 1 || second.futures.size() > 1 ? " in the likeliest future" : "",
        first_m2, second_m2);
  }
  return {};
}

/// Whether an earlier contact of a candidate is with the actor.
bool is_hit_before(const CandidateResult& ranked, std::size_t actor, double time_s) {
  return std::any_of(ranked.contacts.begin(), ranked.contacts.end(),
                     [=](const Contact& contact) {
                       return contact.actor == actor && contact.time_of_impact_s < time_s;
                     }) ||
         std::any_of(ranked.further.begin(), ranked.further.end(),
                     [=](const FurtherContact& contact) {
                       return (contact.a == actor || contact.b == actor) && contact.time_s < time_s;
                     });
}

/// Whether the first actor, hit before, brings along most of the closing speed; `closing` is its
/// velocity less the other's, m/s. The other moves as planned.
bool is_pushed(const Scenario& scenario, const CandidateResult& ranked, std::size_t actor,
               std::size_t other, const Eigen::Vector3d& closing, double time_s) {
  if (!is_hit_before(ranked, actor, time_s) || is_hit_before(ranked, other, time_s)) return false;
  const Result<Motion> planned = make_motion(scenario.actors[other]);
  if (!planned) return false;
  const double of_other = -planned->velocity_at(time_s).linear_mps.dot(closing);
  return of_other < 0.5 * closing.squaredNorm();
}

}  // namespace

const char* const overlap_meaning =
    "what is deep inside the other body at the start exerts no force but counts as crush, "
    "intrusion "
    "and damage, so that severity and score are unreliable";

std::vector<std::size_t> hit_actors(const CandidateResult& ranked) {
  std::vector<std::size_t> actors;
  for (const Contact& contact : ranked.contacts) {
    if (std::find(actors.begin(), actors.end(), contact.actor) == actors.end()) {
      actors.push_back(contact.actor);
    }
  }
  return actors;
}

std::string contact_name(const Scenario& scenario, const Contact& contact) {
  return scenario.actors[contact.actor].name +
         (begins_in_contact(contact) ? " (overlaps at start)" : "") +
         (contact.contact_without_force ? " (no force)" : "");
}

std::string pair_name(const Scenario& scenario, const FurtherContact& contact) {
  return scenario.actors[contact.a].name + " / " + scenario.actors[contact.b].name;
}

std::string brush_words(const CandidateResult& ranked) {
  constexpr double little = 1.0 / 3.0;
  const Contact& first = ranked.contacts.front();
  double own = 0.0;
  double its = 0.0;
  for (const Contact& contact : ranked.contacts) {
    if (contact.actor != first.actor) continue;
    own = std::max(own, contact.severity.ego.delta_v_mps);
    its = std::max(its, contact.severity.other.delta_v_mps);
  }
  const double most = std::max(own, its);
  if (!(most > 0.0) || most > little * first.closing_speed_mps) return {};
  return fmt::format(", changes {} velocity by {:.0f} km/h", its >= own ? "its" : "our",
                     3.6 * most);
}

bool is_brush(const CandidateResult& ranked) {
  return !ranked.first_touch && !ranked.contacts.empty() && !brush_words(ranked).empty();
}

std::vector<FurtherPair> further_pairs(const CandidateResult& ranked) {
  std::vector<FurtherPair> pairs;
  for (const FurtherContact& contact : ranked.further) {
    const auto same = std::find_if(pairs.begin(), pairs.end(), [&contact](const FurtherPair& pair) {
      return (pair.first->a == contact.a && pair.first->b == contact.b) ||
             (pair.first->a == contact.b && pair.first->b == contact.a);
    });
    if (same == pairs.end()) {
      pairs.push_back({&contact, contact.harm});
    } else {
      same->harm += contact.harm;
    }
  }
  return pairs;
}

std::string further_words(const Scenario& scenario, const CandidateResult& ranked,
                          const FurtherContact& contact) {
  const std::string& a = scenario.actors[contact.a].name;
  const std::string& b = scenario.actors[contact.b].name;
  const double time_s = contact.time_s;
  if (is_pushed(scenario, ranked, contact.a, contact.b, contact.closing, time_s)) {
    return a + " is pushed into " + b;
  }
  if (is_pushed(scenario, ranked, contact.b, contact.a, -contact.closing, time_s)) {
    return b + " is pushed into " + a;
  }
  return a + " and " + b + " collide";
}

std::vector<std::string> pushed_words(const Scenario& scenario, const RankResult& result,
                                      std::size_t shown) {
  constexpr std::size_t most = 12;
  constexpr double least_harm = 0.001;  // brushes of fenders would fill the page
  std::vector<std::string> words;
  if (result.measure != Measure::harm) return words;
  std::size_t left_out = 0;
  for (std::size_t place = 0; place < std::min(shown, result.ranking.size()); ++place) {
    const CandidateResult& ranked = result.ranking[place];
    for (const FurtherPair& pair : further_pairs(ranked)) {
      if (!(pair.harm >= least_harm)) continue;
      if (words.size() == most) {
        ++left_out;
        continue;
      }
      words.push_back(fmt::format(
          "{}: {} at {:.2f} s (harm {})", result.candidates[ranked.candidate].name,
          further_words(scenario, ranked, *pair.first), pair.first->time_s, harm_text(pair.harm)));
    }
  }
  if (left_out > 0) {
    words.push_back(
        left_out == 1
            ? std::string("... and 1 more collision of others that injures people")
            : fmt::format("... and {} more collisions of others that injure people", left_out));
  }
  return words;
}

std::string score_words(const CandidateResult& ranked, const std::string& score, Measure measure) {
  const std::string interval = interval_text(ranked);
  return score + " " + measure_unit(measure) + (interval.empty() ? "" : " (" + interval + ")");
}

namespace {

std::string outcome_of_likeliest(const Scenario& scenario, const CandidateResult& ranked) {
  if (ranked.contacts.empty() && !ranked.score) return "has not been looked at to the end";
  if (ranked.contacts.empty()) {
    std::string text = fmt::format("touches nothing within {:.1f} s{}", scenario.horizon_s,
                                   ranked.grazes.empty() ? "" : ", but grazes");
    if (leaves_in_likeliest(ranked)) text += ", but " + in_kmh(leaving_words(ranked));
    return text;
  }
  const Contact& first = ranked.contacts.front();
  const bool glances = is_brush(ranked);
  std::string text = fmt::format(
      "{} {} after {:.2f} s at {:.0f} km/h", glances ? "glances off" : "hits",
      scenario.actors[first.actor].name, first.time_of_impact_s, 3.6 * first.closing_speed_mps);
  if (begins_in_contact(first)) {
    text = fmt::format("overlaps {} at the start, closing at {:.0f} km/h",
                       scenario.actors[first.actor].name, 3.6 * first.closing_speed_mps);
  }
  if (leaves_in_likeliest(ranked)) text = in_kmh(leaving_words(ranked)) + " and " + text;
  const std::vector<std::size_t> actors = hit_actors(ranked);
  for (std::size_t i = 1; i < actors.size(); ++i) {
    text += i + 1 == actors.size() ? " and " : ", ";
    if (glances && i == 1) text += "hits ";
    text += scenario.actors[actors[i]].name;
  }
  constexpr std::size_t described = 3;
  const std::vector<FurtherPair> pairs = further_pairs(ranked);
  for (std::size_t i = 0; i < std::min(described, pairs.size()); ++i) {
    text += ", " + further_words(scenario, ranked, *pairs[i].first);
  }
  if (pairs.size() > described) {
    text += fmt::format(", and {} more pairs of others collide", pairs.size() - described);
  }
  return text;
}

}  // namespace

std::string other_order_words(const RankResult& result) {
  const bool by_score = result.order == RankOrder::score;
  const std::size_t other = first_by(result, by_score ? RankOrder::upper : RankOrder::score);
  if (other == 0) return {};
  const CandidateResult& mine = result.ranking.front();
  const CandidateResult& its = result.ranking[other];
  return by_score
             ? fmt::format(
                   "{} has the least upper end, {:.2g} against {:.2g}: --order upper puts "
                   "it first",
                   quoted(result, other), its.score_interval.highest, mine.score_interval.highest)
             : fmt::format(
                   "Ordered by the upper ends of the intervals; by score {} is first, {:.2g} "
                   "against {:.2g}",
                   quoted(result, other), *its.score, *mine.score);
}

std::string without_errors_words(const RankResult& result) {
  const std::size_t other = first_without_errors(result).value_or(0);
  if (other == 0) return {};
  return fmt::format("Errors of states decide: without them {} is first, {:.2g} against {:.2g}",
                     quoted(result, other), result.ranking[other].futures.front().score,
                     result.ranking.front().futures.front().score);
}

std::string outcome_words(const Scenario& scenario, const CandidateResult& ranked) {
  std::string likeliest = outcome_of_likeliest(scenario, ranked);
  if (ranked.futures.size() < 2) return likeliest;
  const std::string leaving = leaving_probability(ranked);
  likeliest += fmt::format(" in the likeliest future (the probability of a collision is {}{})",
                           percent_text(ranked.collision_probability),
                           leaving.empty() ? "" : ", of leaving the road " + leaving);
  if (!ranked.leaves_road || leaves_in_likeliest(ranked)) return likeliest;
  return likeliest + "; in another it " + in_kmh(leaving_words(ranked));
}

std::string reason_words(const Scenario& scenario, View<const Model> models,
                         const RankResult& result, const std::vector<std::string>& scores,
                         std::size_t place) {
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
  if (first.feasible != second.feasible && result.infeasible != Infeasible::keep) {
    return text +
           fmt::format("The vehicle cannot follow the second: it {}.", demand_words(second.demand));
  }
  if (*first.score == *second.score) {
    return text + fmt::format("Both score {}; the first is placed before because {}.", first_score,
                              tie_words(scenario, first, second));
  }
  text += fmt::format("What counts here is the {}: {} against {}", measure_meaning(result.measure),
                      first_score, second_score);
  if (*first.score > 0.0 && first.separable) {
    const double ratio = *second.score / *first.score;
    text += ratio < 2.0 ? fmt::format(", {:.2g} % more before rounding", 100.0 * (ratio - 1.0))
                        : fmt::format(", {:.2g} times as much before rounding", ratio);
  }
  if (!first.separable && first.overtaken > separable_share) {
    text += fmt::format(
        ". The two are not separable: in {:.0f} % of {} samples of what is not known their order "
        "reverses",
        100.0 * first.overtaken, range_sample_count(result));
  } else if (!first.separable && first.within_sampling_error) {
    text += ". The two are not separable: in another sample of futures their order may reverse";
  } else if (!first.separable) {
    text +=
        ". The two are not separable: simulated with longer steps or 1 mm aside, their order may "
        "reverse";
  }
  return text + "." + other_view(scenario, models, result, first, second);
}

}  // namespace crashrank::detail
