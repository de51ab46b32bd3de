#pragma once

#include "rank/scene.hpp"
#include "rank/tally.hpp"

namespace crashrank::detail {

/// What a crash that is not simulated yet is taken for: the score of its first contact alone, as if
/// both bodies were points that stop each other along the normal and rub on each other across it;
/// harm is no less than in proportion to energies of that and of the closing speed. A guess, no
/// bound: further contacts come on top. 0 for what points do not have, intrusion.
double estimate_score(const Scene& scene, const Motion& ego, const Motion& other,
                      const Contact& first, Tally& tally);

}  // namespace crashrank::detail
