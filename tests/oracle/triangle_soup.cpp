#include "oracle/triangle_soup.hpp"

#include "oracle/triangle_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace oracle {
namespace {

using crashrank::TriangleMesh;

void append(TriangleMesh& mesh, const std::array<Eigen::Vector3d, 3>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& corner : corners) mesh.vertices.emplace_back(corner.cast<float>());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

double reach_of(const TrianglePair& pair) {
  double reach = 0.0;
  for (const Triangle* t : {&pair.a, &pair.b}) {
    for (const Point& p : *t) {
      for (const double x : p) reach = std::max(reach, std::abs(x));
    }
  }
  return reach;
}

}  // namespace

Soup make_soup(Random& random, std::size_t count) {
  Soup soup;
  const bool turned = random.chance(0.5);
  if (turned) {
    soup.b_in_a = crashrank::pose_from_angles(
        {random.real(-3.0, 3.0), random.real(-3.0, 3.0), random.real(-3.0, 3.0)},
        random.real(-3.0, 3.0), random.real(-3.0, 3.0), random.real(-3.0, 3.0));
  }
  const auto size = static_cast<int>(random.integer(-20, 19));
  soup.b_in_a.translation *= std::ldexp(1.0, size);
  const double overall = std::ldexp(1.0, size);
  PairGenerator generator(random.bits(), 0.9);
  while (soup.a.size() < count) {
    const TrianglePair pair = generator.next();
    const double reach = reach_of(pair);
    if (reach == 0.0) continue;
    // A power of two keeps exact contacts exact.
    const double scale = std::ldexp(overall, -std::ilogb(reach));
    std::array<Eigen::Vector3d, 3> a;
    std::array<Eigen::Vector3d, 3> b;
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = scale * Eigen::Vector3d(pair.a[i][0], pair.a[i][1], pair.a[i][2]);
      b[i] = scale * Eigen::Vector3d(pair.b[i][0], pair.b[i][1], pair.b[i][2]);
      if (turned) {
        b[i] = (soup.b_in_a.rotation.transpose() * (b[i] - soup.b_in_a.translation)).eval();
      }
    }
    append(soup.a, a);
    append(soup.b, b);
  }
  return soup;
}

}  // namespace oracle
