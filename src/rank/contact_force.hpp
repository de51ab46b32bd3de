#pragma once

#include "rank/evaluate.hpp"

#include <cstddef>
#include <limits>
#include <optional>

namespace crashrank::detail {

/// No body.
inline constexpr std::size_t no_actor = std::numeric_limits<std::size_t>::max();

/// The body of Contact::contact_without_force in a future, after its simulation in
/// `scratch.chain` has finished; or `no_actor`. Contacts that the plans have after the first are
/// looked at while both bodies keep to their plans within `SceneRun::on_plan_m`, as after a clip of
/// a mirror. Nothing if time was up.
std::optional<std::size_t> actor_without_force(const Scene& scene, const Motion& ego,
                                               std::size_t future, const Contact& first,
                                               Scratch& scratch, RankWork& work);

}  // namespace crashrank::detail
