#include "rank/crash_score.hpp"

#include "crash/rebound.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "rank/measure_table.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

Eigen::Vector3d in_space(const Eigen::Vector2d& v) { return {v.x(), v.y(), 0.0}; }

double pdof_of(const ExposureWindow& window) {
  return pdof_deg(in_space(window.change_mps), in_space(window.forward));
}

/// The effect with the restitution multiplied by a factor, without a new simulation. Exact if the
/// impulse of the restitution phase is a fraction of that of the compression phase.
ContactEffect scale_restitution(const ContactEffect& effect, double factor) {
  ContactEffect e = effect;
  if (factor == 1.0) return e;
  const double loss = rebound_loss(effect.restitution, factor);
  e.dissipated_j *= loss;
  for (SideEffect& side : e.sides) side.crush_j *= loss;
  return e;
}

}  // namespace

double max_intrusion_m(const Vehicle& v) {
  const CrushCore& core = v.strength.core;
  const double half = 0.5 * (core.cage_front_m - core.cage_rear_m);
  return std::max(0.0, std::min(half, core.cage_half_width_m));
}

void CrashEffects::clear() {
  contacts.clear();
  bodies.clear();
  cells.clear();
}

void CrashEffects::add(std::size_t body, View<const ExposureCell> more) {
  bodies.push_back({body, cells.size(), more.size()});
  cells.insert(cells.end(), more.begin(), more.end());
}

HarmExposure exposure_of(const Scene& scene, std::size_t index, const ExposureWindow* window) {
  const Body& body = body_of(scene, index);
  HarmExposure e;
  e.kind = body.vehicle->kind;
  e.ego = index == ego_body;
  e.occupants = body.occupants;
  if (window == nullptr) return e;
  e.delta_v_mps = window->exposure_mps;
  e.direction = window->direction;
  e.closing_speed_mps = window->struck_mps;
  e.leading_edge_m = window->edge_m;
  e.intrusion_m = window->intrusion_m;
  e.road_speed_mps = window->road_mps;
  return e;
}

double WindowReader::hazard(const ExposureWindow& window) const {
  HarmExposure e = exposure_of(scene_, body_.body, &window);
  double hazard = hazard_of(e, scene_.harm, sample_);
  if (is_bound_ && !has_cage(e.kind)) {
    // Windows that exceed this one may have another leading edge. Over all edges the risk is least
    // at one of the ends, see injury.cpp.
    for (const double edge_m : {0.0, 10.0}) {
      e.leading_edge_m = edge_m;
      hazard = std::min(hazard, hazard_of(e, scene_.harm, sample_));
    }
  }
  return hazard;
}

double WindowReader::risk() const {
  return -std::expm1(-spaced_sum(windows_, [this](const ExposureWindow& w) { return hazard(w); }));
}

double WindowReader::summed_mps() const {
  return spaced_sum(windows_, [](const ExposureWindow& w) { return w.exposure_mps; });
}

double WindowReader::intrusion_m() const {
  ContactAction sum;
  for (const ExposureCell& cell : effects_.cells_of(body_)) sum.add(cell.action, 1.0);
  return mean_intrusion_m(sum.intruded_m3, sum.deepest_m);
}

/// Lists windows that `list` lists, too, or that one of those exceeds: one at full length for every
/// half of a window from the first force on. Linear in the number of cells.
void CrashScore::list_some(const Scene& scene, const CrashEffects& effects,
                           const CrashEffects::BodyCells& body) {
  constexpr std::int32_t apart = cells_per_window / 2;
  const Body& of = body_of(scene, body.body);
  const View<const ExposureCell> cells = effects.cells_of(body);
  windows_.clear();
  for (std::size_t first = 0; first < cells.size();) {
    const std::int32_t begin = cells[first].index;
    ExposureCell whole = cells[first];
    std::size_t k = first + 1;
    std::size_t next = cells.size();
    for (; k < cells.size(); ++k) {
      const double share = share_in_window(cells[k].index - begin);
      if (!(share > 0.0)) break;
      whole.action.add(cells[k].action, share);
      if (cells[k].index >= begin + apart) next = std::min(next, k);
    }
    windows_.push_back(exposure_window({of.mass_kg, has_cage(of.vehicle->kind), 1.0}, whole,
                                       begin + 1, whole.action));
    windows_.back().begin = begin;
    first = std::min(next, k);
  }
}

void CrashScore::list(const Scene& scene, const CrashEffects& effects,
                      const CrashEffects::BodyCells& body, double restitution) {
  const Body& of = body_of(scene, body.body);
  list_windows(effects.cells_of(body), {of.mass_kg, has_cage(of.vehicle->kind), restitution},
               windows_);
}

void CrashScore::add_scores(const Scene& scene, const CrashEffects& effects,
                            View<const HarmSample> samples, double* scores, bool is_bound) {
  const MeasureRow& row = measure_row(scene.measure);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (const ContactEffect& simulated : effects.contacts) {
      const ContactEffect effect = scale_restitution(simulated, samples[i].restitution);
      for (const SideEffect& side : effect.sides) {
        scores[i] += row.of_side(side, scene.harm.weights);
      }
      scores[i] += row.of_contact(effect);
    }
  }
  if (row.of_body == nullptr) return;
  for (const CrashEffects::BodyCells& body : effects.bodies) {
    if (body.count == 0) continue;
    const double weight = row.counts_people ? people_weight(exposure_of(scene, body.body, nullptr),
                                                            scene.harm.weights)
                                            : 1.0;
    if (weight == 0.0) continue;
    const bool is_inside = has_cage(body_of(scene, body.body).vehicle->kind);
    const auto same_curve = [is_inside](const HarmSample& p, const HarmSample& q) {
      return p.model == q.model && (is_inside ? p.occupant_speed == q.occupant_speed
                                              : p.outside_speed == q.outside_speed);
    };
    // Samples that read the same windows and curve have the same term.
    struct Term {
      const HarmSample* sample = nullptr;
      double value = 0.0;
    };
    std::array<Term, 8> terms;
    std::size_t known = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const HarmSample& sample = samples[i];
      if (is_bound) {
        list_some(scene, effects, body);
      } else if (i == 0 || sample.restitution != samples[i - 1].restitution) {
        list(scene, effects, body, sample.restitution);
        known = 0;
      }
      const auto end = terms.begin() + static_cast<std::ptrdiff_t>(known);
      const auto term = std::find_if(
          terms.begin(), end, [&](const Term& each) { return same_curve(*each.sample, sample); });
      double value = 0.0;
      if (term != end) {
        value = term->value;
      } else {
        value = row.of_body(WindowReader(scene, effects, body, windows_, sample, is_bound));
        if (known < terms.size()) terms[known++] = {&sample, value};
      }
      scores[i] += weight * value;
    }
  }
}

double CrashScore::score(const Scene& scene, const CrashEffects& effects,
                         const HarmSample& sample) {
  double score = 0.0;
  add_scores(scene, effects, {&sample, 1}, &score);
  return score;
}

double CrashScore::lower_bound(const Scene& scene, const CrashEffects& effects) {
  constexpr double rounding = 1.0 - 1e-9;
  double score = 0.0;
  add_scores(scene, effects, {&scene.nominal, 1}, &score, true);
  return rounding * score;
}

std::vector<PersonRisk> CrashScore::people(const Scene& scene, const CrashEffects& effects) {
  HarmWeights unit_weights = scene.harm.weights;
  unit_weights.ego_occupant = unit_weights.other_occupant = 1.0;
  unit_weights.pedestrian = unit_weights.cyclist = unit_weights.motorcyclist = 1.0;
  std::vector<PersonRisk> people;
  for (const CrashEffects::BodyCells& body : effects.bodies) {
    PersonRisk person;
    person.body = body.body;
    person.persons = people_weight(exposure_of(scene, body.body, nullptr), unit_weights);
    if (body.count > 0) {
      list(scene, effects, body, 1.0);
      const auto most = std::max_element(windows_.begin(), windows_.end(),
                                         [](const ExposureWindow& p, const ExposureWindow& q) {
                                           return p.exposure_mps < q.exposure_mps;
                                         });
      person.exposure_mps = most->exposure_mps;
      person.exposure_pdof_deg = pdof_of(*most);
      person.exposure_time_s = effects.begin_s + most->end * exposure_cell_s;
      if (measure_row(scene.measure).counts_people) {
        person.probability =
            WindowReader(scene, effects, body, windows_, scene.nominal, false).risk();
      }
    }
    people.push_back(person);
  }
  return people;
}

}  // namespace crashrank::detail
