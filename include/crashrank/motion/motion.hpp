#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"

#include <Eigen/Core>

#include <limits>
#include <variant>
#include <vector>

namespace crashrank {

/// Rigid velocity of a body: of its origin, and about it. World axes; m/s and rad/s.
struct Velocity {
  Eigen::Vector3d linear_mps = Eigen::Vector3d::Zero();     ///< of the origin, m/s
  Eigen::Vector3d angular_radps = Eigen::Vector3d::Zero();  ///< about the origin, rad/s
};

/// Velocity of the body's point that is at `point_m` (world) while the body's origin is at
/// `origin_m` (world). m/s.
inline Eigen::Vector3d velocity_of_point(const Velocity& v, const Eigen::Vector3d& origin_m,
                                         const Eigen::Vector3d& point_m) {
  return v.linear_mps + v.angular_radps.cross(point_m - origin_m);
}

/// A vehicle that drives along its own x axis while its heading turns at a constant rate, on a
/// plane road that climbs or falls as its x axis does and is level across: pitch at the start is
/// the slope, roll is a lean. Positive yaw is to the left, about the road's normal. Braking ends in
/// standstill, and with it the yaw: the vehicle never reverses by braking (a negative start speed
/// is reverse gear, and braked by a positive acceleration). Without speed and acceleration a yaw
/// rate spins it on the spot.
struct TurnMotion {
  Pose start;                      ///< pose at time 0, body to world
  double speed_mps = 0.0;          ///< at time 0, along the body's x axis
  double yaw_rate_radps = 0.0;     ///< constant while the vehicle moves
  double acceleration_mps2 = 0.0;  ///< along the body's x axis, constant until standstill
  double top_speed_mps = std::numeric_limits<double>::infinity();  ///< ends a rise of |speed|
};

/// A vehicle whose origin follows a circle or a straight line: the kinematic bicycle with fixed
/// steering, its origin at the rear axle (the default origin of a vehicle). The yaw rate is
/// curvature x speed, so braking slows the turn as well. Standstill and slope as in TurnMotion.
struct ArcMotion {
  Pose start;                      ///< pose at time 0, body to world
  double speed_mps = 0.0;          ///< m/s
  double curvature_per_m = 0.0;    ///< 1 / signed radius of the origin's path; positive: left
  double acceleration_mps2 = 0.0;  ///< m/s²
  double top_speed_mps = std::numeric_limits<double>::infinity();  ///< ends a rise of |speed|, m/s
};

/// Curvature of the rear axle's path, 1/m, for a steering angle at the front wheels (rad, positive
/// to the left, |angle| < pi/2) of a vehicle with that wheelbase (m, > 0).
CRASHRANK_API double curvature_from_steering(double steering_rad, double wheelbase_m);

/// A body in free motion: constant linear velocity of the origin, constant angular velocity about
/// it, both in world axes.
struct FreeMotion {
  Pose start;         ///< pose at time 0, body to world
  Velocity velocity;  ///< constant
};

/// A pose that a body has at a time.
struct TimedPose {
  double time_s = 0.0;  ///< s
  Pose pose;            ///< body to world
};

/// How far the true state of a body is from the one that its motion assumes. Plane of the road.
struct StateError {
  double x_m = 0.0;          ///< world, m
  double y_m = 0.0;          ///< world, m
  double heading_rad = 0.0;  ///< about the body's origin, left positive, rad
  double speed_mps = 0.0;    ///< along the body's forward axis, m/s
};

/// Upper bounds that hold at every instant of a stretch of time, kinks excluded: of the origin's
/// speed and acceleration, and of the body's angular speed and acceleration.
struct MotionBound {
  double speed_mps = 0.0;          ///< m/s
  double angular_radps = 0.0;      ///< rad/s
  double acceleration_mps2 = 0.0;  ///< m/s²
  double angular_radps2 = 0.0;     ///< rad/s²
};

/// How a body moves: its pose and velocity at every time t >= 0 (s). Before 0 it is where it is at
/// 0. A value; reading from many threads is safe. Turns and arcs move in the plane that contains
/// the body's x axis at the start and the horizontal line across it. Start poses are rigid within
/// `max_rigidity_error`; any other makes a motion that is not finite. Rotations off by more than
/// rounding are orthonormalised.
class CRASHRANK_API Motion {
public:
  /// Rests at the world's origin.
  Motion() = default;
  /// Turns at a constant rate.
  Motion(const TurnMotion& turn);
  /// Drives along a circle or a line.
  Motion(const ArcMotion& arc);
  /// Moves freely.
  Motion(const FreeMotion& free);

  /// Rests at a pose.
  static Motion at_rest(const Pose& pose);

  /// Poses at strictly increasing times, at least one. Between two of them the origin moves on a
  /// straight line and the body turns about one axis by the shorter way, both at constant speed;
  /// before the first and after the last it rests. Errors: bad_input naming the first pose that is
  /// out of order, not finite, not rigid, or over 1e4 m/s or rad/s away from the one before.
  static Result<Motion> timed(View<const TimedPose> poses);

  /// Assigns such a motion and reuses memory: if it was a timed motion of as many poses, nothing is
  /// allocated. After an error it rests.
  Status become_timed(View<const TimedPose> poses);

  /// True for a timed motion, the only kind whose copies allocate.
  bool holds_poses() const noexcept { return std::holds_alternative<Timed>(kind_); }

  /// False if a number that it was made from is NaN or infinite (a top speed may be infinite): it
  /// then has no pose.
  bool is_finite() const noexcept;

  /// Changes it to the motion of a body whose state has that error; an error of 0 changes no bit.
  /// The start, or all poses about the first one, is moved and turned. A body that moves is faster
  /// by the error of its speed, and its acceleration, steering or yaw rate stays: a negative error
  /// of more than its speed stops it, none reverses it, and a standing body stays at rest. Timed
  /// poses shift along their headings, stretch by stretch. Errors: none; numbers that are not
  /// finite make a motion that is not. Linear in the poses; allocates nothing.
  void displace(const StateError& error);

  /// Body to world at time t. About 50 ns.
  Pose pose_at(double t_s) const;

  /// Velocity at time t, world axes; at a kink the one that follows.
  Velocity velocity_at(double t_s) const;

  /// Both of the above at little more than the cost of one.
  void state_at(double t_s, Pose& pose, Velocity& velocity) const;

  /// Bounds over [from, until].
  MotionBound bound(double from_s, double until_s) const;

  /// No point of the body within `radius_m` of its origin moves further than this between any two
  /// times of [from, until]. m.
  double reach(double radius_m, double from_s, double until_s) const;

  /// The first kink later than t: a time at which the velocity jumps; infinity when there is none.
  double next_kink(double t_s) const;

  /// When the body has come to rest for good; infinity when it never does.
  double rest_time() const;

private:
  /// Speed along a path under constant acceleration that ends at standstill or top speed.
  struct Profile {
    double speed = 0.0;
    double acceleration = 0.0;
    double end = 0.0;        ///< time at which the acceleration ends
    double end_speed = 0.0;  ///< speed from then on
    double top_speed = std::numeric_limits<double>::infinity();
    bool stops = false;
  };
  struct Planar {
    Pose start;  ///< pose at time 0, body to world
    Eigen::Vector2d heading{1.0, 0.0};
    /// The forward axis at the start minus the heading; 0 on a level road.
    Eigen::Vector3d tilt = Eigen::Vector3d::Zero();
    Profile profile;
    double yaw_rate = 0.0;   ///< used by turns
    double curvature = 0.0;  ///< used by arcs
    bool arc = false;
  };
  struct Segment {
    double time = 0.0;
    Pose pose;          ///< body to world
    Velocity velocity;  ///< constant
  };
  using Timed = std::vector<Segment>;

  static Profile make_profile(double speed, double acceleration, double top_speed);
  static void set_start(Planar& planar, const Pose& start);
  static void planar_state(const Planar& planar, double t, Pose& pose, Velocity& velocity);

  std::variant<FreeMotion, Planar, Timed> kind_ = FreeMotion{};
};

}  // namespace crashrank
