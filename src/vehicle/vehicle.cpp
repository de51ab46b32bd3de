#include "crashrank/vehicle/vehicle.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/model/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;

/// Slopes that stop a body that comes at this closing speed within a distance, borne by a width of
/// a quarter of a metre: what no crash of this model leaves behind.
constexpr double rigid_for_mps = 140.0;
constexpr double rigid_width_m = 0.25;

/// Without mirrors.
double body_width_m(BodyKind kind, const Vector3d& size) {
  constexpr double without_mirrors = 0.9;
  const bool mirrors = kind == BodyKind::car || kind == BodyKind::truck || kind == BodyKind::bus;
  return (mirrors ? without_mirrors : 1.0) * size.y();
}

struct Axles {
  double rear_x_m = 0.0;
  double wheelbase_m = 0.0;
};

/// Middles of the wheels, where the lowest band shows wheels alone at both ends.
std::optional<Axles> find_axles(const Profile& profile, double rear_x, double length) {
  constexpr double longest_wheel_m = 1.1;
  const double middle = rear_x + 0.5 * length;
  std::array<double, 2> low{1e9, 1e9};
  std::array<double, 2> high{-1e9, -1e9};
  for (std::uint32_t i = profile.first[0]; i < profile.first[1]; ++i) {
    const auto x = static_cast<double>(profile.pieces[i].x);
    const std::size_t end = x < middle ? 0 : 1;
    low[end] = std::min(low[end], x);
    high[end] = std::max(high[end], x);
  }
  for (std::size_t end = 0; end < 2; ++end) {
    if (!(high[end] > low[end]) || high[end] - low[end] > longest_wheel_m) return std::nullopt;
  }
  const double rear = 0.5 * (low[0] + high[0]);
  return Axles{rear, 0.5 * (low[1] + high[1]) - rear};
}

/// Middles of the rearmost and the foremost group of axles, where the lowest band shows wheels
/// alone: tandems, tridems and bogies are groups.
std::optional<Axles> find_axle_groups(const Profile& profile) {
  constexpr double least_gap_m = 0.3;
  constexpr double longest_wheel_m = 1.1;
  constexpr double widest_spacing_m = 2.1;  // of the axles of a bogie
  struct Wheel {
    double low;
    double high;
  };
  std::vector<double> places;
  for (std::uint32_t i = profile.first[0]; i < profile.first[1]; ++i) {
    places.push_back(static_cast<double>(profile.pieces[i].x));
  }
  std::sort(places.begin(), places.end());
  std::vector<Wheel> wheels;
  for (const double x : places) {
    if (wheels.empty() || x - wheels.back().high > least_gap_m) wheels.push_back({x, x});
    wheels.back().high = x;
    if (x - wheels.back().low > longest_wheel_m) return std::nullopt;
  }
  const auto middle = [](const Wheel& a, const Wheel& b) { return 0.5 * (a.low + b.high); };
  const auto apart = [&](const Wheel& a, const Wheel& b) {
    return middle(b, b) - middle(a, a) > widest_spacing_m;
  };
  const auto behind = std::adjacent_find(wheels.begin(), wheels.end(), apart);
  if (behind == wheels.end()) return std::nullopt;
  const auto front = std::adjacent_find(
      wheels.rbegin(), wheels.rend(), [&](const Wheel& b, const Wheel& a) { return apart(a, b); });
  const double rear_x = middle(wheels.front(), *behind);
  return Axles{rear_x, middle(*front, wheels.back()) - rear_x};
}

/// Wheels of two axles, of other vehicles than cars also groups of axles; a fifth and four fifths
/// of a car's length where none are seen. Without wheelbase for other kinds.
Axles axles_of(BodyKind kind, const Profile& profile, double rear_x, double length) {
  const bool car = kind == BodyKind::car;
  if (!car && kind != BodyKind::truck && kind != BodyKind::bus) return {};
  const Axles unseen = car ? Axles{rear_x + 0.2 * length, 0.6 * length} : Axles{};
  std::optional<Axles> seen = find_axles(profile, rear_x, length);
  if (!seen && !car) seen = find_axle_groups(profile);
  return seen.value_or(unseen);
}

/// x of the centre of mass, from the ends of the box or from the axles.
double center_x(BodyKind kind, const Axles& axles, double rear_x, double length) {
  constexpr double front_load_of_cars = 0.58;
  constexpr double bicycle = 0.385;
  if (kind == BodyKind::car) return axles.rear_x_m + front_load_of_cars * axles.wheelbase_m;
  return rear_x + (kind == BodyKind::bicycle ? bicycle : 0.5) * length;
}

/// Square of the radius of gyration in yaw, m². `size` is length, width, height.
double gyration2(BodyKind kind, const Vector3d& size) {
  constexpr double car = 0.29;
  constexpr double motorcycle = 0.215;
  constexpr double bicycle = 0.15;
  constexpr double pedestrian = 0.077;
  const auto square = [](double x) { return x * x; };
  switch (kind) {
    case BodyKind::car:
      return square(car * size.x());
    case BodyKind::motorcycle:
      return square(motorcycle * size.x());
    case BodyKind::bicycle:
      return square(bicycle * size.x());
    case BodyKind::pedestrian:
      return square(pedestrian * size.z());
    case BodyKind::pole:
      return (square(size.x()) + square(size.y())) / 16.0;
    default:
      return (square(size.x()) + square(body_width_m(kind, size))) / 12.0;
  }
}

CrushStrength even_strength(double yield_npm, double slope_npm2, double length_m, double height_m) {
  CrushStrength strength;
  strength.front = {yield_npm, slope_npm2, length_m};
  strength.side = strength.front;
  strength.rear = strength.front;
  strength.low_m = 0.0;
  strength.high_m = std::max(height_m, 0.1);
  return strength;
}

/// A core over the body's whole length. What is beside it bears as much until it folds, but does
/// not harden: mirrors, handlebars and arms hold no post as a chassis does.
CrushCore even_core(double half_width_m) {
  CrushCore core;
  core.rails_half_width_m = half_width_m;
  core.cage_half_width_m = half_width_m;
  return core;
}

/// Engine and chassis would stop the body from that speed within `stop_m`, what is behind `after_m`
/// of them within a hundredth of it.
void harden(CrushStrength& strength, double mass_kg, double stop_m, double after_m) {
  constexpr double rigid_share = 0.01;
  const auto slope = [mass_kg](double within_m) {
    return mass_kg * rigid_for_mps * rigid_for_mps / (rigid_width_m * within_m * within_m);
  };
  strength.hardening_npm2 = slope(stop_m);
  strength.rigid_npm2 = slope(rigid_share * stop_m);
  strength.hardening_length_m = after_m;
}

CrushStrength strength_of(const Vehicle& v, const Box& box) {
  // Of lorries and buses: bumper and front wall, then a cab with seats (a bus to its rear wall).
  constexpr double before_cab_m = 0.3;
  constexpr double cab_m = 2.0;
  // Half widths of what hardens, of the whole width: frame and engine within the handlebars, trunk
  // within the arms.
  constexpr double frame_share = 0.25;
  constexpr double trunk_share = 0.25;
  const Vector3d size = box.extent().cast<double>();
  CarShape shape;
  shape.mass_kg = v.mass_kg;
  shape.width_m = body_width_m(v.kind, size);
  shape.front_x_m = static_cast<double>(box.max.x());
  shape.rear_x_m = static_cast<double>(box.min.x());
  shape.rear_axle_x_m = v.rear_axle_x_m;
  shape.wheelbase_m = v.wheelbase_m;
  CrushStrength strength;
  switch (v.kind) {
    case BodyKind::car:
      strength = car_strength(shape);
      harden(strength, v.mass_kg, 5.0, 0.4);
      return strength;
    case BodyKind::truck:
    case BodyKind::bus:
      // Campbell's line for the mass, borne by the chassis over its whole width.
      strength = car_strength(shape);
      strength.core = even_core(0.5 * shape.width_m);
      strength.core.cage_front_m = shape.front_x_m - before_cab_m;
      strength.core.cage_rear_m = v.kind == BodyKind::truck ? strength.core.cage_front_m - cab_m
                                                            : shape.rear_x_m + before_cab_m;
      // A lorry's cab stands on its frame.
      if (v.kind == BodyKind::truck) strength.core.floor_m = 1.0;
      strength.low_m = 0.4;
      strength.high_m = 1.2;
      strength.front.length_m = 0.5;
      strength.side.length_m = 0.3;
      strength.rear.length_m = 0.3;
      harden(strength, v.mass_kg, 5.0, 0.3);
      return strength;
    case BodyKind::motorcycle:
      // Fork and front wheel, 0.12 m wide, shorten by about 0.03 m for each m/s above 3 in barrier
      // tests (a third of a metre at 13 m/s; Severy 1970, from memory): mass · 3 / 0.03 over the
      // width, and mass / 0.03², of the machine without its rider, which leaves it; then the engine
      // follows.
      strength = even_strength(10e3, 200e3, 0.35, size.z());
      strength.front.yield_npm = 160e3;
      strength.front.slope_npm2 = 1.7e6;
      strength.side.length_m = 0.15;
      strength.low_m = 0.1;
      strength.high_m = 0.7;
      strength.rest = 0.06;
      strength.core = even_core(frame_share * size.y());
      harden(strength, v.mass_kg, 1.0, 0.1);
      return strength;
    case BodyKind::bicycle:
      // Fork and front wheel fold over 0.35 m, then the frame and the rider follow.
      strength = even_strength(10e3, 200e3, 0.35, size.z());
      strength.side.length_m = 0.15;
      harden(strength, v.mass_kg, 1.0, 0.1);
      return strength;
    case BodyKind::pedestrian:
      // About 5 kN/m at no depth: what a chest bears over its breadth; bones behind 0.1 m.
      strength = even_strength(5e3, 50e3, 0.1, size.z());
      strength.core = even_core(trunk_share * size.y());
      harden(strength, v.mass_kg, 0.5, 0.05);
      return strength;
    case BodyKind::barrier:
    case BodyKind::pole:
    case BodyKind::building:
      break;
  }
  return CrushStrength::unyielding();
}

void scale(CrushStrength& strength, double factor) {
  for (CrushLaw* law : {&strength.front, &strength.side, &strength.rear}) {
    law->yield_npm *= factor;
    law->slope_npm2 *= factor;
  }
  strength.hardening_npm2 *= factor;
}

Surface surface_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::pedestrian:
      return Surface::person;
    case BodyKind::pole:
      return Surface::wood;
    case BodyKind::barrier:
    case BodyKind::building:
      return Surface::concrete;
    default:
      return Surface::sheet_metal;
  }
}

Result<Vehicle> described(const TriangleMesh& mesh, const VehicleFacts& facts,
                          std::shared_ptr<const Profile> profile) {
  constexpr double least_gyration2_m2 = 1e-6;
  Vehicle v;
  if (profile == nullptr) {
    Result<Profile> made = make_profile(mesh);
    if (!made) return made.error();
    profile = std::make_shared<const Profile>(std::move(*made));
  }
  v.kind = facts.kind;
  const Box box = mesh.bounds();
  const Vector3d size = box.extent().cast<double>();
  const auto rear_x = static_cast<double>(box.min.x());
  v.mass_kg = facts.mass_kg.value_or(guess_mass_kg(facts.kind, mesh));
  v.mass_is_guessed = !facts.mass_kg.has_value();
  v.center_m = box.center().cast<double>();
  v.leading_edge_m = 0.0;
  // What a vehicle is filled with is structure.
  v.profile = v.movable() && profile->has_inner()
                  ? std::make_shared<const Profile>(profile->filled())
                  : std::move(profile);
  v.silhouettes = make_silhouettes(*v.profile);
  const Axles axles = axles_of(v.kind, *v.profile, rear_x, size.x());
  v.rear_axle_x_m = axles.rear_x_m;
  v.wheelbase_m = axles.wheelbase_m;
  v.center_m.x() = center_x(v.kind, axles, rear_x, size.x());
  if (facts.center_of_mass_m) {
    StatedMass center;
    center.center_of_mass_m = v.center_m = *facts.center_of_mass_m;
    if (Status status = check_stated_mass(center, box); !status) return status.error();
  }
  if (v.movable()) {
    v.yaw_inertia_kgm2 = v.mass_kg * std::max(gyration2(v.kind, size), least_gyration2_m2);
    if (facts.yaw_inertia_kgm2) {
      v.yaw_inertia_kgm2 = *facts.yaw_inertia_kgm2;
      if (Status status = check_yaw_inertia(v.yaw_inertia_kgm2, v.mass_kg, size); !status) {
        return status.error();
      }
    }
    // No body is denser than steel; one that nothing presses on drags nothing along.
    constexpr double steel_kgm3 = 7850.0;
    const double volume_m3 = v.profile->volume_m3();
    v.density_kgm3 =
        v.has_outline() && volume_m3 > 0.0 ? std::min(steel_kgm3, v.mass_kg / volume_m3) : 0.0;
  }
  v.strength = facts.honeycomb ? honeycomb_strength(*facts.honeycomb)
               : v.movable()   ? strength_of(v, box)
                               : CrushStrength::unyielding();
  if (!v.strength.rigid) scale(v.strength, facts.stiffness);
  v.surface = facts.surface.value_or(surface_of(v.kind));
  v.breakaway = facts.breakaway;
  v.deflection = facts.deflection;
  return v;
}

}  // namespace

Result<Vehicle> describe_vehicle(const TriangleMesh& mesh, const VehicleFacts& facts,
                                 std::shared_ptr<const Profile> profile) {
  return detail::guarded([&] { return described(mesh, facts, std::move(profile)); });
}

}  // namespace crashrank
