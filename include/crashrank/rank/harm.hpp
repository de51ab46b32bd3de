#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/crash/injury.hpp"
#include "crashrank/vehicle/body_kind.hpp"

#include <cstddef>
#include <vector>

namespace crashrank {

// What a candidate's harm is, as a function of its contacts; all that a bound on it may rest on.
//
//   harm(candidate) = sum over its contacts of harm_of(ego's exposure) + harm_of(other's exposure)
//
// Every term is >= 0, contacts come in time order, and what a contact contributes depends on itself
// and on those before it alone: the sum over the first few is a lower bound on the whole. After the
// first contact there are at most `AfterImpact::most_contacts` - 1 more, and no body is met twice.
//
// harm_of = property_per_mj · crush energy in MJ + people · weight · risk(exposure), risk in [0,
// 1]. It never falls when delta-v (occupants), closing speed (people outside cars) or crush energy
// rise. It depends on the PDOF by its side alone (front, side, rear; `most_harm` takes the worst)
// and on the striker's leading edge in the models that know it, in which it need not be monotonic.
// So the term of somebody outside a car is bounded on both sides at first contact, without
// simulating the crash: see `struck_speed_mps`; that of occupants needs the pulse.
//
// Bounds on what enters, for two bodies of masses m1, m2 that meet with the relative velocity v of
// their centres of mass and the yaw rates w1, w2 (inertias I1, I2), since the pulse conserves
// momentum and never gains energy, with M = m1·m2/(m1 + m2), or the movable body's mass:
//   delta_v of body i  <=  M/m_i · (|v| + sqrt(v² + (I1·w1² + I2·w2²)/M))
//   both crush energies together  <=  (M·v² + I1·w1² + I2·w2²)/2
// The sample's restitution multiplies delta-v by 1 + e.

/// What a person's risk counts for, and how many people are where. Every default is a choice that
/// somebody has to answer for, not a finding: everybody counts alike, one person in each vehicle,
/// and property counts nothing. All >= 0 and at most `harm_limits::weight`.
struct HarmWeights {
  double ego_occupant = 1.0;     ///< a person in the ego
  double other_occupant = 1.0;   ///< a person in another vehicle
  double pedestrian = 1.0;       ///< somebody on foot
  double cyclist = 1.0;          ///< somebody on a bicycle
  double motorcyclist = 1.0;     ///< somebody on a motorcycle
  double property_per_mj = 0.0;  ///< for every MJ of deformation

  double people_in_ego = 1.0;    ///< persons
  double people_in_car = 1.0;    ///< persons, in each
  double people_in_truck = 1.0;  ///< persons, in each
  double people_in_bus = 10.0;   ///< persons, in each
};

/// Ranges of what is not known well. Their corners together are the samples by which a ranking says
/// how stable it is.
struct HarmRanges {
  double least_friction = 0.1;  ///< between the bodies
  double most_friction = 0.6;   ///< between the bodies
  double least_strength = 0.7;  ///< stiffness, times the default strength of all bodies
  double most_strength = 1.4;   ///< times the default
  /// Restitution: delta-v times 1 + e, for a rebound that the pulse leaves out.
  double least_restitution = 0.0;
  double most_restitution = 0.15;  ///< share of delta-v
  /// Times the speed at which the risk curves are read, for the width of the curves themselves; of
  /// occupants and of people outside cars each by itself, since their curves come from different
  /// data.
  double least_risk_speed = 0.9;
  double most_risk_speed = 1.1;  ///< times the speed
  /// The order is looked at under every risk model, not the chosen one alone.
  bool all_models = true;
};

/// How a vehicle goes on after a contact: it leaves with the velocity and the yaw rate that the
/// crash gave it and is slowed evenly, whoever drives. What it meets then is a further contact.
struct AfterImpact {
  /// Between a free roll (0.1 g) and locked wheels (0.7 g): a choice.
  double deceleration_mps2 = 3.5;
  double longest_s = 3.0;         ///< nothing later counts as the same crash
  std::size_t most_contacts = 4;  ///< of one candidate, the first included; 1 follows nobody
};

/// How harm is counted.
struct HarmOptions {
  RiskModel model = RiskModel::tum;  ///< whose curves
  HarmWeights weights;               ///< what people count for
  HarmRanges ranges;                 ///< what is not known
  double friction = 0.3;             ///< between the bodies
  AfterImpact after;                 ///< how the ego goes on
  /// Somebody outside a car who is brushed takes at least this share of the closing speed, whatever
  /// the pulse says that the touch gave him: falls and wheels are not simulated. A choice.
  double least_struck_share = 0.3;
  bool intervals = true;  ///< evaluate the samples, too: five pulses a contact in place of one
};

/// Bounds on what a profile may ask for; the published schema states the same numbers.
namespace harm_limits {
inline constexpr std::size_t file_bytes = std::size_t{1} << 20;  ///< of a profile
inline constexpr double weight = 1e6;                            ///< most
inline constexpr double people = 1000.0;                         ///< most in a vehicle
inline constexpr double friction = 10.0;                         ///< most
inline constexpr double min_strength = 0.01;                     ///< least factor
inline constexpr double max_strength = 100.0;                    ///< most
inline constexpr double min_risk_speed = 0.1;                    ///< least factor
inline constexpr double max_risk_speed = 10.0;                   ///< most
inline constexpr double deceleration_mps2 = 50.0;                ///< most, m/s²
inline constexpr double after_s = 60.0;                          ///< longest, s
inline constexpr std::size_t contacts = 16;                      ///< most of a candidate
}  // namespace harm_limits

/// What a crash does to one body, as harm sees it.
struct HarmExposure {
  BodyKind kind = BodyKind::car;   ///< what is hit
  bool ego = false;                ///< it is the ego
  double delta_v_mps = 0.0;        ///< change of its velocity, m/s
  double pdof_deg = 0.0;           ///< where the force comes from, degrees clockwise from ahead
  double closing_speed_mps = 0.0;  ///< as `struck_speed_mps` has it, for people outside cars
  double leading_edge_m = 0.75;    ///< of what hit it
  double crush_energy_j = 0.0;     ///< turned into its damage, J
};

/// Harm to the people in or on one body: their number times the risk times their weight, and the
/// property's share. Unit: persons with the model's outcome, as weighted.
CRASHRANK_API double harm_of(const HarmExposure& exposure, const HarmOptions& options);

/// The most that `harm_of` comes to for any PDOF and any leading edge, when nothing else of the
/// exposure is larger.
CRASHRANK_API double most_harm(const HarmExposure& exposure, const HarmOptions& options);

/// One way in which all that is not known may lie. The same sample holds for every candidate and
/// every contact: what is wrong in the same way for all of them does not disturb their order.
struct HarmSample {
  double friction = 0.3;             ///< between the bodies
  double strength = 1.0;             ///< times the default
  double restitution = 0.0;          ///< share of delta-v
  RiskModel model = RiskModel::tum;  ///< whose curves
  double occupant_speed = 1.0;       ///< times the speed at which an occupant's curve is read
  double outside_speed = 1.0;        ///< and that of people outside cars
};

/// The samples of a set of options: first what is taken when nothing varies, then every corner of
/// the ranges (2 frictions, 2 strengths, 2 restitutions, 4 models, 2 × 2 speeds: 128; ends that
/// coincide count once). Always the same order.
CRASHRANK_API std::vector<HarmSample> harm_samples(const HarmOptions& options);

/// `harm_of` in one of the samples; `exposure` is that of the sample's friction and strength,
/// without rebound. With the first sample it is `harm_of`.
CRASHRANK_API double harm_of(const HarmExposure& exposure, const HarmOptions& options,
                             const HarmSample& sample);

/// The speed at which the curve of somebody outside a car is read. Curves come from people struck
/// by a front, who take on the vehicle's speed: delta-v = closing speed · M/m. Who is brushed by a
/// flank takes on less, and stands where a full hit of the same delta-v would. Between
/// `least_struck_share` times the closing speed and all of it. `reduced_kg` is m1·m2/(m1 + m2).
CRASHRANK_API double struck_speed_mps(double closing_speed_mps, double delta_v_mps, double mass_kg,
                                      double reduced_kg, const HarmOptions& options);

/// Who travels in or on a body of that kind; false for those that carry nobody.
CRASHRANK_API bool carries_people(BodyKind kind, Person& person) noexcept;

/// Whether bodies of that kind have a passengers' cage that crush can reach into.
CRASHRANK_API bool has_cage(BodyKind kind) noexcept;

}  // namespace crashrank
