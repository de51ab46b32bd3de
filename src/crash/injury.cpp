#include "crashrank/crash/injury.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace crashrank {
namespace {

struct RiskModelEntry {
  RiskModel model;
  const char* name;
  const char* outcome;
};

constexpr std::array<RiskModelEntry, 4> risk_models{{
    {RiskModel::tum, "tum", "MAIS3+"},
    {RiskModel::malliaris_monfort, "malliaris-monfort", "MAIS3+"},
    {RiskModel::malliaris_rosen, "malliaris-rosen", "death"},
    {RiskModel::joksch_monfort, "joksch-monfort", "death"},
}};

const RiskModelEntry& entry_of(RiskModel model) noexcept {
  for (const RiskModelEntry& entry : risk_models) {
    if (entry.model == model) return entry;
  }
  return risk_models.front();
}

enum class Side { front, side, rear };

Side side_of(double pdof_deg) {
  if (pdof_deg <= 45.0 || pdof_deg >= 315.0) return Side::front;
  return pdof_deg >= 135.0 && pdof_deg <= 225.0 ? Side::rear : Side::side;
}

double logistic(double z) { return 1.0 / (1.0 + std::exp(-z)); }

double tum_occupant(double v, Side side) {
  const double by_side = side == Side::side ? 0.244 : (side == Side::rear ? -0.431 : 0.0);
  return logistic(-4.457 + 0.177 * v + by_side);
}

constexpr double mph = 0.44704;
constexpr double kmh = 1.0 / 3.6;

double malliaris(double v, Side side, bool fatal) {
  const double speed = v / mph;
  const double s = side == Side::side ? 1.0 : 0.0;
  const double r = side == Side::rear ? 1.0 : 0.0;
  return fatal ? logistic(-9.032 + 0.198 * speed + 1.462 * s - 1.921 * r)
               : logistic(-5.820 + 0.202 * speed + 0.556 * s - 2.170 * r);
}

double joksch(double v) {
  const double share = v / 31.74;
  return std::min(1.0, share * share * share * share);
}

/// For a person of mean age and sex, whose terms vanish.
double monfort(double v, double edge_m, bool fatal) {
  const double speed = v / kmh - 42.79;
  const double edge = 100.0 * edge_m - 85.25;
  return fatal ? logistic(-3.280 + 0.123 * speed + 0.047 * edge)
               : logistic(-0.460 + 0.091 * speed + 0.039 * edge + 0.002 * speed * edge);
}

double occupant_risk(RiskModel model, const Exposure& e) {
  const Side side = side_of(e.pdof_deg);
  switch (model) {
    case RiskModel::tum:
      return tum_occupant(e.delta_v_mps, side);
    case RiskModel::malliaris_monfort:
      return malliaris(e.delta_v_mps, side, false);
    case RiskModel::malliaris_rosen:
      return malliaris(e.delta_v_mps, side, true);
    case RiskModel::joksch_monfort:
      break;
  }
  return joksch(e.delta_v_mps);
}

double pedestrian_risk(RiskModel model, double v, double edge_m) {
  // The coefficients of the edge were fitted to cars and pickups.
  const double edge = std::clamp(edge_m, 0.5, 1.3);
  switch (model) {
    case RiskModel::tum:
      return logistic(-3.164 + 0.288 * v);
    case RiskModel::malliaris_monfort:
      return monfort(v, edge, false);
    case RiskModel::malliaris_rosen:
      return logistic(-6.9 + 0.090 * v / kmh);
    case RiskModel::joksch_monfort:
      break;
  }
  return monfort(v, edge, true);
}

}  // namespace

const char* risk_model_name(RiskModel model) noexcept { return entry_of(model).name; }

const char* risk_outcome(RiskModel model) noexcept { return entry_of(model).outcome; }

Result<RiskModel> risk_model_from_name(const std::string& name) {
  std::string known;
  for (const RiskModelEntry& entry : risk_models) {
    if (name == entry.name) return entry.model;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  return make_error(ErrorCode::usage, "there is no risk model \"" + name + "\"",
                    "choose one of " + known);
}

double injury_risk(RiskModel model, const Exposure& exposure) {
  constexpr double no_crash_mps = 0.1;
  constexpr double pedestrian_kmh = 29.0;
  constexpr double cyclist_kmh = 44.0;
  constexpr double motorcyclist_kmh = 48.0;
  if (exposure.person == Person::occupant) {
    return exposure.delta_v_mps < no_crash_mps ? 0.0 : occupant_risk(model, exposure);
  }
  if (exposure.impact_speed_mps < no_crash_mps) return 0.0;
  double speed = exposure.impact_speed_mps;
  if (exposure.person == Person::cyclist) speed *= pedestrian_kmh / cyclist_kmh;
  if (exposure.person == Person::motorcyclist) speed *= pedestrian_kmh / motorcyclist_kmh;
  return pedestrian_risk(model, speed, exposure.leading_edge_m);
}

double leading_edge_m(const TriangleMesh& mesh) {
  constexpr double foot_m = 0.6;
  constexpr double leans = 50.0 * std::numbers::pi / 180.0;
  const Box box = mesh.bounds();
  if (box.empty()) return 0.0;
  const double ground = static_cast<double>(box.min.z());
  const double middle = 0.5 * static_cast<double>(box.min.y() + box.max.y());
  const double half = 0.25 * static_cast<double>(box.extent().y());
  const double top = foot_m + std::cos(leans);
  double furthest = -std::numeric_limits<double>::infinity();
  double edge = std::min(static_cast<double>(box.extent().z()), foot_m);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d p = vertex.cast<double>();
    const double height = p.z() - ground;
    if (std::abs(p.y() - middle) > half || height < foot_m || height > top) continue;
    const double along = p.x() * std::cos(leans) + height * std::sin(leans);
    if (along > furthest) {
      furthest = along;
      edge = height;
    }
  }
  return edge;
}

}  // namespace crashrank
