#include "crashrank/vehicle/vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank {

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
    case BodyKind::bus:
      return 13000.0;
    case BodyKind::motorcycle:
      return 250.0;
    case BodyKind::bicycle:
      return 90.0;
    case BodyKind::pedestrian:
      return 75.0;
    case BodyKind::barrier:
    case BodyKind::pole:
    case BodyKind::building:
      return std::numeric_limits<double>::infinity();
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace crashrank
