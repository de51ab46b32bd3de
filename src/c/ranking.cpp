#include "c/enums.hpp"
#include "c/handles.hpp"
#include "c/sized.hpp"

#include "crashrank/report/ranking.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

Result<RankOptions> to_options(const crashrank_rank_options& options) {
  RankOptions made;
  made.workers = options.workers;
  if (options.measure != 0) {
    const Result<Measure> measure =
        c::from_c<Measure>(options.measure, "crashrank_rank_options.measure");
    if (!measure) return measure.error();
    made.measure = *measure;
  }
  if (options.infeasible != 0) {
    const Result<Infeasible> infeasible =
        c::from_c<Infeasible>(options.infeasible, "crashrank_rank_options.infeasible");
    if (!infeasible) return infeasible.error();
    made.infeasible = *infeasible;
  }
  if (options.order != 0) {
    const Result<RankOrder> order =
        c::from_c<RankOrder>(options.order, "crashrank_rank_options.order");
    if (!order) return order.error();
    made.order = *order;
  }
  made.records_motion = options.motion != 0;
  made.smooth = options.smooth != 0;
  return made;
}

/// The candidate in that place, which has to exist.
crashrank_choice to_choice(const crashrank_ranking& ranking, std::size_t place) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const CandidateResult& ranked = ranking.result.ranking[place];
  crashrank_choice choice{};
  choice.candidate = ranking.result.candidates[ranked.candidate].name.c_str();
  choice.score = ranked.score.value_or(unknown);
  choice.lowest_score = ranked.score_interval.lowest;
  choice.highest_score = ranked.score_interval.highest;
  choice.time_of_impact_s = choice.closing_speed_mps = choice.delta_v_mps = unknown;
  choice.other_delta_v_mps = choice.pdof_deg = unknown;
  choice.damaged_triangles = ranked.ego.triangles.size();
  choice.contacts = ranked.contacts.size();
  choice.contact_without_force =
      std::any_of(ranked.futures.begin(), ranked.futures.end(),
                  [](const FutureOutcome& future) { return future.contact_without_force; })
          ? 1
          : 0;
  if (!ranked.contacts.empty()) {
    const Contact& first = ranked.contacts.front();
    choice.other = ranking.actors[first.actor].c_str();
    choice.time_of_impact_s = first.time_of_impact_s;
    choice.closing_speed_mps = first.closing_speed_mps;
    choice.delta_v_mps = first.severity.ego.delta_v_mps;
    choice.other_delta_v_mps = first.severity.other.delta_v_mps;
    choice.pdof_deg = first.severity.ego.pdof_deg;
  }
  return choice;
}

crashrank_manoeuvre to_manoeuvre(const CandidateResult& ranked) {
  constexpr double absent = std::numeric_limits<double>::quiet_NaN();
  crashrank_manoeuvre made{};
  made.feasible = ranked.feasible ? 1 : 0;
  made.leaves_road = ranked.leaves_road ? 1 : 0;
  made.grip_demand = ranked.demand.grip;
  made.engine_demand = ranked.demand.engine;
  made.brakes_demand = ranked.demand.brakes;
  made.steering_demand = ranked.demand.steering;
  made.steering_rate_demand = ranked.demand.steering_rate;
  made.leaves_road_s = ranked.leaves_road ? ranked.leaves_road->time_s : absent;
  made.leaves_road_mps = ranked.leaves_road ? ranked.leaves_road->speed_mps : absent;
  made.least_distance_m = ranked.least_distance_m.value_or(absent);
  made.least_time_gap_s = ranked.least_time_gap_s.value_or(absent);
  made.horizon_speed_mps = ranked.at_horizon ? ranked.at_horizon->speed_mps : absent;
  made.time_to_collision_s = ranked.time_to_collision_s.value_or(absent);
  return made;
}

}  // namespace

crashrank_status crashrank_rank(const crashrank_scenario* scenario, const crashrank_models* models,
                                const crashrank_rank_options* options, crashrank_ranking** ranking,
                                crashrank_error* error) {
  if (const char* null =
          c::first_null({{"scenario", scenario}, {"models", models}, {"ranking", ranking}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    crashrank_rank_options given{};
    if (options != nullptr) {
      const Result<crashrank_rank_options> read = c::read_sized("crashrank_rank_options", *options);
      if (!read) return refuse(read.error(), error);
      given = *read;
    }
    const Result<RankOptions> how = to_options(given);
    if (!how) return refuse(how.error(), error);
    const Scenario completed = c::with_stated_masses(*scenario, *models);
    Result<RankResult> result = rank(completed, models->list, *how);
    if (!result) return refuse(result.error(), error);
    auto made = std::make_unique<crashrank_ranking>();
    for (const ScenarioActor& actor : completed.actors) made->actors.push_back(actor.name);
    if (given.json != 0) {
      made->json = ranking_json(completed, models->list, *result);
    }
    made->result = std::move(*result);
    *ranking = made.release();
    return CRASHRANK_OK;
  });
}

void crashrank_ranking_free(crashrank_ranking* ranking) { delete ranking; }

size_t crashrank_ranking_size(const crashrank_ranking* ranking) {
  return ranking == nullptr ? 0 : ranking->result.ranking.size();
}

crashrank_status crashrank_ranking_get(const crashrank_ranking* ranking, size_t place,
                                       crashrank_choice* choice, crashrank_error* error) {
  if (const char* null = c::first_null({{"ranking", ranking}, {"choice", choice}})) {
    return refuse_null(null, error);
  }
  if (place >= crashrank_ranking_size(ranking)) {
    return refuse(CRASHRANK_USAGE, "the ranking has no such place", error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Status sized = c::check_size("crashrank_choice", *choice);
    if (!sized) return refuse(sized.error(), error);
    c::write_sized(to_choice(*ranking, place), *choice);
    return CRASHRANK_OK;
  });
}

size_t crashrank_ranking_further_count(const crashrank_ranking* ranking, size_t index) {
  if (index >= crashrank_ranking_size(ranking)) return 0;
  return ranking->result.ranking[index].further.size();
}

crashrank_status crashrank_ranking_further(const crashrank_ranking* ranking, size_t index,
                                           size_t contact, crashrank_further_contact* further,
                                           crashrank_error* error) {
  if (const char* null = c::first_null({{"ranking", ranking}, {"further", further}})) {
    return refuse_null(null, error);
  }
  if (index >= crashrank_ranking_size(ranking)) {
    return refuse(CRASHRANK_USAGE, "the ranking has no such index", error);
  }
  if (contact >= crashrank_ranking_further_count(ranking, index)) {
    return refuse(CRASHRANK_USAGE, "the candidate has no such contact between others", error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Status sized = c::check_size("crashrank_further_contact", *further);
    if (!sized) return refuse(sized.error(), error);
    const FurtherContact& from = ranking->result.ranking[index].further[contact];
    const bool has_harm = ranking->result.measure == Measure::harm;
    const crashrank_further_contact made{
        sizeof made,
        ranking->actors[from.a].c_str(),
        ranking->actors[from.b].c_str(),
        from.time_s,
        from.closing_speed_mps,
        from.outcome_a.delta_v_mps,
        from.outcome_b.delta_v_mps,
        has_harm ? from.harm : std::numeric_limits<double>::quiet_NaN()};
    c::write_sized(made, *further);
    return CRASHRANK_OK;
  });
}

size_t crashrank_ranking_motion_count(const crashrank_ranking* ranking, size_t index) {
  if (index >= crashrank_ranking_size(ranking)) return 0;
  return ranking->result.ranking[index].motion.size();
}

crashrank_status crashrank_ranking_motion(const crashrank_ranking* ranking, size_t index,
                                          size_t body, crashrank_body_motion* motion,
                                          crashrank_error* error) {
  if (const char* null = c::first_null({{"ranking", ranking}, {"motion", motion}})) {
    return refuse_null(null, error);
  }
  if (index >= crashrank_ranking_size(ranking)) {
    return refuse(CRASHRANK_USAGE, "the ranking has no such index", error);
  }
  if (body >= crashrank_ranking_motion_count(ranking, index)) {
    return refuse(CRASHRANK_USAGE,
                  "the candidate has no such motion; ask for motions in the options", error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Status sized = c::check_size("crashrank_body_motion", *motion);
    if (!sized) return refuse(sized.error(), error);
    const BodyMotion& from = ranking->result.ranking[index].motion[body];
    const crashrank_body_motion made{
        sizeof made,
        from.body == ego_body ? "ego" : ranking->actors[from.body].c_str(),
        from.t_s.size(),
        from.t_s.data(),
        from.x_m.data(),
        from.y_m.data(),
        from.yaw_rad.data(),
        from.vx_mps.data(),
        from.vy_mps.data(),
        from.yaw_rate_radps.data(),
        reinterpret_cast<const std::uint8_t*>(from.pressed.data())};
    c::write_sized(made, *motion);
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_ranking_manoeuvre(const crashrank_ranking* ranking, size_t index,
                                             crashrank_manoeuvre* manoeuvre,
                                             crashrank_error* error) {
  if (const char* null = c::first_null({{"ranking", ranking}, {"manoeuvre", manoeuvre}})) {
    return refuse_null(null, error);
  }
  if (index >= crashrank_ranking_size(ranking)) {
    return refuse(CRASHRANK_USAGE, "the ranking has no such index", error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Status sized = c::check_size("crashrank_manoeuvre", *manoeuvre);
    if (!sized) return refuse(sized.error(), error);
    c::write_sized(to_manoeuvre(ranking->result.ranking[index]), *manoeuvre);
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_ranking_place(const crashrank_ranking* ranking, size_t index,
                                         size_t* place, size_t* sharing, crashrank_error* error) {
  if (const char* null = c::first_null({{"ranking", ranking}, {"place", place}})) {
    return refuse_null(null, error);
  }
  if (index >= crashrank_ranking_size(ranking)) {
    return refuse(CRASHRANK_USAGE, "the ranking has no such index", error);
  }
  const CandidateResult& ranked = ranking->result.ranking[index];
  *place = ranked.place;
  if (sharing != nullptr) *sharing = ranked.sharing;
  return CRASHRANK_OK;
}

crashrank_status crashrank_ranking_separable(const crashrank_ranking* ranking, size_t index,
                                             int32_t* separable, crashrank_error* error) {
  if (const char* null = c::first_null({{"ranking", ranking}, {"separable", separable}})) {
    return refuse_null(null, error);
  }
  const size_t count = crashrank_ranking_size(ranking);
  if (index >= count) return refuse(CRASHRANK_USAGE, "the ranking has no such index", error);
  const RankResult& result = ranking->result;
  const bool sampled = !needs_crash(result.measure) || !result.samples.empty();
  *separable = -1;
  if (sampled && index + 1 < count) *separable = result.ranking[index].separable ? 1 : 0;
  return CRASHRANK_OK;
}

const char* crashrank_ranking_unit(const crashrank_ranking* ranking) {
  return ranking == nullptr ? nullptr : measure_unit(ranking->result.measure);
}

const char* crashrank_ranking_json(const crashrank_ranking* ranking) {
  return ranking == nullptr || ranking->json.empty() ? nullptr : ranking->json.c_str();
}
