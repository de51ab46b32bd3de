#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <string>

namespace crashrank {

/// Who is hurt.
enum class Person { occupant, pedestrian, cyclist, motorcyclist };

/// A set of published curves that speak of one outcome. Absolute risks of different sets do not
/// compare, so a ranking uses one of them throughout.
enum class RiskModel {
  /// MAIS3+. Occupants by side: logistic LR4S of TUM's EthicalTrajectoryPlanning
  /// (harm_parameters.json); pedestrians: the same project's.
  tum,
  /// MAIS3+. Occupants: Malliaris; pedestrians: Monfort & Mueller with the bonnet's leading edge.
  /// Coefficients read in secondary sources.
  malliaris_monfort,
  /// Death. Occupants: Malliaris; pedestrians: Rosén & Sander. Secondary sources.
  malliaris_rosen,
  /// Death. Occupants: Joksch; pedestrians: Monfort & Mueller. Secondary sources.
  joksch_monfort,
};

/// "tum", "malliaris-monfort", "malliaris-rosen", "joksch-monfort".
CRASHRANK_API const char* risk_model_name(RiskModel model) noexcept;
/// "MAIS3+" or "death".
CRASHRANK_API const char* risk_outcome(RiskModel model) noexcept;
/// Errors: usage, listing the names.
CRASHRANK_API Result<RiskModel> risk_model_from_name(const std::string& name);

/// What the risk of one person depends on.
struct Exposure {
  Person person = Person::occupant;  ///< who
  double delta_v_mps = 0.0;          ///< of the occupant's vehicle, magnitude
  double pdof_deg = 0.0;  ///< of the force on it: front is within 45 degrees of 0, rear of 180
  double impact_speed_mps = 0.0;  ///< closing speed, for people outside cars
  /// Height of the leading edge of what hits a pedestrian; 0.75 m is a car's, 1.09 m a pickup's.
  double leading_edge_m = 0.75;
};

/// Probability of the model's outcome, in [0, 1]; rises with speed. Cyclists and motorcyclists take
/// the pedestrian's curve at a speed lowered in the ratio of the closing speeds that carry 10 % of
/// MAIS3+ (Lubbe et al. 2022: 29, 44 and 48 km/h). No speed, no risk: 0 below 0.1 m/s, where the
/// logistic curves keep a remainder that no crash explains.
CRASHRANK_API double injury_risk(RiskModel model, const Exposure& exposure);

/// Height over its lowest point of a vehicle's bonnet leading edge: where a straight edge of 1 m,
/// leaning back by 50 degrees with its foot 0.6 m over the ground, touches the front first (the
/// definition of the pedestrian protection regulations), over the middle half of the width. A front
/// that ends lower has its own height. m. O(vertices).
CRASHRANK_API double leading_edge_m(const TriangleMesh& mesh);

}  // namespace crashrank
