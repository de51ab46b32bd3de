#include "crashrank/vehicle/vehicle.hpp"

#include "oracle/shipped_models.hpp"
#include "tree/shapes.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
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

BodyKind kind_of(const nlohmann::json& model) {
  for (int kind = 0; kind <= static_cast<int>(BodyKind::building); ++kind) {
    if (model["kind"] == body_kind_name(static_cast<BodyKind>(kind))) {
      return static_cast<BodyKind>(kind);
    }
  }
  ADD_FAILURE() << model["kind"];
  return BodyKind::car;
}

/// A car's box that stands on the ground, its rear axle near the origin.
TriangleMesh car_box() { return test::box_mesh({2.0, 0.9, 0.7}, {1.2, 0, 0.7}); }

TEST(Vehicle, GuessedMassesOfShippedBodiesAreNearTheStated) {
  for (const char* name :
       {"hatch", "sedan", "van", "tram", "pedestrian", "child", "wheelchair", "bicycle"}) {
    const nlohmann::json model = stated(name);
    const double mass_kg = model["mass_kg"];
    EXPECT_NEAR(guess_mass_kg(kind_of(model), shipped(name)), mass_kg, 0.08 * mass_kg) << name;
  }
}

TEST(Vehicle, MirrorsHaveNoMass) {
  const TriangleMesh plain = car_box();
  TriangleMesh mirrored = plain;
  const auto first = static_cast<std::uint32_t>(mirrored.vertices.size());
  for (const float y : {-1.2F, 1.2F}) mirrored.vertices.emplace_back(1.5F, y, 1.0F);
  mirrored.vertices.emplace_back(1.5F, 0.0F, 1.1F);
  mirrored.triangles.push_back({first, first + 1, first + 2});
  mirrored.parts = {{"car", 0, static_cast<std::uint32_t>(mirrored.size())}};
  EXPECT_EQ(guess_mass_kg(BodyKind::car, mirrored), guess_mass_kg(BodyKind::car, plain));
  EXPECT_NEAR(guess_mass_kg(BodyKind::car, plain), guess_mass_kg(BodyKind::car, {4.0, 1.8, 1.4}),
              0.01);
}

TEST(Vehicle, AxlesOfShippedCarsLorriesAndTramsAreFound) {
  for (const char* name : {"sedan", "hatch", "truck", "van", "semitrailer", "tram"}) {
    const nlohmann::json model = stated(name);
    VehicleFacts facts;
    facts.kind = kind_of(model);
    const Result<Vehicle> v = describe_vehicle(shipped(name), facts);
    ASSERT_TRUE(v) << name;
    const double wheelbase = model["wheelbase_m"];
    const double center = model["center_of_mass_m"][0];
    std::printf(
        "%s: rear axle at %.3f m, wheelbase %.3f m (stated %.3f), centre of mass %.3f "
        "(stated %.3f), mass %.0f kg, yaw inertia %.0f kg m2\n",
        name, v->rear_axle_x_m, v->wheelbase_m, wheelbase, v->center_m.x(), center, v->mass_kg,
        v->yaw_inertia_kgm2);
    // The shipped models have their origin under the middle of the rear axle, or of the rear group
    // of axles.
    EXPECT_NEAR(v->rear_axle_x_m, 0.0, 0.05) << name;
    EXPECT_NEAR(v->wheelbase_m, wheelbase, 0.05) << name;
    EXPECT_NEAR(v->center_m.x(), center, 0.1) << name;
    EXPECT_NEAR(v->center_m.y(), 0.0, 0.02) << name;
    EXPECT_TRUE(v->mass_is_guessed);
    EXPECT_EQ(v->surface, Surface::sheet_metal);
  }
}

TEST(Vehicle, DerivedCentreAndInertiaAreThoseOfShippedModels) {
  for (const char* name : {"sedan", "hatch", "truck", "motorcycle", "pedestrian", "jersey_barrier",
                           "pole", "wall", "van", "semitrailer", "tram"}) {
    const nlohmann::json model = stated(name);
    VehicleFacts facts;
    facts.kind = kind_of(model);
    facts.mass_kg = model["mass_kg"].get<double>();
    const Result<Vehicle> v = describe_vehicle(shipped(name), facts);
    ASSERT_TRUE(v) << name;
    EXPECT_EQ(v->mass_kg, *facts.mass_kg);
    EXPECT_FALSE(v->mass_is_guessed);
    const double center = model["center_of_mass_m"][0];
    const double inertia = model["izz_kgm2"];
    std::printf("%s: centre of mass %.3f (stated %.3f), yaw inertia %.4g (stated %.4g)\n", name,
                v->center_m.x(), center, v->yaw_inertia_kgm2, inertia);
    EXPECT_NEAR(v->center_m.x(), center, 0.1) << name;
    EXPECT_NEAR(v->yaw_inertia_kgm2, inertia, (v->kind == BodyKind::car ? 0.05 : 0.08) * inertia)
        << name;
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

TEST(Vehicle, LorriesAndBusesAreEvenBlocksWithoutMirrors) {
  for (const BodyKind kind : {BodyKind::truck, BodyKind::bus}) {
    VehicleFacts facts;
    facts.kind = kind;
    facts.mass_kg = 12000.0;
    const Result<Vehicle> v = describe_vehicle(car_box(), facts);
    ASSERT_TRUE(v);
    EXPECT_TRUE(v->center_m.isApprox(Vector3d(1.2, 0, 0.7), 1e-6));
    EXPECT_NEAR(v->yaw_inertia_kgm2, 12000.0 * (16.0 + 1.62 * 1.62) / 12.0, 1.0);
    EXPECT_EQ(v->wheelbase_m, 0.0);
    EXPECT_FALSE(v->strength.rigid);
  }
}

// The benchmark bicycle of Meijaard et al. (2007), put together from its published bodies: rear
// wheel, frame with rider, fork, front wheel.
TEST(Vehicle, BicyclesAreTheBenchmarkBicycle) {
  constexpr struct {
    double mass_kg, x_m, yaw_inertia_kgm2;
  } bodies[] = {{2.0, 0.0, 0.0603}, {85.0, 0.3, 2.8}, {4.0, 0.9, 0.00708}, {3.0, 1.02, 0.1405}};
  double mass = 0.0;
  double center = 0.0;
  for (const auto& body : bodies) {
    mass += body.mass_kg;
    center += body.mass_kg * body.x_m;
  }
  center /= mass;
  double inertia = 0.0;
  for (const auto& body : bodies) {
    inertia += body.yaw_inertia_kgm2 + body.mass_kg * (body.x_m - center) * (body.x_m - center);
  }
  // From the rear of the rear wheel, 0.3 m of radius, to the front of the front wheel, 0.35 m.
  VehicleFacts facts;
  facts.kind = BodyKind::bicycle;
  facts.mass_kg = mass;
  const TriangleMesh box = test::box_mesh({0.835, 0.3, 0.85}, {0.535, 0, 0.85});
  const Result<Vehicle> v = describe_vehicle(box, facts);
  ASSERT_TRUE(v);
  EXPECT_NEAR(v->center_m.x(), center, 0.01);
  EXPECT_NEAR(v->yaw_inertia_kgm2, inertia, 0.03 * inertia);
}

TEST(Vehicle, WithoutOutlineIsDescribedAndNothingPressesOnIt) {
  VehicleFacts facts;
  facts.kind = BodyKind::truck;
  for (const bool fixed : {false, true}) {
    if (fixed) facts.kind = BodyKind::building;
    const Result<Vehicle> sheet =
        describe_vehicle(test::box_mesh({2.0, 1.0, 0.04}, {0.0, 0.0, 0.04}), facts);
    ASSERT_TRUE(sheet.ok());
    EXPECT_FALSE(sheet->has_outline());
    EXPECT_EQ(sheet->movable(), !fixed);
    EXPECT_EQ(sheet->density_kgm3, 0.0);
    EXPECT_TRUE(sheet->silhouettes.blocks.empty());
  }
  // Wholly above the highest band.
  const Result<Vehicle> high = describe_vehicle(test::box_mesh({1, 1, 1}, {0, 0, 9}), {});
  ASSERT_TRUE(high.ok());
  EXPECT_FALSE(high->has_outline());
  EXPECT_TRUE(describe_vehicle(shipped("truck"), facts)->has_outline());
}

// Axles decide nothing of a lorry's strength: with its wheels and on the same outlines without
// them it is the same.
TEST(Vehicle, AxlesLeaveTheStrengthOfLorriesAlone) {
  VehicleFacts facts;
  facts.kind = BodyKind::truck;
  facts.mass_kg = 14000.0;
  const TriangleMesh mesh = shipped("truck");
  auto without = std::make_shared<Profile>(*make_profile(mesh));
  const std::uint32_t wheels = without->first[1];
  ASSERT_GT(wheels, 0U);
  without->pieces.erase(without->pieces.begin(), without->pieces.begin() + wheels);
  without->area_m2[0] = 0.0F;
  for (std::uint32_t& first : without->first) first -= std::min(first, wheels);
  for (std::uint32_t& first : without->first_inner) first -= std::min(first, wheels);
  const Result<Vehicle> seen = describe_vehicle(mesh, facts);
  const Result<Vehicle> unseen = describe_vehicle(mesh, facts, without);
  ASSERT_TRUE(seen && unseen);
  EXPECT_GT(seen->wheelbase_m, 5.0);
  EXPECT_EQ(unseen->wheelbase_m, 0.0);
  EXPECT_EQ(seen->center_m, unseen->center_m);
  EXPECT_EQ(seen->yaw_inertia_kgm2, unseen->yaw_inertia_kgm2);
  for (const auto law : {&CrushStrength::front, &CrushStrength::side, &CrushStrength::rear}) {
    EXPECT_EQ((seen->strength.*law).yield_npm, (unseen->strength.*law).yield_npm);
    EXPECT_EQ((seen->strength.*law).slope_npm2, (unseen->strength.*law).slope_npm2);
    EXPECT_EQ((seen->strength.*law).length_m, (unseen->strength.*law).length_m);
  }
  const CrushCore& p = seen->strength.core;
  const CrushCore& q = unseen->strength.core;
  EXPECT_EQ(p.rails_half_width_m, q.rails_half_width_m);
  EXPECT_EQ(p.cage_half_width_m, q.cage_half_width_m);
  EXPECT_EQ(p.cage_front_m, q.cage_front_m);
  EXPECT_EQ(p.cage_rear_m, q.cage_rear_m);
  EXPECT_EQ(p.engine_m, q.engine_m);
  EXPECT_EQ(p.inside, q.inside);
  EXPECT_EQ(p.outside, q.outside);
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

TEST(Vehicle, ACentreOfMassOutsideTheBodyIsRefused) {
  const TriangleMesh mesh = test::box_mesh({2.0, 0.9, 0.7}, {2.0, 0.0, 0.7});
  for (const Vector3d& center : {Vector3d(50, 0, 0.5), Vector3d(2, -1, 0.5), Vector3d(2, 0, -50)}) {
    VehicleFacts facts;
    facts.center_of_mass_m = center;
    const Result<Vehicle> vehicle = describe_vehicle(mesh, facts);
    ASSERT_FALSE(vehicle);
    EXPECT_EQ(vehicle.error().code, ErrorCode::bad_input);
  }
  VehicleFacts facts;
  facts.center_of_mass_m = Vector3d(1.5, 0.1, 0.4);
  EXPECT_TRUE(describe_vehicle(mesh, facts));
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

TEST(Vehicle, WithoutATriangleItIsRefused) {
  const Result<Vehicle> empty = describe_vehicle(TriangleMesh{}, {});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, ErrorCode::bad_input);
}

}  // namespace
}  // namespace crashrank
