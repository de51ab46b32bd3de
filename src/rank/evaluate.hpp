#pragma once

#include "rank/box_crash.hpp"
#include "rank/crash_chain.hpp"
#include "rank/crash_score.hpp"
#include "rank/damage.hpp"
#include "rank/report_contacts.hpp"
#include "rank/risk.hpp"
#include "rank/scene.hpp"
#include "rank/stop_check.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace crashrank::detail {

/// Working memory of an evaluation, reused from candidate to candidate; one for each worker.
struct Scratch {
  /// A plan on which the swept box of an actor overlaps that of the ego, with the first and last
  /// time slice in which it does.
  struct Near {
    std::size_t plan = 0;
    std::size_t first_slice = 0;
    std::size_t last_slice = 0;
  };
  struct Hit {
    std::size_t plan = 0;
    std::size_t actor = 0;  ///< actor that follows the plan
    Impact impact;
  };
  std::vector<Near> near;
  std::vector<std::size_t> place;  ///< by plan: index in `near`, or none
  std::vector<Hit> hits;
  std::vector<double> first_s;  ///< by future: time of the first contact so far, s
  std::vector<double> until_s;
  std::vector<char> relevant;  ///< by plan: it influences the outcome, see Futures::split
  /// By actor: see Futures::mark_needed. Entries remain once they are set.
  std::vector<char> needed;
  std::vector<std::uint32_t> same;       ///< futures with the same outcome as the current one
  std::vector<std::uint32_t> remaining;  ///< futures that remain to be simulated
  std::vector<std::uint32_t> others;     ///< working memory for splitting them
  std::vector<WeightedScore> weighted;   ///< working memory for combining futures
  Motion ego;                            ///< motion of the ego in a future that displaces it
  ImpactWorkspace impact;
  CrashChain chain;
  BoxCrash boxes;
  std::vector<PlanarPose> ego_poses;  ///< sampled trajectory of the candidate
  CrashEffects effects;
  std::vector<std::size_t> order;
  CrashScore score;
  DamageScratch damage;
  /// Checked by all searches and before each simulation.
  StopCheck stop;

  bool stopped() const { return stop(); }

  /// Allocates for a scene; afterwards only the damage search allocates.
  void prepare(const Scene& scene);
  /// Marks in `all` what `needed` marks.
  void add_needed(std::vector<char>& all) const {
    for (std::size_t i = 0; i < needed.size(); ++i) {
      if (needed[i] != 0) all[i] = 1;
    }
  }
};

/// Result of simulating a candidate in futures that do not differ for it. Damage is not evaluated
/// yet.
struct SimulatedOutcome {
  CandidateResult result;         ///< contacts without damage, and grazes
  std::vector<DamagePlan> plans;  ///< by contact, followed by the further contacts
  /// place of each effect of the nominal sample in the result
  std::vector<ReportedContact> reported;
  /// Effects of the nominal sample, followed by those of the other simulated samples.
  std::vector<CrashEffects> effects;
  FutureOutcome summary;  ///< summary of the outcome, without its score
  /// first moment off the road on the motion of the ego until the horizon
  std::optional<RoadLeaving> leaving;
  std::vector<std::uint32_t> futures;  ///< the futures that have this outcome
};

/// Results of simulating a candidate in all futures.
struct SimulatedCandidate {
  std::vector<SimulatedOutcome> outcomes;  ///< the first contains the likeliest future
  double collision_probability = 0.0;
  bool decided = true;  ///< false: a search stayed undecided or was stopped
};

/// Simulates the crashes of a candidate in all futures. Like the functions below it depends on the
/// scene and the candidate alone, unless it is stopped: then its result must not be used.
SimulatedCandidate simulate_candidate(const Scene& scene, const Candidate& candidate,
                                      Scratch& scratch, RankWork& work);

/// For each sample the index of its simulation in SimulatedOutcome::effects. Samples that differ
/// only in the risk model and its speeds share a simulation.
std::vector<std::size_t> simulation_of_sample(const Scene& scene);

/// Evaluates damage and scores of all outcomes and combines the futures. `found.first` is the query
/// of the first pose of the first contact; those of later contacts follow it.
CandidateResult finish(const Scene& scene, const Candidate& candidate,
                       SimulatedCandidate&& simulated, PrecomputedPairs found, Scratch& scratch,
                       RankWork& work);

/// Calls simulate_candidate and finish on the calling thread.
CandidateResult evaluate(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                         RankWork& work);

}  // namespace crashrank::detail
