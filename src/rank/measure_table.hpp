#pragma once

#include "crashrank/internal/rank/harm.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "rank/tally.hpp"

namespace crashrank::detail {

/// The most that any crash of a scene can come to.
struct CrashLimits {
  double people = 0.0;            ///< all, as weighted
  double triangles = 0.0;         ///< of all bodies
  double area_m2 = 0.0;           ///< of these; 0 where the measure does not ask for it
  double intrusion_m = 0.0;       ///< of the body with the deepest compartment
  double energy_j = 0.0;          ///< kinetic, of all bodies
  double closing_energy_j = 0.0;  ///< of one contact
  double ego_mass_kg = 0.0;
  double contacts = 0.0;  ///< of one scene
};

/// How one measure is computed; `measure_name` and its neighbours have what users read of it. A
/// score is the sum over its terms: those of bodies' damage alone, or those of contacts, of their
/// sides and of bodies.
struct MeasureRow {
  Measure measure = Measure::polygons;
  bool has_samples = true;     ///< what is not known is varied
  bool counts_people = false;  ///< a body's term is a risk, to be weighted by its people
  /// Of a body's damage from all contacts; null where damage does not count.
  double (*of_damage)(const BodyDamage& whole) = nullptr;
  double (*of_contact)(const ContactEffect& effect) = nullptr;
  double (*of_side)(const SideEffect& side, const HarmWeights& weights) = nullptr;
  /// A body's term with its last event, from the term of the events before.
  double (*of_body)(double before, const BodyEvent& last, bool is_ego) = nullptr;
  /// No score is higher.
  double (*upper_bound)(const CrashLimits& limits, const HarmWeights& weights) = nullptr;
};

/// The row of a measure; constant time.
const MeasureRow& measure_row(Measure measure) noexcept;

/// Whether a measure is read from the damaged triangles, not from what contacts do.
inline bool scored_by_damage(Measure measure) noexcept {
  return measure_row(measure).of_damage != nullptr;
}

}  // namespace crashrank::detail
