#include "crashrank/rank/harm.hpp"

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

double harm_of(const HarmExposure& exposure, const HarmOptions& options) {
  const double property = options.weights.property_per_mj * exposure.crush_energy_j * 1e-6;
  Person person = Person::occupant;
  if (!carries_people(exposure.kind, person)) return property;
  Exposure e;
  e.person = person;
  e.delta_v_mps = exposure.delta_v_mps;
  e.pdof_deg = exposure.pdof_deg;
  e.impact_speed_mps = exposure.closing_speed_mps;
  e.leading_edge_m = exposure.leading_edge_m;
  return property + people_in(exposure, options.weights) *
                        weight_of(person, exposure.ego, options.weights) *
                        injury_risk(options.model, e);
}

}  // namespace crashrank
