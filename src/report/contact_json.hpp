#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/contact.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "report/damage_summary.hpp"

#include <nlohmann/json.hpp>

#include <utility>

namespace crashrank::detail {

/// Keys of what is stated of both bodies of a contact.
struct SideKeys {
  const char* first;
  const char* second;
};
inline constexpr SideKeys ego_other{"ego", "other"};
inline constexpr SideKeys a_b{"a", "b"};

/// {"ego": of one, "other": of the other}
template <class T> nlohmann::ordered_json both(T first, T second, SideKeys keys = ego_other) {
  return {{keys.first, std::move(first)}, {keys.second, std::move(second)}};
}

/// "contact", "overlapping" and so on.
const char* impact_state_name(ImpactState state);

/// Adds the numbers of damaged triangles, their areas and parts of two bodies to an entry.
void add_damage(nlohmann::ordered_json& entry, const DamageSummary& first,
                const DamageSummary& second, SideKeys keys = ego_other);

/// A contact of the ego.
nlohmann::ordered_json contact_json(const Scenario& scenario, View<const Model> models,
                                    const Contact& contact);
/// A contact between two others: what is stated of the ego's contacts as `ego` and `other` has the
/// keys `a` and `b` here, in the order of `bodies`.
nlohmann::ordered_json contact_json(const Scenario& scenario, View<const Model> models,
                                    const FurtherContact& contact, bool simulated);

}  // namespace crashrank::detail
