#include "crash/contact_checks.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::change;
using test::ContactDraw;
using test::ContactScene;
using test::expect_same_bits;
using test::for_random_contacts;
using test::make_scene;
using test::percentile;
using test::print_changes;
using test::simulate;
using test::test_bodies;
using test::variant_for;

TEST(ContactLaw, ExchangeOfTheBodiesChangesNoBit) {
  int acting = 0;
  for_random_contacts(
      101, 1000, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome plain = simulate(scene, variant_for(i));
        std::swap(scene.a, scene.b);
        const ContactOutcome exchanged = simulate(scene, variant_for(i));
        acting += plain.acts ? 1 : 0;
        expect_same_bits(plain, exchanged);
        expect_same_bits(plain.a, exchanged.b);
        expect_same_bits(plain.b, exchanged.a);
        ASSERT_FALSE(testing::Test::HasFailure());
      });
  EXPECT_GT(acting, 800);
}

TEST(ContactLaw, WorkspaceKeepsNoStateBetweenContacts) {
  ContactWorkspace used;
  for_random_contacts(
      102, 200, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        ContactWorkspace fresh;
        const ContactVariant variant = variant_for(i);
        const ContactOutcome first =
            simulate_contact(scene.a, scene.b, {}, scene.point_m, variant, fresh);
        const ContactOutcome again =
            simulate_contact(scene.a, scene.b, {}, scene.point_m, variant, used);
        expect_same_bits(first, again);
        expect_same_bits(first.a, again.a);
        expect_same_bits(first.b, again.b);
        ASSERT_FALSE(testing::Test::HasFailure());
      });
}

TEST(ContactLaw, EveryVectorUnitHasTheSameBits) {
  std::vector<ContactOutcome> expected;
  int units = 0;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & (~left + 1));
    hwy::GetChosenTarget().DeInit();
    SCOPED_TRACE(hwy::TargetName(left & (~left + 1)));
    std::size_t next = 0;
    for_random_contacts(
        105, 200,
        [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
          ContactScene scene;
          if (!make_scene(draw, a, b, closing, scene)) return;
          const ContactOutcome outcome = simulate(scene, variant_for(i));
          if (units == 0) {
            expected.push_back(outcome);
            return;
          }
          ASSERT_LT(next, expected.size());
          expect_same_bits(expected[next], outcome);
          expect_same_bits(expected[next].a, outcome.a);
          expect_same_bits(expected[next].b, outcome.b);
          ++next;
        });
    ++units;
    if (testing::Test::HasFailure()) break;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  std::printf("%d units, %zu contacts\n", units, expected.size());
  EXPECT_GT(expected.size(), 100U);
}

TEST(ContactLaw, TurningTheWorldTurnsTheOutcome) {
  std::vector<double> changes;
  for_random_contacts(
      103, 1500, [&](int i, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome before = simulate(scene);
        const Pose turn = test::flat_pose(0, 0, 0.1 + 0.37 * i);
        for (ContactBody* body : {&scene.a, &scene.b}) {
          body->pose = compose(turn, body->pose);
          body->velocity.linear_mps = turn.rotation * body->velocity.linear_mps;
        }
        scene.point_m = turn.rotation * scene.point_m;
        ContactOutcome after = simulate(scene);
        for (BodyContact* body : {&after.a, &after.b}) {
          body->delta_v_mps = turn.rotation.transpose() * body->delta_v_mps;
        }
        changes.push_back(change(before, after, closing));
      });
  print_changes("rotation", changes);
  EXPECT_LT(percentile(changes, 0.99), 1e-6);
}

/// A copy of the vehicle with every outline piece mirrored at the plane y = 0.
Vehicle mirrored_copy(const Vehicle& v) {
  Vehicle m = v;
  Profile profile = *v.profile;
  for (OutlinePiece& piece : profile.pieces) {
    piece.y = -piece.y;
    piece.normal_y = -piece.normal_y;
  }
  m.center_m.y() = -v.center_m.y();
  m.profile = std::make_shared<const Profile>(std::move(profile));
  m.silhouettes = make_silhouettes(*m.profile);
  return m;
}

/// Differences of delta-v between contacts and their mirror images, for bodies mirrored by the
/// given function.
std::vector<double> mirror_changes(const std::function<const Vehicle*(std::size_t)>& mirrored) {
  std::vector<double> changes;
  for_random_contacts(
      104, 1500, [&](int, const ContactDraw& draw, std::size_t a, std::size_t b, double closing) {
        ContactScene scene;
        if (!make_scene(draw, a, b, closing, scene)) return;
        const ContactOutcome before = simulate(scene);
        const Matrix3d m = Vector3d(1, -1, 1).asDiagonal();
        scene.a.vehicle = mirrored(a);
        scene.b.vehicle = mirrored(b);
        for (ContactBody* body : {&scene.a, &scene.b}) {
          body->pose.rotation = m * body->pose.rotation * m;
          body->pose.translation = m * body->pose.translation;
          body->velocity.linear_mps = m * body->velocity.linear_mps;
          body->velocity.angular_radps *= -1.0;
        }
        scene.point_m = m * scene.point_m;
        ContactOutcome after = simulate(scene);
        for (BodyContact* body : {&after.a, &after.b}) body->delta_v_mps = m * body->delta_v_mps;
        changes.push_back(change(before, after, closing));
      });
  return changes;
}

TEST(ContactLaw, MirroredOutlinesMirrorTheOutcome) {
  std::vector<Vehicle> mirrored;
  for (std::size_t i = 0; i < test_bodies().size(); ++i) {
    mirrored.push_back(mirrored_copy(test_bodies().any(i).vehicle));
  }
  const std::vector<double> changes = mirror_changes([&](std::size_t i) { return &mirrored[i]; });
  print_changes("mirrored outlines", changes);
  EXPECT_LT(percentile(changes, 0.5), 1e-6) << "the goal is 1e-6 in 99 % of contacts";
  EXPECT_LT(percentile(changes, 0.9), 0.001);
  EXPECT_LT(percentile(changes, 0.95), 0.01);
}

TEST(ContactLaw, MirroredMeshesMirrorTheOutcome) {
  const std::vector<double> changes =
      mirror_changes([](std::size_t i) { return &test::mirrored_bodies().any(i).vehicle; });
  print_changes("mirrored meshes", changes);
  EXPECT_LT(percentile(changes, 0.5), 1e-6) << "the goal is 1e-6 in 99 % of contacts";
  EXPECT_LT(percentile(changes, 0.9), 0.001);
  EXPECT_LT(percentile(changes, 0.95), 0.01);
}

TEST(ContactLaw, FrictionIsSymmetricInTheSurfaces) {
  constexpr std::array<Surface, 6> all{Surface::sheet_metal, Surface::steel,  Surface::concrete,
                                       Surface::wood,        Surface::rubber, Surface::person};
  for (const Surface a : all) {
    for (const Surface b : all) {
      EXPECT_EQ(friction_between(a, b), friction_between(b, a));
      EXPECT_GT(friction_between(a, b), 0.0);
      EXPECT_LT(friction_between(a, b), 1.0);
    }
  }
  EXPECT_EQ(friction_between(Surface::sheet_metal, Surface::sheet_metal), 0.3);
  EXPECT_EQ(friction_between(Surface::sheet_metal, Surface::concrete), 0.3);
  EXPECT_EQ(friction_between(Surface::sheet_metal, Surface::steel), 0.1);
}

}  // namespace
}  // namespace crashrank
