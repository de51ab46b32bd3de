#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/motion/motion.hpp"

#include <cstddef>
#include <string>

namespace crashrank::detail {

/// Whether a body can be computed with that stands there: finite, rigid and near enough. What it is
/// not, as the end of a sentence; null where nothing is wrong. Allocates nothing.
const char* pose_fault(const Pose& pose);

/// The same of a motion, over a horizon: its numbers, where it begins, how fast it moves, turns and
/// gains speed (`scenario_limits`), of whatever kind it is and wherever it comes from. Beyond them
/// products overflow, and a body without a pose has no contact: an answer that looks harmless.
const char* motion_fault(const Motion& motion, double horizon_s);

/// Whether a manoeuvre that begins at `begins` may be the ego's: within 1 m and 30° of its pose.
/// What is farther was written in another frame, or for another moment.
bool begins_at(const Pose& begins, const Pose& ego);

/// An actor as errors name it: its index and, where it has one, its name, as `actors[3] "van"`.
std::string actor_place(std::size_t index, const std::string& name);

/// The error for a fault of `what` at `place`.
Error refused_motion(std::string place, const char* what, const char* fault);

}  // namespace crashrank::detail
