#include "crashrank/motion/motion.hpp"

#include "crashrank/internal/base/products.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

namespace crashrank {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of poses that follow each other, m/s and rad/s: what is faster has its times wrong, and beyond
/// all measure its velocity would be infinite.
constexpr double fastest_timed = 1e4;

double sinc(double u) { return u == 0.0 ? 1.0 : std::sin(u) / u; }

// (sin u - u cos u) / u^2, whose numerator cancels near 0.
double turn_factor(double u) {
  if (std::abs(u) < 0.1) {
    const double q = u * u;
    return u * (1.0 / 3 - q * (1.0 / 30 - q * (1.0 / 840 - q / 45360)));
  }
  return (std::sin(u) - u * std::cos(u)) / (u * u);
}

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle) {
  if (angle == 0.0) return v;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

// Rz(angle) applied to a rotation.
Eigen::Matrix3d yawed(const Eigen::Matrix3d& rotation, double angle) {
  if (angle == 0.0) return rotation;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Eigen::Matrix3d result;
  result.row(0) = c * rotation.row(0) - s * rotation.row(1);
  result.row(1) = s * rotation.row(0) + c * rotation.row(1);
  result.row(2) = rotation.row(2);
  return result;
}

// Poses are accepted up to 1e-6 off a rotation, which 100 m away is as much as the tolerance of a
// contact; what is a rotation to rounding keeps its bits. A mirrored or scaled pose has no heading:
// the motion is then not finite, and rankings refuse it.
Pose rigid(const Pose& pose) {
  const double error = rigidity_error(pose);
  if (error <= 1e-12) return pose;
  if (!(error <= max_rigidity_error)) {
    return {pose.rotation, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  }
  return {Eigen::Quaterniond(pose.rotation).normalized().toRotationMatrix(), pose.translation};
}

Pose advanced(const Pose& pose, const Velocity& velocity, double seconds) {
  Pose result = pose;
  result.translation += velocity.linear_mps * seconds;
  const double rate = velocity.angular_radps.norm();
  if (rate > 0.0) {
    const Eigen::AngleAxisd turn(rate * seconds, velocity.angular_radps / rate);
    result.rotation = detail::multiply(turn.toRotationMatrix(), pose.rotation);
  }
  return result;
}

}  // namespace

double curvature_from_steering(double steering_rad, double wheelbase_m) {
  return std::tan(steering_rad) / wheelbase_m;
}

Motion::Profile Motion::make_profile(double speed, double acceleration, double top_speed) {
  Profile p;
  p.speed = speed;
  p.acceleration = acceleration;
  p.end = infinity;
  p.top_speed = top_speed;
  const bool brakes = speed * acceleration < 0.0 || (speed == 0.0 && acceleration < 0.0);
  if (acceleration == 0.0 || (!brakes && std::abs(speed) >= top_speed)) {
    p.end = 0.0;
    p.end_speed = speed;
  } else if (brakes) {
    p.end = -speed / acceleration;
    p.stops = true;
  } else if (top_speed < infinity) {
    p.end_speed = std::copysign(top_speed, acceleration);
    p.end = (p.end_speed - speed) / acceleration;
  }
  if (std::isnan(top_speed)) p.end_speed = top_speed;  // for `is_finite` to see
  return p;
}

void Motion::set_start(Planar& planar, const Pose& start) {
  planar.start = start;
  const Eigen::Vector3d forward = start.rotation.col(0);
  const Eigen::Vector2d ahead = forward.head<2>();
  planar.heading = ahead.norm() > 0.0 ? Eigen::Vector2d(ahead.normalized()) : Eigen::Vector2d(1, 0);
  planar.tilt.setZero();
  if (forward.z() == 0.0) return;
  planar.tilt = forward.normalized();
  planar.tilt.head<2>() -= planar.heading;
}

Motion::Motion(const TurnMotion& turn) {
  Planar p;
  set_start(p, rigid(turn.start));
  p.profile = make_profile(turn.speed_mps, turn.acceleration_mps2, turn.top_speed_mps);
  p.yaw_rate = turn.yaw_rate_radps;
  kind_ = p;
}

Motion::Motion(const ArcMotion& arc) {
  Planar p;
  set_start(p, rigid(arc.start));
  p.profile = make_profile(arc.speed_mps, arc.acceleration_mps2, arc.top_speed_mps);
  p.curvature = arc.curvature_per_m;
  p.arc = true;
  kind_ = p;
}

Motion::Motion(const FreeMotion& free) : kind_(FreeMotion{rigid(free.start), free.velocity}) {}

Motion Motion::at_rest(const Pose& pose) { return FreeMotion{pose, {}}; }

Result<Motion> Motion::timed(View<const TimedPose> poses) {
  Motion motion;
  const Status made = motion.become_timed(poses);
  if (!made) return made.error();
  return motion;
}

bool Motion::is_finite() const noexcept {
  const auto finite = [](const Pose& pose) {
    return pose.rotation.allFinite() && pose.translation.allFinite();
  };
  if (const auto* const free = std::get_if<FreeMotion>(&kind_)) {
    return finite(free->start) && free->velocity.linear_mps.allFinite() &&
           free->velocity.angular_radps.allFinite();
  }
  if (const auto* const planar = std::get_if<Planar>(&kind_)) {
    const Profile& p = planar->profile;
    return finite(planar->start) && std::isfinite(p.speed) && std::isfinite(p.acceleration) &&
           !std::isnan(p.end) && !std::isnan(p.end_speed) && std::isfinite(planar->yaw_rate) &&
           std::isfinite(planar->curvature);
  }
  return true;  // timed poses were checked
}

Status Motion::become_timed(View<const TimedPose> poses) {
  if (!std::holds_alternative<Timed>(kind_)) kind_ = Timed{};
  Timed& segments = *std::get_if<Timed>(&kind_);
  segments.assign(poses.size(), Segment{});
  const auto refuse = [this](std::size_t i, std::string reason, std::string remedy = {}) {
    kind_ = FreeMotion{};
    Error error = make_error(ErrorCode::bad_input, std::move(reason), std::move(remedy));
    error.place = "pose " + std::to_string(i);
    return error;
  };
  if (poses.empty()) {
    kind_ = FreeMotion{};
    return make_error(ErrorCode::bad_input, "a timed motion needs a pose");
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!std::isfinite(poses[i].time_s)) return refuse(i, "its time is not finite");
    if (i > 0 && !(poses[i].time_s > poses[i - 1].time_s)) {
      return refuse(i, "its time is not later than the one before", "sort the poses by time");
    }
    if (!(rigidity_error(poses[i].pose) <= max_rigidity_error)) {
      return refuse(i, "it is not a rigid motion");
    }
    segments[i].time = poses[i].time_s;
    segments[i].pose = rigid(poses[i].pose);
  }
  for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
    const double seconds = segments[i + 1].time - segments[i].time;
    const Pose& from = segments[i].pose;
    const Pose& to = segments[i + 1].pose;
    segments[i].velocity.linear_mps = (to.translation - from.translation) / seconds;
    if (to.rotation != from.rotation) {
      const Eigen::AngleAxisd turn(
          Eigen::Matrix3d(detail::multiply(to.rotation, from.rotation.transpose())));
      segments[i].velocity.angular_radps = turn.axis() * (turn.angle() / seconds);
    }
    const Velocity& v = segments[i].velocity;
    if (!(v.linear_mps.norm() <= fastest_timed && v.angular_radps.norm() <= fastest_timed)) {
      return refuse(
          i + 1,
          "it moves or turns too far from the one before for the time between: over 10 km/s or "
          "10,000 rad/s",
          "correct its time");
    }
  }
  return Success{};
}

void Motion::planar_state(const Planar& planar, double t, Pose& pose, Velocity& velocity) {
  const Profile& p = planar.profile;
  const double rising = std::min(t, p.end);
  const double after = t - rising;
  const bool stopped = p.stops && t >= p.end;
  const double speed = stopped ? 0.0 : (t < p.end ? p.speed + p.acceleration * t : p.end_speed);
  double yaw = 0.0;
  double yaw_rate = 0.0;
  Eigen::Vector2d moved;
  if (planar.arc) {
    double length = p.end_speed * after;
    if (rising > 0.0) length += rising * (p.speed + 0.5 * p.acceleration * rising);
    yaw = planar.curvature * length;
    yaw_rate = planar.curvature * speed;
    moved = length * sinc(0.5 * yaw) * turned(planar.heading, 0.5 * yaw);
  } else {
    const double w = planar.yaw_rate;
    yaw = w * (p.stops ? rising : t);
    yaw_rate = stopped ? 0.0 : w;
    const double u = 0.5 * w * rising;
    moved.setZero();
    if (rising > 0.0) {
      const Eigen::Vector2d along = turned(planar.heading, u);
      const Eigen::Vector2d left(-along.y(), along.x());
      moved = rising * ((p.speed + 0.5 * p.acceleration * rising) * sinc(u) * along +
                        0.5 * p.acceleration * rising * turn_factor(u) * left);
    }
    if (after > 0.0 && !p.stops) {
      const double v = 0.5 * w * after;
      moved += p.end_speed * after * sinc(v) * turned(planar.heading, 2.0 * u + v);
    }
  }
  pose.translation = planar.start.translation;
  pose.translation.head<2>() += moved;
  velocity.linear_mps << speed * turned(planar.heading, yaw), 0.0;
  if (planar.tilt.z() == 0.0) {
    pose.rotation = yawed(planar.start.rotation, yaw);
    velocity.angular_radps << 0.0, 0.0, yaw_rate;
    return;
  }
  // Turns the level road about the horizontal line across the heading.
  pose.translation += moved.dot(planar.heading) * planar.tilt;
  velocity.linear_mps += velocity.linear_mps.head<2>().dot(planar.heading) * planar.tilt;
  Eigen::Vector3d normal;
  normal << -planar.tilt.z() * planar.heading, 1.0 + planar.tilt.head<2>().dot(planar.heading);
  velocity.angular_radps = yaw_rate * normal;
  pose.rotation =
      detail::multiply(Eigen::AngleAxisd(yaw, normal).toRotationMatrix(), planar.start.rotation);
}

void Motion::state_at(double t_s, Pose& pose, Velocity& velocity) const {
  const double t = std::max(t_s, 0.0);
  if (const auto* planar = std::get_if<Planar>(&kind_)) {
    planar_state(*planar, t, pose, velocity);
  } else if (const auto* free = std::get_if<FreeMotion>(&kind_)) {
    pose = advanced(free->start, free->velocity, t);
    velocity = free->velocity;
  } else {
    const Timed& segments = *std::get_if<Timed>(&kind_);
    const auto next = std::upper_bound(segments.begin(), segments.end(), t,
                                       [](double time, const Segment& s) { return time < s.time; });
    if (next == segments.begin()) {
      pose = segments.front().pose;
      velocity = {};
      return;
    }
    const Segment& segment = *(next - 1);
    pose = advanced(segment.pose, segment.velocity, t - segment.time);
    velocity = segment.velocity;
  }
}

Pose Motion::pose_at(double t_s) const {
  Pose pose;
  Velocity velocity;
  state_at(t_s, pose, velocity);
  return pose;
}

Velocity Motion::velocity_at(double t_s) const {
  Pose pose;
  Velocity velocity;
  state_at(t_s, pose, velocity);
  return velocity;
}

MotionBound Motion::bound(double from_s, double until_s) const {
  const double from = std::max(from_s, 0.0);
  const double until = std::max(until_s, from);
  MotionBound bound;
  if (const auto* planar = std::get_if<Planar>(&kind_)) {
    const Profile& p = planar->profile;
    if (p.stops && from >= p.end) return bound;
    const auto speed_at = [&p](double t) {
      return std::abs(t < p.end ? p.speed + p.acceleration * t : p.end_speed);
    };
    bound.speed_mps = std::max(speed_at(from), speed_at(until));
    const double along = from < p.end ? std::abs(p.acceleration) : 0.0;
    bound.angular_radps =
        std::abs(planar->arc ? planar->curvature * bound.speed_mps : planar->yaw_rate);
    bound.acceleration_mps2 = std::hypot(along, bound.speed_mps * bound.angular_radps);
    if (planar->arc) bound.angular_radps2 = std::abs(planar->curvature) * along;
  } else if (const auto* free = std::get_if<FreeMotion>(&kind_)) {
    bound.speed_mps = free->velocity.linear_mps.norm();
    bound.angular_radps = free->velocity.angular_radps.norm();
  } else {
    const Timed& segments = *std::get_if<Timed>(&kind_);
    for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
      if (segments[i + 1].time <= from || segments[i].time > until) continue;
      bound.speed_mps = std::max(bound.speed_mps, segments[i].velocity.linear_mps.norm());
      bound.angular_radps =
          std::max(bound.angular_radps, segments[i].velocity.angular_radps.norm());
    }
  }
  return bound;
}

double Motion::reach(double radius_m, double from_s, double until_s) const {
  const double seconds = std::max(until_s, 0.0) - std::max(from_s, 0.0);
  if (!(seconds > 0.0)) return 0.0;
  const MotionBound b = bound(from_s, until_s);
  // A turn moves a point by no more than its arc and no more than across its circle.
  const double turn = std::min(b.angular_radps * seconds, 2.0) * radius_m;
  // The margin covers the rounding of poses and of this sum.
  return (b.speed_mps * seconds + turn) * (1.0 + 1e-12);
}

double Motion::next_kink(double t_s) const {
  if (const auto* planar = std::get_if<Planar>(&kind_)) {
    const Profile& p = planar->profile;
    const bool yaw_ends = p.stops && !planar->arc && planar->yaw_rate != 0.0;
    if (!yaw_ends || t_s >= p.end) return infinity;
    return p.end;
  }
  if (const auto* segments = std::get_if<Timed>(&kind_)) {
    const auto next = std::upper_bound(segments->begin(), segments->end(), t_s,
                                       [](double time, const Segment& s) { return time < s.time; });
    if (next != segments->end()) return next->time;
  }
  return infinity;
}

double Motion::rest_time() const {
  if (const auto* planar = std::get_if<Planar>(&kind_)) {
    const Profile& p = planar->profile;
    if (p.stops) return p.end;
    const bool turning = !planar->arc && planar->yaw_rate != 0.0;
    return p.end == 0.0 && p.end_speed == 0.0 && !turning ? 0.0 : infinity;
  }
  if (const auto* free = std::get_if<FreeMotion>(&kind_)) {
    const bool rests =
        free->velocity.linear_mps.isZero(0.0) && free->velocity.angular_radps.isZero(0.0);
    return rests ? 0.0 : infinity;
  }
  return std::max(std::get_if<Timed>(&kind_)->back().time, 0.0);
}

}  // namespace crashrank
