#include "report/orientation.hpp"

#include "crashrank/mesh/import.hpp"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

// Meshes of known axes, turned in every way that a file can have them.

namespace crashrank {
namespace {

using detail::guess_reading;
using detail::MeshReading;
using Eigen::Vector3d;

constexpr std::array<Axis, 6> axes{Axis::plus_x,  Axis::minus_x, Axis::plus_y,
                                   Axis::minus_y, Axis::plus_z,  Axis::minus_z};

/// The file that `transform` makes `body` of.
TriangleMesh file_of(const TriangleMesh& body, const ImportTransform& transform) {
  const Vector3d forward = direction(transform.forward);
  const Vector3d up = direction(transform.up);
  const Vector3d left = up.cross(forward);
  TriangleMesh file = body;
  for (Eigen::Vector3f& vertex : file.vertices) {
    const Vector3d at = vertex.cast<double>() / transform.scale;
    vertex = (at.x() * forward + at.y() * left + at.z() * up).cast<float>();
  }
  return file;
}

std::vector<ImportTransform> all_readings() {
  std::vector<ImportTransform> all;
  for (const Axis up : axes) {
    for (const Axis forward : axes) {
      if (std::abs(direction(up).dot(direction(forward))) > 0.5) continue;
      all.push_back({0.0254, up, forward, Vector3d::Zero()});
    }
  }
  return all;
}

TriangleMesh shipped(const std::string& name) {
  Result<ImportedMesh> read = import_mesh(CRASHRANK_MODEL_FOLDER "/" + name + ".obj");
  EXPECT_TRUE(read.ok()) << name;
  return read.ok() ? std::move(read->mesh) : TriangleMesh{};
}

TEST(Orientation, NamedPartsShowTheAxesOfEveryTurnedVehicle) {
  for (const char* const name : {"hatch", "sedan", "van", "truck", "semitrailer", "tram"}) {
    const TriangleMesh body = shipped(name);
    for (const ImportTransform& right : all_readings()) {
      const MeshReading guess = guess_reading(file_of(body, right), {}, false);
      SCOPED_TRACE(std::string(name) + ": right is up " + axis_name(right.up) + " forward " +
                   axis_name(right.forward) + ", guessed " + guess.options());
      EXPECT_EQ(guess.up, right.up);
      EXPECT_EQ(guess.forward, right.forward);
      EXPECT_TRUE(guess.front_known);
    }
  }
}

TEST(Orientation, TheUnitOfCarsIsFound) {
  for (const char* const name : {"hatch", "sedan", "van"}) {
    const TriangleMesh body = shipped(name);
    for (const double scale : {1.0, 0.001, 0.01, 0.0254, 0.3048}) {
      const ImportTransform right{scale, Axis::plus_z, Axis::plus_x, Vector3d::Zero()};
      EXPECT_EQ(guess_reading(file_of(body, right), {}, false).scale, scale) << name;
    }
  }
}

/// What was read already is guessed in the file's axes, too.
TEST(Orientation, AReadingDoesNotDependOnHowTheMeshWasRead) {
  const TriangleMesh body = shipped("sedan");
  for (const ImportTransform& right : all_readings()) {
    for (const ImportTransform& applied : {all_readings()[3], all_readings()[17]}) {
      TriangleMesh read = file_of(body, right);
      ASSERT_TRUE(transform_mesh(read, applied));
      const MeshReading guess = guess_reading(read, applied, false);
      EXPECT_TRUE(guess.has_axes_of(right) && guess.has_scale_of(right)) << guess.options();
      EXPECT_EQ(guess.has_axes_of(applied),
                right.up == applied.up && right.forward == applied.forward);
    }
  }
}

TEST(Orientation, SizeShowsTheAxesButNotTheFront) {
  TriangleMesh body = shipped("sedan");
  for (Part& part : body.parts) part.name = "panel";
  for (const ImportTransform& right : all_readings()) {
    const MeshReading guess = guess_reading(file_of(body, right), {}, false);
    SCOPED_TRACE(std::string("right is up ") + axis_name(right.up) + " forward " +
                 axis_name(right.forward) + ", guessed " + guess.options());
    EXPECT_EQ(direction(guess.forward).cwiseAbs(), direction(right.forward).cwiseAbs());
    EXPECT_FALSE(guess.front_known);
    // Upside down looks right where z is the height.
    if (direction(right.up).z() == 0.0) {
      EXPECT_EQ(guess.up, right.up);
    }
  }
}

TEST(Orientation, GltfHasItsAxesByItsText) {
  TriangleMesh body = shipped("hatch");
  for (Part& part : body.parts) part.name = "panel";
  const ImportTransform text{1.0, Axis::plus_y, Axis::plus_z, Vector3d::Zero()};
  const MeshReading guess = guess_reading(file_of(body, text), {}, true);
  EXPECT_TRUE(guess.has_axes_of(text) && guess.front_known) << guess.options();
  EXPECT_TRUE(detail::is_gltf_file("a/Car.GLB"));
  EXPECT_FALSE(detail::is_gltf_file("car.glb.obj"));
}

TEST(Orientation, AModelInNoUnitGetsTheLengthOfACar) {
  const ImportTransform tiny{5.0, Axis::plus_z, Axis::plus_x, Vector3d::Zero()};
  const MeshReading guess = guess_reading(file_of(shipped("hatch"), tiny), {}, false);
  EXPECT_EQ(guess.scale, 5.0);
}

}  // namespace
}  // namespace crashrank
