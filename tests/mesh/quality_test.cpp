#include "crashrank/mesh/properties.hpp"

#include "mesh/degenerate.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace crashrank {
namespace {

using Rational = boost::multiprecision::cpp_rational;

// The same question asked of exact rationals, by the cross product of two sides.
bool exactly_degenerate(const Triangle& triangle) {
  std::array<std::array<Rational, 3>, 2> side;
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto index = static_cast<Eigen::Index>(axis);
      side[s][axis] = Rational(triangle.corner[s + 1][index]) - Rational(triangle.corner[0][index]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3;
    if (side[0][axis] * side[1][next] != side[0][next] * side[1][axis]) return false;
  }
  return true;
}

class Numbers {
public:
  explicit Numbers(std::uint64_t seed) : random_(seed) {}
  std::uint64_t below(std::uint64_t end) { return random_() % end; }
  // Any finite float, denormals and all exponents alike.
  float any() {
    for (;;) {
      const auto bits = static_cast<std::uint32_t>(random_());
      float value = 0.0F;
      std::memcpy(&value, &bits, sizeof value);
      if (std::isfinite(value)) return value;
    }
  }
  float small_integer() { return static_cast<float>(below(9)) - 4.0F; }

private:
  std::mt19937_64 random_;
};

Triangle make_triangle(Numbers& numbers, std::uint64_t kind) {
  const auto point = [&](auto coordinate) {
    const float x = coordinate();
    const float y = coordinate();
    return Eigen::Vector3f(x, y, coordinate());
  };
  const auto any = [&] { return numbers.any(); };
  const auto integer = [&] { return numbers.small_integer(); };
  if (kind == 0) return {{point(any), point(any), point(any)}};
  if (kind == 1) return {{point(integer), point(integer), point(integer)}};
  // On a line with a power of two as parameter, at a common scale: collinear unless a coordinate
  // is rounded; then one bit off in places.
  const auto scale = static_cast<float>(std::ldexp(1.0, static_cast<int>(numbers.below(120)) - 60));
  const Eigen::Vector3f a = point(integer) * scale;
  const Eigen::Vector3f step = point(integer) * scale;
  Triangle triangle{{a, a + step, a + 4.0F * step}};
  if (kind == 3) {
    float& nudged = triangle.corner[numbers.below(3)][static_cast<Eigen::Index>(numbers.below(3))];
    nudged = std::nextafter(nudged, std::numeric_limits<float>::infinity());
  }
  if (kind == 4) triangle.corner[2] = triangle.corner[numbers.below(2)];
  return triangle;
}

TEST(Degenerate, AgreesWithExactRationals) {
  std::array<int, 5> degenerate_of_kind{};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Numbers numbers(seed);
    for (int i = 0; i < 5000; ++i) {
      const std::uint64_t kind = numbers.below(5);
      const Triangle triangle = make_triangle(numbers, kind);
      const bool expected = exactly_degenerate(triangle);
      ASSERT_EQ(degenerate(triangle), expected)
          << triangle.corner[0].transpose() << " | " << triangle.corner[1].transpose() << " | "
          << triangle.corner[2].transpose();
      degenerate_of_kind[kind] += expected ? 1 : 0;
    }
  }
  // The kinds are what they are meant to be.
  EXPECT_EQ(degenerate_of_kind[0], 0);
  EXPECT_GT(degenerate_of_kind[1], 10);
  EXPECT_GT(degenerate_of_kind[2], 3500);
  EXPECT_LT(degenerate_of_kind[3], 2000);
  EXPECT_GT(degenerate_of_kind[4], 3500);
}

Triangle triangle_of(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  return {{a, b, c}};
}

TEST(Degenerate, SeesTheLastBitAtOppositeEndsOfTheRange) {
  // Doubled differences cancel to less than one ulp of the products, which double alone loses.
  const float big = 1.0F + std::ldexp(1.0F, -23);
  const float tiny = std::ldexp(1.0F, -149);
  const Triangle line = triangle_of({0, 0, 0}, {1, 1, 0}, {big, big, 0});
  EXPECT_TRUE(degenerate(line));
  const Triangle sliver = triangle_of({0, 0, 0}, {1, 1, 0}, {big, 1.0F, tiny});
  EXPECT_FALSE(degenerate(sliver));
  const Triangle denormal = triangle_of({1e30F, 0, 0}, {-1e30F, 0, 0}, {0, tiny, 0});
  EXPECT_FALSE(degenerate(denormal));
}

TriangleMesh cube() {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(static_cast<float>(i & 1U), static_cast<float>(i >> 1U & 1U),
                               2.0F * static_cast<float>(i >> 2U & 1U));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh.parts = {{"cube", 0, 12}};
  return mesh;
}

// Every triangle with vertices of its own, as most formats deliver them.
TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const Eigen::Vector3f& corner : mesh.triangle(t).corner) soup.vertices.push_back(corner);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.parts = mesh.parts;
  return soup;
}

TEST(Quality, ACubeIsSound) {
  for (const TriangleMesh& mesh : {cube(), unwelded(cube())}) {
    const MeshQuality quality = assess(mesh);
    EXPECT_TRUE(quality.watertight);
    EXPECT_EQ(quality.degenerate_triangles, 0U);
    EXPECT_EQ(quality.duplicate_triangles, 0U);
    EXPECT_EQ(quality.open_edges + quality.crowded_edges + quality.reversed_edges, 0U);
    EXPECT_DOUBLE_EQ(quality.area_m2, 10.0);
    EXPECT_EQ(quality.extent_m, Eigen::Vector3d(1, 1, 2));
    EXPECT_TRUE(quality.warnings.empty());
  }
}

TEST(Quality, CountsWhatIsWrong) {
  TriangleMesh open = cube();
  open.triangles.pop_back();
  EXPECT_FALSE(assess(open).watertight);
  EXPECT_EQ(assess(open).open_edges, 3U);

  TriangleMesh twice = cube();
  twice.triangles.push_back({3, 0, 2});
  EXPECT_EQ(assess(twice).duplicate_triangles, 1U);
  EXPECT_EQ(assess(twice).crowded_edges, 3U);
  EXPECT_FALSE(assess(twice).watertight);

  TriangleMesh turned = cube();
  std::swap(turned.triangles[5][0], turned.triangles[5][1]);
  EXPECT_TRUE(assess(turned).watertight);
  EXPECT_EQ(assess(turned).reversed_edges, 3U);
  EXPECT_EQ(assess(turned).warnings.size(), 1U);

  TriangleMesh points = cube();
  points.triangles.push_back({2, 2, 5});
  points.triangles.push_back({1, 1, 1});
  EXPECT_EQ(assess(points).degenerate_triangles, 2U);
  EXPECT_TRUE(assess(points).watertight);
}

TEST(Quality, SurvivesNumbersThatAreNone) {
  TriangleMesh mesh = cube();
  mesh.vertices[7].x() = std::numeric_limits<float>::quiet_NaN();
  mesh.vertices[6].y() = -std::numeric_limits<float>::infinity();
  const MeshQuality quality = assess(mesh);
  EXPECT_EQ(quality.non_finite_vertices, 2U);
  EXPECT_FALSE(quality.watertight);
  EXPECT_TRUE(quality.extent_m.allFinite());
  EXPECT_TRUE(std::isfinite(quality.area_m2));
  EXPECT_EQ(assess(TriangleMesh{}).extent_m, Eigen::Vector3d::Zero());
  EXPECT_FALSE(assess(TriangleMesh{}).watertight);
}

TEST(Quality, SignedZerosAreOnePosition) {
  TriangleMesh mesh = unwelded(cube());
  mesh.vertices[0].x() = -0.0F;
  EXPECT_TRUE(assess(mesh).watertight);
}

TEST(Quality, ExtentsOfNoRoadUserAreWarnedAbout) {
  for (const float scale : {0.1F, 20.0F}) {
    TriangleMesh mesh = cube();
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= scale;
    ASSERT_EQ(assess(mesh).warnings.size(), 1U);
    EXPECT_NE(assess(mesh).warnings[0].find("give the scale"), std::string::npos);
  }
  TriangleMesh far = cube();
  for (Eigen::Vector3f& vertex : far.vertices) vertex.x() += 500'000.0F;
  ASSERT_EQ(assess(far).warnings.size(), 1U);
  EXPECT_NE(assess(far).warnings[0].find("give an origin"), std::string::npos);
}

}  // namespace
}  // namespace crashrank
