#include "crashrank/rank/rank.hpp"

#include "rank/evaluate.hpp"
#include "rank/guard.hpp"
#include "rank/scenario_check.hpp"
#include "rank/scene.hpp"
#include "rank/workers.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

namespace crashrank {
namespace {

Result<RankResult> rank_or_throw(const Scenario& scenario, View<const Model> models,
                                 const RankOptions& options) {
  const Status sound = detail::check_scenario(scenario);
  if (!sound) return sound.error();
  RankResult result;
  const Result<detail::Scene> scene = detail::make_scene(scenario, models, options, result);
  if (!scene) return scene.error();
  result.measure = scene->measure;
  const double ego_length_m = models[result.ego.model].mesh.bounds().extent().x();
  Result<std::vector<Candidate>> candidates = make_candidates(scenario, ego_length_m);
  if (!candidates) return candidates.error();
  result.candidates = std::move(*candidates);

  const std::size_t count = result.candidates.size();
  const auto workers = static_cast<unsigned>(
      std::clamp<std::size_t>(options.workers, 1, std::max<std::size_t>(count, 1)));
  result.ranking.resize(count);
  std::vector<RankWork> work(count);
  std::vector<char> failed(count, 0);
  std::vector<detail::Scratch> scratch(workers);
  detail::for_each_index(count, workers, [&](std::size_t i, unsigned worker) {
    try {
      result.ranking[i] = detail::evaluate(*scene, result.candidates[i], scratch[worker], work[i]);
      result.ranking[i].candidate = i;
    } catch (const std::bad_alloc&) {
      failed[i] = 1;
    }
  });
  if (std::find(failed.begin(), failed.end(), 1) != failed.end()) throw std::bad_alloc();
  result.work = scene->work;
  for (const RankWork& spent : work) result.work += spent;
  detail::put_in_order(result);
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
