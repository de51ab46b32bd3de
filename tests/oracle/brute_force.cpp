#include "oracle/brute_force.hpp"

#include "crashrank/internal/collide/triangle_test.hpp"
#include "oracle/triangle_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace oracle {
namespace {

using crashrank::Pair;
using crashrank::Pose;
using crashrank::TriangleMesh;

Triangle to_oracle(const crashrank::TriangleD& t) {
  Triangle result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = {t.corner[i].x(), t.corner[i].y(), t.corner[i].z()};
  }
  return result;
}

// Extents of a triangle along nine directions: the axes and the sums and differences of two
// coordinates. Rounding is monotone, so that intervals of rounded sums that do not overlap belong
// to exact ones that do not overlap either: triangles told apart here share no point.
struct Extents {
  std::array<double, 9> least;
  std::array<double, 9> most;

  explicit Extents(const Triangle& t) {
    least.fill(INFINITY);
    most.fill(-INFINITY);
    for (const auto& [x, y, z] : t) {
      const std::array<double, 9> at{x, y, z, x + y, x - y, y + z, y - z, z + x, z - x};
      for (std::size_t k = 0; k < at.size(); ++k) {
        least[k] = std::min(least[k], at[k]);
        most[k] = std::max(most[k], at[k]);
      }
    }
  }
  bool apart(const Extents& other) const {
    for (std::size_t k = 0; k < least.size(); ++k) {
      if (most[k] < other.least[k] || other.most[k] < least[k]) return true;
    }
    return false;
  }
};

// All triangles of a mesh in A's frame.
struct Placed {
  std::vector<Triangle> triangle;
  std::vector<Extents> extents;

  Placed(const TriangleMesh& mesh, const Pose* pose) {
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const crashrank::Triangle t = mesh.triangle(i);
      triangle.push_back(
          to_oracle(pose == nullptr ? crashrank::to_double(t) : crashrank::carry(*pose, t)));
      extents.emplace_back(triangle.back());
    }
  }
};

}  // namespace

std::vector<Pair> brute_force(const TriangleMesh& a, const TriangleMesh& b, const Pose& pose) {
  const Placed pa(a, nullptr);
  const Placed pb(b, &pose);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (pa.extents[i].apart(pb.extents[j])) continue;
      if (rational_intersects(pa.triangle[i], pb.triangle[j])) {
        pairs.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
      }
    }
  }
  return pairs;
}

bool shares_point(const TriangleMesh& a, const TriangleMesh& b, const Pose& pose, Pair pair) {
  return rational_intersects(
      to_oracle(crashrank::to_double(a.triangle(static_cast<std::size_t>(pair.a)))),
      to_oracle(crashrank::carry(pose, b.triangle(static_cast<std::size_t>(pair.b)))));
}

}  // namespace oracle
