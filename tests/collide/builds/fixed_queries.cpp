// A fixed set of queries, answered by the scalar engine and by the vector engine on every unit that
// this machine has, for every split rule, leaf size and box frame. Prints one hash over all pairs
// of each query and one over the pairs met first where one is enough; ends with 1 where two of them
// differ. Built in several ways by same_answers.sh: no compiler, flag
// or vector unit may change the hash.

// The vector units that the library is built for.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

#include "crashrank/collide/pair.hpp"
#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/tree/build.hpp"

#include <hwy/targets.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace crashrank;

std::mt19937_64 engine(20260118);

float unit() { return static_cast<float>(engine() >> 40U) * 0x1p-24F; }
float around(float size) { return (2.0F * unit() - 1.0F) * size; }

// Triangles around each other: a few large, some without area, some with a corner in common.
TriangleMesh soup(std::uint32_t count, float size) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float edge = size * (engine() % 20 == 0 ? 0.5F : 0.12F);
    const float at[3] = {around(size), around(size), around(size)};
    Eigen::Vector3f corner[3];
    for (Eigen::Vector3f& c : corner) {
      for (int k = 0; k < 3; ++k) c[k] = at[k] + around(edge);
    }
    const std::uint64_t kind = engine() % 16;
    if (kind == 0) corner[2] = corner[1];
    if (kind == 1) corner[1] = corner[2] = corner[0];
    if (kind == 2) corner[2] = corner[0] + (corner[1] - corner[0]) * 0.5F;
    if (kind == 3 && i > 0) corner[0] = mesh.vertices.back();
    if (kind == 4) corner[1][2] = corner[2][2] = corner[0][2];
    mesh.vertices.insert(mesh.vertices.end(), corner, corner + 3);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// Rotations from whole quaternions: quotients of whole numbers, the same on every machine.
Pose pose(double w, double x, double y, double z, double tx, double ty, double tz) {
  const double n = w * w + x * x + y * y + z * z;
  Pose result;
  result.rotation << (w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n,
      2 * (x * z + w * y) / n, 2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n,
      2 * (y * z - w * x) / n, 2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n,
      (w * w - x * x - y * y + z * z) / n;
  result.translation = Eigen::Vector3d(tx, ty, tz);
  return result;
}

std::string sorted_hash(std::vector<Pair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs_hash(pairs);
}

std::string answers(const Model& a, const Model& b, const std::vector<Pose>& poses, bool scalar) {
  std::string text;
  std::vector<Pair> pairs;
  ModelWorkspace workspace;
  for (const Pose& p : poses) {
    if (scalar) {
      collide(a.tree, b.tree, p, pairs, workspace.scalar);
    } else {
      collide(a, b, p, pairs, workspace);
    }
    text += (text.empty() ? "" : " ") + sorted_hash(pairs);
  }
  return text;
}

// The pair met first of every query: another tree meets another one, another vector unit does not.
void first_met(const Model& a, const Model& b, const std::vector<Pose>& poses,
               std::vector<Pair>& met) {
  std::vector<Pair> pairs;
  ModelWorkspace workspace;
  CollideOptions options;
  options.any = true;
  met.clear();
  for (const Pose& p : poses) {
    collide(a, b, p, pairs, workspace, options);
    met.insert(met.end(), pairs.begin(), pairs.end());
  }
}

}  // namespace

int main() {
  const TriangleMesh meshes[2] = {soup(240, 1.0F), soup(200, 1.25F)};
  const std::vector<Pose> poses{pose(1, 0, 0, 0, 0, 0, 0), pose(3, 1, 2, 5, 0.1, 0.2, -0.1),
                                pose(2, 0, 0, 1, 0.75, 0, 0), pose(7, -1, 4, 2, 0.3, -0.9, 0.2),
                                pose(1, 1, 1, 1, -0.5, 0.5, 1)};
  std::string expected;
  std::vector<Pair> met_by_all;
  std::vector<Pair> expected_met;
  std::vector<Pair> met;
  int trees = 0;
  int units = 0;
  for (int rule = 0; rule < 4; ++rule) {
    for (const std::uint32_t leaf_size : {1U, 4U, 8U}) {
      for (int frame = 0; frame < 2; ++frame) {
        BuildOptions options;
        options.rule = static_cast<SplitRule>(rule);
        options.leaf_size = leaf_size;
        options.frame = static_cast<BoxFrame>(frame);
        const Model a = *make_model(meshes[0], options);
        const Model b = *make_model(meshes[1], options);
        const auto check = [&](const std::string& found, const char* who) {
          if (expected.empty()) expected = found;
          if (found == expected) return true;
          std::fprintf(stderr, "rule %d, leaf size %u, frame %d: %s answers otherwise\n", rule,
                       leaf_size, frame, who);
          return false;
        };
        ++trees;
        if (!check(answers(a, b, poses, true), "the scalar engine")) return 1;
        units = 0;
        for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0;
             left &= left - 1) {
          hwy::SetSupportedTargetsForTest(left & (~left + 1));
          hwy::GetChosenTarget().DeInit();
          if (!check(answers(a, b, poses, false), vector_unit())) return 1;
          first_met(a, b, poses, met);
          if (units == 0) expected_met = met;
          if (met != expected_met) {
            std::fprintf(stderr, "rule %d, leaf size %u, frame %d: %s meets other pairs first\n",
                         rule, leaf_size, frame, vector_unit());
            return 1;
          }
          ++units;
        }
        hwy::SetSupportedTargetsForTest(0);
        hwy::GetChosenTarget().DeInit();
        met_by_all.insert(met_by_all.end(), met.begin(), met.end());
      }
    }
  }
  std::fprintf(stderr, "%d trees, %d vector units\n", trees, units);
  std::printf("%s %s\n", expected.c_str(), pairs_hash(met_by_all).c_str());
  return 0;
}
