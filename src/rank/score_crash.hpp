#pragma once

#include "rank/bounds.hpp"
#include "rank/contact_severity.hpp"
#include "rank/crash_scratch.hpp"
#include "rank/tally.hpp"
#include "rank/watch.hpp"

#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// What came of simulating a contact for its score.
struct CrashScore {
  enum class End {
    done,      ///< `effect` and `after` stand
    given_up,  ///< the score is above what was asked, as far as it was simulated
    stopped,   ///< time was up
  };
  End end = End::done;
  Range score;  ///< bounds on the whole score
  ContactEffect effect;
  EgoAfterContact after;
  std::uint64_t work = 0;
};

/// A contact, what is known of the candidate before it, and when it need not be simulated further.
struct CrashQuery {
  const EgoAtContact& ego;
  const Contact& contact;
  const Tally& tally;
  const Later& later;
  double give_up_above;
};

/// Simulates a contact as `simulate_variants` does its plain variant, for the score alone. Adds the
/// further bodies that pressed to `met` when done.
CrashScore score_crash(const Scene& scene, const CrashQuery& query, const Watch& watch,
                       std::vector<std::size_t>& met, CrashScratch& scratch);

/// Whether `score_crash` can score the scene.
bool scored_by_pulses(const Scene& scene);

}  // namespace crashrank::detail
