#include "crashrank/internal/rank/harm.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace crashrank {
namespace {

double people_in(const HarmExposure& e, const HarmWeights& w) {
  if (e.occupants) return *e.occupants;
  if (e.ego) return w.people_in_ego;
  if (e.kind == BodyKind::bus) return w.people_in_bus;
  if (e.kind == BodyKind::truck) return w.people_in_truck;
  return e.kind == BodyKind::car ? w.people_in_car : 1.0;
}

/// A share that rises smoothly from 0 to 1 around a value.
double share_above(double x, double value) {
  const double square = (x / value) * (x / value);
  return x > 0.0 ? -std::expm1(-square * square) : 0.0;
}

double weight_of(Person person, bool ego, const HarmWeights& w) {
  switch (person) {
    case Person::pedestrian:
      return w.pedestrian;
    case Person::cyclist:
      return w.cyclist;
    case Person::motorcyclist:
      return w.motorcyclist;
    case Person::occupant:
      break;
  }
  return ego ? w.ego_occupant : w.other_occupant;
}

/// Inputs of the injury risk curve for one person in or on a body, with the factors of the sample
/// applied.
Exposure person_exposure(const HarmExposure& body, Person person, const HarmOptions& options,
                         const HarmSample& sample) {
  double fall_mps = 0.0;
  if (person == Person::pedestrian) fall_mps = standing_fall_mps(body.delta_v_mps);
  if (person == Person::cyclist || person == Person::motorcyclist) {
    fall_mps = fall_speed_mps(body.road_speed_mps, body.delta_v_mps);
  }
  Exposure e;
  e.person = person;
  e.delta_v_mps = body.delta_v_mps * sample.occupant_speed;
  e.direction = body.direction;
  e.impact_speed_mps =
      std::max(hurting_speed_mps(body.closing_speed_mps), fall_mps) * sample.outside_speed;
  e.leading_edge_m = body.leading_edge_m;
  e.intrusion_m = body.intrusion_m;
  e.description = options.pedestrian;
  return e;
}

/// Both ends of a range, or one value if they are equal.
std::vector<double> ends(double least, double most) {
  if (least == most) return {least};
  return {least, most};
}

constexpr std::array<RiskModel, 4> all_models{RiskModel::tum, RiskModel::malliaris_monfort,
                                              RiskModel::malliaris_rosen,
                                              RiskModel::joksch_monfort};

}  // namespace

bool carries_people(BodyKind kind, Person& person) noexcept {
  switch (kind) {
    case BodyKind::car:
    case BodyKind::truck:
    case BodyKind::bus:
      person = Person::occupant;
      return true;
    case BodyKind::motorcycle:
      person = Person::motorcyclist;
      return true;
    case BodyKind::bicycle:
      person = Person::cyclist;
      return true;
    case BodyKind::pedestrian:
      person = Person::pedestrian;
      return true;
    case BodyKind::barrier:
    case BodyKind::pole:
    case BodyKind::building:
      break;
  }
  return false;
}

bool has_cage(BodyKind kind) noexcept {
  return kind == BodyKind::car || kind == BodyKind::truck || kind == BodyKind::bus;
}

double fall_speed_mps(double road_speed_mps, double exposure_mps) noexcept {
  return fall_share * std::max(road_speed_mps, 0.0) * share_above(exposure_mps, fall_exposure_mps);
}

double standing_fall_mps(double exposure_mps) noexcept {
  // Speed after a fall from 0.9 m, the height of the centre of mass: sqrt(2·9.81·0.9).
  constexpr double ground_mps = 4.2;
  return ground_mps * share_above(exposure_mps, topple_exposure_mps);
}

double hurting_speed_mps(double speed_mps) noexcept {
  const double share = std::max(speed_mps, 0.0) / walking_mps;
  return -speed_mps * std::expm1(-share * share);
}

double hazard_of(const HarmExposure& exposure, const HarmOptions& options,
                 const HarmSample& sample) {
  Person person = Person::occupant;
  if (!carries_people(exposure.kind, person)) return 0.0;
  return injury_hazard(sample.model, person_exposure(exposure, person, options, sample));
}

double risk_of(const HarmExposure& exposure, const HarmOptions& options, const HarmSample& sample) {
  Person person = Person::occupant;
  if (!carries_people(exposure.kind, person)) return 0.0;
  return injury_risk(sample.model, person_exposure(exposure, person, options, sample));
}

double people_weight(const HarmExposure& exposure, const HarmWeights& weights) {
  Person person = Person::occupant;
  if (!carries_people(exposure.kind, person)) return 0.0;
  return people_in(exposure, weights) * weight_of(person, exposure.ego, weights);
}

double property_harm(const HarmExposure& exposure, const HarmWeights& weights) {
  return weights.property_per_mj * exposure.crush_energy_j * 1e-6;
}

double harm_of(const HarmExposure& exposure, const HarmOptions& options, const HarmSample& sample) {
  return people_weight(exposure, options.weights) * risk_of(exposure, options, sample) +
         property_harm(exposure, options.weights);
}

double harm_of(const HarmExposure& exposure, const HarmOptions& options) {
  HarmSample sample;
  sample.model = options.model;
  return harm_of(exposure, options, sample);
}

double most_harm(const HarmExposure& exposure, const HarmOptions& options) {
  const double property = property_harm(exposure, options.weights);
  Person person = Person::occupant;
  if (!carries_people(exposure.kind, person)) return property;
  const Exposure worst = person_exposure(exposure, person, options, HarmSample{});
  return people_weight(exposure, options.weights) * most_injury_risk(options.model, worst) +
         property;
}

std::vector<HarmSample> harm_samples(const HarmOptions& options) {
  const HarmRanges& r = options.ranges;
  std::vector<RiskModel> models{options.model};
  for (const RiskModel model : all_models) {
    if (r.all_models && model != options.model) models.push_back(model);
  }
  const std::vector<double> speeds = ends(r.least_risk_speed, r.most_risk_speed);
  HarmSample nominal;
  nominal.friction = options.friction;
  nominal.step = options.step;
  nominal.model = options.model;
  std::vector<HarmSample> samples{nominal};
  for (const double friction : ends(r.least_friction, r.most_friction)) {
    for (const double strength : ends(r.least_strength, r.most_strength)) {
      for (const double restitution : ends(r.least_restitution, r.most_restitution)) {
        const bool moves_alike = friction == options.friction && strength == 1.0;
        for (const RiskModel model : models) {
          for (const double occupant : speeds) {
            for (const double outside : speeds) {
              samples.push_back({friction, strength, restitution, model, occupant, outside,
                                 (moves_alike ? 1.0 : sample_step) * options.step, 0.0, false});
            }
          }
        }
      }
    }
  }
  HarmSample numerical = nominal;
  numerical.numerical = true;
  numerical.step = sample_step * options.step;
  constexpr double aside_m = 0.001;
  for (const double shift_m : {0.0, aside_m, -aside_m}) {
    numerical.shift_m = shift_m;
    samples.push_back(numerical);
  }
  return samples;
}

}  // namespace crashrank
