#include "crashrank/collide/body_state.hpp"

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/make_model.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <iostream>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

void add_triangle(TriangleMesh& mesh, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3f& corner : {a, b, c}) mesh.vertices.push_back(corner);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

void add_quad(TriangleMesh& mesh, const std::array<Vector3f, 4>& corner, bool inwards = false) {
  const Vector3f& second = inwards ? corner[3] : corner[1];
  const Vector3f& last = inwards ? corner[1] : corner[3];
  add_triangle(mesh, corner[0], second, corner[2]);
  add_triangle(mesh, corner[0], corner[2], last);
}

/// Faces of a box, of which the last `without` are left out.
void add_box(TriangleMesh& mesh, const Vector3f& low, const Vector3f& high, bool inwards = false,
             std::size_t without = 0) {
  const auto at = [&](unsigned bits) {
    return Vector3f(bits & 1U ? high.x() : low.x(), bits & 2U ? high.y() : low.y(),
                    bits & 4U ? high.z() : low.z());
  };
  constexpr std::array<std::array<unsigned, 4>, 6> faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (std::size_t f = 0; f + without < 6; ++f) {
    add_quad(mesh, {at(faces[f][0]), at(faces[f][1]), at(faces[f][2]), at(faces[f][3])}, inwards);
  }
}

struct Body {
  Model model;
  Solid solid;
};

Body body(TriangleMesh mesh) {
  mesh.parts = {{"body", 0, static_cast<std::uint32_t>(mesh.size())}};
  Solid solid = make_solid(mesh);
  Result<Model> model = make_model(std::move(mesh));
  EXPECT_TRUE(model.ok());
  return {std::move(*model), std::move(solid)};
}

Body box(float low, float high) {
  TriangleMesh mesh;
  add_box(mesh, Vector3f::Constant(low), Vector3f::Constant(high));
  return body(std::move(mesh));
}

BodyState state(const Body& a, const Body& b, const Pose& b_in_a = {}) {
  std::vector<Pair> pairs;
  ModelWorkspace workspace;
  workspace.prepare(a.model, b.model);
  const CollideResult result = collide(a.model, b.model, b_in_a, pairs, workspace);
  return body_state(a.model, a.solid, b.model, b.solid, b_in_a, result);
}

Pose moved(double x, double y, double z) {
  Pose pose;
  pose.translation = {x, y, z};
  return pose;
}

TEST(BodyState, BoxesInsideBesideAndAcross) {
  const Body large = box(-4, 4);
  const Body small = box(-1, 1);
  EXPECT_EQ(state(large, small), BodyState::b_inside_a);
  EXPECT_EQ(state(small, large), BodyState::a_inside_b);
  EXPECT_EQ(state(large, small, moved(2.9, -2.9, 2.9)), BodyState::b_inside_a);
  EXPECT_EQ(state(large, small, moved(3, 0, 0)), BodyState::intersecting);  // touches from inside
  EXPECT_EQ(state(large, small, moved(4, 0, 0)), BodyState::intersecting);
  EXPECT_EQ(state(large, small, moved(5, 0, 0)), BodyState::intersecting);  // from outside
  EXPECT_EQ(state(large, small, moved(5.1, 0, 0)), BodyState::separate);
  EXPECT_EQ(state(large, small, moved(0, 0, 50)), BodyState::separate);
}

TEST(BodyState, NamesAreThoseOfTheAnswer) {
  EXPECT_STREQ(body_state_name(BodyState::separate), "separate");
  EXPECT_STREQ(body_state_name(BodyState::unknown_open), "unknown_open");
}

TEST(BodyState, CavitiesAreOutsideAndNestedShellsInside) {
  TriangleMesh hollow;
  add_box(hollow, Vector3f::Constant(-4), Vector3f::Constant(4));
  add_box(hollow, Vector3f::Constant(-3), Vector3f::Constant(3), true);
  EXPECT_EQ(state(body(hollow), box(-1, 1)), BodyState::separate);
  EXPECT_EQ(state(body(hollow), box(-3.5F, 3.5F)), BodyState::b_inside_a);
  // An engine in a car, both turned outwards: what lies in the engine lies in the car.
  TriangleMesh car;
  add_box(car, Vector3f::Constant(-4), Vector3f::Constant(4));
  add_box(car, Vector3f::Constant(-3), Vector3f::Constant(3));
  EXPECT_EQ(state(body(car), box(-1, 1)), BodyState::b_inside_a);
}

TEST(BodyState, ClosedSurfacesThatAreTurnedUnevenlyHaveAnInside) {
  TriangleMesh mesh;
  add_box(mesh, Vector3f::Constant(-4), Vector3f::Constant(4));
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  const Body uneven = body(mesh);
  EXPECT_TRUE(uneven.solid.closed);
  EXPECT_FALSE(uneven.solid.surfaces[0].oriented);
  EXPECT_EQ(state(uneven, box(-1, 1)), BodyState::b_inside_a);
  EXPECT_EQ(state(uneven, box(-1, 1), moved(5.5, 0, 0)), BodyState::separate);
}

TEST(BodyState, OpenBodiesAreUnknownWithinTheirBoundsAlone) {
  TriangleMesh mesh;
  add_box(mesh, Vector3f::Constant(-4), Vector3f::Constant(4), false, 1);
  const Body open = body(mesh);
  EXPECT_FALSE(open.solid.closed);
  EXPECT_EQ(state(open, box(-1, 1)), BodyState::unknown_open);
  EXPECT_EQ(state(box(-1, 1), open), BodyState::unknown_open);
  EXPECT_EQ(state(open, box(-1, 1), moved(7, 0, 0)), BodyState::separate);
  // Half of it looks out of the open side: not within the bounds.
  EXPECT_EQ(state(open, box(-1, 1), moved(4, 0, 0)), BodyState::separate);
  // An open body inside a closed one is inside.
  EXPECT_EQ(state(box(-9, 9), open), BodyState::b_inside_a);
  // A sheet beside the closed body changes nothing for what lies in the closed body.
  add_box(mesh, {10, -4, -4}, {18, 4, 4});
  EXPECT_EQ(state(body(mesh), box(-1, 1), moved(14, 0, 0)), BodyState::b_inside_a);
}

TEST(BodyState, EverySurfaceOfABodyCounts) {
  // A dumbbell: one of a hundred small boxes lies inside the other body.
  TriangleMesh many;
  for (int i = 0; i < 100; ++i) {
    const auto x = static_cast<float>(10 * i);
    add_box(many, {x, 0, 0}, {x + 1, 1, 1});
  }
  const Body scattered = body(many);
  EXPECT_EQ(scattered.solid.surfaces.size(), 100U);
  for (const int i : {0, 37, 99}) {
    EXPECT_EQ(state(scattered, box(-2, 3), moved(10.0 * i, 0, 0)), BodyState::a_inside_b);
  }
  EXPECT_EQ(state(scattered, box(-2, 3), moved(375.0, 0, 0)), BodyState::separate);
}

using Cell = std::tuple<int, int, int>;

// The surface of unit cells: its edges and diagonals lie straight above and below cell centres and
// corners, where a careless ray counts twice or not at all.
TriangleMesh surface_of(const std::set<Cell>& cells) {
  TriangleMesh mesh;
  for (const auto& [x, y, z] : cells) {
    const Vector3f low(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        std::array<int, 3> next{x, y, z};
        next[static_cast<std::size_t>(axis)] += step;
        if (cells.count({next[0], next[1], next[2]}) > 0) continue;
        Vector3f corner = low;
        if (step > 0) corner[axis] += 1.0F;
        Vector3f u = Vector3f::Zero();
        Vector3f v = Vector3f::Zero();
        u[(axis + 1) % 3] = 1.0F;
        v[(axis + 2) % 3] = 1.0F;
        add_quad(mesh, {corner, corner + u, corner + u + v, corner + v}, step < 0);
      }
    }
  }
  return mesh;
}

TEST(BodyState, LatticeBodiesAnswerAsTheirCells) {
  constexpr unsigned seed = 20261128;
  std::cout << "seed " << seed << '\n';
  std::mt19937_64 random(seed);
  TriangleMesh tetrahedron;
  const Vector3f o(0, 0, 0);
  const Vector3f x(0.25F, 0, 0);
  const Vector3f y(0, 0.25F, 0);
  const Vector3f z(0, 0, 0.25F);
  add_triangle(tetrahedron, o, y, x);
  add_triangle(tetrahedron, o, x, z);
  add_triangle(tetrahedron, o, z, y);
  add_triangle(tetrahedron, x, y, z);
  const Body probe = body(tetrahedron);
  std::size_t inside = 0;
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(round);
    std::set<Cell> cells{{0, 0, 0}};
    while (cells.size() < 25) {
      auto cell = cells.begin();
      std::advance(cell, static_cast<long>(random() % cells.size()));
      std::array<int, 3> next{std::get<0>(*cell), std::get<1>(*cell), std::get<2>(*cell)};
      next[random() % 3] += random() % 2 == 0 ? 1 : -1;
      cells.insert({next[0], next[1], next[2]});
    }
    const Body lattice = body(surface_of(cells));
    EXPECT_TRUE(lattice.solid.closed);
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        for (int k = -4; k <= 4; ++k) {
          // The probe's first corner is the cell's centre: under the diagonals of faces.
          const bool expected = cells.count({i, j, k}) > 0;
          EXPECT_EQ(state(lattice, probe, moved(i + 0.5, j + 0.5, k + 0.5)),
                    expected ? BodyState::b_inside_a : BodyState::separate);
          inside += expected ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(inside, 300U);
}

TEST(BodyState, TurnedBoxesAnswerAsTheirOwnFrameSays) {
  std::mt19937_64 random(5);
  const auto real = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
  };
  const Body large = box(-4, 4);
  const Body small = box(-0.01F, 0.01F);
  int inside = 0;
  for (int round = 0; round < 2000; ++round) {
    const Vector3d center(real(-6, 6), real(-6, 6), real(-6, 6));  // of the small one, in the large
    const double nearest = (center.cwiseAbs().array() - 4.0).abs().minCoeff();
    if (nearest < 0.02) continue;
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(real(-1, 1), real(-1, 1), real(-1, 1), real(-1, 1)).normalized();
    Pose small_in_large;
    small_in_large.rotation = turn.toRotationMatrix();
    small_in_large.translation = center;
    const bool expected = center.cwiseAbs().maxCoeff() < 4.0;
    EXPECT_EQ(state(large, small, small_in_large),
              expected ? BodyState::b_inside_a : BodyState::separate);
    EXPECT_EQ(state(small, large, inverse(small_in_large)),
              expected ? BodyState::a_inside_b : BodyState::separate);
    inside += expected ? 1 : 0;
  }
  EXPECT_GT(inside, 300);
}

}  // namespace
}  // namespace crashrank
