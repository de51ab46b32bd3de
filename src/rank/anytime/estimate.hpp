#pragma once

#include "rank/crash_score.hpp"
#include "rank/scene.hpp"

namespace crashrank::detail {

/// Estimate of the score of a crash that is not simulated yet: the score of its first contact
/// alone, as if both bodies were point masses that stop each other along the normal and rub with
/// friction across it. Harm is at least proportional to energies of the stopped and of the closing
/// velocity. Not a bound, since later contacts add to the score. 0 for intrusion, which point
/// masses do not have.
double estimate_score(const Scene& scene, const Motion& ego, const Motion& other,
                      const Contact& first, CrashEffects& effects, CrashScore& score);

}  // namespace crashrank::detail
