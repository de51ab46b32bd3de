#pragma once

#include "rank/crash_chain.hpp"
#include "rank/damage.hpp"
#include "rank/scene.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// First contact of a candidate with the states of both bodies at that time. Damage and severity
/// are not filled in.
Contact first_contact(const Scene& scene, const Motion& ego, std::size_t actor, const Motion& plan,
                      const Impact& impact);

/// Place of a simulated contact in a result.
struct ReportedContact {
  bool is_further = false;  ///< index into `further`, otherwise into `contacts`
  std::size_t index = 0;
};

/// Adds the contacts of a finished simulation to a result without any, with their effects on both
/// bodies. `touches` and `order` are those of CrashChain::effects. Returns the place of each
/// contact, in that order. `plans` gets the poses at which damage is to be evaluated, of the
/// contacts of the result and then of the further ones.
std::vector<ReportedContact> report_contacts(const Scene& scene, const CrashChain& chain,
                                             View<const Touch> touches,
                                             const std::vector<std::size_t>& order,
                                             CandidateResult& result,
                                             std::vector<DamagePlan>& plans);

/// References to the outcomes of a contact for its two bodies.
struct OutcomePair {
  BodyOutcome& a;
  BodyOutcome& b;
};
OutcomePair outcomes_of(CandidateResult& result, const ReportedContact& reported);

}  // namespace crashrank::detail
