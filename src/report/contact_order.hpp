#pragma once

#include "crashrank/rank/rank.hpp"

#include <vector>

namespace crashrank::detail {

/// A contact of a candidate; one of the two is set.
struct AnyContact {
  const Contact* own = nullptr;             ///< the ego's
  const FurtherContact* further = nullptr;  ///< between two others

  double time_s() const { return own != nullptr ? own->time_of_impact_s : further->time_s; }
};

/// All contacts of a candidate by their begins; the ego's come first where two begin together.
/// They point into `ranked`.
std::vector<AnyContact> contacts_in_order(const CandidateResult& ranked);

}  // namespace crashrank::detail
