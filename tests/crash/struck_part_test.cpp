#include "crash/struck_part.hpp"

#include "crash/scene_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

using test::block_mesh;
using test::flat_pose;
using test::named;
using test::SceneSetup;
using test::vehicle_from;

constexpr double person_kg = 75.0;

Vehicle block(double length, double width, double height, BodyKind kind, double mass_kg) {
  VehicleFacts facts;
  facts.kind = kind;
  facts.mass_kg = mass_kg;
  return vehicle_from(block_mesh(length, width, height), facts);
}

/// A person of 0.3 x 0.5 x 1.7 m.
const Vehicle& person() {
  static const Vehicle v = block(0.3, 0.5, 1.7, BodyKind::pedestrian, person_kg);
  return v;
}

PressedBody placed(const Vehicle& v, const Pose& pose, double vx_mps) {
  ContactBody body{&v, pose, {}};
  body.velocity.linear_mps.x() = vx_mps;
  return {&v, {v.strength, 1.0}, make_planar(body, Eigen::Vector3d::Zero())};
}

double struck_mps(const Vehicle& striker, const Pose& person_pose, double speed_mps) {
  const PressedBody of_person = placed(person(), person_pose, 0.0);
  const PressedBody of_striker = placed(striker, flat_pose(0, 0, 0), speed_mps);
  const PressedBody* const strikers[] = {&of_striker};
  return struck_part_mps(of_person, {strikers, 1});
}

TEST(StruckPart, OfABlockIsTheRootOfItsCoveredShare) {
  constexpr double lorry_kg = 10000.0;
  const Vehicle lorry = block(6.0, 2.4, 3.0, BodyKind::truck, lorry_kg);
  for (double covered_m = 0.0; covered_m <= 0.6; covered_m += 0.01) {
    const double share = std::min(1.0, covered_m / 0.5);
    // Outlines lie up to a millimetre beside the mesh.
    const double least = std::sqrt(std::max(0.0, share - 0.002));
    const double most = std::sqrt(std::min(1.0, share + 0.002));
    const double mps = struck_mps(lorry, flat_pose(3.2, 1.2 + 0.25 - covered_m, 0), 10.0) *
                       (1.0 + share * person_kg / lorry_kg);
    EXPECT_GE(mps, 10.0 * least - 1e-3) << covered_m;
    EXPECT_LE(mps, 10.0 * most + 1e-3) << covered_m;
  }
}

TEST(StruckPart, CountsOnlyWhatIsAheadAtCommonHeights) {
  const Vehicle lorry = block(6.0, 2.4, 3.0, BodyKind::truck, 10000.0);
  const Vehicle trolley = block(6.0, 2.4, 0.6, BodyKind::truck, 10000.0);
  const Pose ahead = flat_pose(3.2, 0.0, 0.0);
  // Who is hit by a low front is hit whole: what is above is not passed by anything.
  EXPECT_NEAR(struck_mps(trolley, ahead, 10.0), struck_mps(lorry, ahead, 10.0), 1e-6);
  EXPECT_EQ(struck_mps(lorry, ahead, -10.0), 0.0);
  EXPECT_EQ(struck_mps(lorry, ahead, 0.0), 0.0);
}

TEST(StruckPart, IsThatOfTheFirstForceBetweenTheBodies) {
  const double half_m = 0.5 * named("truck").silhouettes.width_m();
  const auto struck = [&](double y_m) {
    SceneSetup setup;
    setup.add(named("truck"), flat_pose(0, 0, 0), 15.0);
    setup.add(named("pedestrian"), flat_pose(8.0, y_m, detail::pi), 0.0);
    SceneRun run;
    run.begin(setup.make_bodies(true), 0, 1, 0.0, Eigen::Vector3d::Zero(), {});
    test::run_to_end(run);
    double most = 0.0;
    std::size_t cells = 0;
    for (const ExposureCell& cell : run.exposure_cells(1)) {
      most = std::max(most, cell.action.struck_mps);
      cells += cell.action.struck_mps > 0.0 ? 1 : 0;
    }
    EXPECT_LE(cells, 2U) << y_m;
    return most;
  };
  double before = struck(0.0);
  EXPECT_NEAR(before, 15.0, 0.01);
  for (double y_m = half_m - 0.6; y_m < half_m + 0.4; y_m += 0.02) {
    const double now = struck(y_m);
    EXPECT_LE(now, before + 1e-6) << y_m;
    // Pieces press from their middles on: the last centimetres of overlap exert no force.
    EXPECT_GE(now, before - 3.0) << y_m;
    before = now;
  }
  EXPECT_LT(before, 1.0);
}

}  // namespace
}  // namespace crashrank::detail
