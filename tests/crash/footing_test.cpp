#include "crash/tyres.hpp"
#include "crashrank/vehicle/vehicle.hpp"
#include "tree/shapes.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

namespace crashrank {
namespace {

using detail::Footing;
using detail::Wheels;
using Eigen::Vector3d;

/// A box on the ground with its rear face at x = 0 and its centre at y = `left`.
Vehicle box_vehicle(BodyKind kind, double length, double width, double height, double left = 0.0,
                    const std::optional<Vector3d>& center = {}) {
  VehicleFacts facts;
  facts.kind = kind;
  facts.center_of_mass_m = center;
  Result<Vehicle> vehicle = describe_vehicle(
      test::box_mesh({0.5 * length, 0.5 * width, 0.5 * height}, {0.5 * length, left, 0.5 * height}),
      facts);
  if (!vehicle) throw std::runtime_error(vehicle.error().message());
  return std::move(*vehicle);
}

double total_load(const Footing& f) { return f.front_load.sum() + f.rear_load.sum(); }

/// Sum of load times lever arm: zero if the loads balance the centre of mass.
Eigen::Vector2d imbalance(const Footing& f) {
  return {f.front_m * f.front_load.sum() + f.rear_m * f.rear_load.sum(),
          (f.y_m * (f.front_load + f.rear_load)).sum()};
}

TEST(Footing, CarsStandOnFourWheelsAtTheirAxles) {
  const Vehicle v = box_vehicle(BodyKind::car, 4.5, 1.8, 1.4, 0.1);
  const Footing f = detail::footing_of(v);
  EXPECT_TRUE(f.wheels);
  EXPECT_NEAR(f.front_m + v.center_m.x(), v.rear_axle_x_m + v.wheelbase_m, 1e-12);
  EXPECT_NEAR(f.rear_m + v.center_m.x(), v.rear_axle_x_m, 1e-12);
  // The track is 0.86 of the width; outlines are exact to a cell of 2 cm.
  EXPECT_NEAR(f.y_m[0] - f.y_m[1], 0.86 * 1.8, 0.03);
  EXPECT_NEAR(f.y_m.sum(), 0.0, 0.02);
  // 58 % of the load is on the front axle, see Vehicle.
  EXPECT_NEAR(f.front_load.sum(), 0.58, 1e-12);
  EXPECT_NEAR(total_load(f), 1.0, 1e-12);
  EXPECT_NEAR(imbalance(f).norm(), 0.0, 1e-12);
  EXPECT_GT(f.cornering, 11.0 * 0.57);
  EXPECT_LT(f.cornering, 30.0 * 0.573);
}

TEST(Footing, CentreOfMassDeterminesTheLoads) {
  const Vehicle v = box_vehicle(BodyKind::car, 4.5, 1.8, 1.4, 0.0, Vector3d(2.0, 0.2, 0.5));
  const Footing f = detail::footing_of(v);
  EXPECT_GT(f.front_load[0], f.front_load[1]);
  EXPECT_NEAR(total_load(f), 1.0, 1e-12);
  EXPECT_NEAR(imbalance(f).norm(), 0.0, 1e-12);
  // A centre of mass in front of the front axle puts all load on that axle.
  const Footing nose =
      detail::footing_of(box_vehicle(BodyKind::car, 4.5, 1.8, 1.4, 0.0, Vector3d(4.4, 0, 0.5)));
  EXPECT_NEAR(nose.front_load.sum(), 1.0, 1e-12);
  EXPECT_EQ(nose.rear_load.sum(), 0.0);
}

TEST(Footing, BodiesWithoutAxlesSlideOnFourPatches) {
  for (const BodyKind kind : {BodyKind::motorcycle, BodyKind::bicycle, BodyKind::pedestrian,
                              BodyKind::truck, BodyKind::bus}) {
    Vehicle v = box_vehicle(kind, 2.0, 0.8, 1.5);
    v.wheelbase_m = 0.0;
    v.center_m.x() = 1.0;  // centre of the box
    const Footing f = detail::footing_of(v);
    EXPECT_FALSE(f.wheels);
    EXPECT_EQ(f.cornering, 0.0);
    EXPECT_NEAR(f.front_m, 0.5, 0.03);
    EXPECT_NEAR(f.rear_m, -0.5, 0.03);
    EXPECT_NEAR(f.y_m[0], 0.2, 0.03);
    EXPECT_NEAR(f.y_m[1], -0.2, 0.03);
    EXPECT_NEAR(total_load(f), 1.0, 1e-12);
    EXPECT_NEAR(imbalance(f).norm(), 0.0, 1e-12);
    // Patches never turn, whatever state is requested.
    const Wheels w = detail::wheels_after(f, AfterContact::releases, 0.3, 0.5);
    EXPECT_TRUE((w.front.locked == 1.0).all() && (w.rear.locked == 1.0).all());
    EXPECT_TRUE((w.front.brake == 1.0).all() && (w.rear.side == 1.0).all());
  }
}

TEST(Footing, ALorryWithKnownAxlesStandsOnWheels) {
  Vehicle v = box_vehicle(BodyKind::truck, 9.0, 2.5, 3.5);
  v.rear_axle_x_m = 2.0;
  v.wheelbase_m = 5.0;
  const Footing f = detail::footing_of(v);
  EXPECT_TRUE(f.wheels);
  EXPECT_NEAR(f.front_m, 2.5, 0.02);
  EXPECT_NEAR(f.rear_m, -2.5, 0.02);
  EXPECT_LT(f.cornering, detail::footing_of(box_vehicle(BodyKind::car, 4, 2, 1)).cornering);
}

TEST(Footing, TheMirroredVehicleHasTheMirroredFooting) {
  const Vehicle v = box_vehicle(BodyKind::car, 4.5, 1.8, 1.4, 0.1, Vector3d(2.0, 0.2, 0.5));
  Vehicle m = v;
  m.center_m.y() = -v.center_m.y();
  Profile mirrored = *v.profile;
  for (OutlinePiece& piece : mirrored.pieces) {
    piece.y = -piece.y;
    piece.normal_y = -piece.normal_y;
  }
  m.profile = std::make_shared<const Profile>(std::move(mirrored));
  const Footing f = detail::footing_of(v);
  const Footing g = detail::footing_of(m);
  EXPECT_EQ(g.front_m, f.front_m);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(g.y_m[i], -f.y_m[1 - i]);
    EXPECT_EQ(g.front_load[i], f.front_load[1 - i]);
    EXPECT_EQ(g.rear_load[i], f.rear_load[1 - i]);
  }
}

TEST(Wheels, DamagedWheelsAreLockedAndTheOthersKeepTheirState) {
  Footing f;
  f.wheels = true;
  const Wheels w = detail::wheels_after(f, AfterContact::brakes, 0.1, 0.6, 0b0110U);
  EXPECT_EQ(w.front.locked[0], 0.0);
  EXPECT_EQ(w.front.locked[1], 1.0);
  EXPECT_EQ(w.rear.locked[0], 1.0);
  EXPECT_EQ(w.rear.locked[1], 0.0);
  EXPECT_EQ(w.front.brake[0], 0.6);
  EXPECT_NEAR(w.front.side[0], 0.8, 1e-15);
  EXPECT_EQ(w.front.brake[1], 1.0);
  EXPECT_NEAR(w.sine, 0.0998, 1e-4);
  const Wheels released = detail::wheels_after(f, AfterContact::releases, 0.1, 0.6);
  EXPECT_TRUE((released.front.brake == 0.0).all() && (released.rear.locked == 0.0).all());
  const Wheels locked = detail::wheels_after(f, AfterContact::locks, 0.1, 0.6);
  EXPECT_TRUE((locked.front.locked == 1.0).all() && (locked.rear.locked == 1.0).all());
}

}  // namespace
}  // namespace crashrank
