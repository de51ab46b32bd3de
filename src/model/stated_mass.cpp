#include "crashrank/model/model.hpp"

#include "crashrank/internal/base/guarded.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace crashrank {
namespace {

using Eigen::Vector3d;

constexpr const char* inertia_place = "yaw inertia";
constexpr const char* inertia_remedy =
    "state it in kg m2 about the centre of mass, or leave it out";

std::string six_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string point_text(const Vector3d& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", p.x(), p.y(), p.z());
  return text;
}

Error unsound(const char* place, std::string reason, const char* remedy) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), remedy);
  error.place = place;
  return error;
}

Status check_center(const Vector3d& center_m, const Box& bounds) {
  constexpr const char* place = "centre of mass";
  constexpr double farthest_m = 2000.0;
  constexpr double beside_m = 1e-6;
  const Vector3d low = bounds.min.cast<double>();
  const Vector3d high = bounds.max.cast<double>();
  const bool within = ((center_m - low).array() >= -beside_m).all() &&
                      ((high - center_m).array() >= -beside_m).all();
  if (!within) {
    return unsound(place,
                   point_text(center_m) + " m is not within the body's bounds, " + point_text(low) +
                       " to " + point_text(high) + " m",
                   "state it in body coordinates, m, or leave it out");
  }
  if (!(center_m.cwiseAbs().maxCoeff() <= farthest_m)) {
    return unsound(place, point_text(center_m) + " m is more than 2 km from the body's origin",
                   "move the origin nearer, or leave it out");
  }
  return Success{};
}

Status check_all(const StatedMass& stated, const Box& bounds) {
  const auto sound = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (stated.mass_kg && !sound(*stated.mass_kg)) {
    return unsound("mass", six_digits(*stated.mass_kg) + " kg is not a finite number above 0",
                   "state it in kg, or leave it out");
  }
  if (stated.center_of_mass_m) {
    if (Status status = check_center(*stated.center_of_mass_m, bounds); !status) return status;
  }
  if (!stated.yaw_inertia_kgm2) return Success{};
  if (!sound(*stated.yaw_inertia_kgm2)) {
    return unsound(inertia_place,
                   six_digits(*stated.yaw_inertia_kgm2) + " kg m2 is not a finite number above 0",
                   inertia_remedy);
  }
  if (!stated.mass_kg) return Success{};
  return check_yaw_inertia(*stated.yaw_inertia_kgm2, *stated.mass_kg,
                           bounds.extent().cast<double>());
}

}  // namespace

Status check_yaw_inertia(double yaw_inertia_kgm2, double mass_kg, const Vector3d& extent_m) {
  return detail::guarded([&]() -> Status {
    const double block = extent_m.head<2>().squaredNorm() / 12.0;
    const double least = 0.01 * mass_kg * block;
    const double most = mass_kg * std::max(3.0 * block, 1e-4);
    if (yaw_inertia_kgm2 >= least && yaw_inertia_kgm2 <= most) return Success{};
    return unsound(inertia_place,
                   "a yaw inertia of " + six_digits(yaw_inertia_kgm2) + " kg m2 is not from " +
                       six_digits(least) + " to " + six_digits(most) + ", which " +
                       six_digits(mass_kg) + " kg of the body's size can have",
                   inertia_remedy);
  });
}

Status check_stated_mass(const StatedMass& stated, const Box& bounds) {
  return detail::guarded([&] { return check_all(stated, bounds); });
}

}  // namespace crashrank
