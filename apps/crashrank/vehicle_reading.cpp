#include "vehicle_reading.hpp"

#include "crashrank/vehicle/box_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <utility>

namespace crashrank::cli {

using Eigen::Vector3d;

BodyKind guess_kind(const std::string& stem, const Vector3d& extent_m, bool has_wheels) {
  constexpr std::array<std::pair<const char*, BodyKind>, 16> words{
      {{"truck", BodyKind::truck},
       {"lorry", BodyKind::truck},
       {"bus", BodyKind::bus},
       {"tram", BodyKind::bus},
       {"motorcycle", BodyKind::motorcycle},
       {"motorbike", BodyKind::motorcycle},
       {"bicycle", BodyKind::bicycle},
       {"cyclist", BodyKind::bicycle},
       {"pedestrian", BodyKind::pedestrian},
       {"person", BodyKind::pedestrian},
       {"wheelchair", BodyKind::pedestrian},
       {"barrier", BodyKind::barrier},
       {"pole", BodyKind::pole},
       {"tree", BodyKind::pole},
       {"wall", BodyKind::building},
       {"building", BodyKind::building}}};
  std::string lower = stem;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [word, kind] : words) {
    if (lower.find(word) != std::string::npos) return kind;
  }
  constexpr double longest_car_m = 6.5;
  const double longest = extent_m.maxCoeff();
  if (!has_wheels && !detail::has_vehicle_size(extent_m) && longest == extent_m.z() &&
      longest < 2.3) {
    return BodyKind::pedestrian;
  }
  return longest > longest_car_m ? BodyKind::truck : BodyKind::car;
}

bool drives(BodyKind kind) { return box_axles(kind).wheelbase > 0.0; }

SeenAxles find_axles(const TriangleMesh& mesh, BodyKind kind) {
  if (!drives(kind)) return {};
  std::shared_ptr<const Profile> profile;
  if (Result<Profile> made = make_profile(mesh)) {
    profile = std::make_shared<const Profile>(std::move(*made));
  }
  const auto described = [&](BodyKind as) {
    VehicleFacts facts;
    facts.kind = as;
    return describe_vehicle(mesh, facts, profile);
  };
  // Axles of lorries are those seen, of cars also a guess.
  const Result<Vehicle> seen = described(BodyKind::truck);
  const Result<Vehicle> vehicle = described(kind);
  const Box box = mesh.bounds();
  const double length_m = static_cast<double>(box.extent().x());
  const BoxAxles usual = box_axles(kind);
  SeenAxles axles{static_cast<double>(box.min.x()) + usual.rear_overhang * length_m,
                  usual.wheelbase * length_m, false};
  if (vehicle && vehicle->wheelbase_m > 0.0) {
    axles = {vehicle->rear_axle_x_m, vehicle->wheelbase_m,
             seen && seen->wheelbase_m == vehicle->wheelbase_m};
  }
  return axles;
}

Vector3d guess_origin(const TriangleMesh& mesh, const SeenAxles& axles) {
  const Box box = mesh.bounds();
  Vector3d origin = box.center().cast<double>();
  if (axles.wheelbase_m > 0.0) origin.x() = axles.rear_x_m;
  origin.z() = static_cast<double>(box.min.z());
  // What is near was meant: bodies without their wheels begin above the ground.
  constexpr double near_m = 0.3;
  constexpr double millimetres_per_m = 1e3;
  for (double& along : origin) {
    along =
        std::abs(along) > near_m ? std::round(millimetres_per_m * along) / millimetres_per_m : 0.0;
  }
  return origin;
}

Result<ImportTransform> guess_transform(TriangleMesh& mesh, BodyKind kind,
                                        const detail::MeshReading& reading, SeenAxles& axles) {
  ImportTransform guess;
  if (drives(kind)) {
    guess.scale = reading.scale;
    guess.forward = reading.forward;
    guess.up = reading.up;
  }
  if (Status moved = transform_mesh(mesh, guess); !moved) return moved.error();
  axles = find_axles(mesh, kind);
  guess.origin_m = guess_origin(mesh, axles);
  return guess;
}

std::string options_text(const ImportTransform& transform) {
  const Vector3d& origin = transform.origin_m;
  return fmt::format("--scale {:g} --up {} --forward {} --origin {:g},{:g},{:g}", transform.scale,
                     axis_name(transform.up), axis_name(transform.forward), origin.x(), origin.y(),
                     origin.z());
}

}  // namespace crashrank::cli
