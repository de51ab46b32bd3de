#include "crashrank/scenario/scenario.hpp"

#include "crashrank/scenario/candidate.hpp"
#include "scenario/motion_order.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

/// Motion as written; at rest where it is none, which the ranking refuses.
Motion motion_of(const ActorMotion& written) {
  Result<Motion> motion = make_motion(written, {});
  return motion ? std::move(*motion) : Motion();
}

/// Equal alternatives: the first of them, and the sum of their probabilities.
struct Group {
  std::size_t first = 0;
  double probability = 0.0;
};

/// Sorts alternatives and groups equal ones.
template <class Compare, class Probability>
std::vector<Group> group_equal(std::vector<std::size_t> order, const Compare& compare,
                               const Probability& probability) {
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) {
    const int by_content = compare(p, q);
    return by_content != 0 ? by_content < 0 : p < q;
  });
  std::vector<Group> groups;
  for (const std::size_t k : order) {
    if (groups.empty() || compare(groups.back().first, k) != 0) groups.push_back({k, 0.0});
    groups.back().probability += probability(k);
  }
  return groups;
}

/// What every actor does in a joint future; null: it is absent.
std::vector<std::optional<Motion>> joint_motions(const Scenario& scenario,
                                                 const JointFuture& future) {
  std::vector<std::optional<Motion>> motions;
  for (const ScenarioActor& actor : scenario.actors) motions.emplace_back(motion_of(actor));
  for (const FutureMotion& moved : future.motions) motions[moved.actor] = motion_of(moved.motion);
  for (const std::size_t actor : future.absent) motions[actor].reset();
  return motions;
}

std::size_t likeliest_joint(const Scenario& scenario) {
  std::vector<std::vector<std::optional<Motion>>> futures;
  for (const JointFuture& each : scenario.futures) {
    futures.push_back(joint_motions(scenario, each));
  }
  std::vector<std::size_t> by_name(scenario.actors.size());
  std::iota(by_name.begin(), by_name.end(), std::size_t{0});
  std::stable_sort(by_name.begin(), by_name.end(), [&](std::size_t p, std::size_t q) {
    return scenario.actors[p].name < scenario.actors[q].name;
  });
  const auto compare = [&](std::size_t p, std::size_t q) {
    for (const std::size_t actor : by_name) {
      const std::optional<Motion>& a = futures[p][actor];
      const std::optional<Motion>& b = futures[q][actor];
      if (a.has_value() != b.has_value()) return a ? -1 : 1;
      if (!a) continue;
      if (const int order = detail::compare_motions(*a, *b); order != 0) return order;
    }
    return 0;
  };
  std::vector<std::size_t> order(futures.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<Group> groups = group_equal(
      std::move(order), compare, [&](std::size_t k) { return scenario.futures[k].probability; });
  return groups[detail::likeliest_of(groups.size(),
                                     [&](std::size_t k) { return groups[k].probability; })]
      .first;
}

}  // namespace

bool is_uncertain(const Scenario& scenario) noexcept {
  return !scenario.futures.empty() || scenario.ego.uncertainty.any() ||
         std::any_of(scenario.actors.begin(), scenario.actors.end(),
                     [](const ScenarioActor& actor) {
                       return !actor.predictions.empty() || actor.existence_probability != 1.0 ||
                              actor.perception.any();
                     });
}

Scenario likeliest_future(const Scenario& scenario) {
  Scenario single = scenario;
  single.futures.clear();
  single.ego.uncertainty = {};
  for (ScenarioActor& actor : single.actors) {
    actor.perception = {};
    std::vector<Motion> motions;
    for (const Prediction& each : actor.predictions) motions.push_back(motion_of(each));
    std::vector<std::size_t> order(motions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto compare = [&](std::size_t p, std::size_t q) {
      return detail::compare_motions(motions[p], motions[q]);
    };
    const auto probability = [&](std::size_t k) { return actor.predictions[k].probability; };
    const std::vector<Group> groups = group_equal(std::move(order), compare, probability);
    const double exists = actor.existence_probability;
    double total = 0.0;
    for (const Group& group : groups) total += group.probability;
    // The choices of the actor, then its absence.
    const std::size_t present = std::max<std::size_t>(groups.size(), 1);
    const std::size_t likeliest = detail::likeliest_of(present + 1, [&](std::size_t k) {
      if (k == present) return 1.0 - exists;
      return groups.empty() ? exists : exists * (groups[k].probability / total);
    });
    actor.existence_probability = likeliest == present ? 0.0 : 1.0;
    if (groups.empty()) continue;
    const std::size_t motion =
        detail::likeliest_of(groups.size(), [&](std::size_t k) { return groups[k].probability; });
    const ActorMotion followed = actor.predictions[groups[motion].first];
    static_cast<ActorMotion&>(actor) = followed;
    actor.predictions.clear();
  }
  if (scenario.futures.empty()) return single;
  const JointFuture& likeliest = scenario.futures[likeliest_joint(scenario)];
  for (const FutureMotion& moved : likeliest.motions) {
    static_cast<ActorMotion&>(single.actors[moved.actor]) = moved.motion;
  }
  for (const std::size_t actor : likeliest.absent) single.actors[actor].existence_probability = 0.0;
  return single;
}

}  // namespace crashrank
