#include "rank/measure_table.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace crashrank::detail {
namespace {

double no_contact(const ContactEffect& /*effect*/) { return 0.0; }
double no_side(const SideEffect& /*side*/, const HarmWeights& /*weights*/) { return 0.0; }

constexpr MeasureRow polygons{
    Measure::polygons,
    false,
    false,
    [](const BodyDamage& whole) { return static_cast<double>(whole.triangles.size()); },
    no_contact,
    no_side,
    nullptr,
    [](const CrashLimits& u, const HarmWeights&) { return u.triangles; }};

constexpr MeasureRow area{
    Measure::area, false,
    false,         [](const BodyDamage& whole) { return whole.area_m2; },
    no_contact,    no_side,
    nullptr,       [](const CrashLimits& u, const HarmWeights&) { return u.area_m2; }};

constexpr MeasureRow closing_energy{
    Measure::closing_energy,
    false,
    false,
    nullptr,
    [](const ContactEffect& effect) { return effect.closing_energy_j; },
    no_side,
    nullptr,
    [](const CrashLimits& u, const HarmWeights&) { return u.contacts * u.closing_energy_j; }};

constexpr MeasureRow delta_v{
    Measure::delta_v, true, false, nullptr, no_contact, no_side,
    [](const WindowReader& body) { return body.is_ego() ? body.summed_mps() : 0.0; },
    // The speed of the ego is at most that of a body with all the energy;
    // reversing it doubles the delta-v.
    [](const CrashLimits& u, const HarmWeights&) {
      return u.contacts * 2.0 * std::sqrt(2.0 * u.energy_j / u.ego_mass_kg);
    }};

constexpr MeasureRow energy{Measure::energy,
                            true,
                            false,
                            nullptr,
                            [](const ContactEffect& effect) { return effect.dissipated_j; },
                            no_side,
                            nullptr,
                            [](const CrashLimits& u, const HarmWeights&) { return u.energy_j; }};

constexpr MeasureRow intrusion{
    Measure::intrusion,
    false,
    false,
    nullptr,
    no_contact,
    no_side,
    [](const WindowReader& body) { return body.intrusion_m(); },
    [](const CrashLimits& u, const HarmWeights&) { return u.contacts * 2.0 * u.intrusion_m; }};

constexpr MeasureRow harm{Measure::harm,
                          true,
                          true,
                          nullptr,
                          no_contact,
                          [](const SideEffect& side, const HarmWeights& weights) {
                            HarmExposure crushed;
                            crushed.crush_energy_j = side.crush_j;
                            return property_harm(crushed, weights);
                          },
                          [](const WindowReader& body) { return body.risk(); },
                          [](const CrashLimits& u, const HarmWeights& weights) {
                            return u.people + weights.property_per_mj * 1e-6 * u.energy_j;
                          }};

constexpr std::array<MeasureRow, 7> rows{polygons,  area, closing_energy, delta_v, energy,
                                         intrusion, harm};

constexpr bool rows_match_enumerators() {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (static_cast<std::size_t>(rows[i].measure) != i) return false;
  }
  return true;
}
static_assert(rows_match_enumerators(), "rows must be in the order of the enumerators");

}  // namespace

const MeasureRow& measure_row(Measure measure) noexcept {
  return rows[static_cast<std::size_t>(measure)];
}

}  // namespace crashrank::detail
