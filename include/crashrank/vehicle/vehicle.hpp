#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/internal/vehicle/silhouettes.hpp"
#include "crashrank/internal/vehicle/strength.hpp"
#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

/// Kind of a body. Selects its mass where none is stated.
enum class BodyKind {
  car,
  truck,
  bus,
  motorcycle,
  bicycle,
  pedestrian,
  barrier,
  pole,
  building,
};

/// "car", "truck", ... as in scenario files.
CRASHRANK_API const char* body_kind_name(BodyKind kind) noexcept;

/// Mass of a body from its kind and size, kg: a car −1333.5 + 526.9·(length·width)^0.8 and at least
/// 300, a truck 25000, a bus 13000, a motorcycle 250, a bicycle 90, rider included (TUM's planner
/// for harm-aware trajectories); a bus longer than 25 m, which is a tram, 1500 a metre; a
/// pedestrian 75·(height/1.75 m)^2.7, an adult in a wheelchair, known by length and width, 93.
/// Barriers, poles and buildings do not move: infinity. `extent_m` is length, width without
/// mirrors, height.
CRASHRANK_API double guess_mass_kg(BodyKind kind, const Eigen::Vector3d& extent_m);

/// The same of a mesh. A car's width is that of what is lower than its mirrors. O(triangles).
CRASHRANK_API double guess_mass_kg(BodyKind kind, const TriangleMesh& mesh);

/// Outer material of a body. Selects the friction of a contact, together with that of the body it
/// touches.
enum class Surface {
  sheet_metal,  ///< painted panels of a vehicle
  steel,        ///< guard rails, steel poles, machinery
  concrete,     ///< walls, barriers, masonry
  wood,         ///< trees, timber posts, fences
  rubber,       ///< tyres, crash cushions
  person,       ///< clothing and skin
};

/// "sheet-metal", "steel", "concrete", "wood", "rubber", "person", as in scenario files.
CRASHRANK_API const char* surface_name(Surface surface) noexcept;

/// Inverse of `surface_name`. Errors: usage; the remedy lists the names.
CRASHRANK_API Result<Surface> surface_from_name(const std::string& name);

/// Load at which the foot of a post gives way and its stated mass is free: a slip base, a shear
/// bolt, a hinge. Until then the post is fixed.
struct Breakaway {
  double force_n = std::numeric_limits<double>::infinity();  ///< horizontal force, N, > 0
  /// Moment of that force about the foot, N·m, > 0: the force times its height over the ground.
  double moment_nm = std::numeric_limits<double>::infinity();

  /// Equal in all numbers.
  friend bool operator==(const Breakaway& a, const Breakaway& b) noexcept {
    return a.force_n == b.force_n && a.moment_nm == b.moment_nm;
  }
};

/// How far a fixed rail gives way where a body presses on it, and at which force.
struct Deflection {
  double distance_m = 0.0;  ///< m, > 0; rigid from there on
  double force_n = 0.0;     ///< normal force, constant, N, > 0

  /// Equal in all numbers.
  friend bool operator==(const Deflection& a, const Deflection& b) noexcept {
    return a.distance_m == b.distance_m && a.force_n == b.force_n;
  }
};

/// Force at which a rail gives way that was tested with a car of 1,500 kg at 110 km/h and 20
/// degrees (TB32 of EN 1317-2) and deflected by `distance_m` then, N. Of the kinetic energy of the
/// motion across the rail, 82 kJ, the share that goes into the rail in this model, the rest into
/// the car.
inline double rail_force_n(double distance_m) { return 0.7 * 82e3 / distance_m; }

/// Stated properties of a body besides its mesh; absent ones are derived.
struct VehicleFacts {
  BodyKind kind = BodyKind::car;                    ///< kind of the body
  std::optional<double> mass_kg;                    ///< absent: guessed from kind and size
  std::optional<Eigen::Vector3d> center_of_mass_m;  ///< body coordinates, m; absent: derived
  std::optional<double> yaw_inertia_kgm2;           ///< about the centre of mass; absent: derived
  double stiffness = 1.0;                           ///< times the kind's strength, > 0
  std::optional<Surface> surface;                   ///< absent: the kind's
  std::optional<Honeycomb> honeycomb;               ///< replaces the kind's strength
  std::optional<Breakaway> breakaway;               ///< of a fixed body; its mass is that set free
  std::optional<Deflection> deflection;             ///< of a fixed body without mass
};

/// Properties of a body in a crash besides its triangles.
struct Vehicle {
  BodyKind kind = BodyKind::car;                             ///< kind of the body
  double mass_kg = std::numeric_limits<double>::infinity();  ///< infinity: fixed
  bool mass_is_guessed = false;                              ///< neither stated nor fixed
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();        ///< of mass, body coordinates, m
  double yaw_inertia_kgm2 = 1.0;                             ///< not read where nothing moves it
  CrushStrength strength;                                    ///< resistance to crushing
  Surface surface = Surface::sheet_metal;                    ///< decides friction
  double rear_axle_x_m = 0.0;                                ///< middle of its group of axles, m
  double wheelbase_m = 0.0;                                  ///< 0 where no axles are known, m
  double leading_edge_m = 0.0;                               ///< see crash/injury.hpp
  double density_kgm3 = 0.0;                                 ///< mass over the profile's volume
  std::shared_ptr<const Profile> profile;                    ///< its outlines, never null
  Silhouettes silhouettes;                                   ///< of the profile
  /// By piece of the profile, 1 where it faces the other side of a joint between parts of the body
  /// and presses on nothing; empty: none does.
  std::vector<std::uint8_t> in_joint;
  std::optional<Breakaway> breakaway;    ///< fixed until then
  std::optional<Deflection> deflection;  ///< of a fixed body

  /// False: nothing presses on it, see `make_profile`.
  bool has_outline() const noexcept { return profile != nullptr && profile->presses(); }
  /// False for a body that stays fixed.
  bool movable() const noexcept { return mass_kg < std::numeric_limits<double>::infinity(); }
  /// True for a body that is fixed before its first contact.
  bool stands() const noexcept { return !movable() || breakaway.has_value(); }
};

/// Returns the properties of a body: the stated ones, the others derived from kind and mesh.
///
/// Axles of cars, trucks and buses: at the middles of the wheels where the lowest outlines show
/// those of two axles; else at a fifth and four fifths of a car's length, and none for the others.
///
/// Centre of mass: the middle of the mesh's box, but for
/// - cars, 0.58 of the wheelbase before the rear axle (58 % of the load on the front axle, as
///   passenger cars with front engines stand);
/// - bicycles, 0.385 of the length before the rear end (the benchmark bicycle with rider of
///   Meijaard, Papadopoulos, Ruina and Schwab, Proc. R. Soc. A 463, 2007).
///
/// Radius of gyration in yaw:
/// - cars, 0.29 of the length, as published for a saloon of 4.84 m, 1,621 kg and 3,167 kg·m²;
/// - motorcycles with rider, 0.215 of the length: 0.45 m of a roadster of 2.1 m, 285 kg in all;
/// - bicycles with rider, 0.15 of the length (the benchmark bicycle: 0.25 m of 1.67 m);
/// - pedestrians, 0.077 of the height: standing adults measured 0.071 to 0.077 (Santschi, DuBois
///   and Omoto, AMRL-TDR-63-36, 1963), the upper end since legs and arms are apart in walking;
/// - poles, of an even cylinder; all others, of an even block over the box without mirrors, which a
///   laden lorry is about.
///
/// `profile` null: made of the mesh. O(triangles). Errors: bad_input for a mesh that
/// `make_profile` refuses, or as `check_yaw_inertia` and `check_stated_mass` for a stated inertia
/// and centre of mass.
CRASHRANK_API Result<Vehicle> describe_vehicle(const TriangleMesh& mesh, const VehicleFacts& facts,
                                               std::shared_ptr<const Profile> profile = nullptr);

}  // namespace crashrank
