#include "crashrank/crash/contact_law.hpp"

#include <cmath>
#include <numbers>

namespace crashrank {

double pdof_deg(const Eigen::Vector3d& impulse_on_body, const Eigen::Vector3d& forward) {
  const Eigen::Vector2d ahead = forward.head<2>();
  const Eigen::Vector2d from = -impulse_on_body.head<2>();
  const double x = from.dot(ahead);
  const double right = from.x() * ahead.y() - from.y() * ahead.x();
  if (x == 0.0 && right == 0.0) return 0.0;
  double degrees = std::atan2(right, x) * (180.0 / std::numbers::pi);
  if (degrees < 0.0) degrees += 360.0;
  return degrees >= 360.0 ? 0.0 : degrees;
}

int clock_of(double pdof_deg) {
  const int hour = static_cast<int>(std::floor((pdof_deg + 15.0) / 30.0)) % 12;
  return hour == 0 ? 12 : hour;
}

}  // namespace crashrank
