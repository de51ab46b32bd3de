#include "crashrank/scenario/scenario.hpp"

#include <algorithm>

namespace crashrank {

bool is_uncertain(const Scenario& scenario) noexcept {
  return !scenario.futures.empty() || scenario.ego.uncertainty.any() ||
         std::any_of(scenario.actors.begin(), scenario.actors.end(),
                     [](const ScenarioActor& actor) {
                       return !actor.predictions.empty() || actor.existence_probability != 1.0 ||
                              actor.perception.any();
                     });
}

Scenario likeliest_future(const Scenario& scenario) {
  const auto less_likely = [](const auto& p, const auto& q) {
    return p.probability < q.probability;
  };
  Scenario single = scenario;
  single.futures.clear();
  single.ego.uncertainty = {};
  for (ScenarioActor& actor : single.actors) {
    actor.perception = {};
    double most = 1.0;
    if (!actor.predictions.empty()) {
      const Prediction& likeliest =
          *std::max_element(actor.predictions.begin(), actor.predictions.end(), less_likely);
      most = likeliest.probability;
      static_cast<ActorMotion&>(actor) = static_cast<const ActorMotion&>(likeliest);
      actor.predictions.clear();
    }
    const double exists = actor.existence_probability;
    actor.existence_probability = exists * most < 1.0 - exists ? 0.0 : 1.0;
  }
  if (scenario.futures.empty()) return single;
  const JointFuture& likeliest =
      *std::max_element(scenario.futures.begin(), scenario.futures.end(), less_likely);
  for (const FutureMotion& moved : likeliest.motions) {
    static_cast<ActorMotion&>(single.actors[moved.actor]) = moved.motion;
  }
  for (const std::size_t actor : likeliest.absent) single.actors[actor].existence_probability = 0.0;
  return single;
}

}  // namespace crashrank
