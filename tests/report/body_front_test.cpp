#include "report/body_front.hpp"

#include "crashrank/mesh/import.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using detail::front_by_shape;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// A body 1.6 m wide whose top follows points (x, z), from the rear to the front.
TriangleMesh body_below(const std::vector<std::array<float, 2>>& top) {
  TriangleMesh mesh;
  const auto quad = [&](const Vector3f& a, const Vector3f& b, const Vector3f& c,
                        const Vector3f& d) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  for (std::size_t i = 1; i < top.size(); ++i) {
    const auto [x, z] = top[i - 1];
    const auto [next_x, next_z] = top[i];
    for (const float y : {-0.8F, 0.8F}) {
      quad({x, y, 0.2F}, {next_x, y, 0.2F}, {next_x, y, next_z}, {x, y, z});
    }
    quad({x, -0.8F, z}, {next_x, -0.8F, next_z}, {next_x, 0.8F, next_z}, {x, 0.8F, z});
  }
  return mesh;
}

/// Plates that stand out on both sides at a place and a height.
void add_mirrors(TriangleMesh& mesh, float x, float z) {
  for (const float side : {-1.0F, 1.0F}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(x, side * 0.8F, z);
    mesh.vertices.emplace_back(x, side * 1.0F, z);
    mesh.vertices.emplace_back(x + 0.1F, side * 1.0F, z + 0.1F);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
}

int front_of(const TriangleMesh& mesh) {
  return front_by_shape(mesh, Vector3d::UnitX(), Vector3d::UnitZ());
}

const std::vector<std::array<float, 2>> saloon{{0, 0.9F},    {0.7F, 1}, {1.2F, 1.4F},
                                               {2.3F, 1.4F}, {3.1F, 1}, {4.5F, 0.7F}};
const std::vector<std::array<float, 2>> pickup{{0, 1.1F},    {2.1F, 1.1F}, {2.15F, 1.8F},
                                               {3.4F, 1.8F}, {4, 1.1F},    {5.4F, 1}};
/// A lorry with an empty bed, and one of the same outline that drives the other way.
const std::vector<std::array<float, 2>> flatbed{
    {0, 1.1F}, {5.9F, 1.1F}, {6, 2.8F}, {7.9F, 2.8F}, {8, 1.2F}};

TEST(BodyFront, IsThatOfEveryShippedCarInBothDirections) {
  for (const std::string name : {"hatch", "sedan", "van"}) {
    const Result<ImportedMesh> read = import_mesh(CRASHRANK_MODEL_FOLDER "/" + name + ".obj");
    ASSERT_TRUE(read.ok()) << name;
    const Vector3d up = Vector3d::UnitZ();
    EXPECT_EQ(front_by_shape(read->mesh, Vector3d::UnitX(), up), 1) << name;
    EXPECT_EQ(front_by_shape(read->mesh, -Vector3d::UnitX(), up), -1) << name;
  }
}

TEST(BodyFront, NoShippedBodyIsTurnedRound) {
  for (const std::string name :
       {"truck", "motorcycle", "pedestrian", "jersey_barrier", "pole", "wall", "bicycle", "child",
        "tree", "guard_rail", "semitrailer", "tram", "wheelchair"}) {
    const Result<ImportedMesh> read = import_mesh(CRASHRANK_MODEL_FOLDER "/" + name + ".obj");
    ASSERT_TRUE(read.ok()) << name;
    EXPECT_GE(front_of(read->mesh), 0) << name;
  }
}

TEST(BodyFront, NeedsTwoSignsThatAgree) {
  EXPECT_EQ(front_of(body_below(saloon)), 1);
  // A longer bonnet, but a nose as high as the tail.
  std::vector<std::array<float, 2>> level = saloon;
  level.front()[1] = level.back()[1] = 0.95F;
  EXPECT_EQ(front_of(body_below(level)), 0);
  // The bed of a pickup is no bonnet, and a lorry's cab is no tail.
  EXPECT_EQ(front_of(body_below(pickup)), 0);
  EXPECT_EQ(front_of(body_below(flatbed)), 0);
  EXPECT_EQ(front_of(body_below({{0, 1.5F}, {4, 1.5F}})), 0);
}

TEST(BodyFront, IsWhereMirrorsAreUnlessAllElseContradicts) {
  TriangleMesh body = body_below(pickup);
  add_mirrors(body, 3.5F, 1.1F);
  EXPECT_EQ(front_of(body), 1);
  TriangleMesh low = body_below(pickup);
  add_mirrors(low, 3.5F, 0.4F);  // steps
  EXPECT_EQ(front_of(low), 0);
  TriangleMesh odd = body_below(saloon);
  add_mirrors(odd, 1.2F, 0.9F);
  EXPECT_EQ(front_of(odd), 0);
}

}  // namespace
}  // namespace crashrank
