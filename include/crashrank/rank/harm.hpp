#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/crash/injury.hpp"
#include "crashrank/rank/scenario.hpp"

#include <Eigen/Core>

namespace crashrank {

/// What a person's risk counts for, and how many people are where. Every default is a choice that
/// somebody has to answer for, not a finding: everybody counts alike, one person in each vehicle,
/// and property counts nothing.
struct HarmWeights {
  double ego_occupant = 1.0;
  double other_occupant = 1.0;
  double pedestrian = 1.0;
  double cyclist = 1.0;
  double motorcyclist = 1.0;
  double property_per_mj = 0.0;  ///< for every MJ of deformation

  double people_in_ego = 1.0;
  double people_in_car = 1.0;
  double people_in_truck = 1.0;
  double people_in_bus = 10.0;
};

/// Ranges of what is not known well; the harm's interval is that of its values over them.
struct HarmRanges {
  double least_friction = 0.1;
  double most_friction = 0.6;
  double least_strength = 0.7;  ///< times the default strength of vehicles
  double most_strength = 1.4;
  /// Added to delta-v as a share of it, for a rebound that the pulse leaves out.
  double most_restitution = 0.15;
};

struct HarmOptions {
  RiskModel model = RiskModel::tum;
  HarmWeights weights;
  HarmRanges ranges;
  double friction = 0.3;
  bool intervals = true;  ///< compute the interval too: five pulses a contact in place of one
};

/// What a crash does to one body, as harm sees it.
struct HarmExposure {
  BodyKind kind = BodyKind::car;
  bool ego = false;
  double delta_v_mps = 0.0;
  double pdof_deg = 0.0;
  double closing_speed_mps = 0.0;
  double leading_edge_m = 0.75;  ///< of what hit it
  double crush_energy_j = 0.0;
};

/// Harm to the people in or on one body: their number times the risk times their weight, and the
/// property's share. Unit: persons with the model's outcome, as weighted.
CRASHRANK_API double harm_of(const HarmExposure& exposure, const HarmOptions& options);

/// Who travels in or on a body of that kind; false for those that carry nobody.
CRASHRANK_API bool carries_people(BodyKind kind, Person& person) noexcept;

}  // namespace crashrank
