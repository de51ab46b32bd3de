#pragma once

#include "crashrank/crash/injury.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace crashrank {

// Harm of a candidate as a function of its contacts, and its properties that bounds rely on.
//
// One body in one contact:
//
//   harm_of = people_weight · risk_of + property_harm
//
// people_weight is the number of people in or on the body times their weight, risk_of the
// probability of one of them in [0, 1], property_harm a weight times the crush energy. All terms
// are at least 0. The people on one body are injured with the probability 1 - exp(-H), where H sums
// `hazard_of` over separate impacts (`SpacedSum` in src/crash/exposure.hpp): each further impact
// raises it or leaves it, so the first few contacts give a lower bound.
//
// risk_of is continuous, 0 at zero exposure, and never falls when delta-v (occupants and riders),
// intrusion (occupants), struck speed (people outside cars) or road speed (riders) rise. It depends
// on the PDOF by a coefficient between those of front, side and rear, and on the striker's leading
// edge in the models that have it, in which it need not be monotonic; `most_harm` takes the worst
// of both. The struck speed is the closing speed at which the full hit of a car gives the exposure
// (ExposureWindow::struck_mps); the curves are read at `hurting_speed_mps` of it, or at the speed
// of a fall if that is larger.
//
// Bounds on the inputs, for two bodies of masses m1, m2 with the relative velocity v of their
// centres of mass and the yaw rates w1, w2 (inertias I1, I2), since a contact conserves momentum
// and never gains energy, with M = m1·m2/(m1 + m2), or the movable body's mass:
//   delta_v of body i  <=  M/m_i · (|v| + sqrt(v² + (I1·w1² + I2·w2²)/M))
//   both crush energies together  <=  (M·v² + I1·w1² + I2·w2²)/2
// A sample's factor on the restitution multiplies the part of delta-v by the rebound.

/// Inputs of the harm model for one body in one contact.
struct HarmExposure {
  BodyKind kind = BodyKind::car;   ///< of this body
  bool ego = false;                ///< it is the ego
  double delta_v_mps = 0.0;        ///< its exposure, m/s
  ForceDirection direction;        ///< of its force
  double closing_speed_mps = 0.0;  ///< for people outside cars, m/s; see ExposureWindow::struck_mps
  double leading_edge_m = 0.75;    ///< of the other body, m
  double crush_energy_j = 0.0;     ///< turned into its damage, J
  /// Deepest intrusion into its passenger compartment, m, >= 0; kinds without one have no effect.
  double intrusion_m = 0.0;
  /// Speed over ground before the contact of a motorcycle or bicycle, m/s, >= 0; see
  /// `fall_speed_mps`. No effect on other kinds.
  double road_speed_mps = 0.0;
  /// Number of people in or on it, in place of `HarmWeights::people_in_ego` and the others; 0 to
  /// `harm_limits::people`. 0: a parked vehicle, whose only harm is the property's.
  std::optional<double> occupants;
};

/// Fraction of the road speed that is used as impact speed of a fallen rider, who slides instead of
/// striking an obstacle. A design choice.
inline constexpr double fall_share = 0.3;

/// Exposure of a two-wheeler around which its rider begins to fall, m/s: 1 % fall at a third of it,
/// 63 % at it. A design choice.
inline constexpr double fall_exposure_mps = 1.5;

/// Impact speed equivalent to the fall of a rider, m/s: `fall_share` times the road speed, times
/// 1 - exp(-(E/fall_exposure_mps)^4). Negative values count as 0.
CRASHRANK_API double fall_speed_mps(double road_speed_mps, double exposure_mps) noexcept;

/// Exposure of a person on foot around which the person falls, m/s. A design choice: a nudge at
/// walking pace, 1.5 m/s, makes 4 % fall.
inline constexpr double topple_exposure_mps = 3.3;

/// Impact speed equivalent to the fall of a person on foot, m/s: 4.2, the speed at which a centre
/// of mass 0.9 m high reaches the ground, times 1 - exp(-(E/topple_exposure_mps)^4). Negative
/// values count as 0.
CRASHRANK_API double standing_fall_mps(double exposure_mps) noexcept;

/// Speed around which impacts begin to injure people outside cars seriously, m/s: nobody is
/// seriously hurt by walking into a parked car, which a logistic curve fitted to collisions at 20
/// to 80 km/h does not know. A design choice.
inline constexpr double walking_mps = 3.6;

/// Impact speed at which the curves of people outside cars are read, m/s: the speed times
/// 1 - exp(-(v/walking_mps)²), which leaves 99.3 % of 29 km/h and 16 % of 1.5 m/s.
CRASHRANK_API double hurting_speed_mps(double speed_mps) noexcept;

/// Harm to the people in or on one body in one contact: their number times the risk times their
/// weight, and the property's share. Unit: persons with the model's outcome, as weighted.
CRASHRANK_API double harm_of(const HarmExposure& exposure, const HarmOptions& options);

/// Upper bound on `harm_of` over all PDOF, all leading edges and all exposures whose members do not
/// exceed those of this one, for the same number of people. The directions front, side and rear
/// have the extreme risks, see injury.hpp.
CRASHRANK_API double most_harm(const HarmExposure& exposure, const HarmOptions& options);

/// The samples of a set of options, always in the same order: first the nominal one, then every
/// corner of the ranges (2 frictions, 2 strengths, 2 restitutions, 4 models, 2 × 2 speeds: 128;
/// equal ends count once), then three `is_numerical` ones with nominal parameters: the ego
/// where it is, 1 mm to the left and 1 mm to the right. All but the nominal one have `sample_step`.
CRASHRANK_API std::vector<HarmSample> harm_samples(const HarmOptions& options);

/// `harm_of` in one of the samples; `exposure` is that of the contact simulated in the sample. With
/// the first sample it is `harm_of`.
CRASHRANK_API double harm_of(const HarmExposure& exposure, const HarmOptions& options,
                             const HarmSample& sample);

/// Probability of the sample's model's outcome for one person in or on the body in this contact
/// alone, in [0, 1], without weights or numbers of people; 0 for kinds without people.
CRASHRANK_API double risk_of(const HarmExposure& exposure, const HarmOptions& options,
                             const HarmSample& sample);
/// -ln(1 - p) of that, see `injury_hazard`.
CRASHRANK_API double hazard_of(const HarmExposure& exposure, const HarmOptions& options,
                               const HarmSample& sample);

/// Number of people in or on the body times the weight of one of them; 0 for kinds without people.
/// `HarmExposure::occupants` replaces the number of `weights`.
CRASHRANK_API double people_weight(const HarmExposure& exposure, const HarmWeights& weights);

/// Harm of the damage to the body itself, in the unit of `harm_of`.
CRASHRANK_API double property_harm(const HarmExposure& exposure, const HarmWeights& weights);

/// Kind of the people in or on a body of that kind; false if it has none.
CRASHRANK_API bool carries_people(BodyKind kind, Person& person) noexcept;

/// Returns true if bodies of that kind have a passenger cage that crush can reach into.
CRASHRANK_API bool has_cage(BodyKind kind) noexcept;

}  // namespace crashrank
