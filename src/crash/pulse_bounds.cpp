#include "crash/pulse_run.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

double turning_j(const PlanarBody& body) {
  return body.inverse_inertia > 0.0 ? 0.5 * body.spin * body.spin / body.inverse_inertia : 0.0;
}

}  // namespace

/// The centres of mass never again move faster against each other: all kinetic energy about the
/// common centre of mass in their speed.
double PulseRun::most_speed_mps() const {
  const double inverse = a_.inverse_mass + b_.inverse_mass;
  const double speed = (a_.velocity - b_.velocity).norm();
  const double turns = 2.0 * (turning_j(a_) + turning_j(b_));
  return (1.0 + 1e-9) * std::sqrt(speed * speed + turns * inverse);
}

double PulseRun::most_left_ns() const {
  const double inverse = a_.inverse_mass + b_.inverse_mass;
  if (over_ || !(inverse > 0.0)) return 0.0;
  const double speed = (a_.velocity - b_.velocity).norm();
  return ((1.0 + 1e-9) * speed + most_speed_mps()) / inverse;
}

double PulseRun::rounding_ns() const {
  const double inverse = a_.inverse_mass + b_.inverse_mass;
  return inverse > 0.0 ? 1e-12 * speeds_before_mps_ / inverse : 0.0;
}

double PulseRun::least_whole_ns() const {
  const double inverse = a_.inverse_mass + b_.inverse_mass;
  if (!(inverse > 0.0)) return 0.0;
  return std::max(0.0, (1.0 - 1e-9) * speed_before_mps_ - most_speed_mps()) / inverse;
}

double PulseRun::most_whole_ns() const {
  const double inverse = a_.inverse_mass + b_.inverse_mass;
  if (!(inverse > 0.0)) return 0.0;
  return ((1.0 + 1e-9) * speed_before_mps_ + most_speed_mps()) / inverse;
}

double PulseRun::most_left_j() const {
  const double inverse = a_.inverse_mass + b_.inverse_mass;
  if (over_ || !(inverse > 0.0)) return 0.0;
  const double speed = (a_.velocity - b_.velocity).norm();
  return (1.0 + 1e-9) * (0.5 * speed * speed / inverse + turning_j(a_) + turning_j(b_)) +
         1e-12 * energy_before_j_;
}

double PulseRun::moving_j() const {
  const auto moving = [](const PlanarBody& body) {
    return body.inverse_mass > 0.0 ? 0.5 * body.velocity.squaredNorm() / body.inverse_mass : 0.0;
  };
  return moving(a_) + moving(b_) + turning_j(a_) + turning_j(b_);
}

}  // namespace crashrank::detail
