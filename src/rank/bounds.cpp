#include "rank/bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace crashrank::detail {
namespace {

using Eigen::Vector3d;

/// Sums and roots round; bounds are widened by far more than that.
constexpr double slack = 1.0 + 1e-9;

double surface_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    const Vector3d a = t.corner[0].cast<double>();
    area += 0.5 * (t.corner[1].cast<double>() - a).cross(t.corner[2].cast<double>() - a).norm();
  }
  return area;
}

/// Speed that no point of the body exceeds until the horizon.
double top_speed(const Scene& scene, const Body& body, const Motion& motion) {
  const MotionBound bound = motion.bound(0.0, scene.slice_s.back());
  return slack * (bound.speed_mps + bound.angular_radps * body.radius_m);
}

double most_energy(const Scene& scene, const Body& body, const Motion& motion) {
  if (!std::isfinite(body.mass_kg)) return 0.0;
  const double speed = top_speed(scene, body, motion);
  const double spin = motion.bound(0.0, scene.slice_s.back()).angular_radps;
  return slack * 0.5 * (body.mass_kg * speed * speed + body.mass.inertia_kgm2(2, 2) * spin * spin);
}

/// Risk is 1 at most, and at such a speed it is.
constexpr double surely_mps = 1e3;

/// Harm to those on one body, property apart, whatever hits it.
double surely(const Scene& scene, const Body& body, bool ego) {
  HarmExposure worst;
  worst.kind = body.kind;
  worst.ego = ego;
  worst.delta_v_mps = surely_mps;
  worst.closing_speed_mps = surely_mps;
  return most_harm(worst, scene.harm);
}

double property(const Scene& scene, double energy_j) {
  return scene.harm.weights.property_per_mj * energy_j * 1e-6;
}

/// The least that `harm_of` comes to for any PDOF.
double least_harm(const HarmExposure& exposure, const HarmOptions& options) {
  constexpr std::array<double, 3> sides_deg{0.0, 90.0, 180.0};
  HarmExposure mildest = exposure;
  double least = std::numeric_limits<double>::infinity();
  for (const double side : sides_deg) {
    mildest.pdof_deg = side;
    least = std::min(least, harm_of(mildest, options));
  }
  return least;
}

/// What one delta-v or a larger, up to another, does to the people on both bodies.
struct DeltaV {
  double least = 0.0;
  double most = 0.0;
};

TermBounds harm_bounds(const Scene& scene, const Contact& contact, const DeltaV& ego,
                       const DeltaV& other) {
  const Body& actor = scene.actors[contact.actor];
  TermBounds bounds;
  BodyOutcome outcome;
  outcome.delta_v_mps = ego.least;
  bounds.least +=
      least_harm(exposure_of(scene, scene.ego, actor, true, contact, outcome), scene.harm);
  outcome.delta_v_mps = ego.most;
  bounds.most +=
      most_harm(exposure_of(scene, scene.ego, actor, true, contact, outcome), scene.harm);
  outcome.delta_v_mps = other.least;
  bounds.least +=
      least_harm(exposure_of(scene, actor, scene.ego, false, contact, outcome), scene.harm);
  outcome.delta_v_mps = other.most;
  bounds.most +=
      most_harm(exposure_of(scene, actor, scene.ego, false, contact, outcome), scene.harm);
  return {bounds.least / slack, bounds.most * slack};
}

double reduced_kg(const RigidBody& a, const RigidBody& b) {
  const double inverse =
      (a.movable() ? 1.0 / a.mass_kg : 0.0) + (b.movable() ? 1.0 / b.mass_kg : 0.0);
  return inverse > 0.0 ? 1.0 / inverse : 0.0;
}

double turning_j(const RigidBody& body) {
  if (!body.movable()) return 0.0;
  const double spin = body.velocity.angular_radps.z();
  return body.inertia_kgm2(2, 2) * spin * spin;
}

/// Of the measure, from what both delta-v and the dissipated energy lie between.
TermBounds bounds_of(const Scene& scene, const CrashSetup& crash, const Contact& contact,
                     double least_ns, double most_ns, double least_j, double most_j) {
  const auto delta_v = [&](const RigidBody& body) -> DeltaV {
    if (!body.movable()) return {};
    return {std::max(0.0, least_ns / body.mass_kg / slack), slack * most_ns / body.mass_kg};
  };
  const DeltaV ego = delta_v(crash.a.rigid);
  const DeltaV other = delta_v(crash.b.rigid);
  switch (scene.measure) {
    case Measure::delta_v:
      return {ego.least, ego.most};
    case Measure::energy:
      return {least_j / slack, slack * most_j};
    case Measure::harm: {
      TermBounds bounds = harm_bounds(scene, contact, ego, other);
      bounds.most += property(scene, slack * most_j);
      return bounds;
    }
    default:
      return {0.0, std::numeric_limits<double>::infinity()};
  }
}

}  // namespace

void ScoreBounds::prepare(const Scene& scene) {
  const std::size_t count = scene.actors.size();
  term_.assign(count, 0.0);
  energy_.assign(count, 0.0);
  surface_m2_.assign(count, 0.0);
  order_.resize(count);
  ego_surface_m2_ = surface_of(scene.ego.model->mesh);
  triangles_ = static_cast<double>(scene.ego.model->mesh.size());
  area_m2_ = ego_surface_m2_;
  for (std::size_t i = 0; i < count; ++i) {
    surface_m2_[i] = surface_of(scene.actors[i].model->mesh);
    area_m2_ += surface_m2_[i];
    triangles_ += static_cast<double>(scene.actors[i].model->mesh.size());
    term_[i] = surely(scene, scene.ego, true) + surely(scene, scene.actors[i], false);
  }
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::sort(order_.begin(), order_.end(), [&](std::size_t p, std::size_t q) {
    return term_[p] != term_[q] ? term_[p] > term_[q] : p < q;
  });
  update(scene);
}

void ScoreBounds::update(const Scene& scene) {
  energy_sum_j_ = 0.0;
  for (std::size_t i = 0; i < scene.actors.size(); ++i) {
    energy_[i] = most_energy(scene, scene.actors[i], scene.actors[i].motion);
    energy_sum_j_ += energy_[i];
  }
}

double ScoreBounds::energy_j(const Scene& scene, const Motion& ego) const {
  return slack * (energy_sum_j_ + most_energy(scene, scene.ego, ego));
}

double ScoreBounds::most(const Scene& scene, const Motion& ego) const {
  switch (scene.measure) {
    case Measure::polygons:
      return triangles_;
    case Measure::area:
      return slack * area_m2_;
    case Measure::closing_energy: {
      double score = 0.0;
      for (const Body& body : scene.actors) {
        // The point of contact may lie as far from either origin as both bodies reach.
        const double speed = top_speed(scene, scene.ego, ego) + top_speed(scene, body, body.motion);
        const double reduced = std::isinf(body.mass_kg) ? scene.ego.mass_kg
                                                        : scene.ego.mass_kg * body.mass_kg /
                                                              (scene.ego.mass_kg + body.mass_kg);
        score += 1.002 * 0.5 * reduced * speed * speed;
      }
      return score;
    }
    case Measure::intrusion: {
      double score = 0.0;
      for (const Body& body : scene.actors) score += 2.0 * (body.radius_m + scene.ego.radius_m);
      return score;
    }
    case Measure::delta_v:
    case Measure::energy:
    case Measure::harm:
      break;
  }
  return most_after(scene, ego, {}, std::max<std::size_t>(scene.harm.after.most_contacts, 1));
}

double ScoreBounds::most_with_first(const Scene& scene, const Motion& ego,
                                    const std::vector<std::size_t>& first) const {
  const double all = most(scene, ego);
  if (scene.measure != Measure::harm) return all;
  const std::size_t rest_contacts = std::max<std::size_t>(scene.harm.after.most_contacts, 1) - 1;
  double best = 0.0;
  for (const std::size_t actor : first) {
    const double rest = most_after(scene, ego, {&actor, 1}, rest_contacts);
    best = std::max(best, slack * (term_[actor] + rest));
  }
  return std::min(all, best);
}

double ScoreBounds::most_after(const Scene& scene, const Motion& ego, View<const std::size_t> met,
                               std::size_t left) const {
  const double energy = energy_j(scene, ego);
  const std::size_t actors = term_.size() - std::min(term_.size(), met.size());
  left = std::min(left, actors);
  if (left == 0) return 0.0;
  switch (scene.measure) {
    case Measure::energy:
      // What is dissipated is nowhere gained again, and every body is met once.
      return energy;
    case Measure::delta_v:
      // All energy in the ego's speed, before the crash and after it.
      return static_cast<double>(left) * slack * 2.0 * std::sqrt(2.0 * energy / scene.ego.mass_kg);
    default:
      break;
  }
  double sum = 0.0;
  for (const std::size_t actor : order_) {
    if (left == 0) break;
    if (std::find(met.begin(), met.end(), actor) != met.end()) continue;
    sum += term_[actor];
    --left;
  }
  return slack * (sum + property(scene, energy));
}

TermBounds bounds_at_contact(const Scene& scene, const CrashSetup& crash, const Contact& contact) {
  const RigidBody& a = crash.a.rigid;
  const RigidBody& b = crash.b.rigid;
  const double reduced = reduced_kg(a, b);
  if (!(reduced > 0.0)) return {0.0, 0.0};
  const double speed = (a.velocity.linear_mps - b.velocity.linear_mps).norm();
  const double turning = turning_j(a) + turning_j(b);
  const double most_ns = slack * reduced * (speed + std::sqrt(speed * speed + turning / reduced));
  const double most_j = slack * 0.5 * (reduced * speed * speed + turning);
  return bounds_of(scene, crash, contact, 0.0, most_ns, 0.0, most_j);
}

TermBounds bounds_in_pulse(const Scene& scene, const CrashSetup& crash, const Contact& contact,
                           const PulseRun& run) {
  const double so_far = run.impulse_ns().norm();
  const double left = run.most_left_ns();
  const double rounding = run.rounding_ns();
  const double least = std::max(0.0, std::max(so_far - left, run.least_whole_ns()) - rounding);
  const double most = std::min(so_far + left, run.most_whole_ns()) + rounding;
  const double spent = run.dissipated_j();
  const double least_spent = std::max(0.0, spent - run.rounding_j());
  return bounds_of(scene, crash, contact, least, most, least_spent,
                   slack * spent + run.most_left_j());
}

}  // namespace crashrank::detail
