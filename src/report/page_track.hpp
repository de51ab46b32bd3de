#pragma once

#include "crashrank/motion/motion.hpp"
#include "crashrank/rank/contact.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// A time and values that are linear between times.
template <std::size_t values> struct Sample {
  double time_s = 0.0;
  std::array<double, values> at{};
};

/// Where the origin of a body is: x, y, z, m, and the heading, rad, which does not jump at full
/// turns. Times rise.
using Track = std::vector<Sample<4>>;

/// A motion until `until_s`, in steps of at most 0.05 s.
Track track_of(const Motion& motion, double until_s);

/// The origin of a body that moves as simulated, from the first force on; `plan` is its motion
/// until then.
Track track_of(const BodyMotion& simulated, const Motion& plan);

/// A body on its plan until the first force, then as simulated, if it is; from 0 to `end_s` at
/// most.
Track track_of(const Motion& plan, const BodyMotion* simulated, double end_s);

/// Returns the samples of `track` without those that lie within the tolerances (m, m, m, rad) of a
/// line between those that stay, and one sample of a body that does not move. Linear.
Track thinned(const Track& track, const std::array<double, 4>& tolerance);

/// A track as the page plays it: {"t", "x", "y", "a", "z"}, milliseconds, millimetres and 0.1 mrad
/// of heading, to 1 cm and 4 mrad. "z" is absent where it is 0.
nlohmann::ordered_json track_json(const Track& track);

/// What a body lives through: {"t": ms, "v": mm/s}, its change of velocity within the last 0.3 s.
nlohmann::ordered_json exposure_json(const BodyMotion& simulated);

/// The motion of an actor; at rest where it is not a rigid motion.
Motion motion_of(const ActorMotion& stated);

/// How a body leans beside its heading: its rotation without the turn about the vertical.
Eigen::Matrix3d tilt_of(const Pose& pose);

/// When there is nothing more to see of a candidate, s: half a second after its bodies stand for
/// good, or after the first contact where no motion is recorded; the horizon without a contact.
double played_end_s(const Scenario& scenario, const CandidateResult& ranked);

}  // namespace crashrank::detail
