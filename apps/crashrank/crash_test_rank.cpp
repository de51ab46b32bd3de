#include "crash_test_rank.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace crashrank::cli {

Result<Crash> rank_crash(const CrashBody& ego, const CrashBody& other, double horizon_s) {
  Scenario scenario;
  scenario.name = "crash test";
  scenario.models = {ego.facts, other.facts};
  scenario.ego.pose = ego.start;
  scenario.ego.speed_mps = ego.speed_mps;
  ListedCandidate straight;
  straight.name = "straight on";
  // A yaw rate makes the ego's motion that of an actor, to the bit.
  straight.yaw_rate_radps = 0.0;
  scenario.listed = {straight};
  scenario.grid.reset();
  scenario.add_straight_braking = false;
  ScenarioActor actor;
  actor.name = "other";
  actor.model = 1;
  actor.pose = other.start;
  actor.speed_mps = other.speed_mps;
  scenario.actors = {actor};
  scenario.horizon_s = std::min(horizon_s, scenario_limits::horizon_s);
  scenario.measure = Measure::delta_v;
  scenario.harm.intervals = false;
  const std::vector<Model> models{ego.model, other.model};
  const Result<RankResult> ranked = rank(scenario, models);
  if (!ranked) return ranked.error();
  Crash crash;
  const std::vector<Contact>& contacts = ranked->ranking.front().contacts;
  if (contacts.empty()) return crash;
  crash.state = contacts.front().state;
  const auto acting = std::find_if(contacts.begin(), contacts.end(), [](const Contact& contact) {
    return contact.severity.duration_s > 0.0;
  });
  crash.acts = acting != contacts.end();
  if (crash.acts) crash.severity = acting->severity;
  return crash;
}

}  // namespace crashrank::cli
