#pragma once

#include "crashrank/internal/rank/harm.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "rank/crash_score.hpp"

namespace crashrank::detail {

/// Maxima over all possible crashes of a scene, from which measures derive upper bounds.
struct CrashLimits {
  double people = 0.0;            ///< all people, weighted
  double triangles = 0.0;         ///< number of triangles of all bodies
  double area_m2 = 0.0;           ///< surface of all bodies; 0 unless the measure needs it
  double intrusion_m = 0.0;       ///< largest over all bodies
  double energy_j = 0.0;          ///< kinetic energy of all bodies
  double closing_energy_j = 0.0;  ///< of one contact, J
  double ego_mass_kg = 0.0;
  double contacts = 0.0;  ///< largest number of contacts in one scene
};

/// Definition of one measure; `measure_name` and its neighbours hold the texts for users. A score
/// is a sum of terms: either of the damage of bodies, or of contacts, of the two sides of contacts,
/// and of bodies.
struct MeasureRow {
  Measure measure = Measure::polygons;
  bool has_samples = true;     ///< the score is evaluated in samples of the unknown parameters
  bool counts_people = false;  ///< the term of a body is a risk, which is weighted by its people
  /// Term of the damage of a body from all contacts; null if the measure does not use damage.
  double (*of_damage)(const BodyDamage& whole) = nullptr;
  double (*of_contact)(const ContactEffect& effect) = nullptr;
  double (*of_side)(const SideEffect& side, const HarmWeights& weights) = nullptr;
  /// Term of a body; null if there is none.
  double (*of_body)(const WindowReader& body) = nullptr;
  /// Upper bound on the score.
  double (*upper_bound)(const CrashLimits& limits, const HarmWeights& weights) = nullptr;
};

/// Returns the definition of a measure in constant time.
const MeasureRow& measure_row(Measure measure) noexcept;

/// Returns true if the score is computed from damaged triangles instead of the mechanics of
/// contacts.
inline bool scored_by_damage(Measure measure) noexcept {
  return measure_row(measure).of_damage != nullptr;
}

}  // namespace crashrank::detail
