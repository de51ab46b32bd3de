#include "rank/score_crash.hpp"

#include "rank/crash_setup.hpp"

namespace crashrank::detail {
namespace {

BodyOutcome outcome_of(const PulseBody& body, const BodyImpulse& impulse) {
  BodyOutcome outcome;
  outcome.delta_v_mps = impulse.delta_v_mps.norm();
  outcome.pdof_deg =
      body.rigid.movable() ? impulse.pdof_deg : pdof_deg(impulse.impulse_ns, body.rigid.forward);
  return outcome;
}

double term_of(const Scene& scene, const CrashSetup& crash, const Contact& contact,
               const PulseResult& pulse) {
  switch (scene.measure) {
    case Measure::delta_v:
      return pulse.a.delta_v_mps.norm();
    case Measure::energy:
      return pulse.dissipated_j;
    default:
      break;
  }
  const Body& other = scene.actors[contact.actor];
  const double ego_harm =
      harm_of(exposure_of(scene, scene.ego, other, true, contact, outcome_of(crash.a, pulse.a)),
              scene.harm);
  const double other_harm =
      harm_of(exposure_of(scene, other, scene.ego, false, contact, outcome_of(crash.b, pulse.b)),
              scene.harm);
  return ego_harm + other_harm;
}

}  // namespace

bool scored_by_pulses(const Scene& scene) {
  switch (scene.measure) {
    case Measure::delta_v:
    case Measure::energy:
      return true;
    case Measure::harm:
      return scene.harm.weights.property_per_mj == 0.0;
    default:
      return false;
  }
}

CrashScore score_crash(const Scene& scene, const EgoAtContact& ego, const Contact& contact,
                       const GiveUp& give_up, const Watch& watch, PulseMemory& memory) {
  constexpr int steps_at_a_time = 2;
  CrashScore score;
  const CrashSetup crash = set_up_crash(scene, ego, contact);
  PulseResult pulse;
  if (can_press(crash.a, crash.b, crash.along)) {
    score.term = bounds_at_contact(scene, crash, contact);
    const SeverityOptions how = coarse(scene.harm.friction);
    const ViewFrame frame = view_along(crash.along, contact.point_m);
    memory.look.stop = &Watch::stop;
    memory.look.stop_context = const_cast<Watch*>(&watch);
    memory.look.boxes = 0;
    look(crash.a, crash.b, frame, how.pulse, memory);
    score.work += memory.looked_at;
    if (memory.look.stopped) {
      score.end = CrashScore::End::stopped;
      return score;
    }
    PulseRun run(crash.a, crash.b, frame, {how.pulse.friction, 1.0}, how.pulse, memory);
    // The clock is looked at after every step, the bounds after as many whether there is one or
    // not.
    bool late = false;
    const auto goes_on = [&] {
      bool more = true;
      for (int step = 0; step < steps_at_a_time && more && !late; ++step) {
        more = run.advance(1);
        late = watch.expired();
      }
      return more;
    };
    while (goes_on()) {
      const TermBounds now = bounds_in_pulse(scene, crash, contact, run);
      score.term.least = std::max(score.term.least, now.least);
      score.term.most = std::min(score.term.most, now.most);
      // Rounded as the interval will be, so that whoever is given up is beaten by it, too.
      const bool above = give_up.before + score.term.least > give_up.above;
      if (!late && !above) continue;
      score.end = above ? CrashScore::End::given_up : CrashScore::End::stopped;
      score.work += run.work();
      return score;
    }
    score.work += run.work();
    pulse = run.result();
  }
  score.term.least = term_of(scene, crash, contact, pulse);
  score.term.most = score.term.least;
  score.after = after_pulse(crash, pulse);
  return score;
}

}  // namespace crashrank::detail
