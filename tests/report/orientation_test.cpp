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

TEST(Orientation, SizeShowsTheAxesAndShapeTheFront) {
  TriangleMesh body = shipped("sedan");
  for (Part& part : body.parts) part.name = "panel";
  for (const ImportTransform& right : all_readings()) {
    const MeshReading guess = guess_reading(file_of(body, right), {}, false);
    SCOPED_TRACE(std::string("right is up ") + axis_name(right.up) + " forward " +
                 axis_name(right.forward) + ", guessed " + guess.options());
    EXPECT_EQ(direction(guess.forward).cwiseAbs(), direction(right.forward).cwiseAbs());
    // Upside down looks right where z is the height.
    if (right.up == Axis::minus_z) continue;
    EXPECT_EQ(guess.up, right.up);
    EXPECT_EQ(guess.forward, right.forward);
    EXPECT_TRUE(guess.front_known);
    EXPECT_STREQ(guess.shown_by, "its shape");
  }
}

TEST(Orientation, TheFrontOfABoxIsNotKnown) {
  TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back((i & 1) != 0 ? 4.0F : 0.0F, (i & 2) != 0 ? 1.7F : 0.0F,
                              (i & 4) != 0 ? 1.5F : 0.0F);
  }
  box.triangles = {{0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}};
  box.parts = {{"box", 0, 7}};
  EXPECT_FALSE(guess_reading(box, {}, false).front_known);
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

TEST(Orientation, OneNamedEndAloneShowsNothing) {
  TriangleMesh tree = shipped("tree");  // its trunk
  const MeshReading guess = guess_reading(tree, {}, false);
  EXPECT_FALSE(guess.front_known) << guess.options();
  EXPECT_EQ(guess.up, Axis::plus_z);
}

TEST(Orientation, WhatIsHigherThanLongIsNoToyCar) {
  EXPECT_EQ(guess_reading(shipped("wheelchair"), {}, false).scale, 1.0);
}

TEST(Orientation, ASmallCarsScalesAreThoseOfItsLengthWidthAndWheels) {
  // The hatch's length 4.14 m, width 2.0 m and wheels of 0.63 m, in files that are 0.6 as large.
  const ImportTransform small{1.0 / 0.6, Axis::plus_y, Axis::plus_z, Vector3d::Zero()};
  const TriangleMesh body = shipped("hatch");
  const MeshReading guess = guess_reading(file_of(body, small), {}, true);
  EXPECT_EQ(guess.scale, 1.0);
  EXPECT_NEAR(guess.length_m, 0.6 * 4.136, 0.01);
  EXPECT_LT(guess.least_car_scale, small.scale);
  EXPECT_GT(guess.most_car_scale, small.scale);
  EXPECT_LT(guess.most_car_scale, 1.1 * small.scale);  // else it would be too wide
  EXPECT_NE(guess.size_doubt().find("2.48 m long"), std::string::npos) << guess.size_doubt();
  EXPECT_EQ(guess_reading(body, {}, false).size_doubt(), "");
  EXPECT_EQ(guess_reading(shipped("motorcycle"), {}, false).size_doubt(), "");
}

TEST(Orientation, AModelInNoUnitGetsTheLengthOfACar) {
  const ImportTransform tiny{5.0, Axis::plus_z, Axis::plus_x, Vector3d::Zero()};
  const MeshReading guess = guess_reading(file_of(shipped("hatch"), tiny), {}, false);
  EXPECT_EQ(guess.scale, 5.0);
}

}  // namespace
}  // namespace crashrank
