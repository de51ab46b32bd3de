#include "crashrank/vehicle/vehicle.hpp"

#include "crash/shapes.hpp"
#include "oracle/shipped_models.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <string>

namespace crashrank {
namespace {

using Eigen::Vector3d;

TriangleMesh shipped(const std::string& name) {
  return *oracle::read_obj(std::string(CRASHRANK_MODEL_FOLDER "/") + name + ".obj");
}

nlohmann::json stated(const std::string& name) {
  std::ifstream file(CRASHRANK_MODEL_FOLDER "/models.json");
  const nlohmann::json all = nlohmann::json::parse(file);
  for (const nlohmann::json& model : all["models"]) {
    if (model["name"] == name) return model;
  }
  return {};
}

/// A car's box that stands on the ground, its rear axle near the origin.
TriangleMesh car_box() { return test::box_mesh({2.0, 0.9, 0.7}, {1.2, 0, 0.7}); }

TEST(Vehicle, AxlesOfShippedCarsAreFound) {
  for (const char* name : {"sedan", "hatch"}) {
    const nlohmann::json model = stated(name);
    const Result<Vehicle> v = describe_vehicle(shipped(name), {});
    ASSERT_TRUE(v) << name;
    const double wheelbase = model["wheelbase_m"];
    const double center = model["center_of_mass_m"][0];
    std::printf(
        "%s: rear axle at %.3f m, wheelbase %.3f m (stated %.3f), centre of mass %.3f "
        "(stated %.3f), mass %.0f kg, yaw inertia %.0f kg m2\n",
        name, v->rear_axle_x_m, v->wheelbase_m, wheelbase, v->center_m.x(), center, v->mass_kg,
        v->yaw_inertia_kgm2);
    // The shipped models have their origin under the middle of the rear axle.
    EXPECT_NEAR(v->rear_axle_x_m, 0.0, 0.05) << name;
    EXPECT_NEAR(v->wheelbase_m, wheelbase, 0.05) << name;
    EXPECT_NEAR(v->center_m.x(), center, 0.1) << name;
    EXPECT_NEAR(v->center_m.y(), 0.0, 0.02) << name;
    EXPECT_TRUE(v->mass_is_guessed);
    EXPECT_EQ(v->surface, Surface::sheet_metal);
  }
}

TEST(Vehicle, DerivedInertiaIsThatOfShippedCars) {
  for (const char* name : {"sedan", "hatch"}) {
    const nlohmann::json model = stated(name);
    VehicleFacts facts;
    facts.mass_kg = model["mass_kg"].get<double>();
    const Result<Vehicle> v = describe_vehicle(shipped(name), facts);
    ASSERT_TRUE(v) << name;
    EXPECT_EQ(v->mass_kg, *facts.mass_kg);
    EXPECT_FALSE(v->mass_is_guessed);
    const double inertia = model["izz_kgm2"];
    EXPECT_NEAR(v->yaw_inertia_kgm2, inertia, 0.05 * inertia) << name;
  }
}

TEST(Vehicle, ABoxWithoutWheelsHasItsAxlesAtFifths) {
  const Result<Vehicle> v = describe_vehicle(car_box(), {});
  ASSERT_TRUE(v);
  EXPECT_NEAR(v->rear_axle_x_m, -0.8 + 0.2 * 4.0, 1e-6);
  EXPECT_NEAR(v->wheelbase_m, 0.6 * 4.0, 1e-6);
  EXPECT_NEAR(v->center_m.x(), 0.58 * 2.4, 1e-6);
  EXPECT_NEAR(v->center_m.z(), 0.7, 1e-6);
  EXPECT_NEAR(v->yaw_inertia_kgm2, v->mass_kg * 0.29 * 0.29 * 16.0, 1e-3 * v->mass_kg);
}

TEST(Vehicle, OtherKindsAreEvenBlocks) {
  VehicleFacts facts;
  facts.kind = BodyKind::truck;
  facts.mass_kg = 12000.0;
  const Result<Vehicle> v = describe_vehicle(car_box(), facts);
  ASSERT_TRUE(v);
  EXPECT_TRUE(v->center_m.isApprox(Vector3d(1.2, 0, 0.7), 1e-6));
  EXPECT_NEAR(v->yaw_inertia_kgm2, 12000.0 * (16.0 + 3.24) / 12.0, 1.0);
  EXPECT_EQ(v->wheelbase_m, 0.0);
  EXPECT_FALSE(v->strength.rigid);
}

TEST(Vehicle, StatedFactsOverrideDerivedOnes) {
  VehicleFacts facts;
  facts.mass_kg = 1800.0;
  facts.center_of_mass_m = Vector3d(1.1, -0.05, 0.6);
  facts.yaw_inertia_kgm2 = 2500.0;
  facts.surface = Surface::rubber;
  const Result<Vehicle> v = describe_vehicle(car_box(), facts);
  ASSERT_TRUE(v);
  EXPECT_EQ(v->mass_kg, 1800.0);
  EXPECT_EQ(v->center_m, Vector3d(1.1, -0.05, 0.6));
  EXPECT_EQ(v->yaw_inertia_kgm2, 2500.0);
  EXPECT_EQ(v->surface, Surface::rubber);
  facts.stiffness = 3.0;
  const Result<Vehicle> stiff = describe_vehicle(car_box(), facts);
  ASSERT_TRUE(stiff);
  EXPECT_DOUBLE_EQ(stiff->strength.front.yield_npm, 3.0 * v->strength.front.yield_npm);
  EXPECT_DOUBLE_EQ(stiff->strength.front.slope_npm2, 3.0 * v->strength.front.slope_npm2);
  EXPECT_DOUBLE_EQ(stiff->strength.side.slope_npm2, 3.0 * v->strength.side.slope_npm2);
  EXPECT_DOUBLE_EQ(stiff->strength.rear.slope_npm2, 3.0 * v->strength.rear.slope_npm2);
  EXPECT_DOUBLE_EQ(stiff->strength.hardening_npm2, 3.0 * v->strength.hardening_npm2);
  EXPECT_EQ(stiff->strength.front.length_m, v->strength.front.length_m);
  EXPECT_EQ(stiff->mass_kg, v->mass_kg);
}

TEST(Vehicle, AbsurdInertiaIsRefused) {
  VehicleFacts facts;
  facts.mass_kg = 1500.0;
  const double flat = (16.0 + 3.24) / 12.0;
  for (const double absurd :
       {-1.0, 0.0, 1e-3, 0.009 * 1500.0 * flat, 3.01 * 1500.0 * flat, 1e9,
        std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    facts.yaw_inertia_kgm2 = absurd;
    const Result<Vehicle> v = describe_vehicle(car_box(), facts);
    ASSERT_FALSE(v) << absurd;
    EXPECT_EQ(v.error().code, ErrorCode::bad_input) << absurd;
  }
  for (const double possible : {0.011 * 1500.0 * flat, 1500.0 * flat, 2.99 * 1500.0 * flat}) {
    facts.yaw_inertia_kgm2 = possible;
    EXPECT_TRUE(describe_vehicle(car_box(), facts)) << possible;
  }
}

TEST(Vehicle, WhatStandsIsRigidAndImmovable) {
  const struct {
    BodyKind kind;
    Surface surface;
  } rows[] = {{BodyKind::pole, Surface::wood},
              {BodyKind::barrier, Surface::concrete},
              {BodyKind::building, Surface::concrete}};
  for (const auto& row : rows) {
    VehicleFacts facts;
    facts.kind = row.kind;
    const Result<Vehicle> v = describe_vehicle(car_box(), facts);
    ASSERT_TRUE(v);
    EXPECT_FALSE(v->movable());
    EXPECT_TRUE(v->strength.rigid);
    EXPECT_EQ(v->surface, row.surface);
  }
}

TEST(Vehicle, DensityIsMassOverVolume) {
  VehicleFacts facts;
  facts.mass_kg = 1000.0;
  // Bands are cut at their middles: up to 1.4 m the whole band from 1.2 to 1.6 m counts.
  const Result<Vehicle> v = describe_vehicle(test::box_mesh({2.0, 0.9, 0.6}, {1.2, 0, 0.6}), facts);
  ASSERT_TRUE(v);
  EXPECT_NEAR(v->density_kgm3, 1000.0 / (4.0 * 1.8 * 1.2), 1.5);
}

TEST(Vehicle, AGivenProfileIsUsedAndAMissingOneIsMade) {
  const TriangleMesh mesh = car_box();
  const auto profile = std::make_shared<const Profile>(*make_profile(mesh));
  const Result<Vehicle> given = describe_vehicle(mesh, {}, profile);
  const Result<Vehicle> made = describe_vehicle(mesh, {});
  ASSERT_TRUE(given && made);
  EXPECT_EQ(given->profile, profile);
  ASSERT_EQ(made->profile->pieces.size(), profile->pieces.size());
  EXPECT_EQ(made->profile->area_m2, profile->area_m2);
}

TEST(Vehicle, WithoutAnOutlineItIsRefused) {
  // Wholly above the highest band, and without a triangle.
  const Result<Vehicle> high = describe_vehicle(test::box_mesh({1, 1, 1}, {0, 0, 9}), {});
  ASSERT_FALSE(high);
  EXPECT_EQ(high.error().code, ErrorCode::bad_input);
  const Result<Vehicle> empty = describe_vehicle(TriangleMesh{}, {});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, ErrorCode::bad_input);
}

}  // namespace
}  // namespace crashrank
