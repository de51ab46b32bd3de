#pragma once

#include "crashrank/crash/contact_law.hpp"
#include "crashrank/interop/frames.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include "base/random.hpp"
#include "oracle/shipped_models.hpp"
#include "tree/shapes.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::test {

/// A mesh of a vertical prism with a regular polygon as base, for posts and poles.
inline TriangleMesh prism_mesh(double radius, double height, std::uint32_t sides) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double round = 2.0 * detail::pi * i / sides;
    for (const double z : {0.0, height}) {
      mesh.vertices.push_back(
          Eigen::Vector3d(radius * std::cos(round), radius * std::sin(round), z).cast<float>());
    }
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t j = (i + 1) % sides;
    mesh.triangles.push_back({2 * i, 2 * j, 2 * j + 1});
    mesh.triangles.push_back({2 * i, 2 * j + 1, 2 * i + 1});
    if (i == 0 || j == 0) continue;
    mesh.triangles.push_back({0, 2 * j, 2 * i});
    mesh.triangles.push_back({1, 2 * i + 1, 2 * j + 1});
  }
  return mesh;
}

/// A mesh of a box on the ground, centred at the origin.
inline TriangleMesh block_mesh(double length, double width, double height) {
  return box_mesh({0.5 * length, 0.5 * width, 0.5 * height}, {0, 0, 0.5 * height});
}

inline Vehicle vehicle_from(const TriangleMesh& mesh, const VehicleFacts& facts) {
  Result<Vehicle> vehicle = describe_vehicle(mesh, facts);
  if (!vehicle) throw std::runtime_error(vehicle.error().message());
  return std::move(*vehicle);
}

inline Vehicle vehicle_from(const TriangleMesh& mesh, BodyKind kind) {
  VehicleFacts facts;
  facts.kind = kind;
  return vehicle_from(mesh, facts);
}

/// A body without rigid core, hardening and displaced mass: the same crush law on all sides and at
/// all heights.
inline Vehicle uniform_block(double length, double width, double height, double mass_kg,
                             const CrushLaw& law) {
  VehicleFacts facts;
  facts.mass_kg = mass_kg;
  Vehicle v = vehicle_from(block_mesh(length, width, height), facts);
  v.center_m = Eigen::Vector3d(0, 0, 0.5 * height);
  v.density_kgm3 = 0.0;
  v.strength = CrushStrength{};
  v.strength.front = v.strength.side = v.strength.rear = law;
  v.strength.low_m = 0.0;
  v.strength.high_m = height;
  return v;
}

/// A model from data/models.
struct ShippedModel {
  const char* name;
  BodyKind kind;
};

inline constexpr ShippedModel movable_models[] = {{"sedan", BodyKind::car},
                                                  {"hatch", BodyKind::car},
                                                  {"truck", BodyKind::truck},
                                                  {"motorcycle", BodyKind::motorcycle},
                                                  {"pedestrian", BodyKind::pedestrian}};
inline constexpr ShippedModel fixed_models[] = {
    {"wall", BodyKind::building}, {"jersey_barrier", BodyKind::barrier}, {"pole", BodyKind::pole}};
inline constexpr double post_diameters_m[] = {0.06, 0.12, 0.25};

inline TriangleMesh shipped_mesh(const std::string& name) {
  Result<TriangleMesh> mesh =
      oracle::read_obj(std::string(CRASHRANK_MODEL_FOLDER "/") + name + ".obj");
  if (!mesh) throw std::runtime_error(mesh.error().message());
  return std::move(*mesh);
}

/// A body for random contacts.
struct NamedBody {
  std::string name;
  Vehicle vehicle;
};

/// All bodies for random contacts: movable models, then fixed models and posts. Optionally
/// mirrored.
struct BodySet {
  std::vector<NamedBody> movable;
  std::vector<NamedBody> fixed;

  explicit BodySet(bool mirror) {
    const auto described = [&](TriangleMesh mesh, BodyKind kind) {
      return vehicle_from(mirror ? mirrored(std::move(mesh)) : std::move(mesh), kind);
    };
    for (const ShippedModel& m : movable_models) {
      movable.push_back({m.name, described(shipped_mesh(m.name), m.kind)});
    }
    for (const ShippedModel& m : fixed_models) {
      fixed.push_back({m.name, described(shipped_mesh(m.name), m.kind)});
    }
    for (const double diameter : post_diameters_m) {
      const int mm = static_cast<int>(std::lround(1000.0 * diameter));
      fixed.push_back({"post of " + std::to_string(mm) + " mm",
                       described(prism_mesh(0.5 * diameter, 3.0, 16), BodyKind::pole)});
    }
  }
  std::size_t size() const { return movable.size() + fixed.size(); }
  const NamedBody& any(std::size_t i) const {
    return i < movable.size() ? movable[i] : fixed[i - movable.size()];
  }
};

inline const BodySet& test_bodies() {
  static const BodySet one(false);
  return one;
}
inline const BodySet& mirrored_bodies() {
  static const BodySet one(true);
  return one;
}

/// Two bodies at first contact.
struct ContactScene {
  ContactBody a;
  ContactBody b;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
};

struct OutlineEnds {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

inline std::vector<OutlineEnds> outline_in_world(const ContactBody& body, std::size_t band) {
  std::vector<OutlineEnds> ends;
  const Profile& profile = *body.vehicle->profile;
  for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
    const OutlinePiece& piece = profile.pieces[i];
    const Eigen::Vector2d middle(piece.x, piece.y);
    const Eigen::Vector2d half =
        0.5 * static_cast<double>(piece.length_m) *
        Eigen::Vector2d(static_cast<double>(-piece.normal_y), static_cast<double>(piece.normal_x));
    const Eigen::Matrix2d turn = body.pose.rotation.topLeftCorner<2, 2>();
    const Eigen::Vector2d at = body.pose.translation.head<2>();
    ends.push_back({turn * (middle - half) + at, turn * (middle + half) + at});
  }
  return ends;
}

/// Distance that A can travel along a unit direction until the outlines of a height band touch;
/// infinity if they never do. Sets the point of contact.
inline double travel_to_contact(const ContactBody& a, const ContactBody& b,
                                const Eigen::Vector2d& direction, Eigen::Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  const auto cross = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return p.x() * q.y() - p.y() * q.x();
  };
  for (std::size_t band = 0; band < profile_bands; ++band) {
    const std::vector<OutlineEnds> of_a = outline_in_world(a, band);
    const std::vector<OutlineEnds> of_b = outline_in_world(b, band);
    // Vertices of one outline against segments of the other; `sign` is 1 if the vertices move.
    const auto sweep = [&](const std::vector<OutlineEnds>& vertices,
                           const std::vector<OutlineEnds>& segments, double sign) {
      std::vector<std::pair<double, double>> ranges;
      for (const OutlineEnds& s : segments) {
        const double p = cross(direction, s.from);
        const double q = cross(direction, s.to);
        ranges.emplace_back(std::min(p, q), std::max(p, q));
      }
      for (const OutlineEnds& v : vertices) {
        const double lane = cross(direction, v.from);
        for (std::size_t k = 0; k < segments.size(); ++k) {
          if (lane < ranges[k].first || lane > ranges[k].second) continue;
          const OutlineEnds& s = segments[k];
          const double p = cross(direction, s.from);
          const double q = cross(direction, s.to);
          const double share = p == q ? 0.0 : (lane - p) / (q - p);
          const Eigen::Vector2d hit = s.from + share * (s.to - s.from);
          const double travel = sign * direction.dot(hit - v.from);
          if (travel < least) {
            least = travel;
            point = sign > 0.0 ? hit : v.from;
          }
        }
      }
    };
    sweep(of_a, of_b, 1.0);
    sweep(of_b, of_a, -1.0);
  }
  return least;
}

/// Moves A along the relative velocity until its outline is `gap_m` from B's. Returns false if they
/// would pass each other.
inline bool move_to_contact(ContactScene& scene, double gap_m) {
  const Eigen::Vector3d closing = scene.a.velocity.linear_mps - scene.b.velocity.linear_mps;
  const Eigen::Vector2d direction = closing.head<2>().normalized();
  constexpr double far_m = 60.0;
  scene.a.pose.translation.head<2>() -= far_m * direction;
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  const double travel = travel_to_contact(scene.a, scene.b, direction, point);
  if (!std::isfinite(travel)) return false;
  scene.a.pose.translation.head<2>() += (travel - gap_m) * direction;
  scene.point_m = Eigen::Vector3d(point.x(), point.y(), 0.5);
  return true;
}

inline Pose flat_pose(double x, double y, double yaw) {
  return pose_from_angles({x, y, 0}, yaw, 0, 0);
}

/// The two bodies of a contact.
struct Pairing {
  std::size_t a = 0;  ///< index into `BodySet::movable`
  std::size_t b = 0;  ///< index for `BodySet::any`
};

/// Random headings, directions and offsets. B moves in half of the contacts in which it is movable.
/// Uses the same random numbers for all bodies.
struct ContactDraw {
  double yaw_a;
  double yaw_b;
  double course;
  double offset;
  double share;
  double spin_a;
  double spin_b;

  explicit ContactDraw(Random& random)
      : yaw_a(random.uniform(-detail::pi, detail::pi)),
        yaw_b(random.uniform(-detail::pi, detail::pi)),
        course(random.uniform(-detail::pi, detail::pi)),
        offset(random.uniform(-1, 1)),
        share(std::max(0.0, random.uniform(-1, 1))),
        spin_a(random.uniform(-0.5, 0.5)),
        spin_b(random.uniform(-0.5, 0.5)) {}

  /// The draw mirrored at the plane y = 0.
  ContactDraw mirrored_copy() const {
    ContactDraw d = *this;
    for (double* value : {&d.yaw_a, &d.yaw_b, &d.course, &d.offset, &d.spin_a, &d.spin_b}) {
      *value = -*value;
    }
    return d;
  }
};

inline double half_diagonal(const Vehicle& v) {
  const Silhouettes& s = v.silhouettes;
  return 0.5 *
         std::hypot(static_cast<double>(s.max_x - s.min_x), static_cast<double>(s.max_y - s.min_y));
}

/// Sets up the contact of a draw; returns false if the bodies pass each other.
inline bool make_contact(const ContactDraw& draw, const Vehicle& a, const Vehicle& b,
                         double closing_mps, double gap_m, ContactScene& scene) {
  scene = {};
  scene.a.vehicle = &a;
  scene.b.vehicle = &b;
  const Eigen::Vector3d direction(std::cos(draw.course), std::sin(draw.course), 0);
  const Eigen::Vector3d aside(-direction.y(), direction.x(), 0);
  scene.a.pose = flat_pose(0, 0, draw.yaw_a);
  scene.b.pose = flat_pose(0, 0, draw.yaw_b);
  // Align the centres of the outlines, then offset A by a share of the distance at which they still
  // touch.
  const auto middle = [](const ContactBody& body) {
    const Silhouettes& s = body.vehicle->silhouettes;
    const Eigen::Vector3d local(0.5 * static_cast<double>(s.min_x + s.max_x),
                                0.5 * static_cast<double>(s.min_y + s.max_y), 0);
    return Eigen::Vector3d(body.pose.rotation * local);
  };
  const double reach = 0.7 * (half_diagonal(a) + half_diagonal(b));
  scene.a.pose.translation = draw.offset * reach * aside - middle(scene.a);
  scene.b.pose.translation = -middle(scene.b);
  const double share = b.movable() ? draw.share : 0.0;
  scene.a.velocity.linear_mps = (1.0 - share) * closing_mps * direction;
  scene.b.velocity.linear_mps = -share * closing_mps * direction;
  if (!move_to_contact(scene, gap_m)) return false;
  return true;
}

/// Gives both bodies a yaw rate.
inline void spin(const ContactDraw& draw, ContactScene& scene) {
  scene.a.velocity.angular_radps.z() = draw.spin_a;
  if (scene.b.vehicle->movable()) scene.b.velocity.angular_radps.z() = draw.spin_b;
}

/// Kinetic energy of planar motion, J, for the velocity of the centre of mass and the yaw rate.
inline double energy_j(const Vehicle& v, const Eigen::Vector3d& velocity, double yaw_rate) {
  if (!v.movable()) return 0.0;
  return 0.5 *
         (v.mass_kg * velocity.head<2>().squaredNorm() + v.yaw_inertia_kgm2 * yaw_rate * yaw_rate);
}

inline Eigen::Vector3d center_of(const ContactBody& body) {
  Eigen::Vector3d center = body.pose.rotation * body.vehicle->center_m + body.pose.translation;
  center.z() = 0.0;
  return center;
}

inline Eigen::Vector3d center_velocity(const ContactBody& body) {
  return velocity_of_point(body.velocity, body.pose.translation, center_of(body))
      .cwiseProduct(Eigen::Vector3d(1, 1, 0));
}

/// The value that the given share of the values does not exceed.
inline double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  return values[std::min(at, values.size() - 1)];
}

}  // namespace crashrank::test
