#pragma once

#include "rank/crash_chain.hpp"
#include "rank/damage.hpp"
#include "rank/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// First contact of a candidate with the states of both bodies at that time. Damage and severity
/// are not filled in.
Contact first_contact(const Scene& scene, const Motion& ego, std::size_t actor, const Motion& plan,
                      const Impact& impact);

/// First contact of a crash, while both bodies follow their plans.
struct Touch {
  Contact contact;
  std::int32_t triangle_ego = -1;  ///< triangles that touch first; negative if there are none
  std::int32_t triangle_other = -1;
  Pose ego;  ///< poses at that time
  Pose other;
};

/// First contact of a candidate from the search on the motion of the ego and a plan of an actor.
Touch first_touch(const Scene& scene, const Motion& ego, std::size_t actor, const Motion& plan,
                  const Impact& impact);

/// Place of a simulated contact in a result.
struct ReportedContact {
  bool is_further = false;  ///< index into `further`, otherwise into `contacts`
  std::size_t index = 0;
};

/// Adds the contacts of a finished simulation to a result without any, with their effects on both
/// bodies. `first` is the first contact and `order` that of CrashChain::effects. Returns the place
/// of each contact, in that order. `plans` gets the poses at which damage is to be evaluated, of
/// the contacts of the result and then of the further ones.
std::vector<ReportedContact> report_contacts(const Scene& scene, const CrashChain& chain,
                                             const Touch& first,
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
