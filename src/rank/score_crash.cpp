#include "rank/score_crash.hpp"

#include "crash/lone_contact.hpp"
#include "rank/crash_setup.hpp"

#include <algorithm>

namespace crashrank::detail {

bool scored_by_pulses(const Scene& scene) {
  return scene.measure == Measure::delta_v || scene.measure == Measure::energy ||
         scene.measure == Measure::harm;
}

CrashScore score_crash(const Scene& scene, const CrashQuery& q, const Watch& watch,
                       std::vector<std::size_t>& met, CrashScratch& scratch) {
  constexpr int steps_at_a_time = 4;
  CrashScore score;
  const CrashSetup crash =
      set_up_crash(scene, q.ego, q.contact, {met.data(), met.size()}, scratch.group);
  score.score = q.tally.bounds(scene, pending_at_contact(crash, q.contact), q.later);
  LoneContact run(crash.a, crash.b, crash.fixed, q.contact.point_m, variant_of(scene.plain), {},
                  scratch.workspace);
  while (run.advance(steps_at_a_time)) {
    const Range now = q.tally.bounds(scene, pending_in_run(crash, q.contact, run.run()), q.later);
    score.score.least = std::max(score.score.least, now.least);
    score.score.most = std::min(score.score.most, now.most);
    const bool above = score.score.least > q.give_up_above;
    if (!above && !watch.expired()) continue;
    score.end = above ? CrashScore::End::given_up : CrashScore::End::stopped;
    score.work = run.run().work();
    return score;
  }
  score.work = run.run().work();
  const ContactOutcome outcome = run.outcome();
  add_pressed(scene, scratch.workspace.state(), scratch.group, met);
  score.effect = effect_of(q.contact, crash, outcome);
  score.after = after_contact(crash, outcome);
  return score;
}

}  // namespace crashrank::detail
