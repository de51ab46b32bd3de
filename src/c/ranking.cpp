#include "c/handles.hpp"

#include "crashrank/report/ranking.hpp"

#include <limits>
#include <memory>
#include <utility>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

Result<RankOptions> to_options(const crashrank_rank_options* options) {
  RankOptions made;
  if (options == nullptr) return made;
  made.workers = options->workers;
  if (options->measure != nullptr) {
    const Result<Measure> measure = measure_from_name(options->measure);
    if (!measure) return measure.error();
    made.measure = *measure;
  }
  return made;
}

}  // namespace

crashrank_status crashrank_rank(const crashrank_scenario* scenario, const crashrank_models* models,
                                const crashrank_rank_options* options, crashrank_ranking** ranking,
                                crashrank_error* error) {
  if (scenario == nullptr || models == nullptr || ranking == nullptr) return refuse_null(error);
  return guarded(error, [&]() -> crashrank_status {
    const Result<RankOptions> how = to_options(options);
    if (!how) return refuse(how.error(), error);
    const Scenario told = c::with_stated_masses(*scenario, *models);
    Result<RankResult> result = rank(told, models->list, *how);
    if (!result) return refuse(result.error(), error);
    auto made = std::make_unique<crashrank_ranking>();
    for (const ScenarioActor& actor : told.actors) made->actors.push_back(actor.name);
    if (options != nullptr && options->json != 0) {
      made->json = ranking_json(told, models->list, *result);
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
  if (ranking == nullptr || choice == nullptr) return refuse_null(error);
  if (place >= crashrank_ranking_size(ranking)) {
    return refuse(CRASHRANK_USAGE, "the ranking has no such place", error);
  }
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const CandidateResult& ranked = ranking->result.ranking[place];
  crashrank_choice told{};
  told.candidate = ranking->result.candidates[ranked.candidate].name.c_str();
  told.score = ranked.score.value_or(unknown);
  told.lowest_score = ranked.score_interval.lowest;
  told.highest_score = ranked.score_interval.highest;
  told.time_of_impact_s = told.closing_speed_mps = told.delta_v_mps = unknown;
  told.other_delta_v_mps = told.pdof_deg = unknown;
  told.damaged_triangles = ranked.ego.triangles.size();
  told.contacts = ranked.contacts.size();
  if (!ranked.contacts.empty()) {
    const Contact& first = ranked.contacts.front();
    told.other = ranking->actors[first.actor].c_str();
    told.time_of_impact_s = first.time_of_impact_s;
    told.closing_speed_mps = first.closing_speed_mps;
    told.delta_v_mps = first.severity.ego.delta_v_mps;
    told.other_delta_v_mps = first.severity.other.delta_v_mps;
    told.pdof_deg = first.severity.ego.pdof_deg;
  }
  *choice = told;
  return CRASHRANK_OK;
}

size_t crashrank_ranking_further_count(const crashrank_ranking* ranking, size_t index) {
  if (index >= crashrank_ranking_size(ranking)) return 0;
  return ranking->result.ranking[index].further.size();
}

crashrank_status crashrank_ranking_further(const crashrank_ranking* ranking, size_t index,
                                           size_t contact, crashrank_further_contact* further,
                                           crashrank_error* error) {
  if (ranking == nullptr || further == nullptr) return refuse_null(error);
  if (index >= crashrank_ranking_size(ranking)) {
    return refuse(CRASHRANK_USAGE, "the ranking has no such index", error);
  }
  if (contact >= crashrank_ranking_further_count(ranking, index)) {
    return refuse(CRASHRANK_USAGE, "the candidate has no such contact between others", error);
  }
  const FurtherContact& from = ranking->result.ranking[index].further[contact];
  const bool has_harm = ranking->result.measure == Measure::harm;
  *further = {ranking->actors[from.a].c_str(),
              ranking->actors[from.b].c_str(),
              from.time_s,
              from.closing_speed_mps,
              from.outcome_a.delta_v_mps,
              from.outcome_b.delta_v_mps,
              has_harm ? from.harm : std::numeric_limits<double>::quiet_NaN()};
  return CRASHRANK_OK;
}

crashrank_status crashrank_ranking_place(const crashrank_ranking* ranking, size_t index,
                                         size_t* place, size_t* sharing, crashrank_error* error) {
  if (ranking == nullptr || place == nullptr) return refuse_null(error);
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
  if (ranking == nullptr || separable == nullptr) return refuse_null(error);
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
