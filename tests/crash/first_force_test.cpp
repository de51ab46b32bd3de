// When and where the contact law begins to press, against the exact time of impact of the meshes.
#include "crash/scene_cases.hpp"

#include "campaign.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/motion/time_of_impact.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::flat_pose;
using test::Random;

void append(TriangleMesh& mesh, TriangleMesh part, const Vector3d& at, double turn) {
  const Eigen::AngleAxisd about(turn, Vector3d::UnitZ());
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& v : part.vertices) {
    mesh.vertices.push_back((about * v.cast<double>() + at).cast<float>());
  }
  for (const auto& [a, b, c] : part.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
}

/// Size of a box and the height of its middle.
void append_box(TriangleMesh& mesh, const Vector3d& size, double x, double y, double middle_z,
                double turn) {
  append(mesh, test::box_mesh(0.5 * size), {x, y, middle_z}, turn);
}

/// A body of boxes, beams, plates and posts, a ring, a walled yard or a portal, at random heights
/// and turns.
TriangleMesh random_body(Random& random, bool fixed) {
  TriangleMesh mesh;
  const double turn = random.uniform(-3.1, 3.1);
  // What a movable body encloses counts as its structure.
  switch (fixed ? random.below(4) : 2 + random.below(2)) {
    case 0: {  // a ring of straight walls
      const double radius = random.uniform(2.0, 6.0);
      const double low = random.uniform(0.0, 1.0);
      const double height = random.uniform(0.1, 1.5);
      constexpr int walls = 8;
      for (int k = 0; k < walls; ++k) {
        const double round = turn + 2.0 * detail::pi * k / walls;
        append_box(mesh, {0.3, 2.2 * radius * std::tan(detail::pi / walls), height},
                   radius * std::cos(round), radius * std::sin(round), low + 0.5 * height, round);
      }
      break;
    }
    case 1: {  // a portal: two posts and a beam
      const double half = random.uniform(0.8, 3.0);
      const double high = random.uniform(0.6, 3.5);
      const double beam = random.uniform(0.05, 0.4);
      for (const double side : {-half, half}) {
        append_box(mesh, {0.2, 0.2, high}, -side * std::sin(turn), side * std::cos(turn),
                   0.5 * high, turn);
      }
      append_box(mesh, {0.2, 2.0 * half, beam}, 0, 0, high - 0.5 * beam, turn);
      break;
    }
    default: {
      const std::size_t parts = 1 + random.below(4);
      for (std::size_t k = 0; k < parts; ++k) {
        const Vector3d size(random.uniform(0.1, 4.0), random.uniform(0.1, 1.5),
                            random.uniform(0.03, 1.2));
        append_box(mesh, size, random.uniform(-1.5, 1.5), random.uniform(-1.0, 1.0),
                   random.uniform(0.15, 2.5) + 0.5 * size.z(), random.uniform(-3.1, 3.1));
      }
    }
  }
  return mesh;
}

/// When two meshes touch, and when the law begins to press; below 0 where it never does.
struct Meeting {
  Impact impact;
  double force_s = -1.0;
};

/// A moving body on its way of `until_m` towards a fixed one. The scene begins at time 0, or as in
/// a ranking where the meshes touch.
Meeting meeting_of(const TriangleMesh& mesh_a, const VehicleFacts& moving, const Pose& from,
                   double speed_mps, const TriangleMesh& mesh_b, const Pose& at, double until_m,
                   bool from_contact = false) {
  VehicleFacts standing;
  standing.kind = BodyKind::building;
  const Vehicle a = test::vehicle_from(mesh_a, moving);
  const Vehicle b = test::vehicle_from(mesh_b, standing);
  test::SceneSetup setup;
  setup.add(a, from, speed_mps);
  setup.add(b, at, 0.0);
  const Result<Model> model_a = make_model(mesh_a);
  const Result<Model> model_b = make_model(mesh_b);
  Meeting meeting;
  if (!model_a || !model_b) {
    ADD_FAILURE() << "no model";
    return meeting;
  }
  ImpactWorkspace workspace;
  const double until_s = until_m / speed_mps;
  meeting.impact = time_of_impact(model_a->tree, setup.plans[0], model_b->tree, setup.plans[1], 0.0,
                                  until_s, workspace);
  detail::SceneRun run;
  run.prepare(2, std::max(a.profile->pieces.size(), b.profile->pieces.size()), false);
  detail::SceneOptions options = test::options_with_steps(0.03);
  options.until_s = until_s;
  options.longest_s = until_s;
  options.fastest_plan_mps = speed_mps;
  const double start_s = from_contact ? meeting.impact.time_s : 0.0;
  run.begin(setup.make_bodies(false), 0, 1, start_s, Vector3d::Zero(), options);
  while (meeting.force_s < 0.0 && run.advance(1)) {
    if (run.touched(0)) meeting.force_s = run.now_s();
  }
  return meeting;
}

TEST(FirstForce, ComesNearTheExactTimeOfImpactAndNeverWithoutOne) {
  const test::Campaign campaign = test::scene_campaign(4001, 300);
  Random random(campaign.seed);
  std::uint64_t meet = 0;
  std::uint64_t apart = 0;
  std::uint64_t missing = 0;   // contacts without a force
  std::uint64_t invented = 0;  // forces without a contact
  std::vector<double> off_m;   // travel between contact and force
  for (std::uint64_t n = 0; n < campaign.count; ++n) {
    const TriangleMesh mesh_a = random_body(random, false);
    const TriangleMesh mesh_b = random_body(random, true);
    VehicleFacts moving;
    moving.mass_kg = 1500.0;
    const double speed_mps = random.uniform(2.0, 20.0);
    const double way_m = 14.0;
    const Pose from = flat_pose(-way_m, random.uniform(-3.0, 3.0), random.uniform(-0.15, 0.15));
    const Pose at = flat_pose(0.0, 0.0, random.uniform(-3.1, 3.1));
    const Meeting meeting = meeting_of(mesh_a, moving, from, speed_mps, mesh_b, at, 2.0 * way_m);
    const Impact& impact = meeting.impact;
    const double force_s = meeting.force_s;
    if (impact.state != ImpactState::contact && impact.state != ImpactState::none) continue;
    const bool contact = impact.state == ImpactState::contact;
    (contact ? meet : apart) += 1;
    if (!contact) {
      invented += force_s >= 0.0 ? 1U : 0U;
      if (force_s >= 0.0) {
        std::printf("scene %llu: a force without a contact\n", static_cast<unsigned long long>(n));
      }
      continue;
    }
    if (force_s < 0.0) {
      ++missing;
      std::printf("scene %llu: a contact at %.3f s without a force\n",
                  static_cast<unsigned long long>(n), impact.time_s);
      continue;
    }
    off_m.push_back(std::abs(force_s - impact.time_s) * speed_mps);
  }
  const auto share_within = [&](double bound_m) {
    const auto within =
        std::count_if(off_m.begin(), off_m.end(), [bound_m](double off) { return off <= bound_m; });
    return static_cast<double>(within) / static_cast<double>(meet);
  };
  std::printf(
      "%llu contacts: the force within 2 cm of travel in %.1f %%, 5 cm in %.1f %%, 10 cm in "
      "%.1f %%, never in %llu; %llu apart, %llu of them with a force\n",
      static_cast<unsigned long long>(meet), 100.0 * share_within(0.02), 100.0 * share_within(0.05),
      100.0 * share_within(0.1), static_cast<unsigned long long>(missing),
      static_cast<unsigned long long>(apart), static_cast<unsigned long long>(invented));
  EXPECT_GT(meet, campaign.count / 4);
  // Pieces of 5 cm act at their middles, and heights are known by row and column of a band.
  EXPECT_GE(share_within(0.02), 0.76) << "the goal is 99 %";
  EXPECT_GE(share_within(0.05), 0.95);
  EXPECT_GE(share_within(0.1), 0.97);
  EXPECT_LE(static_cast<double>(missing), 0.01 * static_cast<double>(meet) + 1.0);
  EXPECT_LE(static_cast<double>(invented), 0.01 * static_cast<double>(apart) + 1.0);
}

// A body whose upper parts stand back behind a lower end within one band of heights: a cabin behind
// a bonnet, a box behind a coupling.
TEST(FirstForce, ABeamAboveTheBonnetPressesOnWhatStandsBehindIt) {
  const test::Campaign campaign = test::scene_campaign(4002, 120);
  Random random(campaign.seed);
  for (std::uint64_t n = 0; n < campaign.count; ++n) {
    const double bonnet_m = random.uniform(0.62, 1.1);
    const double step_m = random.uniform(0.5, 1.6);
    TriangleMesh mesh;
    append_box(mesh, {4.4, 1.8, bonnet_m - 0.2}, 0.0, 0.0, 0.1 + 0.5 * bonnet_m, 0.0);
    append_box(mesh, {2.8 - step_m, 1.5, 1.5 - bonnet_m}, 0.8 - 0.5 * step_m, 0.0,
               0.5 * (1.5 + bonnet_m), 0.0);
    const double low_m = random.uniform(bonnet_m + 0.01, 1.4);
    const double high_m = low_m + random.uniform(0.02, 0.08);
    TriangleMesh beam;
    append_box(beam, {0.05, 6.0, high_m - low_m}, 0.0, 0.0, 0.5 * (low_m + high_m), 0.0);
    VehicleFacts car;
    car.mass_kg = 1500.0;
    const double speed_mps = random.uniform(3.0, 20.0);
    const Pose from = flat_pose(-8.0, 0.0, random.uniform(-0.1, 0.1));
    for (const bool from_contact : {false, true}) {
      const Meeting meeting = meeting_of(mesh, car, from, speed_mps, beam, flat_pose(0.0, 0.0, 0.0),
                                         14.0, from_contact);
      ASSERT_EQ(meeting.impact.state, ImpactState::contact);
      EXPECT_NEAR(meeting.force_s * speed_mps, meeting.impact.time_s * speed_mps, 0.1)
          << "beam from " << low_m << " to " << high_m << " m, bonnet " << bonnet_m << " m";
    }
  }
}

}  // namespace
}  // namespace crashrank
