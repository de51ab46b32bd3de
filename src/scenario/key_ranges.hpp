#pragma once

#include "crashrank/scenario/scenario.hpp"
#include "scenario/number_range.hpp"

#include <array>
#include <cstddef>
#include <string>

namespace crashrank::detail::ranges {

inline constexpr double rad_per_deg = 0.017453292519943295;

// The range of every number of a scenario file, in the units of the file. The parser and the check
// of scenarios made by programs take them from here and state none themselves; `fields` names for
// each the place in the published schema that states it.
namespace limits = scenario_limits;

inline constexpr NumberRange symmetric(double most) { return {-most, most}; }
inline constexpr NumberRange up_to(double most) { return {0.0, most}; }
inline constexpr NumberRange above_zero_to(double most) { return {0.0, most, true}; }

inline constexpr NumberRange position = symmetric(limits::position_m);
inline constexpr NumberRange angle = symmetric(limits::angle_deg);
inline constexpr NumberRange speed = symmetric(limits::speed_mps);
inline constexpr NumberRange acceleration = symmetric(limits::acceleration_mps2);
inline constexpr NumberRange yaw_rate = symmetric(limits::yaw_rate_dps);
inline constexpr NumberRange steering = symmetric(limits::steering_deg);
inline constexpr NumberRange pose_time = up_to(limits::horizon_s);
inline constexpr NumberRange horizon = above_zero_to(limits::horizon_s);
inline constexpr NumberRange grip{limits::min_grip, limits::max_grip};
inline constexpr NumberRange occupants = up_to(harm_limits::people);

inline constexpr NumberRange mass{limits::min_mass_kg, limits::max_mass_kg};
inline constexpr NumberRange yaw_inertia = above_zero_to(limits::yaw_inertia_kgm2);
inline constexpr NumberRange scale{limits::min_scale, limits::max_scale};
inline constexpr NumberRange box_side = above_zero_to(limits::box_m);
inline constexpr NumberRange stiffness{limits::min_stiffness, limits::max_stiffness};
inline constexpr NumberRange honeycomb_pressure = above_zero_to(limits::honeycomb_pa);
inline constexpr NumberRange honeycomb_size = above_zero_to(limits::honeycomb_m);
inline constexpr NumberRange honeycomb_low = up_to(limits::honeycomb_m);
inline constexpr NumberRange breakaway = above_zero_to(limits::breakaway);
inline constexpr NumberRange deflection = up_to(limits::deflection_m);

inline constexpr NumberRange wheelbase{limits::min_wheelbase_m, limits::max_wheelbase_m};
inline constexpr NumberRange max_acceleration = up_to(limits::acceleration_mps2);
inline constexpr NumberRange max_deceleration{limits::min_deceleration_mps2,
                                              limits::acceleration_mps2};
inline constexpr NumberRange max_steering = up_to(limits::steering_deg);
inline constexpr NumberRange max_steering_rate{limits::min_steering_rate_dps,
                                               limits::max_steering_rate_dps};
inline constexpr NumberRange grid_side{1.0, static_cast<double>(limits::grid_side)};

/// Of a prediction or a joint future.
inline constexpr NumberRange probability = above_zero_to(1.0);
/// That an actor exists.
inline constexpr NumberRange existence = up_to(1.0);
// Standard deviations of a state.
inline constexpr NumberRange position_error = up_to(limits::position_error_m);
inline constexpr NumberRange heading_error = up_to(limits::heading_error_deg);
inline constexpr NumberRange speed_error = up_to(limits::speed_error_mps);

inline constexpr NumberRange harm_per_leaving = up_to(road_limits::harm_per_leaving);

// Of harm, in scenarios and profiles.
inline constexpr NumberRange weight = up_to(harm_limits::weight);
inline constexpr NumberRange people = up_to(harm_limits::people);
inline constexpr NumberRange age = up_to(harm_limits::age_years);
inline constexpr NumberRange share = up_to(1.0);
inline constexpr NumberRange friction = up_to(harm_limits::friction);
inline constexpr NumberRange strength{harm_limits::min_strength, harm_limits::max_strength};
inline constexpr NumberRange restitution = up_to(harm_limits::restitution);
inline constexpr NumberRange risk_speed{harm_limits::min_risk_speed, harm_limits::max_risk_speed};
inline constexpr NumberRange step{harm_limits::min_step, harm_limits::max_step};
inline constexpr NumberRange former_deceleration = up_to(harm_limits::deceleration_mps2);
inline constexpr NumberRange former_time = up_to(harm_limits::after_s);
inline constexpr NumberRange former_contacts{1.0, static_cast<double>(harm_limits::contacts)};

/// A range and the place in data/scenario.schema.json that states it, a JSON pointer.
struct Field {
  const char* schema;
  NumberRange range;
};

/// Every place of the schema that is a number: a test holds the schema, the parser and the check
/// against these rows.
inline constexpr std::array fields{
    Field{"/properties/horizon_s", horizon},
    Field{"/properties/grip", grip},
    Field{"/$defs/position_m", position},
    Field{"/$defs/angle_deg", angle},
    Field{"/$defs/speed_mps", speed},
    Field{"/$defs/acceleration_mps2", acceleration},
    Field{"/$defs/yaw_rate_dps", yaw_rate},
    Field{"/$defs/occupants", occupants},
    Field{"/$defs/probability", probability},
    Field{"/$defs/existence_probability", existence},
    Field{"/$defs/model/properties/mass_kg", mass},
    Field{"/$defs/model/properties/scale", scale},
    Field{"/$defs/model/properties/box/items", box_side},
    Field{"/$defs/model/properties/yaw_inertia_kgm2", yaw_inertia},
    Field{"/$defs/model/properties/stiffness", stiffness},
    Field{"/$defs/model/properties/honeycomb/properties/pressure_pa", honeycomb_pressure},
    Field{"/$defs/model/properties/honeycomb/properties/depth_m", honeycomb_size},
    Field{"/$defs/model/properties/honeycomb/properties/low_m", honeycomb_low},
    Field{"/$defs/model/properties/honeycomb/properties/high_m", honeycomb_size},
    Field{"/$defs/model/properties/breakaway/properties/force_n", breakaway},
    Field{"/$defs/model/properties/breakaway/properties/moment_nm", breakaway},
    Field{"/$defs/model/properties/deflection_m", deflection},
    Field{"/$defs/model/properties/deflection_force_n", breakaway},
    Field{"/$defs/poses/items/properties/t_s", pose_time},
    Field{"/$defs/ego/properties/wheelbase_m", wheelbase},
    Field{"/$defs/ego/properties/max_acceleration_mps2", max_acceleration},
    Field{"/$defs/ego/properties/max_deceleration_mps2", max_deceleration},
    Field{"/$defs/ego/properties/max_steering_deg", max_steering},
    Field{"/$defs/ego/properties/max_steering_rate_dps", max_steering_rate},
    Field{"/$defs/candidates/properties/grid/oneOf/1/properties/accelerations", grid_side},
    Field{"/$defs/candidates/properties/grid/oneOf/1/properties/steerings", grid_side},
    Field{"/$defs/candidate/oneOf/0/properties/steering_deg", steering},
    Field{"/$defs/state_errors/properties/position_m", position_error},
    Field{"/$defs/state_errors/properties/heading_deg", heading_error},
    Field{"/$defs/state_errors/properties/speed_mps", speed_error},
    Field{"/$defs/road/properties/off_road/properties/harm_per_leaving", harm_per_leaving},
    Field{"/$defs/road/properties/off_road/properties/grip", grip},
    Field{"/$defs/harm/properties/weights/properties/ego_occupant", weight},
    Field{"/$defs/harm/properties/weights/properties/other_occupant", weight},
    Field{"/$defs/harm/properties/weights/properties/pedestrian", weight},
    Field{"/$defs/harm/properties/weights/properties/cyclist", weight},
    Field{"/$defs/harm/properties/weights/properties/motorcyclist", weight},
    Field{"/$defs/harm/properties/weights/properties/property_per_mj", weight},
    Field{"/$defs/harm/properties/people/properties/ego", people},
    Field{"/$defs/harm/properties/people/properties/car", people},
    Field{"/$defs/harm/properties/people/properties/truck", people},
    Field{"/$defs/harm/properties/people/properties/bus", people},
    Field{"/$defs/harm/properties/pedestrian/properties/age_years", age},
    Field{"/$defs/harm/properties/pedestrian/properties/male_share", share},
    Field{"/$defs/harm/properties/friction", friction},
    Field{"/$defs/harm/properties/ranges/properties/friction/items", friction},
    Field{"/$defs/harm/properties/ranges/properties/strength/items", strength},
    Field{"/$defs/harm/properties/ranges/properties/restitution/items", restitution},
    Field{"/$defs/harm/properties/ranges/properties/risk_speed/items", risk_speed},
    Field{"/$defs/harm/properties/after_impact/properties/deceleration_mps2", former_deceleration},
    Field{"/$defs/harm/properties/after_impact/properties/longest_s", former_time},
    Field{"/$defs/harm/properties/after_impact/properties/most_contacts", former_contacts},
    Field{"/$defs/harm/properties/least_struck_share", share},
};

/// How many elements an array or object, or characters a text of the schema may have.
struct Size {
  const char* schema;   ///< JSON pointer
  const char* keyword;  ///< "maxItems", "maxProperties" or "maxLength"
  std::size_t most;
};

/// Every place of the schema that limits a size to more than a few.
inline constexpr std::array sizes{
    Size{"/properties/description", "maxLength", limits::description_characters},
    Size{"/properties/models", "maxProperties", limits::models},
    Size{"/properties/actors", "maxItems", limits::actors},
    Size{"/properties/futures", "maxItems", limits::futures},
    Size{"/$defs/note", "maxLength", limits::description_characters},
    Size{"/$defs/name", "maxLength", limits::name_characters},
    Size{"/$defs/model/properties/mesh", "maxLength", limits::path_characters},
    Size{"/$defs/poses", "maxItems", limits::poses},
    Size{"/$defs/candidates/properties/listed", "maxItems", limits::listed_candidates},
    Size{"/$defs/candidates/properties/table", "maxLength", limits::path_characters},
    Size{"/$defs/actor/oneOf/2/properties/predictions", "maxItems", limits::predictions},
    Size{"/$defs/future/properties/absent", "maxItems", limits::actors},
    Size{"/$defs/road/properties/drivable", "maxItems", road_limits::areas},
    Size{"/$defs/road/properties/drivable/items/properties/holes", "maxItems", road_limits::holes},
};

/// "key[index]".
inline std::string indexed(const char* key, std::size_t index) {
  return std::string(key) + "[" + std::to_string(index) + "]";
}

}  // namespace crashrank::detail::ranges
