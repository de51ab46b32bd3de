#include "crashrank/rank/harm.hpp"

#include <algorithm>
#include <array>

namespace crashrank {
namespace {

double people_in(const HarmExposure& e, const HarmWeights& w) {
  if (e.ego) return w.people_in_ego;
  if (e.kind == BodyKind::bus) return w.people_in_bus;
  if (e.kind == BodyKind::truck) return w.people_in_truck;
  return e.kind == BodyKind::car ? w.people_in_car : 1.0;
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

/// Both ends of a range, one of them where they coincide.
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

double struck_speed_mps(double closing_speed_mps, double delta_v_mps, double mass_kg,
                        double reduced_kg, const HarmOptions& options) {
  const double full_hit_mps = reduced_kg > 0.0 ? delta_v_mps * mass_kg / reduced_kg : 0.0;
  return std::clamp(full_hit_mps, options.least_struck_share * closing_speed_mps,
                    closing_speed_mps);
}

double harm_of(const HarmExposure& exposure, const HarmOptions& options, const HarmSample& sample) {
  const double property = options.weights.property_per_mj * exposure.crush_energy_j * 1e-6;
  Person person = Person::occupant;
  if (!carries_people(exposure.kind, person)) return property;
  Exposure e;
  e.person = person;
  e.delta_v_mps = exposure.delta_v_mps * (1.0 + sample.restitution) * sample.occupant_speed;
  e.pdof_deg = exposure.pdof_deg;
  e.impact_speed_mps = exposure.closing_speed_mps * sample.outside_speed;
  e.leading_edge_m = exposure.leading_edge_m;
  return property + people_in(exposure, options.weights) *
                        weight_of(person, exposure.ego, options.weights) *
                        injury_risk(sample.model, e);
}

double harm_of(const HarmExposure& exposure, const HarmOptions& options) {
  HarmSample sample;
  sample.model = options.model;
  return harm_of(exposure, options, sample);
}

double most_harm(const HarmExposure& exposure, const HarmOptions& options) {
  // One direction of each side; the risk is monotonic in the edge between the ends at which
  // `injury_risk` holds it, one way or the other.
  constexpr std::array<double, 3> sides_deg{0.0, 90.0, 180.0};
  constexpr std::array<double, 2> edges_m{0.0, 10.0};
  double most = 0.0;
  HarmExposure worst = exposure;
  for (const double side : sides_deg) {
    for (const double edge : edges_m) {
      worst.pdof_deg = side;
      worst.leading_edge_m = edge;
      most = std::max(most, harm_of(worst, options));
    }
  }
  return most;
}

std::vector<HarmSample> harm_samples(const HarmOptions& options) {
  const HarmRanges& r = options.ranges;
  std::vector<RiskModel> models{options.model};
  for (const RiskModel model : all_models) {
    if (r.all_models && model != options.model) models.push_back(model);
  }
  const std::vector<double> speeds = ends(r.least_risk_speed, r.most_risk_speed);
  std::vector<HarmSample> samples(1);
  samples.front().friction = options.friction;
  samples.front().model = options.model;
  for (const double friction : ends(r.least_friction, r.most_friction)) {
    for (const double strength : ends(r.least_strength, r.most_strength)) {
      for (const double restitution : ends(r.least_restitution, r.most_restitution)) {
        for (const RiskModel model : models) {
          for (const double occupant : speeds) {
            for (const double outside : speeds) {
              samples.push_back({friction, strength, restitution, model, occupant, outside});
            }
          }
        }
      }
    }
  }
  return samples;
}

}  // namespace crashrank
