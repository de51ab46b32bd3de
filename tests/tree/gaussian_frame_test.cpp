#include "crashrank/internal/tree/gaussian_frame.hpp"

#include "crashrank/base/pose.hpp"
#include "crashrank/internal/tree/projection.hpp"
#include "crashrank/tree/build.hpp"
#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>

namespace crashrank {
namespace {

// A soup stretched along x, less along y, turned by a pose.
TriangleMesh turned_slab(const Pose& pose, std::uint64_t seed) {
  TriangleMesh mesh = test::triangle_soup(400, 0.1F, seed);
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3f centred = vertex - Eigen::Vector3f::Constant(0.5F);
    const Eigen::Vector3f stretched = centred.cwiseProduct(Eigen::Vector3f(9, 4, 1));
    vertex = carry(pose, stretched).cast<float>();
  }
  return mesh;
}

TEST(GaussianFrame, FindsTheAxesOfATurnedSlab) {
  const Pose pose = pose_from_angles({3, -2, 1}, 0.6, -0.3, 0.4);
  const Eigen::Matrix3d axes = gaussian_axes(turned_slab(pose, 41));
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(std::abs(axes.col(k).dot(pose.rotation.col(k))), 0.995) << k;
  }
}

TEST(GaussianFrame, AgreesWithEigensSolver) {
  for (std::uint64_t seed = 50; seed < 90; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto angle = [&random] { return 6.0 * static_cast<double>(test::unit_real(random)); };
    const double yaw = angle();
    const double pitch = angle();
    const double roll = angle();
    const TriangleMesh mesh = turned_slab(pose_from_angles({1, 2, 3}, yaw, pitch, roll), seed);
    Eigen::MatrixXd points(static_cast<Eigen::Index>(3 * mesh.size()), 3);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        points.row(static_cast<Eigen::Index>(3 * i + k)) =
            mesh.triangle(i).corner[k].cast<double>().transpose();
      }
    }
    const Eigen::MatrixXd centred = points.rowwise() - points.colwise().mean();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
        Eigen::Matrix3d(centred.transpose() * centred));
    const Eigen::Matrix3d axes = gaussian_axes(mesh);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(std::abs(axes.col(k).dot(solver.eigenvectors().col(2 - k))), 1.0, 1e-9);
      Eigen::Index largest = 0;
      axes.col(k).cwiseAbs().maxCoeff(&largest);
      EXPECT_GT(axes(largest, k), 0.0);
    }
    EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(GaussianFrame, DoesNotDependOnHowVerticesAreShared) {
  TriangleMesh shared;
  shared.vertices = {{0, 0, 0}, {5, 1, 0}, {4, 3, 1}, {1, 2, 2}, {900, 900, 900}};
  shared.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 2, 3}};
  TriangleMesh apart;
  for (std::size_t i = 0; i < shared.size(); ++i) {
    const Triangle t = shared.triangle(i);
    test::add_triangle(apart, t.corner[0], t.corner[1], t.corner[2]);
  }
  EXPECT_EQ(gaussian_axes(shared), gaussian_axes(apart));
}

TEST(GaussianFrame, TreesOfBodiesAlongTheirAxesAreMarkedAsWorld) {
  TriangleMesh mesh;
  for (const float x : {-4.0F, 4.0F}) {
    for (const float y : {-1.0F, 1.0F}) test::add_triangle(mesh, {x, y, 0}, {x, -y, 0}, {-x, y, 0});
  }
  BuildOptions options;
  options.frame = BoxFrame::gaussian;
  const Result<AabbTree> tree = build_tree(mesh, options);
  ASSERT_TRUE(tree.ok());
  EXPECT_TRUE(tree->axes_are_world);
  EXPECT_EQ(tree->axes, Eigen::Matrix3d::Identity());
}

TEST(Projection, RoundsOutward) {
  const float most = std::numeric_limits<float>::max();
  EXPECT_EQ(detail::float_below(1.0), 1.0F);
  EXPECT_EQ(detail::float_below(1.0 + 1e-12), 1.0F);
  EXPECT_EQ(detail::float_above(1.0 + 1e-12), std::nextafter(1.0F, 2.0F));
  EXPECT_EQ(detail::float_below(-1e-300), -std::numeric_limits<float>::denorm_min());
  EXPECT_EQ(detail::float_above(-1e-300), 0.0F);
  EXPECT_EQ(detail::float_below(1e300), most);
  EXPECT_EQ(detail::float_above(1e300), INFINITY);
  EXPECT_EQ(detail::float_below(-1e300), -INFINITY);
  EXPECT_EQ(detail::float_above(-1e300), -most);
}

// The exact projection as a sum of six doubles that lose nothing: products of a double and a float
// split with fma, summed in long double against bounds that are floats.
TEST(Projection, EnclosesTheExactValue) {
  std::mt19937_64 random(61);
  for (int round = 0; round < 20000; ++round) {
    const double yaw = 7.0 * static_cast<double>(test::unit_real(random));
    const double pitch = 7.0 * static_cast<double>(test::unit_real(random));
    const Eigen::Matrix3d axes = pose_from_angles({0, 0, 0}, yaw, pitch, 1.0).rotation;
    const auto exponent = static_cast<int>(random() % 60) - 30;
    Eigen::Vector3f point = test::unit_point(random) * std::ldexp(1.0F, exponent);
    // Half of them cancel: a point nearly perpendicular to the axis.
    if (round % 2 == 0) {
      point = (axes.col(1) * static_cast<double>(point.x())).cast<float>();
    }
    const detail::FloatInterval p = detail::project(axes, 0, point);
    long double exact = 0;
    for (int k = 0; k < 3; ++k) {
      const double a = axes(k, 0);
      const auto x = static_cast<double>(point[k]);
      const double high = a * x;
      const double low = std::fma(a, x, -high);
      exact += static_cast<long double>(high);
      exact += static_cast<long double>(low);
    }
    ASSERT_LE(p.low, exact) << "round " << round;
    ASSERT_GE(p.high, exact) << "round " << round;
    ASSERT_LE(static_cast<long double>(p.high) - p.low,
              std::ldexp(4.0L, -23) * std::abs(exact) + 1e-14L * point.norm());
  }
}

}  // namespace
}  // namespace crashrank
