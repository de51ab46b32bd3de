#include "scenario/motion_check.hpp"

#include "crashrank/scenario/scenario.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace crashrank::detail {
namespace {

namespace limits = scenario_limits;

// Conversions and bounds round.
constexpr double a_little_more = 1.0 + 1e-6;
constexpr double fastest_turn_radps =
    a_little_more * limits::yaw_rate_dps * std::numbers::pi / 180.0;

}  // namespace

const char* pose_fault(const Pose& pose) {
  if (!pose.translation.allFinite() || !pose.rotation.allFinite()) return "is not finite";
  if (!(rigidity_error(pose) <= max_rigidity_error)) return "is not rigid";
  if (pose.translation.cwiseAbs().maxCoeff() > limits::position_m) {
    return "is more than 100 km from the origin";
  }
  return nullptr;
}

const char* motion_fault(const Motion& motion, double horizon_s) {
  static_assert(limits::position_m == 1e5 && limits::fastest_mps == 300.0 &&
                limits::yaw_rate_dps == 720.0 && limits::acceleration_mps2 == 50.0);
  if (!motion.is_finite()) return "is not finite, or begins at a pose that is not rigid";
  if (const char* const fault = pose_fault(motion.pose_at(0.0))) return fault;
  // The first kink of all is where timed poses begin.
  if (motion.holds_poses() && motion.next_kink(-std::numeric_limits<double>::infinity()) > 0.0) {
    return "begins after time 0";
  }
  const MotionBound bound = motion.bound(0.0, horizon_s);
  if (!(bound.speed_mps <= a_little_more * limits::fastest_mps)) return "is faster than 300 m/s";
  if (!(bound.angular_radps <= fastest_turn_radps)) return "turns faster than 720 deg/s";
  // The bound adds what keeps the body on its curve.
  const double gains = std::hypot(limits::acceleration_mps2, bound.speed_mps * bound.angular_radps);
  if (!(bound.acceleration_mps2 <= a_little_more * gains)) {
    return "gains or loses more than 50 m/s in a second";
  }
  return nullptr;
}

bool begins_at(const Pose& begins, const Pose& ego) {
  constexpr double farthest_m = 1.0;
  // The cosine of 30°. A rotation's trace is 1 + 2·cos of its angle.
  constexpr double least_cosine = 0.5 * std::numbers::sqrt3;
  const double trace = begins.rotation.cwiseProduct(ego.rotation).sum();
  return (begins.translation - ego.translation).norm() <= farthest_m &&
         trace >= 1.0 + 2.0 * least_cosine;
}

std::string actor_place(std::size_t index, const std::string& name) {
  const std::string place = "actors[" + std::to_string(index) + "]";
  return name.empty() ? place : place + " \"" + name + "\"";
}

Error refused_motion(std::string place, const char* what, const char* fault) {
  Error error = make_error(ErrorCode::bad_input, std::string(what) + " " + fault,
                           "check what it was made from: its units, its times, its frame");
  error.place = std::move(place);
  return error;
}

}  // namespace crashrank::detail
