#include "report/scene_views.hpp"

#include "crashrank/scenario/candidate.hpp"
#include "report/damage_summary.hpp"

namespace crashrank::detail {

std::vector<SceneView> scene_views(const Scenario& scenario, View<const Model> models,
                                   const RankResult& result, std::size_t place) {
  const CandidateResult& ranked = result.ranking[place];
  std::vector<SceneView> views{{scenario.ego.model, ranked.ego}};
  if (!ranked.contacts.empty()) {
    views.front().damage.pose = ranked.contacts.front().ego.pose;
    for (DamagedBody& body : damaged_others(scenario, models, ranked)) {
      views.push_back({scenario.actors[body.actor].model, std::move(body.damage)});
    }
    return views;
  }
  constexpr double near_m = 15.0;
  const double end_s = scenario.horizon_s;
  const Pose ego = result.candidates[ranked.candidate].motion.pose_at(end_s);
  views.front().damage.pose = ego;
  for (const ScenarioActor& actor : scenario.actors) {
    if (actor.existence_probability == 0.0) continue;
    const Result<Motion> motion = make_motion(actor);
    SceneView view{actor.model, {}};
    view.damage.pose = motion ? motion->pose_at(end_s) : actor.pose;
    if ((view.damage.pose.translation - ego.translation).norm() < near_m) views.push_back(view);
  }
  return views;
}

}  // namespace crashrank::detail
