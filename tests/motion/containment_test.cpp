#include "crashrank/internal/motion/containment.hpp"

#include "crashrank/tree/build.hpp"

#include "base/random.hpp"
#include "tree/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::box_mesh;
using test::Random;
using test::tree_of;

TEST(Containment, PointsInABoxAreThoseOfItsInequalities) {
  constexpr std::uint64_t seed = 3;
  Random random(seed);
  const Vector3d half(1.0, 0.6, 0.3);
  for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
    TriangleMesh mesh = box_mesh(half, {0.5, 0, 0}, 4);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
      std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);  // facing does not matter
    }
    const AabbTree tree = tree_of(mesh, {SplitRule::sah, frame, 3});
    for (int i = 0; i < 3000; ++i) {
      Vector3d p = random.vector(1.5);
      if (i % 3 == 0) {
        // On the grid of the mesh, where rays run through edges and corners.
        p = Vector3d(-0.75 + 0.5 * random.below(5), -0.9 + 0.3 * random.below(7),
                     -0.45 + 0.15 * random.below(7));
      }
      const Vector3d q = (p - Vector3d(0.5, 0, 0)).cwiseAbs() - half;
      if (q.cwiseAbs().minCoeff() < 1e-5) continue;
      EXPECT_EQ(contains_point(tree, p), q.maxCoeff() < 0)
          << p.transpose() << ", seed " << seed << ", case " << i;
    }
  }
}

TEST(Containment, ACarWithoutUnderbodyStillHasAnInside) {
  TriangleMesh mesh = box_mesh({2, 1, 1});
  // Triangles 8 and 9 are the lower face.
  mesh.triangles.erase(mesh.triangles.begin() + 8, mesh.triangles.begin() + 10);
  const AabbTree open = tree_of(mesh);
  EXPECT_TRUE(contains_point(open, {0.1, 0.2, 0.3}));
  EXPECT_FALSE(contains_point(open, {0.1, 0.2, -2.0}));
  EXPECT_FALSE(contains_point(open, {0.1, 0.2, 3.0}));
  // A sheet bounds nothing on either side.
  const AabbTree sheet = tree_of(test::sheet_mesh(1, 1));
  EXPECT_FALSE(contains_point(sheet, {0.01, 0, 0}));
  EXPECT_FALSE(contains_point(sheet, {-0.01, 0, 0}));
}

TEST(Containment, TellsWhichBodyIsInside) {
  const AabbTree big = tree_of(box_mesh({2, 2, 2}));
  const AabbTree small = tree_of(test::sphere_mesh(0.3, 6, {0.5, 0, 0}));
  Pose pose = pose_from_angles({0.2, 0.3, 0.1}, 0.4, 0.5, 0.6);
  EXPECT_EQ(containment(big, small, pose), Containment::b_in_a);
  EXPECT_EQ(containment(small, big, inverse(pose)), Containment::a_in_b);
  pose.translation = Vector3d(9, 0, 0);
  EXPECT_EQ(containment(big, small, pose), Containment::apart);
  // Within the hollow of a shell: inside the outer surface, outside the solid.
  TriangleMesh shell = box_mesh({2, 2, 2});
  const TriangleMesh hollow = box_mesh({1, 1, 1});
  const auto first = static_cast<std::uint32_t>(shell.vertices.size());
  shell.vertices.insert(shell.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  for (const auto& t : hollow.triangles) {
    shell.triangles.push_back({t[1] + first, t[0] + first, t[2] + first});
  }
  pose.translation = Vector3d(0, 0, 0);
  EXPECT_EQ(containment(tree_of(shell), small, pose), Containment::apart);
}

}  // namespace
}  // namespace crashrank
