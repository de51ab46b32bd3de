#pragma once

#include "rank/crash_chain.hpp"
#include "rank/damage.hpp"
#include "rank/scene.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// The first contact of a candidate as the two bodies meet; damage and severity are still to be
/// reported.
Contact first_contact(const Scene& scene, const Motion& ego, std::size_t actor, const Motion& plan,
                      const Impact& impact);

/// Where in a result a simulated contact is reported.
struct ReportedContact {
  bool is_further = false;  ///< in `further`, else in `contacts`
  std::size_t index = 0;
};

/// Adds the contacts of a chain that is over to a result whose only contact so far is the first,
/// with what they do to both bodies; `order` is theirs, see `CrashChain::effects`;
/// `ego` and `other` are the poses at the first. Returns where
/// each of that order is reported. `plans` gets where their damage is to be read: of the result's
/// contacts, then of the further ones.
std::vector<ReportedContact> report_contacts(const Scene& scene, const CrashChain& chain,
                                             const std::vector<std::size_t>& order,
                                             const Impact& impact, const Pose& ego,
                                             const Pose& other, CandidateResult& result,
                                             std::vector<DamagePlan>& plans);

/// The two outcomes of a contact.
struct OutcomePair {
  BodyOutcome& a;
  BodyOutcome& b;
};
OutcomePair outcomes_of(CandidateResult& result, const ReportedContact& reported);

}  // namespace crashrank::detail
