// Attacks the box test from both sides. It must never separate boxes whose triangles share a point:
// pairs of triangles are pushed together until they touch in the very last bit, where a missing
// margin shows. And it must separate boxes that a face of one of them keeps apart, or an axis has
// been dropped and every query pays for it. Compiled once with the library's header and once with
// that of every planted fault, each time under a function name, and for a fault a namespace, of its
// own.

#include "crashrank/internal/collide/box_test.hpp"
#include "oracle/box_checks.hpp"
#include "oracle/random.hpp"
#include "oracle/triangle_oracle.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace oracle {
namespace {

using crashrank::AabbTree;
using crashrank::Box;
using crashrank::Pose;
using FloatTriangle = std::array<Eigen::Vector3f, 3>;

Eigen::Matrix3d random_rotation(Random& random) {
  const double pi = 3.14159265358979;
  return crashrank::pose_from_angles({0, 0, 0}, random.real(-pi, pi), random.real(-pi, pi),
                                     random.real(-pi, pi))
      .rotation;
}

// Poses off a rotation by as much as is accepted have to be survived too.
Eigen::Matrix3d nearly(Random& random, Eigen::Matrix3d rotation) {
  if (random.chance(0.7)) return rotation;
  for (Eigen::Index i = 0; i < 9; ++i) rotation(i) += random.real(-1.6e-7, 1.6e-7);
  return rotation;
}

// Half of the frames stand along the world's axes, where contacts can be exact.
Eigen::Matrix3d frame(Random& random) {
  return random.chance(0.5) ? Eigen::Matrix3d::Identity().eval() : random_rotation(random);
}

Eigen::Vector3f point(Random& random, double reach) {
  return Eigen::Vector3d(random.real(-reach, reach), random.real(-reach, reach),
                         random.real(-reach, reach))
      .cast<float>();
}

// A box in the tree's frame around vertices of the body, rounded outwards as the build does.
AabbTree tree_around(const Eigen::Matrix3d& axes, const FloatTriangle& vertices) {
  AabbTree tree;
  tree.axes = axes;
  tree.axes_are_world = axes == Eigen::Matrix3d::Identity();
  Box box;
  for (const Eigen::Vector3f& vertex : vertices) {
    const Eigen::Vector3d v = tree.axes_are_world ? vertex.cast<double>().eval()
                                                  : axes.transpose() * vertex.cast<double>();
    Eigen::Vector3f low = v.cast<float>();
    Eigen::Vector3f high = low;
    if (!tree.axes_are_world) {
      for (int k = 0; k < 3; ++k) {
        low[k] = std::nextafter(low[k], -INFINITY);
        high[k] = std::nextafter(high[k], INFINITY);
      }
    }
    box.grow(low);
    box.grow(high);
  }
  tree.nodes.push_back({box, 0, 1});
  return tree;
}

Triangle in_a(const FloatTriangle& vertices, const Pose& pose) {
  Triangle t;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d p = crashrank::carry(pose, vertices[i]);
    t[i] = {p.x(), p.y(), p.z()};
  }
  return t;
}

bool may_touch(const AabbTree& a, const AabbTree& b, const Pose& pose) {
  return boxes_may_touch(a.nodes[0].box, b.nodes[0].box, box_transform(a, b, pose));
}

// Moves B along `direction` between a touching and a free position until the two differ in the last
// bit, and returns the touching one.
Pose last_touch(const FloatTriangle& a, const FloatTriangle& b, const Pose& touching,
                const Eigen::Vector3d& direction) {
  const Triangle fixed = in_a(a, Pose{});
  const auto at = [&](double distance) {
    Pose pose = touching;
    pose.translation += distance * direction;
    return pose;
  };
  double near = 0.0;
  double far = 1.0;
  while (rational_intersects(fixed, in_a(b, at(far)))) far *= 2.0;
  for (;;) {
    const double middle = 0.5 * (near + far);
    if (middle <= near || middle >= far) return at(near);
    (rational_intersects(fixed, in_a(b, at(middle))) ? near : far) = middle;
  }
}

// A flat triangle across one axis of its own body and a corner of the other's box standing on it:
// the box faces touch where the triangles do, and only the margins keep the boxes together.
BoxCheck touching_pairs(Random& random, std::uint64_t tests) {
  BoxCheck count;
  for (std::uint64_t i = 0; i < tests; ++i) {
    const double reach = std::pow(10.0, random.real(-3.0, 3.0));
    const Eigen::Vector3f home = point(random, random.chance(0.5) ? reach : 20.0 * reach);
    Pose pose{nearly(random, frame(random)), Eigen::Vector3d::Zero()};
    const auto axis = static_cast<int>(random.integer(0, 2));
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const bool flat_is_a = random.chance(0.5);
    FloatTriangle flat{point(random, reach), point(random, reach), point(random, reach)};
    for (Eigen::Vector3f& corner : flat) corner[axis] = 0.0F;
    for (Eigen::Vector3f& corner : flat) corner += home;
    // The other triangle opens away from the flat one in all three of its own axes.
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis) * side;
    const Eigen::Vector3d away =
        flat_is_a ? (pose.rotation.transpose() * unit).eval() : (pose.rotation * unit).eval();
    const Eigen::Vector3f tip = point(random, reach);
    FloatTriangle standing{tip, point(random, reach), point(random, reach)};
    for (std::size_t corner = 1; corner < 3; ++corner) {
      for (int k = 0; k < 3; ++k) {
        const float offset = std::abs(standing[corner][k]);
        standing[corner][k] = tip[k] + (away[k] < 0.0 ? -offset : offset);
      }
    }
    const FloatTriangle& a = flat_is_a ? flat : standing;
    const FloatTriangle& b = flat_is_a ? standing : flat;
    const Eigen::Vector3f middle = (flat[0] + flat[1] + flat[2]) / 3.0F;
    const Eigen::Vector3d outward = flat_is_a ? unit : (pose.rotation * -unit).eval();
    pose.translation = (flat_is_a ? middle : tip).cast<double>() -
                       crashrank::carry(pose, flat_is_a ? tip : middle) - 1e-3 * reach * outward;
    if (!rational_intersects(in_a(a, Pose{}), in_a(b, pose))) continue;
    pose = last_touch(a, b, pose, reach * outward);
    ++count.tests;
    const Eigen::Matrix3d world = Eigen::Matrix3d::Identity();
    count.wrong +=
        static_cast<std::uint64_t>(!may_touch(tree_around(world, a), tree_around(world, b), pose));
  }
  return count;
}

// Any contact, any frames: boxes around triangles that share a point.
BoxCheck common_points(Random& random, std::uint64_t tests) {
  BoxCheck count;
  for (std::uint64_t i = 0; i < tests; ++i) {
    const double reach = std::pow(10.0, random.real(-3.0, 3.0));
    const FloatTriangle a{point(random, reach), point(random, reach), point(random, reach)};
    const FloatTriangle b{point(random, reach), point(random, reach), point(random, reach)};
    Pose pose{nearly(random, frame(random)), point(random, 0.5 * reach).cast<double>()};
    const Triangle fixed = in_a(a, Pose{});
    if (!rational_intersects(fixed, in_a(b, pose))) continue;
    if (random.chance(0.5)) pose = last_touch(a, b, pose, point(random, reach).cast<double>());
    ++count.tests;
    const AabbTree tree_a = tree_around(frame(random), a);
    const AabbTree tree_b = tree_around(frame(random), b);
    count.wrong += static_cast<std::uint64_t>(!may_touch(tree_a, tree_b, pose));
  }
  return count;
}

// Boxes that face `axis` of A (0 to 2) or of B (3 to 5) keeps apart by a thousandth of their size.
BoxCheck separated_boxes(Random& random, std::uint64_t tests, int axis) {
  BoxCheck count;
  for (std::uint64_t i = 0; i < tests; ++i) {
    const FloatTriangle a{point(random, 1.0), point(random, 1.0), point(random, 1.0)};
    const FloatTriangle b{point(random, 1.0), point(random, 1.0), point(random, 1.0)};
    const AabbTree tree_a = tree_around(frame(random), a);
    const AabbTree tree_b = tree_around(frame(random), b);
    Pose pose{random_rotation(random), Eigen::Vector3d::Zero()};
    const Eigen::Matrix3d turn_b = pose.rotation * tree_b.axes;
    const Eigen::Vector3d normal = axis < 3 ? tree_a.axes.col(axis) : turn_b.col(axis - 3);
    const Box& box_a = tree_a.nodes[0].box;
    const Box& box_b = tree_b.nodes[0].box;
    const double reach_a =
        (tree_a.axes.transpose() * normal).cwiseAbs().dot(0.5 * box_a.extent().cast<double>());
    const double reach_b =
        (turn_b.transpose() * normal).cwiseAbs().dot(0.5 * box_b.extent().cast<double>());
    const Eigen::Vector3d center_a = tree_a.axes * box_a.center().cast<double>();
    const Eigen::Vector3d center_b = turn_b * box_b.center().cast<double>();
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    pose.translation = center_a - center_b + side * 1.001 * (reach_a + reach_b) * normal;
    ++count.tests;
    count.wrong += static_cast<std::uint64_t>(may_touch(tree_a, tree_b, pose));
  }
  return count;
}

}  // namespace

std::array<BoxCheck, box_check_count> CRASHRANK_UNDER_TEST(const BoxCheckOptions& options);

std::array<BoxCheck, box_check_count> CRASHRANK_UNDER_TEST(const BoxCheckOptions& options) {
  Random random(options.seed);
  std::array<BoxCheck, box_check_count> checks{touching_pairs(random, options.tests),
                                               common_points(random, options.tests)};
  for (int axis = 0; axis < 6; ++axis) {
    checks[2 + static_cast<std::size_t>(axis)] = separated_boxes(random, options.tests, axis);
  }
  constexpr std::array<const char*, box_check_count> what{
      "touching in the last bit", "sharing a point",   "apart along A's x", "apart along A's y",
      "apart along A's z",        "apart along B's x", "apart along B's y", "apart along B's z"};
  for (std::size_t i = 0; i < checks.size(); ++i) checks[i].what = what[i];
  return checks;
}

}  // namespace oracle
