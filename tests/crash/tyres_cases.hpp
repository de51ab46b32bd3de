#pragma once

#include "base/random.hpp"
#include "crash/tyres.hpp"
#include "crashrank/interop/frames.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace crashrank::test {

inline constexpr double gravity_mps2 = 9.80665;

/// A mid-size car with 58 % of its load on the front axle.
struct Saloon {
  double mass_kg = 1680.0;
  double inertia_kgm2 = 3280.0;
  detail::Footing footing;

  Saloon() {
    footing.front_m = 0.42 * 2.8;
    footing.rear_m = -0.58 * 2.8;
    footing.y_m << 0.78, -0.78;
    footing.front_load << 0.29, 0.29;
    footing.rear_load << 0.21, 0.21;
    footing.wheels = true;
    footing.cornering = 9.5;
  }

  /// A body at the origin; heading and direction of the velocity from the x axis, rad.
  detail::PlanarBody body(double speed_mps, double heading, double direction,
                          double spin_radps) const {
    detail::PlanarBody b;
    b.inverse_mass = 1.0 / mass_kg;
    b.inverse_inertia = 1.0 / inertia_kgm2;
    b.cosine = std::cos(heading);
    b.sine = std::sin(heading);
    b.vx = speed_mps * std::cos(direction);
    b.vy = speed_mps * std::sin(direction);
    b.spin = spin_radps;
    return b;
  }
};

/// One step of free motion on the road.
inline void step_on_road(const detail::Footing& footing, const detail::Wheels& wheels, double grip,
                         double seconds, detail::PlanarBody& body) {
  body.move(0.5 * seconds);
  detail::apply_tyre_forces(footing, wheels, grip, seconds, body);
  body.move(0.5 * seconds);
}

inline void move_on_road(const detail::Footing& footing, const detail::Wheels& wheels, double grip,
                         double step_s, double until_s, detail::PlanarBody& body) {
  const auto steps = static_cast<int>(std::lround(until_s / step_s));
  for (int i = 0; i < steps; ++i) step_on_road(footing, wheels, grip, step_s, body);
}

inline bool at_rest(const detail::PlanarBody& b) {
  return b.vx == 0.0 && b.vy == 0.0 && b.spin == 0.0;
}

/// A random state of the wheels.
inline detail::Wheels random_wheels(Random& random, const detail::Footing& footing) {
  const auto after = static_cast<AfterContact>(random.below(3));
  const double steering = random.uniform(-0.6, 0.6);
  const double brake = random.uniform(0, 1);
  const unsigned damaged = random.below(2) == 0 ? 0U : random.below(16);
  return detail::wheels_after(footing, after, steering, brake, damaged);
}

/// A random footing, wheels or patches.
inline detail::Footing random_footing(Random& random) {
  detail::Footing f;
  f.front_m = random.uniform(0.1, 4.0);
  f.rear_m = -random.uniform(0.1, 4.0);
  const double left = random.uniform(0.05, 1.5);
  const double right = -random.uniform(0.05, 1.5);
  f.y_m << left, right;
  const double on_front = -f.rear_m / (f.front_m - f.rear_m);
  const double on_left = -right / (left - right);
  f.front_load << on_front * on_left, on_front * (1.0 - on_left);
  f.rear_load << (1.0 - on_front) * on_left, (1.0 - on_front) * (1.0 - on_left);
  f.wheels = random.below(4) != 0;
  f.cornering = f.wheels ? random.uniform(5.0, 20.0) : 0.0;
  return f;
}

/// A random moving body with random heading and direction of velocity.
inline detail::PlanarBody random_body(Random& random, const detail::Footing& f) {
  detail::PlanarBody b;
  const double gyration = random.uniform(0.3, 1.0) * (f.front_m - f.rear_m);
  b.inverse_mass = 1.0 / std::exp(random.uniform(std::log(50.0), std::log(4e4)));
  b.inverse_inertia = b.inverse_mass / (gyration * gyration);
  const double heading = random.uniform(-detail::pi, detail::pi);
  b.cosine = std::cos(heading);
  b.sine = std::sin(heading);
  // From 10 µm/s to 60 m/s, and up to 30 rad/s.
  const double speed = std::exp(random.uniform(std::log(1e-5), std::log(60.0)));
  const double direction = random.below(3) == 0 ? heading : random.uniform(-detail::pi, detail::pi);
  b.vx = speed * std::cos(direction);
  b.vy = speed * std::sin(direction);
  if (random.below(4) != 0) b.spin = random.uniform(-1, 1) * std::min(30.0, speed);
  return b;
}

/// A wheel of the reference model.
struct ReferenceWheel {
  double x_m = 0.0;
  double y_m = 0.0;
  double load = 0.0;  ///< share of the weight
  double steering_rad = 0.0;
  double brake = 0.0;  ///< share of grip·load
  bool locked = false;
};

/// Motion of a rigid body on wheels: explicit tyre forces, integrated with the classical
/// Runge-Kutta method of fourth order in steps of 0.1 ms. State: x, y, heading, velocity, yaw rate.
class ReferenceCar {
public:
  using State = Eigen::Matrix<double, 6, 1>;

  std::vector<ReferenceWheel> wheels;
  double mass_kg = 1680.0;
  double inertia_kgm2 = 3280.0;
  double grip = 0.8;
  double cornering = 9.5;

  State after(State s, double until_s) const {
    constexpr double h = 1e-4;
    const auto steps = static_cast<int>(std::lround(until_s / h));
    for (int i = 0; i < steps; ++i) {
      const State k1 = rate(s);
      const State k2 = rate(s + 0.5 * h * k1);
      const State k3 = rate(s + 0.5 * h * k2);
      const State k4 = rate(s + h * k3);
      s += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    return s;
  }

private:
  State rate(const State& s) const {
    const Eigen::Rotation2Dd heading(s[2]);
    Eigen::Vector2d force(0, 0);
    double moment = 0.0;
    for (const ReferenceWheel& w : wheels) {
      const Eigen::Vector2d arm = heading * Eigen::Vector2d(w.x_m, w.y_m);
      const Eigen::Vector2d v(s[3] - s[5] * arm.y(), s[4] + s[5] * arm.x());
      const double most = grip * w.load * mass_kg * gravity_mps2;
      Eigen::Vector2d f(0, 0);
      if (w.locked) {
        if (v.norm() > 1e-9) f = -most / v.norm() * v;
      } else {
        const Eigen::Rotation2Dd wheel(s[2] + w.steering_rad);
        const Eigen::Vector2d rolling = wheel.inverse() * v;
        const double tangent = std::abs(rolling.y()) / std::max(std::abs(rolling.x()), 1e-9);
        const double side = std::min(cornering * w.load * mass_kg * gravity_mps2 * tangent,
                                     std::sqrt(1.0 - w.brake * w.brake) * most);
        f = wheel * Eigen::Vector2d(-std::copysign(w.brake * most, rolling.x()),
                                    -std::copysign(side, rolling.y()));
      }
      force += f;
      moment += arm.x() * f.y() - arm.y() * f.x();
    }
    State r;
    r << s[3], s[4], s[5], force.x() / mass_kg, force.y() / mass_kg, moment / inertia_kgm2;
    return r;
  }
};

}  // namespace crashrank::test
