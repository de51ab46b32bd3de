#include "wheel.hpp"

#include "solids.hpp"

#include <algorithm>

namespace generate {
namespace {

// A drum inside the tyre whose outer face is hollowed between the spokes.
Mesh spoked_rim(const Vec3& center, double rim, double width, int spokes, double edge) {
  const int sides = 4 * ((std::max(24, steps(6.2832 * rim, edge)) + 2) / 4);
  const int rings = std::max(4, steps(rim, edge));
  std::vector<std::vector<Vec3>> places;
  const auto row = [&](double r, double y, double hollow) {
    std::vector<Vec3> ring;
    for (int s = 0; s <= sides; ++s) {
      const double turns = static_cast<double>(s % sides) / sides;
      const Vec2 turn = unit_circle(turns);
      const double gap = std::clamp(0.4 - 1.2 * unit_circle(spokes * turns).x(), 0.0, 1.0);
      ring.push_back(center + Vec3(r * turn.x(), y - hollow * gap, -r * turn.y()));
    }
    places.push_back(ring);
  };
  row(0.0, -0.30 * width, 0.0);
  row(0.98 * rim, -0.38 * width, 0.0);
  for (int k = rings; k >= 0; --k) {
    const double share = static_cast<double>(k) / rings;
    const bool open = share > 0.3 && share < 0.9;
    row(0.99 * rim * share, (0.40 - 0.12 * (1.0 - share * share)) * width, open ? 0.22 * width : 0);
  }
  return sheet(places);
}

}  // namespace

Wheel wheel(const Vec3& center, double radius, double rim, double width, int spokes, double edge) {
  Wheel result;
  const double wall = radius - rim;
  result.tyre = turned({{rim, -0.40 * width},
                        {rim + 0.45 * wall, -0.50 * width},
                        {radius - 0.08 * wall, -0.44 * width},
                        {radius, -0.32 * width},
                        {radius, 0.32 * width},
                        {radius - 0.08 * wall, 0.44 * width},
                        {rim + 0.45 * wall, 0.50 * width},
                        {rim, 0.40 * width},
                        {rim, -0.40 * width}},
                       center, edge, 24);
  result.rim = spoked_rim(center, rim, width, spokes, edge);
  return result;
}

Wheel round_wheel(const Vec3& center, double radius, double rim, double width, int spokes,
                  double edge) {
  std::vector<Vec2> section;
  const double middle = 0.5 * (radius + rim);
  for (int i = 0; i <= 10; ++i) {
    const Vec2 turn = unit_circle(0.1 * (i % 10) - 0.5);
    section.emplace_back(middle + (radius - middle) * turn.x(), 0.5 * width * turn.y());
  }
  return {turned(section, center, edge, 24), spoked_rim(center, rim, 0.7 * width, spokes, edge)};
}

void add_round_wheel(const std::string& place, const Vec3& center, double radius, double rim,
                     double width, double edge, Model* model) {
  const Wheel made = round_wheel(center, radius, rim, width, 6, edge);
  model->add("wheel_" + place, made.tyre);
  model->add("rim_" + place, made.rim);
}

Mesh wheel_housing(const Field& body, const Vec3& hub, double radius, double floor_z, double edge) {
  const double drop = (hub.z() - floor_z) / radius;
  // The arc runs from the floor in front over the top to the floor behind.
  double low_turn = 0.0;
  while (unit_circle(low_turn).y() < drop && low_turn < 0.24) low_turn += 0.001;
  const double sweep = 0.5 + 2.0 * low_turn;
  const int along = steps(6.2832 * sweep * radius, edge, 10);
  const int across = steps(0.25, edge, 2);
  const int rings = steps(radius, edge, 2);
  std::vector<std::vector<Vec3>> barrel(static_cast<std::size_t>(across) + 1);
  std::vector<std::vector<Vec3>> wall(static_cast<std::size_t>(rings) + 1);
  for (int i = 0; i <= along; ++i) {
    const Vec2 turn = unit_circle(-low_turn + sweep * i / along);
    const Vec3 arc(hub.x() + radius * turn.x(), hub.y(), hub.z() + radius * turn.y());
    double outside = hub.y() + 1.0;
    double inside = hub.y();
    for (int round = 0; round < 40; ++round) {
      const double half = 0.5 * (outside + inside);
      (body(Vec3(arc.x(), half, arc.z())) > 0.0 ? outside : inside) = half;
    }
    for (int k = 0; k <= across; ++k) {
      const double y = inside + (hub.y() - inside) * k / across;
      barrel[static_cast<std::size_t>(k)].emplace_back(arc.x(), y, arc.z());
    }
    const Vec3 foot(hub.x(), hub.y(), floor_z);
    for (int r = 0; r <= rings; ++r) {
      wall[static_cast<std::size_t>(r)].push_back(arc +
                                                  static_cast<double>(r) / rings * (foot - arc));
    }
  }
  Mesh mesh = sheet(barrel);
  mesh.append(sheet(wall));
  return mesh;
}

}  // namespace generate
