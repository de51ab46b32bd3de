#include "crashrank/rank/anytime/ranker.hpp"
#include "c/enums.hpp"
#include "c/handles.hpp"
#include "c/harm.hpp"
#include "c/sized.hpp"
#include "scenario/scenario_check.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>

struct crashrank_ranker {
  crashrank::Ranker ranker;
  std::size_t most_candidates = 0;
  crashrank::Scenario prepared;       ///< what an update cannot change is compared with it
  std::vector<double> ego_lengths_m;  ///< by model
  std::vector<crashrank::Candidate> candidates;
  std::vector<crashrank_ranked> answer;
};

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

bool same_limits(const ScenarioEgo& a, const ScenarioEgo& b) {
  return a.max_acceleration_mps2 == b.max_acceleration_mps2 &&
         a.max_deceleration_mps2 == b.max_deceleration_mps2 &&
         a.max_steering_rad == b.max_steering_rad &&
         a.max_steering_rate_radps == b.max_steering_rate_radps;
}

bool same_road(const Road& a, const Road& b) {
  const auto same_area = [](const Area& p, const Area& q) {
    return p.outer == q.outer && p.holes == q.holes;
  };
  return a.harm_per_leaving == b.harm_per_leaving && a.off_road_grip == b.off_road_grip &&
         std::equal(a.drivable.begin(), a.drivable.end(), b.drivable.begin(), b.drivable.end(),
                    same_area);
}

/// A Ranker's scene holds the bodies and the horizon that it was prepared with, but for those that
/// enter and leave.
Status same_bodies(const crashrank_ranker& ranker, const Scenario& scenario) {
  const Scenario& prepared = ranker.prepared;
  const auto other = [](const char* place) {
    Error error =
        make_error(ErrorCode::usage, "is not what the ranker was created with",
                   "create a ranker anew; an update changes poses, motions and candidates");
    error.place = place;
    return error;
  };
  if (scenario.horizon_s != prepared.horizon_s) return other("horizon_s");
  if (scenario.grip != prepared.grip) return other("grip");
  if (!same_limits(scenario.ego, prepared.ego)) return other("ego's limits");
  if (!same_road(scenario.road, prepared.road)) return other("road");
  if (!c::same_harm(scenario.harm, prepared.harm)) return other("harm");
  const auto same_model = [](const ScenarioModel& a, const ScenarioModel& b) {
    // What an update leaves out may be stated in a model file.
    const auto same_if_stated = [](const auto& now, const auto& then) {
      return !now || now == then;
    };
    return a.kind == b.kind && same_if_stated(a.mass_kg, b.mass_kg) &&
           same_if_stated(a.center_of_mass_m, b.center_of_mass_m) &&
           same_if_stated(a.yaw_inertia_kgm2, b.yaw_inertia_kgm2) && a.stiffness == b.stiffness &&
           a.surface == b.surface && a.honeycomb == b.honeycomb && a.breakaway == b.breakaway &&
           a.deflection_m == b.deflection_m && a.deflection_force_n == b.deflection_force_n;
  };
  if (!std::equal(scenario.models.begin(), scenario.models.end(), prepared.models.begin(),
                  prepared.models.end(), same_model)) {
    return other("models");
  }
  if (scenario.ego.model != prepared.ego.model) return other("ego.model");
  if (scenario.ego.occupants != prepared.ego.occupants) return other("ego.occupants");
  if (scenario.ego.uncertainty != prepared.ego.uncertainty) return other("ego.uncertainty");
  const auto same_actor = [&](const ScenarioActor& a, const ScenarioActor& b) {
    const auto index = static_cast<std::size_t>(&b - prepared.actors.data());
    const double exists = a.existence_probability;
    const bool same_body =
        a.model == b.model && a.occupants == b.occupants && exists == b.existence_probability;
    const bool enters = (exists == 0.0 || exists == 1.0) && ranker.ranker.can_enter(index, a.model);
    return (same_body || enters) && a.predictions.size() == b.predictions.size() &&
           a.perception == b.perception;
  };
  if (!std::equal(scenario.actors.begin(), scenario.actors.end(), prepared.actors.begin(),
                  prepared.actors.end(), same_actor)) {
    return other("actors");
  }
  const auto same_future = [](const JointFuture& a, const JointFuture& b) {
    const auto same_motion = [](const FutureMotion& p, const FutureMotion& q) {
      return p.actor == q.actor;
    };
    return a.probability == b.probability && a.absent == b.absent &&
           std::equal(a.motions.begin(), a.motions.end(), b.motions.begin(), b.motions.end(),
                      same_motion);
  };
  if (!std::equal(scenario.futures.begin(), scenario.futures.end(), prepared.futures.begin(),
                  prepared.futures.end(), same_future)) {
    return other("futures");
  }
  if (risk_name(scenario.risk) != risk_name(prepared.risk)) return other("risk");
  return Success{};
}

/// By plan: a scenario without joint futures.
std::vector<double> plan_probabilities(const Scenario& scenario) {
  std::vector<double> probabilities;
  for (const ScenarioActor& actor : scenario.actors) {
    if (actor.predictions.empty()) probabilities.push_back(1.0);
    for (const Prediction& prediction : actor.predictions) {
      probabilities.push_back(prediction.probability);
    }
  }
  return probabilities;
}

/// Lets bodies leave and enter so that the actors are those of a scenario, with one motion each as
/// `plan_motions` has it for every plan. `same_bodies` has found no fault.
Status exchange_bodies(crashrank_ranker& ranker, const Scenario& scenario,
                       const std::vector<Motion>& motions) {
  std::size_t plan = 0;
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    const ScenarioActor& actor = scenario.actors[i];
    ScenarioActor& before = ranker.prepared.actors[i];
    const bool same = actor.model == before.model && actor.occupants == before.occupants;
    const bool stays = before.existence_probability > 0.0 && actor.existence_probability > 0.0;
    if (ranker.ranker.can_enter(i, actor.model) && !(stays && same)) {
      if (before.existence_probability > 0.0) {
        if (Status left = ranker.ranker.leave(i); !left) return left;
      }
      before.existence_probability = 0.0;
      if (actor.existence_probability > 0.0) {
        Status entered = ranker.ranker.enter(i, actor.model, motions[plan], actor.occupants);
        if (!entered) return entered;
      }
      before.existence_probability = actor.existence_probability;
      before.model = actor.model;
      before.occupants = actor.occupants;
    }
    plan += std::max<std::size_t>(1, actor.predictions.size());
  }
  return Success{};
}

/// The candidates and motions of a scenario. Errors: bad_input; usage for other bodies.
Status situate(crashrank_ranker& ranker, const Scenario& scenario) {
  if (Status same = same_bodies(ranker, scenario); !same) return same;
  if (Status sound = detail::check_scenario(scenario); !sound) return sound;
  Result<std::vector<Candidate>> candidates =
      make_candidates(scenario, ranker.ego_lengths_m[scenario.ego.model]);
  if (!candidates) return candidates.error();
  if (candidates->size() > ranker.most_candidates) {
    return make_error(ErrorCode::usage,
                      "the scenario leaves " + std::to_string(candidates->size()) +
                          " candidates, more than the ranker's most_candidates",
                      "raise it, or leave fewer");
  }
  const Result<std::vector<Motion>> motions = plan_motions(scenario);
  if (!motions) return motions.error();
  ranker.answer.reserve(candidates->size());
  if (scenario.futures.empty()) {
    if (Status there = exchange_bodies(ranker, scenario, *motions); !there) return there;
  }
  if (Status moved =
          ranker.ranker.move_actors(scenario.ego.pose, *motions,
                                    EgoMotion{scenario.ego.speed_mps, scenario.ego.yaw_rate_radps});
      !moved)
    return moved;
  if (scenario.futures.empty()) {
    if (Status weighed = ranker.ranker.weigh_plans(plan_probabilities(scenario)); !weighed) {
      return weighed;
    }
  }
  ranker.candidates = std::move(*candidates);
  return Success{};
}

}  // namespace

crashrank_status crashrank_ranker_create(const crashrank_scenario* scenario,
                                         const crashrank_models* models,
                                         const crashrank_ranker_options* options,
                                         crashrank_ranker** ranker, crashrank_error* error) {
  if (const char* null =
          c::first_null({{"scenario", scenario}, {"models", models}, {"ranker", ranker}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    RankerOptions how;
    if (options != nullptr) {
      const Result<crashrank_ranker_options> given =
          c::read_sized("crashrank_ranker_options", *options);
      if (!given) return refuse(given.error(), error);
      how.rank.workers = given->workers;
      if (given->measure != 0) {
        const Result<Measure> measure =
            c::from_c<Measure>(given->measure, "crashrank_ranker_options.measure");
        if (!measure) return refuse(measure.error(), error);
        how.rank.measure = *measure;
      }
      if (given->most_candidates > 0) how.limits.candidates = given->most_candidates;
      if (given->most_actors > 0) how.limits.actors = given->most_actors;
    }
    Scenario complete = c::with_stated_masses(*scenario, *models);
    Result<Ranker> made = Ranker::prepare(complete, models->list, how);
    if (!made) return refuse(made.error(), error);
    auto handle = std::make_unique<crashrank_ranker>(
        crashrank_ranker{std::move(*made), how.limits.candidates, std::move(complete), {}, {}, {}});
    for (const Model& model : models->list) {
      handle->ego_lengths_m.push_back(static_cast<double>(model.mesh.bounds().extent().x()));
    }
    if (const Status ready = situate(*handle, scenario->scenario); !ready) {
      return refuse(ready.error(), error);
    }
    *ranker = handle.release();
    return CRASHRANK_OK;
  });
}

void crashrank_ranker_free(crashrank_ranker* ranker) { delete ranker; }

crashrank_status crashrank_ranker_update(crashrank_ranker* ranker,
                                         const crashrank_scenario* scenario,
                                         crashrank_error* error) {
  if (const char* null = c::first_null({{"ranker", ranker}, {"scenario", scenario}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Status ready = situate(*ranker, scenario->scenario);
    if (!ready) return refuse(ready.error(), error);
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_ranker_rank(crashrank_ranker* ranker, const crashrank_budget* budget,
                                       crashrank_answer* answer, crashrank_error* error) {
  if (const char* null = c::first_null({{"ranker", ranker}, {"answer", answer}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Status sized = c::check_size("crashrank_answer", *answer);
    if (!sized) return refuse(sized.error(), error);
    RankBudget within;
    if (budget != nullptr) {
      const Result<crashrank_budget> given = c::read_sized("crashrank_budget", *budget);
      if (!given) return refuse(given.error(), error);
      if (given->deadline_s != 0.0) within.deadline_s = given->deadline_s;
      if (given->work > 0) within.work = given->work;
      within.first_place_only = given->first_place_only != 0;
    }
    const RankerAnswer ranked = ranker->ranker.rank(ranker->candidates, within);
    if (!ranked.status) return refuse(ranked.status.error(), error);
    ranker->answer.clear();
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    for (const RankedCandidate& one : ranked.ranking) {
      crashrank_ranked entry{};
      entry.candidate = one.candidate;
      entry.score = one.known ? one.score : unknown;
      entry.lowest_score = one.interval.lowest;
      entry.highest_score = one.interval.highest;
      entry.estimated_score = one.stage >= RankStage::searched ? one.estimate : unknown;
      entry.time_of_impact_s = one.collides ? one.time_of_impact_s : unknown;
      entry.closing_speed_mps = one.collides ? one.closing_speed_mps : unknown;
      entry.collision_probability = one.collision_probability;
      entry.in_race = one.in_race ? 1 : 0;
      entry.collides = one.collides ? 1 : 0;
      entry.contact_without_force = one.contact_without_force ? 1 : 0;
      ranker->answer.push_back(entry);
    }
    crashrank_answer made{};
    made.ranking = ranker->answer.data();
    made.count = ranker->answer.size();
    made.in_race = ranked.in_race;
    made.hash = ranked.hash;
    made.elapsed_s = ranked.elapsed_s;
    made.complete = ranked.complete ? 1 : 0;
    made.proved = ranked.proved ? 1 : 0;
    static_assert(static_cast<int>(RankBasis::braking) + 1 == CRASHRANK_BASIS_BRAKING &&
                  static_cast<int>(RankBasis::proved) + 1 == CRASHRANK_BASIS_PROVED);
    made.basis = static_cast<std::int32_t>(ranked.basis) + 1;
    c::write_sized(made, *answer);
    return CRASHRANK_OK;
  });
}

const char* crashrank_ranker_candidate_name(const crashrank_ranker* ranker, size_t candidate) {
  if (ranker == nullptr || candidate >= ranker->candidates.size()) return nullptr;
  return ranker->candidates[candidate].name.c_str();
}
