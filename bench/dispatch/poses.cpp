#include "common.hpp"

#include "crashrank/collide/collide.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

namespace crashrank::bench {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Uniform in [0, 1), the same with every standard library.
double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

}  // namespace

/// Prints poses of B whose front has run into A's left side: turned by -90° ± 20°, at any place
/// along the middle half of A, 5 to 30 cm deeper than where they first touch.
void print_poses(const Model& a, const Model& b, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Box box_a = a.tree.nodes[0].box;
  const Box box_b = b.tree.nodes[0].box;
  const double reach = static_cast<double>(box_a.extent().norm() + box_b.extent().norm());
  CollideWorkspace workspace;
  std::vector<Pair> pairs;
  CollideOptions any;
  any.any = true;
  for (int i = 0; i < count; ++i) {
    const double yaw = -pi / 2.0 + (unit(random) - 0.5) * pi * 40.0 / 180.0;
    const double deeper = 0.05 + 0.25 * unit(random);
    Pose pose = pose_from_angles({0.0, 0.0, 0.0}, yaw, 0.0, 0.0);
    const Eigen::Vector3d front =
        pose.rotation * Eigen::Vector3d(box_b.max.x(), box_b.center().y(), 0.0);
    pose.translation.x() =
        box_a.center().x() + (unit(random) - 0.5) * 0.5 * box_a.extent().x() - front.x();
    // Between well apart and well inside lies the first touch.
    double apart = box_a.max.y() - front.y() + reach;
    double inside = box_a.center().y() - front.y();
    for (int step = 0; step < 40; ++step) {
      pose.translation.y() = 0.5 * (apart + inside);
      const bool touching = collide(a.tree, b.tree, pose, pairs, workspace, any).intersecting;
      (touching ? inside : apart) = pose.translation.y();
    }
    pose.translation.y() = inside - deeper;
    for (int row = 0; row < 3; ++row) {
      std::printf("%.17g %.17g %.17g %.17g ", pose.rotation(row, 0), pose.rotation(row, 1),
                  pose.rotation(row, 2), pose.translation[row]);
    }
    std::printf("0 0 0 1\n");
  }
}

}  // namespace crashrank::bench
