#include "mesh/profile_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace crashrank {
namespace {

using Eigen::Vector2d;
using test::add_prism;
using test::add_wall;
using test::band_of;
using test::expect_sound;
using test::prism;
using test::profile_of;
using test::reason_of;
using test::rectangle;

TEST(Profile, IsRefusedWithoutTriangles) {
  EXPECT_EQ(reason_of({}), "has no triangle to take an outline from");
  TriangleMesh loose;
  loose.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
  EXPECT_EQ(reason_of(loose), "has no triangle to take an outline from");
}

void expect_no_outline(const TriangleMesh& mesh) {
  const Profile profile = profile_of(mesh);
  EXPECT_TRUE(profile.pieces.empty());
  EXPECT_EQ(profile.first, Profile{}.first);
  EXPECT_EQ(profile.volume_m3(), 0.0);
}

TEST(Profile, HasNoPieceWhereNothingIsEnclosed) {
  TriangleMesh one;
  one.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
  one.triangles = {{0, 1, 2}};
  expect_no_outline(one);
  one.vertices = {{0.3F, 0.1F, 0.0F}, {4.7F, 1.3F, 0.2F}, {1.1F, -0.4F, 2.9F}};
  expect_no_outline(one);
  one.triangles = {{0, 0, 0}};
  expect_no_outline(one);

  TriangleMesh plate;
  plate.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  expect_no_outline(plate);
  expect_no_outline(prism(rectangle(0, 0, 2, 2), 4.0, 6.0));
  expect_no_outline(prism(rectangle(0, 0, 0, 7), 0.0, 2.0));  // a sheet
}

TEST(Profile, IsRefusedForVerticesThatAreNotThereOrFarOut) {
  const TriangleMesh box = prism(rectangle(0, 0, 2, 2), 0.0, 1.0);
  const Profile expected = profile_of(box);
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float wrong : {std::nanf(""), infinity, -infinity, 1.001e6F, -3e38F}) {
    for (int axis = 0; axis < 3; ++axis) {
      TriangleMesh mesh = box;
      mesh.vertices[3][axis] = wrong;
      EXPECT_EQ(reason_of(mesh), "has a vertex more than 1e6 m from its origin, or not finite");
      // Without a triangle it does not count.
      mesh = box;
      mesh.vertices.push_back({0, 0, 0});
      mesh.vertices[mesh.vertices.size() - 1][axis] = wrong;
      const Profile profile = profile_of(mesh);
      EXPECT_EQ(profile.first, expected.first);
      EXPECT_EQ(profile.area_m2, expected.area_m2);
      EXPECT_EQ(profile.ground_m, 0.0);
    }
  }
  TriangleMesh mesh = box;
  mesh.triangles[0][1] = static_cast<std::uint32_t>(mesh.vertices.size());
  EXPECT_EQ(reason_of(mesh), "has a triangle with a vertex that is not there");
}

TEST(Profile, OfTheLargestBodiesIsWithinTheLimits) {
  const Profile profile = profile_of(prism(rectangle(-1e6, -2e5, 1e6, 2e5), 0.0, 3.0));
  expect_sound(profile);
  EXPECT_NEAR(band_of(profile, 0).area_m2, 8e11, 0.01 * 8e11);
  for (const OutlinePiece& piece : profile.pieces) EXPECT_LE(piece.length_m, 100.01F);
  EXPECT_LT(profile.pieces.size(), 600'000U);
}

TEST(Profile, OfTooManySmallBodiesIsRefused) {
  TriangleMesh mesh;
  for (int i = 0; i < 240; ++i) {
    for (int j = 0; j < 240; ++j) {
      const Vector2d at(0.15 * i, 0.15 * j);
      add_prism(mesh, rectangle(at.x(), at.y(), at.x() + 0.06, at.y() + 0.05), 0.0, 4.0);
    }
  }
  EXPECT_EQ(reason_of(mesh, ErrorCode::limit_exceeded),
            "has outlines of more than 2 million pieces between 0 and 4 m");
}

// As many cells as they pass through would take gigabytes.
TEST(Profile, OfManyLargeTrianglesHasACoarserRaster) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> coordinate(-90.0, 90.0);
  TriangleMesh mesh = prism(rectangle(-100, -100, 100, 100), 0.05, 0.15);
  for (int i = 0; i < 100'000; ++i) {
    add_wall(mesh, {coordinate(random), coordinate(random)},
             {coordinate(random), coordinate(random)}, 0.05, 0.15);
  }
  const Profile profile = profile_of(mesh);
  EXPECT_NEAR(band_of(profile, 0).area_m2, 4e4, 40.0);
  EXPECT_EQ(band_of(profile, 0).outlines(), 1);
}

}  // namespace
}  // namespace crashrank
