#pragma once

#include "rank/scene.hpp"
#include "rank/tally.hpp"

namespace crashrank::detail {

/// What a crash that is not simulated yet is taken for: the score of its first contact alone, as if
/// both bodies were points that stick together; harm is no less than in proportion to the closing
/// energy. A guess, no bound: glancing contacts are milder, and further ones come on top.
double guess_score(const Scene& scene, const Motion& ego, const Motion& other, const Contact& first,
                   Tally& room);

}  // namespace crashrank::detail
