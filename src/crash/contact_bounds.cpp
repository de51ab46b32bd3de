#include "crash/contact_run.hpp"

#include <algorithm>
#include <cmath>

namespace crashrank::detail {

// Bounds. Let E be the kinetic energy of both bodies about their common centre of mass, M the
// reduced mass and v the relative speed of the centres of mass: M·v²/2 <= E. E never grows except
// in rebounds, each of which restores at most e² <= 1/4 of the energy lost since the previous one.

double ContactRun::max_later_speed_mps() const {
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

double ContactRun::max_remaining_impulse_ns() const {
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  if (over_ || !(inverse > 0.0)) return 0.0;
  return ((1.0 + 1e-9) * relative_speed() + max_later_speed_mps()) / inverse;
}

double ContactRun::rounding_ns() const {
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  return inverse > 0.0 ? 1e-12 * speed_sum_before_mps_ / inverse : 0.0;
}

double ContactRun::min_total_impulse_ns() const {
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  if (!(inverse > 0.0)) return 0.0;
  return std::max(0.0, (1.0 - 1e-9) * speed_before_mps_ - max_later_speed_mps()) / inverse;
}

double ContactRun::max_total_impulse_ns() const {
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  if (!(inverse > 0.0)) return 0.0;
  return ((1.0 + 1e-9) * speed_before_mps_ + max_later_speed_mps()) / inverse;
}

double ContactRun::min_total_loss_j() const {
  constexpr double most_restored = 0.25;
  const double lost = dissipated_j();
  return std::max(0.0, (over_ ? lost : (1.0 - most_restored) * lost) - rounding_j());
}

double ContactRun::max_total_loss_j() const {
  const double lost = dissipated_j();
  if (over_) return lost;
  const double most = max_later_speed_mps();
  const double inverse = motion_of(first_).inverse_mass + motion_of(second()).inverse_mass;
  return lost + 0.5 * most * most / inverse + rounding_j();
}

}  // namespace crashrank::detail
