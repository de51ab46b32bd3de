#include "crashrank/rank/rank.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "rank/evaluate.hpp"
#include "rank/evaluate_on_workers.hpp"
#include "rank/measure_table.hpp"
#include "rank/order.hpp"
#include "rank/progress.hpp"
#include "rank/reach.hpp"
#include "rank/scene.hpp"
#include "scenario/scenario_check.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

/// Evaluates all candidates. Sets in `needed` what an evaluation sets in Scratch::needed.
Status evaluate_all(const detail::Scene& scene, const RankOptions& options, RankResult& result,
                    std::vector<char>& needed) {
  const std::size_t count = result.candidates.size();
  if (options.workers > 1 && count > 0) {
    return detail::evaluate_on_workers(scene, options, result, needed);
  }
  detail::RankProgress progress(options, count);
  detail::Scratch scratch;
  progress.attach_to(scratch);
  for (std::size_t i = 0; i < count; ++i) {
    result.ranking[i] = detail::evaluate(scene, result.candidates[i], scratch, result.work);
    if (result.ranking[i].score) progress.advance();
  }
  scratch.add_needed(needed);
  return Success{};
}

/// Evaluates all candidates in futures that leave out distant actors. If crashes reach some of
/// these, evaluates all again with them included.
Status evaluate_in_futures(detail::Scene& scene, const RankOptions& options, RankResult& result) {
  std::vector<char> rings(scene.actors.size());
  detail::leave_out_distant_actors(scene, {result.candidates.data(), result.candidates.size()},
                                   rings, result.work.box_tests);
  std::vector<char> needed(scene.actors.size());
  Status done = evaluate_all(scene, options, result, needed);
  for (int repeats = 0; done && detail::include_needed_actors(scene, needed, repeats, rings);
       ++repeats) {
    done = evaluate_all(scene, options, result, needed);
  }
  result.futures = scene.futures.summary;
  return done;
}

/// Finds the damage in the first places by another simulation of the nominal sample.
void add_damage(detail::Scene& scene, std::size_t places, RankResult& result) {
  scene.finds_damage = true;
  scene.samples.clear();
  detail::Scratch scratch;
  for (std::size_t row = 0; row < std::min(places, result.ranking.size()); ++row) {
    CandidateResult& ranked = result.ranking[row];
    if (!ranked.score || !ranked.collides) continue;
    CandidateResult damaged =
        detail::evaluate(scene, result.candidates[ranked.candidate], scratch, result.work);
    for (std::size_t i = 0; i < ranked.contacts.size(); ++i) {
      ranked.contacts[i].ego = std::move(damaged.contacts[i].ego);
      ranked.contacts[i].other = std::move(damaged.contacts[i].other);
    }
    for (std::size_t i = 0; i < ranked.further.size(); ++i) {
      ranked.further[i].damage_a = std::move(damaged.further[i].damage_a);
      ranked.further[i].damage_b = std::move(damaged.further[i].damage_b);
    }
    ranked.ego = std::move(damaged.ego);
  }
}

Result<RankResult> rank_or_throw(const Scenario& scenario, View<const Model> models,
                                 const RankOptions& options) {
  if (Status shared = detail::check_workers(options.workers); !shared) return shared.error();
  const Status sound = detail::check_scenario(scenario);
  if (!sound) return sound.error();
  if (options.harm) {
    const Status weighed = detail::check_harm(*options.harm, "harm");
    if (!weighed) return weighed.error();
  }
  RankResult result;
  Result<detail::Scene> scene = detail::make_scene(scenario, models, options, result);
  if (!scene) return scene.error();
  result.measure = scene->measure;
  result.harm = scene->harm;
  result.samples = scene->samples;
  result.infeasible = scene->infeasible;
  result.order = options.order;
  result.has_motion = scene->records_motion;
  const double ego_length_m = models[result.ego.model].mesh.bounds().extent().x();
  Result<std::vector<Candidate>> candidates = make_candidates(scenario, ego_length_m);
  if (!candidates) return candidates.error();
  result.candidates = std::move(*candidates);

  const std::size_t count = result.candidates.size();
  result.ranking.resize(count);
  result.work = scene->work;
  scene->finds_damage = detail::scored_by_damage(scene->measure) || options.damaged_places >= count;
  const Status evaluated = evaluate_in_futures(*scene, options, result);
  if (!evaluated) return evaluated.error();
  for (std::size_t i = 0; i < count; ++i) result.ranking[i].candidate = i;
  detail::sort_ranking(result);
  if (!scene->finds_damage) add_damage(*scene, options.damaged_places, result);
  return result;
}

}  // namespace

Result<RankResult> rank(const Scenario& scenario, View<const Model> models,
                        const RankOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Result<RankResult> result =
      detail::guarded([&] { return rank_or_throw(scenario, models, options); });
  if (result) {
    result->elapsed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return result;
}

}  // namespace crashrank
