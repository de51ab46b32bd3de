#pragma once

#include "crashrank/crash/after_contact.hpp"
#include "crashrank/crash/injury.hpp"

#include <cstddef>

namespace crashrank {

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
  /// Times the restitution of the contact law, which is never more than 0.5. The law has 0.2 to
  /// 0.32 in fresh structure; measured are 0.2 to 0.4 at a delta-v of 0.9 to 2.2 m/s, about 0.1 at
  /// medium and high speed (SAE 931842): factors of 0.5 to 1.3.
  double least_restitution = 0.5;
  double most_restitution = 1.5;  ///< times the law's
  /// Times the speed at which the risk curves are read, for the width of the curves themselves; of
  /// occupants and of people outside cars each by itself, since their curves come from different
  /// data.
  double least_risk_speed = 0.9;
  double most_risk_speed = 1.1;  ///< times the speed
  /// The order is looked at under every risk model, not the chosen one alone.
  bool all_models = true;
};

/// How harm is counted.
struct HarmOptions {
  RiskModel model = RiskModel::tum;  ///< whose curves
  HarmWeights weights;               ///< what people count for
  HarmRanges ranges;                 ///< what is not known
  double friction = 0.3;             ///< between the bodies
  /// What the undamaged wheels of all vehicles do that were hit. `brakes`: with 0.45 of the grip,
  /// the ego with more where its manoeuvre did. Bodies without wheels slide.
  AfterContact after_contact = AfterContact::brakes;
  /// Without effect: a contact that transfers no velocity injures nobody, and the fall of a brushed
  /// rider comes from `HarmExposure::road_speed_mps`. Profiles and scenarios may still contain it.
  double least_struck_share = 0.3;
  bool intervals = true;  ///< evaluate the samples: eight simulations a crash in place of one
  /// Age and sex of all pedestrians, for the curves that have coefficients of them; empty: the mean
  /// person of the curve's sample.
  PedestrianDescription pedestrian;
};

/// Bounds on what a profile may ask for; the published schema states the same numbers.
namespace harm_limits {
inline constexpr std::size_t file_bytes = std::size_t{1} << 20;  ///< of a profile
inline constexpr double weight = 1e6;                            ///< most
inline constexpr double people = 1000.0;                         ///< most in a vehicle
inline constexpr double friction = 10.0;                         ///< most
inline constexpr double min_strength = 0.01;                     ///< least factor
inline constexpr double max_strength = 100.0;                    ///< most
inline constexpr double restitution = 10.0;                      ///< most factor
inline constexpr double min_risk_speed = 0.1;                    ///< least factor
inline constexpr double max_risk_speed = 10.0;                   ///< most
inline constexpr double deceleration_mps2 = 50.0;                ///< most, m/s²
inline constexpr double after_s = 60.0;                          ///< longest, s
inline constexpr double age_years = 120.0;                       ///< most
inline constexpr std::size_t contacts = 16;                      ///< most of a candidate
}  // namespace harm_limits

}  // namespace crashrank
