#pragma once

#include "rank/crash_scratch.hpp"
#include "rank/damage.hpp"
#include "rank/scene.hpp"
#include "rank/tally.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// Memory that evaluating candidates reuses, one for each worker.
struct Scratch {
  /// An actor whose swept box meets the ego's, and in which slices.
  struct Near {
    std::size_t actor = 0;
    std::size_t first_slice = 0;
    std::size_t last_slice = 0;
  };
  struct Hit {
    std::size_t actor = 0;
    Impact impact;
  };
  std::vector<Near> near;
  std::vector<std::size_t> place;  ///< by actor: where it is in `near`, or none
  std::vector<Hit> hits;
  ImpactWorkspace impact;
  CrashScratch crash;
  DamageScratch damage;
  /// Given to the search for contacts, see ImpactOptions.
  bool (*stop)(void* stop_context) = nullptr;
  void* stop_context = nullptr;
};

/// A candidate followed to its contacts, with the damage still to be read.
struct Approach {
  CandidateResult result;         ///< contacts without damage, grazes
  std::vector<DamagePlan> plans;  ///< by contact
  /// By contact: in the plain variant, then in those of the samples.
  std::vector<std::vector<ContactEffect>> effects;
  std::vector<std::size_t> met;  ///< actors that were hit or pressed
  bool decided = true;

  /// Those of `met` from an index on.
  View<const std::size_t> met_since(std::size_t first) const {
    return {met.data() + first, met.size() - first};
  }
};

/// Follows one candidate to its first contact. Depends on the scene and the candidate alone, as do
/// the others here.
Approach approach(const Scene& scene, const Candidate& candidate, Scratch& scratch, RankWork& work);

/// Reads the damage and scores it. `found` is of the first contact's first pose; those of the
/// contacts after it follow.
CandidateResult finish(const Scene& scene, const Candidate& candidate, Approach&& approach,
                       FoundDamage found, Scratch& scratch, RankWork& work);

/// Both at once, on the calling thread.
CandidateResult evaluate(const Scene& scene, const Candidate& candidate, Scratch& scratch,
                         RankWork& work);

/// The total order of a ranking: whether `a` stands before `b`.
bool ranks_before(const CandidateResult& a, const CandidateResult& b);

/// Orders the ranking and says how sure its first place is.
void put_in_order(RankResult& result);

/// Fills `place` and `sharing` of a ranking that is in order.
void assign_places(std::vector<CandidateResult>& ranking);

/// Fills the places of a ranking that is in order, and says how stable they are over the samples.
void tell_stability(RankResult& result);

}  // namespace crashrank::detail
