#include "crashrank/crash/contact.hpp"

#include "crash/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using test::box_mesh;
constexpr double pi = std::numbers::pi;

Model model_of(const TriangleMesh& mesh, const BuildOptions& options = {}) {
  return *make_model(mesh, options);
}

class Contact : public testing::Test {
protected:
  ContactFacts facts(const Model& a, const Motion& ma, const Model& b, const Motion& mb) {
    const Impact impact = time_of_impact(a.tree, ma, b.tree, mb, 0, 5, impact_workspace_);
    EXPECT_TRUE(impact.hit());
    impact_ = impact;
    return contact_facts(a, ma, b, mb, impact, workspace_);
  }
  Impact impact_;
  ImpactWorkspace impact_workspace_;
  ContactWorkspace workspace_;
};

TEST_F(Contact, TwoTrianglesCutEachOtherInASegment) {
  const TriangleD flat{{Vector3d(0, 0, 0), Vector3d(4, 0, 0), Vector3d(0, 4, 0)}};
  const TriangleD upright{{Vector3d(1, 1, -1), Vector3d(1, 1, 1), Vector3d(1, -9, 0)}};
  std::array<Vector3d, 2> ends;
  ASSERT_TRUE(cut_of(flat, upright, ends));
  const bool turned = ends[0].y() > ends[1].y();
  EXPECT_NEAR((ends[turned ? 1 : 0] - Vector3d(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((ends[turned ? 0 : 1] - Vector3d(1, 1, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(cut_of(flat, flat, ends));
}

TEST_F(Contact, AnOffsetFrontalHasTheSharedWidthAndHeight) {
  // 1.8 m wide cars, 40 % overlap; the other one is higher off the ground.
  const Model a = model_of(box_mesh({2.2, 0.9, 0.5}, {0, 0, 0.7}, 5));
  const Model b = model_of(box_mesh({2.2, 0.9, 0.6}, {0, 0, 1.0}, 4));
  const Motion ma = TurnMotion{pose_from_angles({-10, 0, 0}, 0, 0, 0), 15, 0, 0};
  const Motion mb = TurnMotion{pose_from_angles({10, 1.08, 0}, pi, 0, 0), 10, 0, 0};
  const ContactFacts f = facts(a, ma, b, mb);
  EXPECT_EQ(f.normal_source, NormalSource::region);
  // Both fronts and two corners bound the curve: it leans by the depth over the width and height.
  EXPECT_NEAR((f.normal - Vector3d(1, 0, 0)).norm(), 0, 0.04);
  EXPECT_NEAR(f.normal_speed_mps, 25, 0.03);
  EXPECT_NEAR(f.relative_speed_mps, 25, 1e-9);
  EXPECT_NEAR(f.overlap_width_m, 0.72, 1e-3);
  EXPECT_NEAR(f.overlap_height_m, 1.2 - 0.4, 1e-3);
  EXPECT_NEAR(f.overlap_area_m2, 0.72 * 0.8, 1e-2);
  EXPECT_NEAR(f.lowest_m, 0.4, 1e-5);
  EXPECT_NEAR(f.highest_m, 1.2, 1e-5);
  EXPECT_NEAR(f.point_m.y(), 0.54, 2e-3);
  EXPECT_GT(f.region_a.max.x(), 2.1F);
  EXPECT_GT(f.region_b.max.x(), 2.1F);
  EXPECT_LT(f.region_b.max.y(), 0.91F);
  EXPECT_NEAR((f.time_s - impact_.time_s) * 25, 0.02, 1e-9);
}

TEST_F(Contact, TheNormalOfAnObliqueHitIsThatOfTheFace) {
  // A pole against the side of a turned car.
  const double turn = 0.5;
  const Model car = model_of(box_mesh({2.2, 0.9, 0.7}, {0, 0, 0.7}, 6));
  const Model pole = model_of(test::sphere_mesh(0.2, 12, {0, 0, 0.7}));
  const Motion parked = Motion::at_rest(pose_from_angles({0, 0, 0}, turn, 0, 0));
  const Vector3d out(-std::sin(turn), std::cos(turn), 0);
  Pose start;
  start.translation = 4 * out;
  const Motion flying = FreeMotion{start, {-8 * out + Vector3d(1, 0, 0), {0, 0, 0}}};
  const ContactFacts f = facts(car, parked, pole, flying);
  EXPECT_NEAR((f.normal - out).norm(), 0, 1e-3);
  EXPECT_NEAR(f.normal_speed_mps, 8 + std::sin(turn), 1e-2);
  EXPECT_GT(f.overlap_width_m, 0.15);
  EXPECT_LT(f.overlap_width_m, 0.4);
}

TEST_F(Contact, FacesThatPointAnywhereStillGiveAPlane) {
  TriangleMesh mixed = box_mesh({2.2, 0.9, 0.5}, {0, 0, 0.7}, 5);
  for (std::size_t i = 0; i < mixed.triangles.size(); i += 2) {
    std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
  }
  const Model a = model_of(mixed);
  const Model wall = model_of(box_mesh({0.2, 5, 2}));
  const Motion ma = TurnMotion{pose_from_angles({-10, 0, 0}, 0, 0, 0), 15, 0, 0};
  const ContactFacts f = facts(a, ma, wall, Motion());
  EXPECT_EQ(f.normal_source, NormalSource::plane);
  EXPECT_NEAR((f.normal - Vector3d(1, 0, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR(f.overlap_width_m, 1.8, 1e-5);
  EXPECT_NEAR(f.overlap_height_m, 1.0, 1e-5);
}

TEST_F(Contact, TheTreeDoesNotMatter) {
  const TriangleMesh mesh_a = box_mesh({2.2, 0.9, 0.5}, {0, 0, 0.7}, 5);
  const TriangleMesh mesh_b = test::sphere_mesh(0.8, 14, {0, 0.3, 0.8});
  const Motion ma = ArcMotion{pose_from_angles({-10, 1, 0}, 0, 0, 0), 15, 0.01, -2};
  const ContactFacts one = facts(model_of(mesh_a), ma, model_of(mesh_b), Motion());
  const BuildOptions other{SplitRule::sah, BoxFrame::gaussian, 1};
  const ContactFacts two = facts(model_of(mesh_a, other), ma, model_of(mesh_b, other), Motion());
  EXPECT_NEAR(one.time_s, two.time_s, 1e-7);
  EXPECT_NEAR((one.point_m - two.point_m).norm(), 0, 1e-5);
  EXPECT_NEAR((one.normal - two.normal).norm(), 0, 1e-5);
}

TEST_F(Contact, InsideAnotherThereIsNoRegion) {
  const Model big = model_of(box_mesh({3, 3, 3}));
  const Model small = model_of(box_mesh({0.2, 0.2, 0.2}, {0.1, 0, 0}));
  const Motion moving = FreeMotion{{}, {{0, 4, 0}, {0, 0, 0}}};
  const ContactFacts f = facts(big, Motion(), small, moving);
  EXPECT_EQ(f.pairs, 0U);
  EXPECT_EQ(f.normal_source, NormalSource::motion);
  EXPECT_NEAR((f.point_m - Vector3d(0.1, 0, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((f.normal - Vector3d(0, -1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(f.normal_speed_mps, 4, 1e-12);
  EXPECT_TRUE(f.region_a.empty());
}

TEST_F(Contact, BodiesThatOverlapAtTheStartAreSeenAsTheyStand) {
  const Model box = model_of(box_mesh({1, 1, 1}, {0, 0, 0}, 3));
  Pose start;
  start.translation = Vector3d(1.5, 0.5, 0.25);
  const ContactFacts f = facts(box, Motion(), box, FreeMotion{start, {{-1, 0, 0}, {0, 0, 0}}});
  EXPECT_EQ(f.time_s, 0.0);
  EXPECT_GT(f.pairs, 0U);
  EXPECT_GT(f.normal.x(), 0.0);
}

}  // namespace
}  // namespace crashrank
