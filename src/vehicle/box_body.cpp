#include "crashrank/vehicle/box_body.hpp"

#include "crashrank/internal/base/guarded.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;

/// A horizontal rectangle, lengths as shares of the box: z of the height, rear and front of the
/// length from the rear end, half_width of the width.
struct Section {
  double z;
  double rear;
  double front;
  double half_width;
};

/// A closed part through sections of rising height, its upright edges cut off.
struct Loft {
  std::string part;
  std::vector<Section> sections;
  double corner = 0.0;  ///< cut off, of the shorter side of each section
  double y = 0.0;       ///< of its middle, as a share of the width
};

/// Sections read from the outlines of the models in data/models: of cars from both, of lorries the
/// two-axled one; heads and arms of persons and riders as of the walking adult.
std::vector<Loft> shape_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::car:
      return {{"body",
               {{0.13, 0.04, 0.98, 0.47},
                {0.22, 0.0, 1.0, 0.49},
                {0.42, 0.0, 1.0, 0.5},
                {0.5, 0.0, 0.985, 0.5},
                {0.58, 0.01, 0.95, 0.49},
                {0.66, 0.015, 0.75, 0.48}},
               0.15},
              {"cabin",
               {{0.66, 0.03, 0.75, 0.46},
                {0.75, 0.055, 0.7, 0.42},
                {0.85, 0.09, 0.65, 0.39},
                {0.95, 0.13, 0.6, 0.35},
                {1.0, 0.18, 0.55, 0.31}},
               0.1}};
    case BodyKind::truck:
      return {{"chassis", {{0.13, 0.005, 0.8, 0.4}, {0.28, 0.0, 0.8, 0.4}}},
              {"cab",
               {{0.1, 0.8, 0.99, 0.47},
                {0.2, 0.79, 1.0, 0.49},
                {0.33, 0.79, 1.0, 0.5},
                {0.6, 0.79, 0.985, 0.5},
                {0.75, 0.79, 0.97, 0.49},
                {0.85, 0.8, 0.9, 0.46}},
               0.1},
              {"load", {{0.28, 0.0, 0.78, 0.5}, {1.0, 0.0, 0.78, 0.5}}}};
    case BodyKind::bus:
      return {{"body",
               {{0.08, 0.01, 0.99, 0.48},
                {0.12, 0.0, 1.0, 0.5},
                {0.9, 0.0, 0.99, 0.5},
                {1.0, 0.01, 0.97, 0.46}},
               0.05}};
    case BodyKind::motorcycle:
      return {{"frame",
               {{0.1, 0.05, 0.95, 0.08},
                {0.18, 0.0, 1.0, 0.08},
                {0.3, 0.05, 0.95, 0.08},
                {0.5, 0.25, 0.8, 0.1}}},
              {"engine",
               {{0.12, 0.2, 0.75, 0.2},
                {0.2, 0.1, 0.75, 0.3},
                {0.3, 0.05, 0.8, 0.36},
                {0.45, 0.05, 0.8, 0.37},
                {0.55, 0.2, 0.8, 0.3}}},
              {"rider",
               {{0.5, 0.3, 0.6, 0.37},
                {0.6, 0.33, 0.78, 0.5},
                {0.7, 0.37, 0.71, 0.5},
                {0.8, 0.4, 0.56, 0.4},
                {0.84, 0.44, 0.6, 0.17},
                {0.97, 0.45, 0.61, 0.17},
                {1.0, 0.48, 0.58, 0.12}},
               0.2}};
    case BodyKind::bicycle:
      return {{"frame",
               {{0.12, 0.05, 0.95, 0.05},
                {0.19, 0.0, 1.0, 0.05},
                {0.3, 0.05, 0.93, 0.05},
                {0.5, 0.25, 0.75, 0.08}}},
              {"rider",
               {{0.15, 0.4, 0.6, 0.25},
                {0.5, 0.25, 0.55, 0.3},
                {0.55, 0.25, 0.75, 0.5},
                {0.75, 0.35, 0.75, 0.45},
                {0.85, 0.45, 0.7, 0.36},
                {0.88, 0.52, 0.68, 0.14},
                {0.97, 0.52, 0.68, 0.14},
                {1.0, 0.55, 0.66, 0.1}},
               0.2}};
    case BodyKind::pedestrian:
      return {{"body",
               {{0.0, 0.0, 1.0, 0.27},
                {0.08, 0.0, 0.95, 0.27},
                {0.17, 0.1, 0.76, 0.27},
                {0.3, 0.3, 0.68, 0.28},
                {0.45, 0.28, 0.62, 0.48},
                {0.55, 0.25, 0.75, 0.5},
                {0.67, 0.21, 0.6, 0.5},
                {0.78, 0.26, 0.55, 0.45},
                {0.85, 0.33, 0.55, 0.36},
                {0.88, 0.35, 0.56, 0.16},
                {0.97, 0.35, 0.56, 0.16},
                {1.0, 0.38, 0.53, 0.1}},
               0.2}};
    case BodyKind::barrier:
      return {{"body",
               {{0.0, 0.0, 1.0, 0.5},
                {0.09, 0.0, 1.0, 0.5},
                {0.41, 0.0, 1.0, 0.21},
                {1.0, 0.0, 1.0, 0.125}}}};
    case BodyKind::pole:  // an octagon with equal sides
      return {{"body", {{0.0, 0.0, 1.0, 0.5}, {1.0, 0.0, 1.0, 0.5}}, 0.2929}};
    case BodyKind::building:
      break;
  }
  return {{"body", {{0.0, 0.0, 1.0, 0.5}, {1.0, 0.0, 1.0, 0.5}}}};
}

/// Wheels of a kind: diameter of the height, width of the box's width; 0 for none.
struct Wheels {
  double diameter = 0.0;
  double width = 0.0;
  bool in_line = false;  ///< one on each axle
};

Wheels wheels_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::car:
      return {0.45, 0.12};
    case BodyKind::truck:
      return {0.27, 0.13};
    case BodyKind::bus:
      return {0.31, 0.12};
    case BodyKind::motorcycle:
      return {0.37, 0.2, true};
    case BodyKind::bicycle:
      return {0.39, 0.08, true};
    default:
      return {};
  }
}

/// Wheels seen from the side are hexagons on the ground.
void add_wheels(BodyKind kind, const Vector3d& size_m, std::vector<Loft>& lofts) {
  constexpr double most_of_length = 0.075;  // radius on long low bodies
  const Wheels wheels = wheels_of(kind);
  if (wheels.diameter == 0.0) return;
  const BoxAxles axles = box_axles(kind);
  const double front = axles.rear_overhang + axles.wheelbase;
  const double most = wheels.in_line ? std::min(axles.rear_overhang, 1.0 - front) : most_of_length;
  const double radius = std::min(0.5 * wheels.diameter * size_m.z() / size_m.x(), most);
  const double height = 2.0 * radius * size_m.x() / size_m.z();
  for (const auto& [name, x] :
       {std::pair("wheel_rear", axles.rear_overhang), {"wheel_front", front}}) {
    for (const double side : {1.0, -1.0}) {
      const double half = 0.5 * wheels.width;
      Loft wheel{name,
                 {{0.0, x - 0.5 * radius, x + 0.5 * radius, half},
                  {0.5 * height, x - radius, x + radius, half},
                  {height, x - 0.5 * radius, x + 0.5 * radius, half}}};
      if (!wheels.in_line) {
        wheel.part += side > 0.0 ? "_left" : "_right";
        wheel.y = side * (0.48 - half);
      }
      lofts.push_back(std::move(wheel));
      if (wheels.in_line) break;
    }
  }
}

/// Builds a mesh of lofts. Each section is a ring of points, counter-clockwise from above, from the
/// side that faces right of the front: cut corner, front, cut corner, left, and so on.
class Mesher {
public:
  Mesher(const Vector3d& size_m, double origin)
      : size_m_(size_m),
        origin_(origin),
        cell_m_(std::max(std::clamp(0.1 * size_m.minCoeff(), 0.02, 0.15),
                         size_m.maxCoeff() / most_cuts)) {}

  void add(const Loft& loft) {
    const std::size_t first = mesh_.size();
    double along_m = 0.0;
    double across_m = 0.0;
    for (const Section& s : loft.sections) {
      along_m = std::max(along_m, (s.front - s.rear) * size_m_.x());
      across_m = std::max(across_m, 2.0 * s.half_width * size_m_.y());
    }
    along_ = cuts(along_m);
    across_ = cuts(across_m);
    corner_ = loft.corner > 0.0 ? cuts(loft.corner * std::min(along_m, across_m)) : 0;
    std::uint32_t ring = add_ring(loft.sections.front(), loft);
    close(ring, false);
    for (std::size_t i = 1; i < loft.sections.size(); ++i) {
      const Section& from = loft.sections[i - 1];
      const Section& to = loft.sections[i];
      const std::uint32_t steps = cuts(farthest_m(from, to));
      for (std::uint32_t k = 1; k <= steps; ++k) {
        const std::uint32_t above = add_ring(between(from, to, 1.0 * k / steps), loft);
        for (std::uint32_t p = 0; p < ring_size(); ++p) {
          const std::uint32_t next = (p + 1) % ring_size();
          add_quad(ring + p, ring + next, above + next, above + p);
        }
        ring = above;
      }
    }
    close(ring, true);
    mesh_.parts.push_back({loft.part, static_cast<std::uint32_t>(first),
                           static_cast<std::uint32_t>(mesh_.size() - first)});
  }

  TriangleMesh take() { return std::move(mesh_); }

private:
  static constexpr double most_cuts = 64.0;

  std::uint32_t cuts(double length_m) const {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(length_m / cell_m_), 1.0, most_cuts));
  }

  double farthest_m(const Section& a, const Section& b) const {
    return std::max({std::abs(a.z - b.z) * size_m_.z(), std::abs(a.rear - b.rear) * size_m_.x(),
                     std::abs(a.front - b.front) * size_m_.x(),
                     std::abs(a.half_width - b.half_width) * size_m_.y()});
  }

  static Section between(const Section& a, const Section& b, double share) {
    const auto mix = [share](double from, double to) { return from + share * (to - from); };
    return share == 1.0 ? b
                        : Section{mix(a.z, b.z), mix(a.rear, b.rear), mix(a.front, b.front),
                                  mix(a.half_width, b.half_width)};
  }

  std::uint32_t ring_size() const { return 4 * corner_ + 2 * across_ + 2 * along_; }

  std::uint32_t add_vertex(const Vector3d& point_m) {
    mesh_.vertices.push_back(point_m.cast<float>());
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.triangles.push_back({a, c, d});
  }

  /// Returns the index of its first vertex.
  std::uint32_t add_ring(const Section& s, const Loft& loft) {
    const double rear = (s.rear - origin_) * size_m_.x();
    const double front = (s.front - origin_) * size_m_.x();
    const double left = (loft.y + s.half_width) * size_m_.y();
    const double right = (loft.y - s.half_width) * size_m_.y();
    const double cut = loft.corner * std::min(front - rear, left - right);
    const double z = s.z * size_m_.z();
    const std::array<Vector3d, 8> ends{{{front - cut, right, z},
                                        {front, right + cut, z},
                                        {front, left - cut, z},
                                        {front - cut, left, z},
                                        {rear + cut, left, z},
                                        {rear, left - cut, z},
                                        {rear, right + cut, z},
                                        {rear + cut, right, z}}};
    const std::array<std::uint32_t, 8> sides{corner_, across_, corner_, along_,
                                             corner_, across_, corner_, along_};
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::size_t side = 0; side < sides.size(); ++side) {
      const Vector3d step = (ends[(side + 1) % 8] - ends[side]) / std::max(1U, sides[side]);
      for (std::uint32_t k = 0; k < sides[side]; ++k) add_vertex(ends[side] + k * step);
    }
    return first;
  }

  /// Closes a ring with rows from its right to its left side, from the front to the rear.
  void close(std::uint32_t ring, bool upwards) {
    std::vector<std::uint32_t> before;
    for (std::uint32_t row = 0; row <= 2 * corner_ + along_; ++row) {
      const std::uint32_t right = ring + (corner_ + ring_size() - row) % ring_size();
      const std::uint32_t left = ring + corner_ + across_ + row;
      const bool on_ring = row == 0 || row == 2 * corner_ + along_;
      const auto point = [&](std::uint32_t v) { return mesh_.vertices[v].cast<double>().eval(); };
      const Vector3d from = point(right);
      const Vector3d step = (point(left) - from) / across_;
      std::vector<std::uint32_t> now{right};
      for (std::uint32_t k = 1; k < across_; ++k) {
        now.push_back(!on_ring ? add_vertex(from + k * step) : row == 0 ? right + k : right - k);
      }
      now.push_back(left);
      for (std::uint32_t k = 0; row > 0 && k < across_; ++k) {
        if (upwards) {
          add_quad(now[k], before[k], before[k + 1], now[k + 1]);
        } else {
          add_quad(before[k], now[k], now[k + 1], before[k + 1]);
        }
      }
      before = std::move(now);
    }
  }

  Vector3d size_m_;
  double origin_;  ///< as a share of the length
  double cell_m_;
  std::uint32_t along_ = 1;   ///< pieces of the left and the right side of a ring
  std::uint32_t across_ = 1;  ///< of the front and the rear side
  std::uint32_t corner_ = 0;  ///< of a cut corner
  TriangleMesh mesh_;
};

}  // namespace

BoxAxles box_axles(BodyKind kind) noexcept {
  switch (kind) {
    case BodyKind::car:
      return {0.2, 0.6};
    case BodyKind::truck:
      return {0.25, 0.6};
    case BodyKind::bus:
      return {0.27, 0.5};
    case BodyKind::motorcycle:
      return {0.17, 0.68};
    case BodyKind::bicycle:
      return {0.19, 0.62};
    default:
      return {};
  }
}

Result<TriangleMesh> make_box_body(BodyKind kind, const Vector3d& size_m) {
  return detail::guarded([&]() -> Result<TriangleMesh> {
    if (!((size_m.array() > 0.0) && (size_m.array() <= max_box_side_m)).all()) {
      Error error =
          make_error(ErrorCode::bad_input, "has a side that is not above 0 and at most 100 m",
                     "give length, width and height in metres");
      error.place = "box";
      return error;
    }
    std::vector<Loft> lofts = shape_of(kind);
    add_wheels(kind, size_m, lofts);
    Mesher mesher(size_m, box_axles(kind).rear_overhang);
    for (const Loft& loft : lofts) mesher.add(loft);
    return mesher.take();
  });
}

}  // namespace crashrank
