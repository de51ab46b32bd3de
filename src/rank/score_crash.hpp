#pragma once

#include "crash/pulse_run.hpp"
#include "rank/bounds.hpp"
#include "rank/contact_severity.hpp"
#include "rank/watch.hpp"

#include <cstdint>

namespace crashrank::detail {

/// What one crash adds to the score.
struct CrashScore {
  enum class End {
    done,      ///< `term.least` is it
    given_up,  ///< it is above what was asked, as far as it was followed
    stopped,   ///< time was up
  };
  End end = End::done;
  TermBounds term;
  EgoAfterContact after;
  std::uint64_t work = 0;
};

/// When a crash is not worth following: its term, added to what crashes `before` cost, is `above`.
struct GiveUp {
  double before = 0.0;
  double above = 0.0;
};

/// Simulates the crash that begins with a contact as `tell_severity` does, for the score alone: of
/// the measures delta_v and energy, and of harm where property has no weight. Left as soon as its
/// term is proved to be worth giving up.
CrashScore score_crash(const Scene& scene, const EgoAtContact& ego, const Contact& contact,
                       const GiveUp& give_up, const Watch& watch, PulseMemory& memory);

/// Whether `score_crash` can score the scene.
bool scored_by_pulses(const Scene& scene);

}  // namespace crashrank::detail
