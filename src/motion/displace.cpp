#include "crashrank/motion/motion.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace crashrank {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Rotation about the vertical axis.
class Yaw {
public:
  explicit Yaw(double angle_rad) : cosine_(std::cos(angle_rad)), sine_(std::sin(angle_rad)) {}

  Vector2d turned(const Vector2d& v) const {
    return {cosine_ * v.x() - sine_ * v.y(), sine_ * v.x() + cosine_ * v.y()};
  }
  void turn(Vector3d& v) const { v.head<2>() = turned(Vector2d(v.head<2>())); }
  void turn(Matrix3d& rotation) const {
    for (int axis = 0; axis < 3; ++axis) {
      rotation.col(axis).head<2>() = turned(Vector2d(rotation.col(axis).head<2>()));
    }
  }

private:
  double cosine_;
  double sine_;
};

Vector3d forward_axis(const Matrix3d& rotation) { return rotation.col(0).normalized(); }

/// What the error adds to a speed along the body's forward axis: neither reverses it.
double gained(double speed, double error) {
  if (speed > 0.0) return std::max(speed + error, 0.0) - speed;
  if (speed < 0.0) return std::min(speed + error, 0.0) - speed;
  return 0.0;
}

}  // namespace

void Motion::displace(const StateError& error) {
  const bool moved = error.x_m != 0.0 || error.y_m != 0.0;
  const bool is_turned = error.heading_rad != 0.0;
  if (!moved && !is_turned && error.speed_mps == 0.0) return;
  const Yaw yaw(error.heading_rad);
  const Vector2d shift(error.x_m, error.y_m);
  if (auto* const planar = std::get_if<Planar>(&kind_)) {
    planar->start.translation.head<2>() += shift;
    if (is_turned) {
      yaw.turn(planar->start.rotation);
      set_start(*planar, Pose(planar->start));
    }
    const Profile& p = planar->profile;
    const double speed = p.speed + gained(p.speed, error.speed_mps);
    if (speed == p.speed) return;
    // What the error stops stays where it is, unless it speeds up: braking does not set it off the
    // other way, and no yaw rate spins it on the spot.
    const bool rests = speed == 0.0 && !(p.speed * p.acceleration > 0.0);
    planar->profile = make_profile(speed, rests ? 0.0 : p.acceleration, p.top_speed);
    if (rests) planar->yaw_rate = 0.0;
  } else if (auto* const free = std::get_if<FreeMotion>(&kind_)) {
    free->start.translation.head<2>() += shift;
    if (is_turned) {
      yaw.turn(free->start.rotation);
      yaw.turn(free->velocity.linear_mps);
    }
    const Vector3d forward = forward_axis(free->start.rotation);
    const double speed = forward.dot(free->velocity.linear_mps);
    free->velocity.linear_mps += gained(speed, error.speed_mps) * forward;
  } else {
    Timed& segments = *std::get_if<Timed>(&kind_);
    const Vector2d pivot = segments.front().pose.translation.head<2>();
    Vector3d gone(error.x_m, error.y_m, 0.0);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      Segment& segment = segments[i];
      Vector3d& place = segment.pose.translation;
      if (is_turned) {
        place.head<2>() = pivot + yaw.turned(Vector2d(place.head<2>() - pivot));
        yaw.turn(segment.pose.rotation);
        yaw.turn(segment.velocity.linear_mps);
        yaw.turn(segment.velocity.angular_radps);
      }
      place += gone;
      if (i + 1 == segments.size()) break;
      const Vector3d forward = forward_axis(segment.pose.rotation);
      const double speed = forward.dot(segment.velocity.linear_mps);
      const Vector3d faster = gained(speed, error.speed_mps) * forward;
      segment.velocity.linear_mps += faster;
      gone += (segments[i + 1].time - segment.time) * faster;
    }
  }
}

}  // namespace crashrank
