#include "crash/exposure.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "crashrank/report/ranking.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "report/body_doubts.hpp"
#include "report/manoeuvre_words.hpp"
#include "report/ranking_words.hpp"
#include "report/score_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using detail::Counted;

/// How far a candidate was followed: to its first contact; not at all where that is not known.
double followed_s(const Scenario& scenario, const CandidateResult& ranked) {
  if (!ranked.contacts.empty()) return ranked.contacts.front().time_of_impact_s;
  return ranked.score ? scenario.horizon_s : 0.0;
}

/// The speed at which a timed motion's body is stopped dead where its poses end, if before then.
double cut_speed_mps(const Motion& motion, double before_s) {
  const double end = motion.rest_time();
  if (!motion.holds_poses() || !(end < before_s) || !(end > 0.0)) return 0.0;
  return motion.velocity_at(end * (1.0 - 1e-9)).linear_mps.norm();
}

constexpr double moves_mps = 0.5;
/// A sum of probabilities above this is 1 but for rounding.
constexpr double certain = 1.0 - 1e-9;

void doubt_speeds(const RankResult& result, std::vector<std::string>& doubts) {
  if (!needs_crash(result.measure)) return;
  Counted fast;
  for (const CandidateResult& ranked : result.ranking) {
    const auto is_fast = [](const auto& contact) {
      return contact.closing_speed_mps > fastest_contact_mps;
    };
    const auto is_fast_future = [](const FutureOutcome& future) {
      return future.fastest_contact_mps > fastest_contact_mps;
    };
    if (std::any_of(ranked.contacts.begin(), ranked.contacts.end(), is_fast) ||
        std::any_of(ranked.further.begin(), ranked.further.end(), is_fast) ||
        std::any_of(ranked.futures.begin(), ranked.futures.end(), is_fast_future)) {
      fast.add({});
    }
  }
  if (fast.count == 0) return;
  doubts.push_back(fmt::format(
      "{} a contact at more than {:g} m/s, faster than the crash model was checked for; rank by "
      "closing-energy",
      fast.many("candidate leads to", "candidates lead to"), fastest_contact_mps));
}

void doubt_crowds(const RankResult& result, std::vector<std::string>& doubts) {
  Counted crowded;
  for (const CandidateResult& ranked : result.ranking) {
    if (!ranked.crowded) continue;
    crowded.add(
        fmt::format("'{}', in place {}", result.candidates[ranked.candidate].name, ranked.place));
  }
  if (crowded.count == 0) return;
  doubts.push_back(fmt::format(
      "{} to more bodies or contacts than are simulated, or to contact forces on a body for more "
      "than {:g} s, after which scores count none, so that they may be too low: {}",
      crowded.many("candidate leads", "candidates lead"),
      static_cast<double>(detail::ExposureRecord::most_cells) * detail::exposure_cell_s,
      crowded.examples()));
}

void doubt_starts(const Scenario& scenario, const RankResult& result,
                  std::vector<std::string>& doubts) {
  std::size_t candidates = 0;
  double greatest = 0.0;
  std::vector<std::size_t> actors;
  for (const CandidateResult& ranked : result.ranking) {
    bool overlaps = false;
    const auto add = [&](ImpactState state, std::size_t actor) {
      if (!detail::begins_in_contact(state)) return false;
      overlaps = true;
      if (std::find(actors.begin(), actors.end(), actor) == actors.end()) actors.push_back(actor);
      return true;
    };
    for (const Contact& contact : ranked.contacts) add(contact.state, contact.actor);
    double probability = 0.0;
    for (const FutureOutcome& future : ranked.futures) {
      const bool counts = future.collides && add(future.state, future.actor);
      if (counts) probability += future.probability;
    }
    if (!overlaps) continue;
    ++candidates;
    greatest = std::max(greatest, ranked.futures.empty() ? 1.0 : probability);
  }
  if (candidates == 0) return;
  Counted others;
  for (const std::size_t actor : actors) {
    others.add(fmt::format("'{}'", scenario.actors[actor].name));
  }
  doubts.push_back(fmt::format(
      "the ego overlaps {} at the start ({} of {} candidates{}): {}; begin the scenario before the "
      "contact",
      others.examples(), candidates, result.ranking.size(),
      greatest > certain
          ? std::string()
          : fmt::format(", with a probability of {}", detail::percent_text(greatest)),
      detail::overlap_meaning));
}

bool has_outline(const RankResult& result, std::size_t actor) {
  return actor >= result.actors.size() || result.actors[actor].has_outline;
}

/// A contact without force in the likeliest future with a body that has an outline, or none.
bool is_unforced(const RankResult& result, const Contact& contact, bool with_outline) {
  return contact.contact_without_force && has_outline(result, contact.actor) == with_outline;
}

/// The same in any future.
bool is_unforced(const RankResult& result, const CandidateResult& ranked, bool with_outline) {
  return std::any_of(
             ranked.contacts.begin(), ranked.contacts.end(),
             [&](const Contact& each) { return is_unforced(result, each, with_outline); }) ||
         std::any_of(ranked.futures.begin(), ranked.futures.end(), [&](const FutureOutcome& each) {
           return each.contact_without_force &&
                  has_outline(result, each.unforced_actor) == with_outline;
         });
}

/// Body, speed and highest score of a candidate with a contact without force.
std::string unforced_words(const Scenario& scenario, const RankResult& result,
                           const CandidateResult& ranked) {
  std::string text =
      fmt::format("'{}', in place {}, ", result.candidates[ranked.candidate].name, ranked.place);
  const auto contact =
      std::find_if(ranked.contacts.begin(), ranked.contacts.end(),
                   [&](const Contact& each) { return is_unforced(result, each, true); });
  if (contact != ranked.contacts.end()) {
    text += fmt::format("with '{}' at {:.1f} m/s", scenario.actors[contact->actor].name,
                        contact->closing_speed_mps);
  } else {
    const auto future =
        std::find_if(ranked.futures.begin(), ranked.futures.end(), [&](const FutureOutcome& each) {
          return each.contact_without_force && has_outline(result, each.unforced_actor);
        });
    text += fmt::format(
        "with '{}' {}", scenario.actors[future->unforced_actor].name,
        future->is_likeliest ? "after the first contact" : "in a future that is not the likeliest");
  }
  return text + fmt::format(" (up to {:.2g} {})", ranked.score_interval.highest,
                            measure_unit(result.measure));
}

void doubt_forces(const Scenario& scenario, const RankResult& result,
                  std::vector<std::string>& doubts) {
  Counted unforced;
  for (const CandidateResult& ranked : result.ranking) {
    if (!is_unforced(result, ranked, true)) continue;
    const std::string words = unforced_words(scenario, result, ranked);
    unforced.add(words);
    if (ranked.place > 1) continue;
    doubts.push_back(fmt::format("the first place rests on a contact without force: {}", words));
  }
  if (unforced.count == 0) return;
  doubts.push_back(fmt::format(
      "{} that touch at more than {:g} m/s, but the crash model finds no force in time, so that "
      "scores may be too low: {}",
      unforced.many("candidate has bodies", "candidates have bodies"), least_forced_speed_mps,
      unforced.examples()));
}

void doubt_outlines(const Scenario& scenario, const RankResult& result,
                    std::vector<std::string>& doubts) {
  Counted without;
  for (std::size_t i = 0; i < result.actors.size(); ++i) {
    if (!result.actors[i].has_outline) without.add("'" + scenario.actors[i].name + "'");
  }
  if (without.count == 0) return;
  Counted touches;
  bool first = false;
  for (const CandidateResult& ranked : result.ranking) {
    if (!is_unforced(result, ranked, false)) continue;
    touches.add({});
    first = first || ranked.place == 1;
  }
  doubts.push_back(fmt::format(
      "{} no material between 0.1 and 4 m over the ground of its model, so that nothing presses on "
      "it and it adds no harm: {}{}; if that is wrong, check scale, up axis and origin of the mesh",
      without.many("body has", "bodies have"), without.examples(),
      touches.count == 0
          ? std::string()
          : fmt::format(" (touched by {}{})", touches.many("candidate", "candidates"),
                        first ? ", the first place among them" : "")));
}

/// Steps that the wheels of a vehicle can mount: no higher than about their radius, and high enough
/// to press at all.
void doubt_kerbs(const Scenario& scenario, View<const Model> models, const RankResult& result,
                 std::vector<std::string>& doubts) {
  constexpr double lowest_m = 0.1;
  constexpr double wheel_radius_m = 0.3;
  Counted kerbs;
  for (std::size_t i = 0; i < result.actors.size(); ++i) {
    const RankedBody& body = result.actors[i];
    if (std::isfinite(body.mass_kg) || !body.has_outline) continue;
    const Box bounds = models[body.model].mesh.bounds();
    const double height_m =
        static_cast<double>(bounds.max.z()) - std::max(0.0, static_cast<double>(bounds.min.z()));
    if (height_m < lowest_m || height_m > wheel_radius_m) continue;
    const auto hits = [i](const CandidateResult& ranked) {
      return std::any_of(ranked.contacts.begin(), ranked.contacts.end(),
                         [i](const Contact& contact) { return contact.actor == i; });
    };
    if (std::none_of(result.ranking.begin(), result.ranking.end(), hits)) continue;
    kerbs.add(fmt::format("'{}' ({:.2f} m)", scenario.actors[i].name, height_m));
  }
  if (kerbs.count == 0) return;
  doubts.push_back(fmt::format(
      "{} hit, fixed and no higher than a wheel's radius, so that wheels may mount it: here it "
      "stops what overlaps it in height, and lets all else pass; leave it out, or state it as the "
      "road's end: {}",
      kerbs.many("body is", "bodies are"), kerbs.examples()));
}

void doubt_manoeuvres(const Scenario& scenario, const RankResult& result,
                      std::vector<std::string>& doubts) {
  const double speed = std::abs(scenario.ego.speed_mps);
  Counted slips;
  Counted ends;
  Counted jumps;
  for (std::size_t place = 0; place < result.ranking.size(); ++place) {
    const CandidateResult& ranked = result.ranking[place];
    const Candidate& candidate = result.candidates[ranked.candidate];
    const double until_s = followed_s(scenario, ranked);
    const std::string candidate_text =
        fmt::format("'{}', in place {}, ", candidate.name, ranked.place);
    if (!ranked.feasible) slips.add(candidate_text + detail::demand_words(ranked.demand));
    if (!candidate.motion.holds_poses()) continue;
    const double cut = cut_speed_mps(candidate.motion, until_s);
    if (cut > moves_mps) {
      ends.add(candidate_text +
               fmt::format("at {:g} s and {:.1f} m/s", candidate.motion.rest_time(), cut));
    }
    const double begins = candidate.motion.velocity_at(0.0).linear_mps.norm();
    if (std::abs(begins - speed) > 1.0 + 0.1 * speed) {
      jumps.add(candidate_text + fmt::format("at {:.1f} m/s", begins));
    }
  }
  if (slips.count > 0) {
    const bool kept = result.infeasible == Infeasible::keep || slips.count == result.ranking.size();
    doubts.push_back(fmt::format(
        "{}: {}",
        kept ? slips.many("manoeuvre asks for more than the vehicle can do and is ranked like all "
                          "others",
                          "manoeuvres ask for more than the vehicle can do and are ranked like all "
                          "others")
             : slips.many("manoeuvre asks for more than the vehicle can do and stands behind what "
                          "it can follow",
                          "manoeuvres ask for more than the vehicle can do and stand behind what "
                          "it can follow"),
        slips.examples()));
  }
  if (!result.dropped.empty()) {
    doubts.push_back(fmt::format(
        "{} manoeuvre{} left out: the vehicle cannot follow {}", result.dropped.size(),
        result.dropped.size() == 1 ? " is" : "s are", result.dropped.size() == 1 ? "it" : "them"));
  }
  if (ends.count > 0) {
    doubts.push_back(
        fmt::format("{} still from then on, which is more than the vehicle can do: {}",
                    ends.many("listed plan ends before the horizon while moving, and stands",
                              "listed plans end before the horizon while moving, and stand"),
                    ends.examples()));
  }
  if (jumps.count > 0) {
    doubts.push_back(fmt::format("{} at another speed than the ego's {:.1f} m/s: {}",
                                 jumps.many("listed plan begins", "listed plans begin"), speed,
                                 jumps.examples()));
  }
}

void doubt_horizon(const Scenario& scenario, const RankResult& result,
                   std::vector<std::string>& doubts) {
  Counted imminent;
  for (const CandidateResult& ranked : result.ranking) {
    if (!ranked.imminent || !(*ranked.time_to_collision_s < imminent_crash_s)) continue;
    imminent.add(fmt::format("'{}', in place {}, {:.2f} s before a crash with '{}'",
                             result.candidates[ranked.candidate].name, ranked.place,
                             *ranked.time_to_collision_s, scenario.actors[*ranked.imminent].name));
  }
  if (imminent.count == 0) return;
  doubts.push_back(fmt::format(
      "{} the horizon ({:g} s) without contact but close to a crash, which no score counts: {}; "
      "state a longer horizon_s",
      imminent.many("candidate reaches", "candidates reach"), scenario.horizon_s,
      imminent.examples()));
}

void doubt_road(const Scenario& scenario, const RankResult& result,
                std::vector<std::string>& doubts) {
  if (!scenario.road.ends() || result.ranking.empty()) return;
  const std::string leaving = detail::leaving_probability(result.ranking.front());
  const auto leaves_at_once = [](const CandidateResult& ranked) {
    return detail::leaves_in_likeliest(ranked) && ranked.leaves_road->time_s == 0.0;
  };
  if (std::any_of(result.ranking.begin(), result.ranking.end(), leaves_at_once)) {
    doubts.emplace_back(
        "the ego begins beside the road, so that every plan leaves it at once; are road.drivable "
        "and "
        "the ego's pose in the same frame?");
  } else if (result.ranking.front().leaves_road && result.measure == Measure::harm &&
             scenario.road.harm_per_leaving == 0.0) {
    doubts.emplace_back(
        "the first place " + detail::leaving_words(result.ranking.front()) +
        (leaving.empty() ? "" : " with a probability of " + leaving) +
        ", and what lies beside it counts as harmless; state road.off_road.harm_per_leaving");
  }
}

/// Looks at every motion that an actor may follow, and names each actor once.
void doubt_actors(const Scenario& scenario, std::vector<std::string>& doubts) {
  Counted ends;
  std::vector<char> named(scenario.actors.size(), char{0});
  const auto look = [&](std::size_t actor, const ActorMotion& stated) {
    if (stated.poses.empty() || named[actor] != 0) return;
    const Result<Motion> motion = make_motion(stated, {});
    if (!motion) return;
    const double cut = cut_speed_mps(*motion, scenario.horizon_s);
    if (cut <= moves_mps) return;
    named[actor] = 1;
    ends.add(fmt::format("'{}', at {:g} s and {:.1f} m/s", scenario.actors[actor].name,
                         motion->rest_time(), cut));
  };
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    if (actor.predictions.empty()) look(i, actor);
    for (const Prediction& prediction : actor.predictions) look(i, prediction);
  }
  for (const JointFuture& future : scenario.futures) {
    for (const FutureMotion& moved : future.motions) look(moved.actor, moved.motion);
  }
  if (ends.count == 0) return;
  doubts.push_back(fmt::format(
      "the poses of {} before the horizon ({:g} s) while moving, and stand still from then on: {}",
      ends.many("actor end", "actors end"), scenario.horizon_s, ends.examples()));
}

void doubt_fixed(const Scenario& scenario, const RankResult& result,
                 std::vector<std::string>& doubts) {
  Counted moving;
  for (std::size_t i = 0; i < result.actors.size(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    const bool moves = actor.speed_mps != 0.0 || actor.acceleration_mps2 != 0.0 ||
                       actor.yaw_rate_radps != 0.0 || actor.poses.size() > 1;
    const bool stands =
        std::isinf(result.actors[i].mass_kg) || scenario.models[actor.model].breakaway.has_value();
    if (stands && moves) moving.add("'" + actor.name + "'");
  }
  if (moving.count == 0) return;
  doubts.push_back(fmt::format(
      "{} a motion, but its body is fixed: it moves until first contact and stands in the crash "
      " ({}); give its model a mass, or no motion",
      moving.many("actor has", "actors have"), moving.examples()));
}

void doubt_keys(const Scenario& scenario, std::vector<std::string>& doubts) {
  if (scenario.keys_without_effect.empty()) return;
  std::string keys;
  for (const std::string& key : scenario.keys_without_effect) {
    keys += (keys.empty() ? "" : ", ") + key;
  }
  doubts.push_back(fmt::format("the scenario sets {}, which {} without effect; leave {} out", keys,
                               scenario.keys_without_effect.size() == 1 ? "is" : "are",
                               scenario.keys_without_effect.size() == 1 ? "it" : "them"));
}

void doubt_explanation(const RankResult& result, std::vector<std::string>& doubts) {
  const auto brief = std::count_if(
      result.ranking.begin(), result.ranking.end(),
      [](const CandidateResult& ranked) { return ranked.score && ranked.first_touch; });
  if (brief == 0) return;
  doubts.push_back(fmt::format(
      "the explanation ended after {} of {} candidates with contacts: the others have score and "
      "first contact alone, and no places were compared in samples; rank without a deadline",
      std::count_if(result.ranking.begin(), result.ranking.end(),
                    [](const CandidateResult& ranked) { return !ranked.contacts.empty(); }),
      std::count_if(result.ranking.begin(), result.ranking.end(),
                    [](const CandidateResult& ranked) { return ranked.collides; })));
}

void doubt_probabilities(const Scenario& scenario, std::vector<std::string>& doubts) {
  Counted normalised;
  for (const std::string& place : scenario.normalised) normalised.add(place);
  if (normalised.count == 0) return;
  doubts.push_back(fmt::format("probabilities do not sum to 1 and were divided by their sum: {}",
                               normalised.examples()));
}

}  // namespace

std::vector<std::string> ranking_doubts(const Scenario& asked, View<const Model> models,
                                        const RankResult& result) {
  const Scenario made = is_uncertain(asked) ? likeliest_future(asked) : Scenario{};
  const Scenario& scenario = is_uncertain(asked) ? made : asked;
  std::vector<std::string> doubts;
  doubt_speeds(result, doubts);
  doubt_crowds(result, doubts);
  doubt_starts(scenario, result, doubts);
  doubt_forces(scenario, result, doubts);
  doubt_outlines(scenario, result, doubts);
  doubt_kerbs(scenario, models, result, doubts);
  doubt_manoeuvres(scenario, result, doubts);
  doubt_horizon(scenario, result, doubts);
  if (result.futures.undrawn > 0) {
    doubts.push_back(
        fmt::format("{} improbable predictions, absences or joint futures are in none of the {} "
                    "drawn futures, so "
                    "that no score counts them; draw more, --futures",
                    result.futures.undrawn, result.futures.sampled));
  }
  doubt_road(scenario, result, doubts);
  doubt_actors(asked, doubts);
  doubt_fixed(scenario, result, doubts);
  detail::doubt_bodies(scenario, models, result, doubts);
  doubt_keys(scenario, doubts);
  doubt_explanation(result, doubts);
  doubt_probabilities(asked, doubts);
  return doubts;
}

std::string why_partial(const RankResult& result, bool bounded) {
  return fmt::format("{}: a partial answer, its first place {}",
                     bounded ? "the budget ended before every score was known"
                             : "a search for a contact came to no end",
                     result.proved ? "proved" : "not proved");
}

std::string ranking_progress(const RankResult& result) {
  const auto known = std::count_if(result.ranking.begin(), result.ranking.end(),
                                   [](const CandidateResult& c) { return c.score.has_value(); });
  return fmt::format("{} of {} candidates are evaluated, of the others only bounds are known",
                     known, result.ranking.size());
}

}  // namespace crashrank
