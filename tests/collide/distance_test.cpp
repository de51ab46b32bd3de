#include "crashrank/collide/collide.hpp"

#include "base/random.hpp"
#include "collide/triangle_distance.hpp"
#include "crashrank/internal/collide/triangle_test.hpp"
#include "crashrank/tree/build.hpp"
#include "oracle/triangle_oracle.hpp"
#include "oracle/triangle_pairs.hpp"
#include "tree/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::Random;

TriangleD from_oracle(const oracle::Triangle& t) {
  TriangleD result;
  for (std::size_t i = 0; i < 3; ++i) result.corner[i] = Vector3d(t[i][0], t[i][1], t[i][2]);
  return result;
}

double extent(const TriangleD& t) {
  double size = 0.0;
  for (const Vector3d& p : t.corner) {
    for (const Vector3d& q : t.corner) size = std::max(size, (p - q).norm());
  }
  return size;
}

// Distance of a point from a triangle's hull, by alternating over its edges and inside: written
// for reading, in extended precision, for checking only that a witness lies on its triangle.
long double off_triangle(const Vector3d& x, const TriangleD& t) {
  using V = Eigen::Matrix<long double, 3, 1>;
  const V p = x.cast<long double>();
  long double best = std::numeric_limits<long double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const V a = t.corner[i].cast<long double>();
    const V d = t.corner[(i + 1) % 3].cast<long double>() - a;
    const long double dd = d.squaredNorm();
    const long double s = dd > 0 ? std::clamp<long double>(d.dot(p - a) / dd, 0, 1) : 0;
    best = std::min(best, (a + s * d - p).norm());
  }
  const V a = t.corner[0].cast<long double>();
  const V u = t.corner[1].cast<long double>() - a;
  const V v = t.corner[2].cast<long double>() - a;
  const V n = u.cross(v);
  const long double nn = n.squaredNorm();
  if (nn > 0) {
    const long double beta = (p - a).cross(v).dot(n) / nn;
    const long double gamma = u.cross(p - a).dot(n) / nn;
    if (beta >= 0 && gamma >= 0 && beta + gamma <= 1) {
      best = std::min(best, std::abs(n.dot(p - a)) / std::sqrt(nn));
    }
  }
  return best;
}

// The lower bound is a statement about a direction and the upper one about two points: both are
// checked for what they say, in extended precision, so nothing here repeats the search for them.
void check_gap(const TriangleD& a, const TriangleD& b, const TriangleGap& gap, bool intersect,
               double tightness) {
  ASSERT_EQ(gap.lower == 0.0, intersect);
  ASSERT_LE(gap.lower, gap.upper);
  double size = extent(a) + extent(b) + gap.upper;
  for (std::size_t i = 0; i < 3; ++i) {
    size = std::max({size, 1e-4 * a.corner[i].norm(), 1e-4 * b.corner[i].norm()});
  }
  // Where nearly parallel triangles cross, a common point is known less well.
  const double slack = (intersect ? 1e-6 : 1e-11) * size;
  EXPECT_LE(static_cast<double>(off_triangle(gap.point_a, a)), slack);
  EXPECT_LE(static_cast<double>(off_triangle(gap.point_b, b)), slack);
  if (intersect) {
    EXPECT_EQ(gap.upper, 0.0);
    return;
  }
  if (gap.direction.isZero(0.0)) {
    // Too close for a proof in doubles: the witnesses must then be that close as well. What is too
    // close follows from how well the triangles' normals are known.
    EXPECT_LE(gap.upper, std::max(1e-9, tightness) * size);
    return;
  }
  using V = Eigen::Matrix<long double, 3, 1>;
  const V n = gap.direction.cast<long double>();
  long double a_end = -std::numeric_limits<long double>::infinity();
  long double b_begin = -a_end;
  for (std::size_t i = 0; i < 3; ++i) {
    a_end =
        std::max(a_end, n.dot(a.corner[i].cast<long double>() - gap.point_a.cast<long double>()));
    b_begin =
        std::min(b_begin, n.dot(b.corner[i].cast<long double>() - gap.point_a.cast<long double>()));
  }
  EXPECT_LE(static_cast<long double>(gap.lower), (b_begin - a_end) / n.norm());
  EXPECT_LE(gap.upper - gap.lower, tightness * size);
}

TEST(TriangleDistance, EveryFamilyOfPairsIsBracketedAndProved) {
  constexpr std::uint64_t seed = 2024;
  oracle::PairGenerator pairs(seed, 0.9);
  std::size_t touching = 0;
  for (int i = 0; i < 20000; ++i) {
    const oracle::TrianglePair pair = pairs.next();
    const TriangleD a = from_oracle(pair.a);
    const TriangleD b = from_oracle(pair.b);
    const bool intersect = oracle::rational_intersects(pair.a, pair.b);
    touching += intersect ? 1 : 0;
    SCOPED_TRACE(std::string(oracle::name(pair.family)) + ", seed " + std::to_string(seed) +
                 ", case " + std::to_string(i));
    // The normal of a sliver, and with it the place of a foot, is mostly rounding.
    const bool thin =
        pair.family == oracle::Family::sliver || pair.family == oracle::Family::mixed_sizes;
    check_gap(a, b, triangle_distance(a, b), intersect, thin ? 1e-7 : 1e-11);
    if (HasFailure()) return;
  }
  EXPECT_GT(touching, 2000U);
  EXPECT_LT(touching, 18000U);
}

TEST(TriangleDistance, ClosedForms) {
  const TriangleD a{{Vector3d(0, 0, 0), Vector3d(4, 0, 0), Vector3d(0, 4, 0)}};
  const TriangleD above{{Vector3d(1, 1, 2), Vector3d(9, 9, 3), Vector3d(9, 8, 5)}};
  EXPECT_NEAR(triangle_distance(a, above).lower, 2.0, 1e-12);
  const TriangleD beside{{Vector3d(-3, 1, 0), Vector3d(-3, 2, 1), Vector3d(-3, 2, -1)}};
  EXPECT_NEAR(triangle_distance(a, beside).lower, 3.0, 1e-12);
  const TriangleD point{{Vector3d(3, 4, 0), Vector3d(3, 4, 0), Vector3d(3, 4, 0)}};
  EXPECT_NEAR(triangle_distance(a, point).lower, 3.0 / std::sqrt(2.0), 1e-12);
  const TriangleD needle{{Vector3d(2, 1, 1), Vector3d(2, 1, 5), Vector3d(2, 1, 3)}};
  EXPECT_NEAR(triangle_distance(a, needle).lower, 1.0, 1e-12);
  const TriangleD through{{Vector3d(1, 1, -1), Vector3d(1, 1, 1), Vector3d(1, 1, 5)}};
  const TriangleGap gap = triangle_distance(a, through);
  EXPECT_EQ(gap.lower, 0.0);
  EXPECT_NEAR((gap.point_a - Vector3d(1, 1, 0)).norm(), 0.0, 1e-12);
}

DistanceResult brute(const AabbTree& a, const AabbTree& b, const Pose& pose) {
  DistanceResult best;
  best.distance_m = best.upper_m = std::numeric_limits<double>::infinity();
  for (const Triangle& tb : b.triangles) {
    const TriangleD carried = carry(pose, tb);
    for (const Triangle& ta : a.triangles) {
      const TriangleGap gap = triangle_distance(to_double(ta), carried);
      best.distance_m = std::min(best.distance_m, gap.lower);
      best.upper_m = std::min(best.upper_m, gap.upper);
    }
  }
  return best;
}

TEST(Distance, AgreesWithAllPairsUnderEveryRuleAndFrame) {
  constexpr std::uint64_t seed = 5;
  Random random(seed);
  DistanceWorkspace workspace;
  CollideWorkspace collide_workspace;
  std::vector<Pair> pairs;
  const TriangleMesh mesh_a = test::sphere_mesh(1.0, 7);
  const TriangleMesh mesh_b = test::box_mesh({0.9, 0.4, 0.3}, {0.3, 0, 0}, 3);
  int touching = 0;
  for (const SplitRule rule :
       {SplitRule::min_relative_segment, SplitRule::paper, SplitRule::sah, SplitRule::median}) {
    for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
      const AabbTree a = test::tree_of(mesh_a, {rule, frame, 4});
      const AabbTree b = test::tree_of(mesh_b, {rule, frame, 2});
      for (int i = 0; i < 25; ++i) {
        const Pose pose = random.pose(2.5);
        const DistanceResult found = distance(a, b, pose, workspace);
        const DistanceResult all = brute(a, b, pose);
        const bool intersecting = collide(a, b, pose, pairs, collide_workspace).intersecting;
        ASSERT_EQ(found.distance_m == 0.0, intersecting) << "seed " << seed << ", case " << i;
        touching += intersecting ? 1 : 0;
        ASSERT_LE(found.distance_m, all.upper_m);
        ASSERT_NEAR(found.upper_m, all.upper_m, 1e-12);
        ASSERT_NEAR(found.distance_m, all.distance_m, 1e-12);
        EXPECT_FALSE(found.beyond_cutoff);
        if (!intersecting) {
          EXPECT_NEAR((found.point_a_m - found.point_b_m).norm(), found.upper_m, 1e-12);
        }
        // With a cutoff on either side of the distance.
        const DistanceResult nearer = distance(a, b, pose, workspace, {found.upper_m * 0.9 - 1e-9});
        if (!intersecting) {
          EXPECT_TRUE(nearer.beyond_cutoff);
          EXPECT_GT(nearer.distance_m, found.upper_m * 0.9 - 1e-9);
          EXPECT_LE(nearer.distance_m, all.upper_m);
          EXPECT_LE(nearer.work.primitive_tests, found.work.primitive_tests);
        }
        const DistanceResult further =
            distance(a, b, pose, workspace, {found.upper_m * 1.1 + 1e-9});
        EXPECT_EQ(further.upper_m, found.upper_m);
      }
    }
  }
  EXPECT_GT(touching, 5);
}

TEST(Distance, BoxesAndSpheresHaveTheirClosedForm) {
  DistanceWorkspace workspace;
  const AabbTree box = test::tree_of(test::box_mesh({1, 2, 3}));
  const auto at = [](double x, double y, double z) {
    Pose pose;
    pose.translation = Vector3d(x, y, z);
    return pose;
  };
  EXPECT_NEAR(distance(box, box, at(5, 0, 0), workspace).distance_m, 3.0, 1e-12);
  EXPECT_NEAR(distance(box, box, at(5, 8, 18), workspace).distance_m, 13.0, 1e-12);
  const AabbTree ball = test::tree_of(test::sphere_mesh(0.5, 40));
  // Towards a pole the ball's surface is exactly at its radius.
  EXPECT_NEAR(distance(box, ball, at(0, 0, 4), workspace).distance_m, 0.5, 1e-7);
  // Inside, it is the surface that counts.
  EXPECT_NEAR(distance(box, ball, at(0, 0, 0), workspace).distance_m, 0.5, 1e-3);
}

TEST(Distance, ADeepTreeNeedsNoRecursionAndAWarmQueryNoMemory) {
  TriangleMesh strip;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const auto x = static_cast<float>(i) * 0.01F;
    strip.vertices.insert(strip.vertices.end(), {{x, 0, 0}, {x + 0.01F, 0, 0}, {x, 0.01F, 0}});
    strip.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const AabbTree deep = test::tree_of(strip, {SplitRule::paper, BoxFrame::world, 1});
  ASSERT_GT(deep.depth, 5000U);
  DistanceWorkspace workspace;
  Pose pose;
  pose.translation = Vector3d(0, 0, 0.25);
  EXPECT_NEAR(distance(deep, deep, pose, workspace).distance_m, 0.25, 1e-12);
  const auto* const memory = workspace.stack.data();
  distance(deep, deep, pose, workspace);
  EXPECT_EQ(workspace.stack.data(), memory);
}

}  // namespace
}  // namespace crashrank
