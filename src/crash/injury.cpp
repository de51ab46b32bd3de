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

constexpr double mph = 0.44704;
constexpr double kmh = 1.0 / 3.6;
// The coefficients of the leading edge were fitted to cars and pickups.
constexpr double lowest_edge_m = 0.5;
constexpr double highest_edge_m = 1.3;

double logistic(double z) { return 1.0 / (1.0 + std::exp(-z)); }

/// Argument of a logistic curve: its value at zero exposure, and the increase by the exposure, >=
/// 0.
struct Argument {
  double at_zero = 0.0;
  double gain = 0.0;
};

/// (L(z) - L(z0)) / (1 - L(z0)) without cancellation, for z = z0 + gain. With u = exp(z0) and
/// g = exp(gain): 1 - (1 + u)/(1 + u·g) = u·(g - 1)/(1 + u·g) = (1 - 1/g) · L(z0 + gain). Both
/// factors rise with the gain, the second with z0.
double risk_over_zero(const Argument& z) {
  return -std::expm1(-z.gain) * logistic(z.at_zero + z.gain);
}

/// -ln(1 - p) of that, log1p(L(z0) · (exp(gain) - 1)).
double hazard_over_zero(const Argument& z) {
  constexpr double most_gain = 600.0;  // keeps the exponential finite
  return std::log1p(logistic(z.at_zero) * std::expm1(std::min(z.gain, most_gain)));
}

/// Logistic curve for occupants: intercept, slope per m/s, and the differences of side and rear
/// from front.
struct OccupantCurve {
  double intercept;
  double per_mps;
  double side;
  double rear;
};

constexpr OccupantCurve tum_occupant{-4.457, 0.177, 0.244, -0.431};
constexpr OccupantCurve malliaris_mais3{-5.820, 0.202 / mph, 0.556, -2.170};
constexpr OccupantCurve malliaris_fatal{-9.032, 0.198 / mph, 1.462, -1.921};

Argument occupant_argument(const OccupantCurve& curve, const Exposure& e) {
  return {
      curve.intercept + curve.side * e.direction.from_side + curve.rear * e.direction.from_behind,
      curve.per_mps * std::max(e.delta_v_mps, 0.0) +
          intrusion_gain_per_m * std::max(e.intrusion_m, 0.0)};
}

/// Not a logistic curve; intrusion multiplies the odds by exp(gain), as it does in a logistic
/// curve.
double joksch(const Exposure& e) {
  const double share = std::max(e.delta_v_mps, 0.0) / 31.74;
  const double risk = std::min(share * share * share * share, 1.0);
  if (risk == 0.0) return 0.0;
  return risk /
         (risk + (1.0 - risk) * std::exp(-intrusion_gain_per_m * std::max(e.intrusion_m, 0.0)));
}

/// The logistic curve of occupants; null in the model that has none.
const OccupantCurve* occupant_curve(RiskModel model) {
  switch (model) {
    case RiskModel::tum:
      return &tum_occupant;
    case RiskModel::malliaris_monfort:
      return &malliaris_mais3;
    case RiskModel::malliaris_rosen:
      return &malliaris_fatal;
    case RiskModel::joksch_monfort:
      break;
  }
  return nullptr;
}

/// Monfort & Mueller, centred on the means of their sample. The coefficient of the leading edge in
/// the MAIS3+ curve depends on the speed.
Argument monfort(double v_mps, double edge_m, const PedestrianDescription& person, bool fatal) {
  constexpr double mean_speed_kmh = 42.79;
  const double speed = v_mps / kmh;
  const double edge = 100.0 * edge_m - 85.25;
  const double male = person.male_share ? std::clamp(*person.male_share, 0.0, 1.0) - 0.59 : 0.0;
  const double age = person.age_years ? std::clamp(*person.age_years, 0.0, 120.0) - 42.42 : 0.0;
  if (fatal) {
    return {-3.280 - 0.123 * mean_speed_kmh + 0.047 * edge + 0.319 * male + 0.030 * age,
            0.123 * speed};
  }
  const double per_kmh = 0.091 + 0.002 * edge;
  return {-0.460 - per_kmh * mean_speed_kmh + 0.039 * edge - 0.119 * male + 0.029 * age,
          per_kmh * speed};
}

Argument rosen_sander(double v_mps, const PedestrianDescription& person) {
  const double speed = v_mps / kmh;
  if (!person.age_years) return {-6.9, 0.090 * speed};
  return {-9.1 + 0.040 * std::clamp(*person.age_years, 0.0, 120.0), 0.095 * speed};
}

/// Solves (1 - exp(-g)) · L(z0 + g) = 0.1 for z0, at g = 0.288 · 29/3.6: the risk is 10 % at
/// 29 km/h. z0 = -ln(10 · (1 - exp(-g)) - 1) - g.
constexpr double tum_pedestrian_at_zero = -4.401597234498132;
constexpr double tum_pedestrian_per_mps = 0.288;

Argument pedestrian_argument(RiskModel model, double v_mps, double edge_m,
                             const PedestrianDescription& person) {
  switch (model) {
    case RiskModel::tum:
      return {tum_pedestrian_at_zero, tum_pedestrian_per_mps * v_mps};
    case RiskModel::malliaris_monfort:
      return monfort(v_mps, edge_m, person, false);
    case RiskModel::malliaris_rosen:
      return rosen_sander(v_mps, person);
    case RiskModel::joksch_monfort:
      break;
  }
  return monfort(v_mps, edge_m, person, true);
}

/// Speed at which the pedestrian curve has the risk of this person, m/s.
double pedestrian_speed_mps(const Exposure& e) {
  // 10 % MAIS3+ (Lubbe et al. 2022).
  constexpr double pedestrian_kmh = 29.0;
  constexpr double cyclist_kmh = 44.0;
  constexpr double motorcyclist_kmh = 48.0;
  const double speed = std::max(e.impact_speed_mps, 0.0);
  if (e.person == Person::cyclist) return speed * pedestrian_kmh / cyclist_kmh;
  if (e.person == Person::motorcyclist) return speed * pedestrian_kmh / motorcyclist_kmh;
  return speed;
}

PedestrianDescription description_of(const Exposure& e) {
  return e.person == Person::pedestrian ? e.description : PedestrianDescription{};
}

/// Largest risk of a person outside a car over all leading-edge heights h. z0 and z = z0 + gain are
/// linear in h, with the slopes z0' and z'. From 1 - p = (1 + exp(z0))/(1 + exp(z)):
///
///   d ln(1 - p)/dh = z0' · L(z0) - z' · L(z)
///
/// - z0' >= 0 (all curves except Monfort & Mueller's MAIS3+): z' >= z0' there, so p never falls.
/// - z0' < 0 <= z': p rises.
/// - z0' < z' < 0: p rises while L(z)/L(z0) < z0'/z'. The logarithm of the left side has the slope
///   z' · (1 - L(z)) - z0' · (1 - L(z0)) >= 0, as L(z) >= L(z0) and |z'| < |z0'|. So p rises up to
///   one point and falls from there; bisection encloses it.
double most_outside_risk(RiskModel model, const Exposure& e) {
  const double speed = pedestrian_speed_mps(e);
  const auto at = [&](double edge_m) {
    return pedestrian_argument(model, speed, edge_m, description_of(e));
  };
  double low = lowest_edge_m;
  double high = highest_edge_m;
  const Argument first = at(low);
  const Argument last = at(high);
  double most = std::max(risk_over_zero(first), risk_over_zero(last));
  const double slope_at_zero = last.at_zero - first.at_zero;
  const double slope = slope_at_zero + last.gain - first.gain;
  if (slope_at_zero >= 0.0 || slope >= 0.0) return most;
  const auto rises = [&](const Argument& z) {
    return slope * logistic(z.at_zero + z.gain) > slope_at_zero * logistic(z.at_zero);
  };
  // At lower speeds rounding would decide the comparison: bound the risk over all edges at once.
  constexpr double least_mps = 1e-3;
  const bool decides = speed > least_mps;
  if (decides && (!rises(first) || rises(last))) return most;
  for (int step = 0; decides && step < 36; ++step) {
    const double middle = 0.5 * (low + high);
    (rises(at(middle)) ? low : high) = middle;
  }
  // Take the larger end value of each of the two factors of the risk: an upper bound within the
  // last interval.
  const Argument left = at(low);
  const Argument right = at(high);
  most = std::max(most, -std::expm1(-right.gain) * logistic(left.at_zero + left.gain));
  return most;
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

ForceDirection force_direction(double pdof_deg) {
  const double angle = std::abs(std::remainder(pdof_deg, 360.0)) * std::numbers::pi / 180.0;
  const double along = std::cos(angle);
  return {1.0 - along * along, along < 0.0 ? along * along : 0.0};
}

namespace {

/// Value of a logistic curve's argument, or of the risk by the curve that is none.
template <typename OfArgument, typename OfRisk>
double read_curve(RiskModel model, const Exposure& e, OfArgument&& of_argument, OfRisk&& of_risk) {
  if (e.person == Person::occupant) {
    const OccupantCurve* const curve = occupant_curve(model);
    return curve != nullptr ? of_argument(occupant_argument(*curve, e)) : of_risk(joksch(e));
  }
  const double edge_m = std::clamp(e.leading_edge_m, lowest_edge_m, highest_edge_m);
  return of_argument(
      pedestrian_argument(model, pedestrian_speed_mps(e), edge_m, description_of(e)));
}

}  // namespace

double injury_hazard(RiskModel model, const Exposure& exposure) {
  return read_curve(model, exposure, hazard_over_zero,
                    [](double risk) { return -std::log1p(-risk); });
}

double injury_risk(RiskModel model, const Exposure& exposure) {
  return read_curve(model, exposure, risk_over_zero, [](double risk) { return risk; });
}

double most_injury_risk(RiskModel model, const Exposure& exposure) {
  if (exposure.person != Person::occupant) return most_outside_risk(model, exposure);
  double most = 0.0;
  Exposure worst = exposure;
  for (const double pdof : {0.0, 90.0, 180.0}) {
    worst.direction = force_direction(pdof);
    most = std::max(most, injury_risk(model, worst));
  }
  return most;
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
