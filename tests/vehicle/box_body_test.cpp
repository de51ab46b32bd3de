#include "crashrank/vehicle/box_body.hpp"

#include "crashrank/mesh/properties.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashrank {
namespace {

using Eigen::Vector3d;

struct Sized {
  BodyKind kind;
  Vector3d size_m;
};

const Sized usual[] = {
    {BodyKind::car, {4.6, 1.82, 1.46}},      {BodyKind::truck, {9.5, 2.55, 3.75}},
    {BodyKind::bus, {12.0, 2.55, 3.1}},      {BodyKind::motorcycle, {2.1, 0.8, 1.7}},
    {BodyKind::bicycle, {1.8, 0.6, 1.75}},   {BodyKind::pedestrian, {0.6, 0.55, 1.75}},
    {BodyKind::barrier, {4.0, 0.6, 0.8}},    {BodyKind::pole, {0.3, 0.3, 6.0}},
    {BodyKind::building, {12.0, 20.0, 8.0}},
};

TEST(BoxBody, BoundsAreTheBoxAboutTheRearAxle) {
  for (const Sized& body : usual) {
    for (const Vector3d& size : {body.size_m, Vector3d(100, 100, 100), Vector3d(0.01, 0.02, 0.01),
                                 Vector3d(100, 0.1, 2)}) {
      SCOPED_TRACE(body_kind_name(body.kind));
      const Result<TriangleMesh> mesh = make_box_body(body.kind, size);
      ASSERT_TRUE(mesh) << mesh.error().message();
      const Box box = mesh->bounds();
      const double tolerance = 1e-6 * size.maxCoeff();
      EXPECT_LT((box.extent().cast<double>() - size).cwiseAbs().maxCoeff(), tolerance);
      EXPECT_NEAR(-box.min.x(), box_axles(body.kind).rear_overhang * size.x(), tolerance);
      EXPECT_EQ(box.min.z(), 0.0F);
      EXPECT_NEAR(box.min.y(), -box.max.y(), tolerance);
      EXPECT_LE(mesh->size(), 100'000U);
    }
  }
}

TEST(BoxBody, SurfacesAreClosedAndFaceOutwards) {
  for (const Sized& body : usual) {
    SCOPED_TRACE(body_kind_name(body.kind));
    const TriangleMesh mesh = *make_box_body(body.kind, body.size_m);
    const MeshQuality quality = assess(mesh);
    EXPECT_TRUE(quality.watertight);
    EXPECT_EQ(quality.degenerate_triangles, 0U);
    EXPECT_TRUE(quality.warnings.empty());
    const double volume = shell_properties(mesh).volume_m3;
    EXPECT_GT(volume, 0.1 * body.size_m.prod());
    EXPECT_LT(volume, 1.001 * body.size_m.prod());
  }
}

TEST(BoxBody, AVehiclesWheelsStandWhereItsAxlesAreStated) {
  for (const Sized& body : {usual[0], usual[1], usual[2]}) {
    SCOPED_TRACE(body_kind_name(body.kind));
    VehicleFacts facts;
    facts.kind = body.kind;
    const Result<Vehicle> v = describe_vehicle(*make_box_body(body.kind, body.size_m), facts);
    ASSERT_TRUE(v) << v.error().message();
    EXPECT_NEAR(v->mass_kg, guess_mass_kg(body.kind, body.size_m), 0.01);
    EXPECT_NEAR(v->rear_axle_x_m, 0.0, 0.05);
    EXPECT_NEAR(v->wheelbase_m, box_axles(body.kind).wheelbase * body.size_m.x(), 0.05);
  }
}

TEST(BoxBody, SidesThatNoBodyHasAreRefused) {
  for (const double side : {0.0, -1.0, 100.1, std::nan(""), HUGE_VAL}) {
    const Result<TriangleMesh> mesh = make_box_body(BodyKind::car, {4.5, side, 1.5});
    ASSERT_FALSE(mesh) << side;
    EXPECT_EQ(mesh.error().code, ErrorCode::bad_input);
    EXPECT_EQ(mesh.error().place, "box");
    EXPECT_FALSE(mesh.error().remedy.empty());
  }
}

}  // namespace
}  // namespace crashrank
