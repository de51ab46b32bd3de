#pragma once

#include "rank/crash_chain.hpp"
#include "rank/damage.hpp"
#include "rank/report_contacts.hpp"
#include "rank/risk.hpp"
#include "rank/scene.hpp"
#include "rank/stop_check.hpp"
#include "rank/tally.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace crashrank::detail {

/// Memory that evaluating candidates reuses, one for each worker.
struct Scratch {
  /// A plan on which an actor's swept box overlaps the ego's, and in which slices.
  struct Near {
    std::size_t plan = 0;
    std::size_t first_slice = 0;
    std::size_t last_slice = 0;
  };
  struct Hit {
    std::size_t plan = 0;
    std::size_t actor = 0;  ///< whose plan it is
    Impact impact;
  };
  std::vector<Near> near;
  std::vector<std::size_t> place;  ///< by plan: where it is in `near`, or none
  std::vector<Hit> hits;
  std::vector<double> first_s;  ///< by future, while hits are searched
  std::vector<double> until_s;
  std::vector<char> relevant;            ///< by plan, see Futures::split
  bool needs_left_out = false;           ///< see Futures::needs_left_out; of all since it was false
  std::vector<std::uint32_t> same;       ///< futures that share an outcome
  std::vector<std::uint32_t> remaining;  ///< and those still to be evaluated
  std::vector<std::uint32_t> others;     ///< while these are split
  std::vector<WeightedScore> weighted;   ///< while futures are combined
  Motion ego;                            ///< in a future that displaces it
  ImpactWorkspace impact;
  CrashChain chain;
  std::vector<PlanarPose> ego_poses;  ///< of the candidate
  std::vector<ContactEffect> effects;
  std::vector<std::size_t> order;
  Tally tally;
  DamageScratch damage;
  /// Asked by all searches and before each simulation.
  StopCheck stop;

  bool stopped() const { return stop(); }

  /// Room for a scene: nothing but its damage allocates after it.
  void prepare(const Scene& scene);
};

/// A candidate followed through its crash in futures that do not differ for it, with the damage
/// still to be read.
struct SimulatedOutcome {
  CandidateResult result;                 ///< contacts without damage, grazes
  std::vector<DamagePlan> plans;          ///< by contact, then by further contact
  std::vector<ReportedContact> reported;  ///< by effect of the nominal variant
  /// Of the nominal variant, then of those of the samples.
  std::vector<std::vector<ContactEffect>> effects;
  FutureOutcome summary;               ///< without its score
  std::optional<RoadLeaving> leaving;  ///< of the ego's motion until the horizon
  std::vector<std::uint32_t> futures;  ///< that it is of
};

/// The same in all futures.
struct SimulatedCandidate {
  std::vector<SimulatedOutcome> outcomes;  ///< the likeliest future's first
  double collision_probability = 0.0;
  bool decided = true;  ///< else the search came to no end or was stopped
};

/// Follows one candidate through its crash. Depends on the scene and the candidate alone, as do
/// the others here, unless it is stopped: then nothing is known of it.
SimulatedCandidate simulate_candidate(const Scene& scene, const Candidate& candidate,
                                      Scratch& scratch, RankWork& work);

/// Reads the damage, scores it and combines the futures. `found` is of the first contact's first
/// pose; those of the contacts after it follow.
CandidateResult finish(const Scene& scene, const Candidate& candidate,
                       SimulatedCandidate&& simulated, PrecomputedPairs found, Scratch& scratch,
                       RankWork& work);

/// Both at once, on the calling thread.
CandidateResult evaluate(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                         RankWork& work);

}  // namespace crashrank::detail
