#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <optional>
#include <string>

namespace crashrank {

// Injury risk as a function of crash severity.
//
// Zero exposure. A published logistic curve L(z) = 1/(1 + exp(-z)) keeps a remainder at zero speed
// (4 % for TUM's pedestrians), which no crash explains. Every curve is therefore read as
//
//   p = (L(z) - L(z0)) / (1 - L(z0)) = (1 - exp(-(z - z0))) · L(z)
//
// where z0 is the logistic's argument at zero exposure: the probability of injury by this crash,
// given that the person is not injured without it. z - z0 >= 0 grows with speed and intrusion, so p
// is 0 at zero exposure, continuous, and rises with both. The second form also shows that p rises
// with any coefficient that z0 and z have in common, since that leaves z - z0 alone: the direction
// of force with the largest coefficient has the largest risk.
//
// Direction of force. The published coefficients are of front, side and rear. In between they are
// blended in the angle a between the PDOF and ahead:
//
//   coefficient = front · cos²(a) + side · sin²(a)   for cos(a) >= 0
//               = rear  · cos²(a) + side · sin²(a)   for cos(a) < 0
//
// The blend is a weighted mean of two of the three, so a pure direction (0, 90 or 180 degrees) has
// the least and the largest risk over all angles. It is a choice: the sources class by 45 degrees.
//
// Persons. No source in use has a coefficient for belts, airbags, seating position, or the side
// nearer to the impact; there is no option for them. Age and sex are in two curves of pedestrians.

/// Kind of the exposed person.
enum class Person { occupant, pedestrian, cyclist, motorcyclist };

/// A set of published curves of one outcome. Absolute risks of different sets do not compare, so a
/// ranking uses one set throughout. "Secondary" sources: the coefficients were read in papers or
/// programs that cite the original.
enum class RiskModel {
  /// MAIS3+. Occupants: logistic LR4S of TUM's EthicalTrajectoryPlanning (harm_parameters.json).
  /// Pedestrians: 10 % at 29 km/h, a single point (Lubbe et al. 2022), with the slope of TUM's
  /// pedestrian curve (0.288 per m/s). The point comes from the source of the riders' ratios, so
  /// that people outside cars compare; TUM's own curve has 30 % at that speed.
  tum,
  /// MAIS3+. Occupants: Malliaris; pedestrians: Monfort & Mueller with the bonnet's leading edge.
  /// Secondary sources.
  malliaris_monfort,
  /// Death. Occupants: Malliaris; pedestrians: Rosén & Sander. Secondary sources.
  malliaris_rosen,
  /// Death. Occupants: Joksch, (delta-v / 31.74 m/s)^4 without direction; pedestrians: Monfort &
  /// Mueller. Secondary sources.
  joksch_monfort,
};

/// "tum", "malliaris-monfort", "malliaris-rosen", "joksch-monfort".
CRASHRANK_API const char* risk_model_name(RiskModel model) noexcept;
/// "MAIS3+" or "death".
CRASHRANK_API const char* risk_outcome(RiskModel model) noexcept;
/// Errors: usage, listing the names.
CRASHRANK_API Result<RiskModel> risk_model_from_name(const std::string& name);

/// Age and sex of pedestrians, for the curves that have coefficients of them. An empty field gives
/// the curve of the mean person. Riders and occupants have no such coefficients.
struct PedestrianDescription {
  /// Years, clamped to [0, 120]. Monfort & Mueller: 0.029 (MAIS3+) or 0.030 (death) per year,
  /// empty: their mean, 42.42. Rosén & Sander: their curve with age, empty: that without. No effect
  /// in `RiskModel::tum`.
  std::optional<double> age_years;
  /// Probability that the person is male, clamped to [0, 1]; enters the logistic's argument as the
  /// share. Monfort & Mueller: -0.119 (MAIS3+) or 0.319 (death), empty: their mean, 0.59. No effect
  /// in the other models.
  std::optional<double> male_share;
};

/// Gain of the logistic's argument per metre of intrusion into the passenger compartment, 1/m: the
/// odds of injury double every 0.15 m (factor 1.047 per cm). A CHOICE: no published coefficient
/// per length was found that holds for the whole body beside delta-v. It is set by the scale of the
/// structural rating of the IIHS small-overlap test, whose lower compartment leaves "good" at
/// roughly 0.15 m (odds × 2), "acceptable" at 0.225 m (× 2.8) and "marginal" at 0.30 m (× 4).
inline constexpr double intrusion_gain_per_m = 4.62098;

/// Weights of the coefficients of side and rear, each in [0, 1]; what is left to a sum of 1 is the
/// weight of the front. The share of a delta-v that is crush between several bodies has no
/// direction and counts as from ahead.
struct ForceDirection {
  double from_side = 0.0;    ///< weight of the coefficient of a force from a side
  double from_behind = 0.0;  ///< weight of that of a force from behind
};

/// The weights of a PDOF in degrees clockwise from ahead; see above.
CRASHRANK_API ForceDirection force_direction(double pdof_deg);

/// Inputs of the risk of one person.
struct Exposure {
  Person person = Person::occupant;  ///< kind of person
  double delta_v_mps = 0.0;          ///< delta-v of the occupant's vehicle, magnitude, m/s
  ForceDirection direction;          ///< of the force on that vehicle
  double impact_speed_mps = 0.0;     ///< closing speed, for people outside cars, m/s
  /// Height of the leading edge of the striking vehicle, m; 0.75 is a car's, 1.09 a pickup's.
  double leading_edge_m = 0.75;
  /// Deepest intrusion into the passenger compartment, for occupants, m, >= 0.
  double intrusion_m = 0.0;
  PedestrianDescription description;  ///< age and sex of a pedestrian
};

/// Probability of the model's outcome, in [0, 1]: 0 at zero exposure (delta-v and intrusion of
/// occupants, impact speed of others), continuous, and never falling with any of the three.
/// Negative values count as 0. Cyclists and motorcyclists take the curve of a mean pedestrian at a
/// speed lowered in the ratio of the closing speeds at 10 % MAIS3+ (Lubbe et al. 2022: 29, 44 and
/// 48 km/h). Intrusion adds `intrusion_gain_per_m` to the logistic's argument; in Joksch's curve,
/// which is no logistic, it multiplies the odds alike, so that it counts beside a delta-v only.
CRASHRANK_API double injury_risk(RiskModel model, const Exposure& exposure);

/// -ln(1 - p) of that probability: hazards of independent impacts add up. Infinite where it is 1.
CRASHRANK_API double injury_hazard(RiskModel model, const Exposure& exposure);

/// The largest `injury_risk` over all directions of force and all leading edges. Between the edges
/// of 0.5 and 1.3 m, to which `injury_risk` clamps, the risk of Monfort & Mueller's MAIS3+ curve
/// may have a maximum at low speed; it is bounded from above to 1e-9 of its value (above 1 mm/s).
CRASHRANK_API double most_injury_risk(RiskModel model, const Exposure& exposure);

/// Height over its lowest point of a vehicle's bonnet leading edge: where a straight edge of 1 m,
/// leaning back by 50 degrees with its foot 0.6 m over the ground, touches the front first (the
/// definition of the pedestrian protection regulations), over the middle half of the width. A front
/// that ends lower has its own height. m. O(vertices).
CRASHRANK_API double leading_edge_m(const TriangleMesh& mesh);

}  // namespace crashrank
