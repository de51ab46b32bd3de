#include "crashrank/vehicle/vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace crashrank {
namespace {

/// Width of what is lower than mirrors, m: these are at two thirds of the height of cars, and above
/// 1.1 m on vans.
double low_width_m(const TriangleMesh& mesh) {
  constexpr double low_share = 0.55;
  constexpr double low_m = 1.1;
  const Box box = mesh.bounds();
  const double level = static_cast<double>(box.min.z()) +
                       std::min(low_m, low_share * static_cast<double>(box.extent().z()));
  double right = std::numeric_limits<double>::infinity();
  double left = -right;
  const auto reach = [&](double y) {
    right = std::min(right, y);
    left = std::max(left, y);
  };
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d a = mesh.vertices[triangle[i]].cast<double>();
      const Eigen::Vector3d b = mesh.vertices[triangle[(i + 1) % 3]].cast<double>();
      if (a.z() <= level) reach(a.y());
      if ((a.z() <= level) == (b.z() <= level)) continue;
      reach(a.y() + (level - a.z()) / (b.z() - a.z()) * (b.y() - a.y()));
    }
  }
  return std::max(left - right, 0.0);
}

/// Adults have 75 kg at 1.75 m. The family of Hybrid III dummies, from 16.2 kg at 0.95 m (three
/// years) to 101 kg at 1.88 m, grows with the power 2.7 of the height, within 13 %.
double person_mass_kg(const Eigen::Vector3d& extent_m) {
  constexpr double adult_kg = 75.0;
  constexpr double wheelchair_kg = 18.0;
  const double height_m = extent_m.z();
  // A person who sits on wheels is longer and wider for the height than one who walks.
  if (height_m > 1.0 && height_m < 1.6 && extent_m.x() > 0.65 * height_m &&
      extent_m.y() > 0.42 * height_m) {
    return adult_kg + wheelchair_kg;
  }
  return adult_kg * std::pow(std::clamp(extent_m.maxCoeff(), 0.7, 2.1) / 1.75, 2.7);
}

}  // namespace

const char* body_kind_name(BodyKind kind) noexcept {
  switch (kind) {
    case BodyKind::car:
      return "car";
    case BodyKind::truck:
      return "truck";
    case BodyKind::bus:
      return "bus";
    case BodyKind::motorcycle:
      return "motorcycle";
    case BodyKind::bicycle:
      return "bicycle";
    case BodyKind::pedestrian:
      return "pedestrian";
    case BodyKind::barrier:
      return "barrier";
    case BodyKind::pole:
      return "pole";
    case BodyKind::building:
      return "building";
  }
  return "car";
}

double guess_mass_kg(BodyKind kind, const Eigen::Vector3d& extent_m) {
  switch (kind) {
    case BodyKind::car:
      return std::max(300.0, -1333.5 + 526.9 * std::pow(extent_m.x() * extent_m.y(), 0.8));
    case BodyKind::truck:
      return 25000.0;
    case BodyKind::bus: {
      // Longer than any bus: a tram. Low-floor ones have 1.25 to 1.35 t/m empty (Combino, Flexity,
      // Citadis), and people on half of their places.
      constexpr double longest_bus_m = 25.0;
      constexpr double tram_kg_per_m = 1500.0;
      return extent_m.x() > longest_bus_m ? tram_kg_per_m * extent_m.x() : 13000.0;
    }
    case BodyKind::motorcycle:
      return 250.0;
    case BodyKind::bicycle:
      return 90.0;
    case BodyKind::pedestrian:
      return person_mass_kg(extent_m);
    case BodyKind::barrier:
    case BodyKind::pole:
    case BodyKind::building:
      return std::numeric_limits<double>::infinity();
  }
  return std::numeric_limits<double>::infinity();
}

double guess_mass_kg(BodyKind kind, const TriangleMesh& mesh) {
  Eigen::Vector3d extent_m = mesh.bounds().extent().cast<double>();
  if (kind == BodyKind::car) extent_m.y() = low_width_m(mesh);
  return guess_mass_kg(kind, extent_m);
}

}  // namespace crashrank
