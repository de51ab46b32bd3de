// A fixed piece of work to count instructions of: check.sh runs it under callgrind, which counts
// inside the functions named counted_work only.
//
//   instruction_count build|scalar|vector|any

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/tree/build.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace crashrank;

namespace {

// A closed surface, bumpy, of 2·across·along triangles.
TriangleMesh body(std::uint32_t across, std::uint32_t along) {
  TriangleMesh mesh;
  constexpr double pi = 3.14159265358979;
  for (std::uint32_t i = 0; i <= across; ++i) {
    for (std::uint32_t j = 0; j < along; ++j) {
      const double polar = pi * i / across;
      const double turn = 2.0 * pi * j / along;
      const double r = 1.0 + 0.05 * std::sin(9.0 * turn) * std::sin(7.0 * polar);
      mesh.vertices.push_back(Eigen::Vector3d(2.0 * r * std::cos(polar),
                                              r * std::sin(polar) * std::cos(turn),
                                              0.7 * r * std::sin(polar) * std::sin(turn))
                                  .cast<float>());
    }
  }
  for (std::uint32_t i = 0; i < across; ++i) {
    for (std::uint32_t j = 0; j < along; ++j) {
      const std::uint32_t a = i * along + j;
      const std::uint32_t b = i * along + (j + 1) % along;
      mesh.triangles.push_back({a, a + along, b});
      mesh.triangles.push_back({b, a + along, b + along});
    }
  }
  return mesh;
}

struct Bench {
  TriangleMesh mesh = body(80, 100);
  Model model = *make_model(mesh);
  std::vector<Pose> poses;
  std::vector<Pair> pairs;
  ModelWorkspace workspace;
};

}  // namespace

extern "C" __attribute__((noinline, visibility("default"))) std::size_t counted_work(
    Bench& bench, const std::string& what) {
  if (what == "build") return build_tree(bench.mesh)->nodes.size();
  std::size_t found = 0;
  for (const Pose& pose : bench.poses) {
    found +=
        what == "scalar"
            ? collide(bench.model.tree, bench.model.tree, pose, bench.pairs, bench.workspace.scalar)
                  .pairs
            : collide(bench.model, bench.model, pose, bench.pairs, bench.workspace, {what == "any"})
                  .pairs;
  }
  return found;
}

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what != "build" && what != "scalar" && what != "vector" && what != "any") {
    std::fputs("usage: instruction_count build|scalar|vector|any\n", stderr);
    return 2;
  }
  Bench bench;
  for (int i = 0; i < 12; ++i) {
    bench.poses.push_back(
        pose_from_angles({0.3 * i, 1.1 - 0.1 * i, 0.05 * i}, 1.5 - 0.1 * i, 0.02 * i, -0.01 * i));
  }
  bench.pairs.reserve(1 << 16);
  bench.workspace.prepare(bench.model, bench.model);
  std::printf("%zu %s\n", counted_work(bench, what), vector_unit());
  return 0;
}
