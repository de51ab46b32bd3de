#pragma once

#include "crashrank/motion/motion.hpp"
#include "crashrank/rank/contact.hpp"

#include <nlohmann/json.hpp>

namespace crashrank::detail {

/// A motion until `until_s` as the page plays it: {"t", "x", "y", "a", "z"}, milliseconds,
/// millimetres and 0.1 mrad of heading that do not jump at full turns; between two times everything
/// is linear. "z" is absent where it is 0.
nlohmann::ordered_json track_json(const Motion& motion, double until_s);

/// The origin of a body that moves as simulated, from the first force on; `plan` is its motion
/// until then.
nlohmann::ordered_json track_json(const BodyMotion& simulated, const Motion& plan);

/// What a body lives through: {"t": ms, "v": mm/s}, its change of velocity within the last 0.3 s.
nlohmann::ordered_json exposure_json(const BodyMotion& simulated);

/// When the bodies of a simulation stand for good, s; 0 without any.
double rest_time_s(const std::vector<BodyMotion>& motions);

}  // namespace crashrank::detail
