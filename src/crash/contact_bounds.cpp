#include "crash/contact_run.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

// Bounds. With E the energy of both about their common centre of mass, the speed v of the centres
// of mass against each other obeys M·v²/2 <= E, M the reduced mass. E falls but for rebounds, each
// of which restores at most e² <= 1/4 of what was lost since the one before.

double ContactRun::most_speed_mps() const {
  constexpr double most_restored = 0.25;
  const PlanarBody& p = motion_of(first_);
  const PlanarBody& q = motion_of(second());
  const double inverse = p.inverse_mass + q.inverse_mass;
  const auto turning = [](const PlanarBody& body) {
    return body.inverse_inertia > 0.0 ? body.spin * body.spin / body.inverse_inertia : 0.0;
  };
  const double speed = relative_speed();
  const double lost = over_ ? 0.0 : std::max(0.0, dissipated_j());
  const double twice =
      speed * speed / inverse + turning(p) + turning(q) + 2.0 * most_restored * lost;
  return (1.0 + 1e-9) * std::sqrt(twice * inverse);
}

double ContactRun::most_left_ns() const {
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  if (over_ || !(inverse > 0.0)) return 0.0;
  return ((1.0 + 1e-9) * relative_speed() + most_speed_mps()) / inverse;
}

double ContactRun::rounding_ns() const {
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  return inverse > 0.0 ? 1e-12 * speeds_before_mps_ / inverse : 0.0;
}

double ContactRun::least_whole_ns() const {
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  if (!(inverse > 0.0)) return 0.0;
  return std::max(0.0, (1.0 - 1e-9) * speed_before_mps_ - most_speed_mps()) / inverse;
}

double ContactRun::most_whole_ns() const {
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  if (!(inverse > 0.0)) return 0.0;
  return ((1.0 + 1e-9) * speed_before_mps_ + most_speed_mps()) / inverse;
}

double ContactRun::least_whole_j() const {
  constexpr double most_restored = 0.25;
  const double lost = dissipated_j();
  return std::max(0.0, (over_ ? lost : (1.0 - most_restored) * lost) - rounding_j());
}

double ContactRun::most_whole_j() const {
  const double lost = dissipated_j();
  if (over_) return lost;
  const double most = most_speed_mps();
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  return lost + 0.5 * most * most / inverse + rounding_j();
}

}  // namespace crashrank::detail
