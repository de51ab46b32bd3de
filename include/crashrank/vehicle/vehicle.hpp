#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/vehicle/body_kind.hpp"
#include "crashrank/vehicle/silhouettes.hpp"
#include "crashrank/vehicle/strength.hpp"
#include "crashrank/vehicle/surface.hpp"

#include <Eigen/Core>

#include <limits>
#include <memory>
#include <optional>

namespace crashrank {

/// What is stated of a body besides its mesh; what is absent is derived.
struct VehicleFacts {
  BodyKind kind = BodyKind::car;                    ///< what it is
  std::optional<double> mass_kg;                    ///< absent: guessed from kind and size
  std::optional<Eigen::Vector3d> center_of_mass_m;  ///< body coordinates, m
  std::optional<double> yaw_inertia_kgm2;           ///< about the centre of mass
  double stiffness = 1.0;                           ///< times the kind's strength, > 0
  std::optional<Surface> surface;                   ///< absent: the kind's
};

/// Everything that a body is in a crash besides its triangles.
struct Vehicle {
  BodyKind kind = BodyKind::car;                             ///< what it is
  double mass_kg = std::numeric_limits<double>::infinity();  ///< infinity: nothing moves it
  bool mass_is_guessed = false;                              ///< neither stated nor fixed
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();        ///< of mass, body coordinates, m
  double yaw_inertia_kgm2 = 1.0;                             ///< not read where nothing moves it
  CrushStrength strength;                                    ///< what it takes to crush it
  Surface surface = Surface::sheet_metal;                    ///< decides friction
  double rear_axle_x_m = 0.0;                                ///< of two-axled vehicles, m
  double wheelbase_m = 0.0;                                  ///< 0 without wheels, m
  double leading_edge_m = 0.0;                               ///< see crash/injury.hpp
  double density_kgm3 = 0.0;                                 ///< mass over the profile's volume
  std::shared_ptr<const Profile> profile;                    ///< its outlines, never null
  Silhouettes silhouettes;                                   ///< of the profile

  /// False for a body that nothing moves.
  bool movable() const noexcept { return mass_kg < std::numeric_limits<double>::infinity(); }
};

/// Describes a body: what is stated of it, the rest derived from kind and mesh.
/// Cars: axles at the middles of the wheels where the lowest outlines show four, else a fifth and
/// four fifths of the length; centre of mass 0.58 of the wheelbase before the rear axle (58 % of
/// the load on the front axle, as passenger cars with front engines stand); radius of gyration
/// 0.29 of the length in yaw, as published for a mid-size saloon of 4.84 m, 1,621 kg and 3,167
/// kg·m². Other kinds: the middle of the box, and the inertia of an even block over its box.
/// `profile` null: made of the mesh. O(triangles). Errors: bad_input where no outline can be made,
/// or where the inertia is more than a ring around the body or less than 1 % of an even rod's.
CRASHRANK_API Result<Vehicle> describe_vehicle(const TriangleMesh& mesh, const VehicleFacts& facts,
                                               std::shared_ptr<const Profile> profile = nullptr);

}  // namespace crashrank
