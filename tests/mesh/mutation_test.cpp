#include "crashrank/mesh/import.hpp"

#include "mesh/gltf_writer.hpp"
#include "mesh/mesh_writers.hpp"
#include "mesh/scratch_dir.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

// Flips, cuts, repeats and overwrites: what transfer errors and fuzzers do to a file.
std::string mutated(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % end); };
  const std::size_t changes = 1 + below(4);
  for (std::size_t i = 0; i < changes && bytes.size() > 16; ++i) {
    const std::size_t at = below(bytes.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(16, bytes.size() - at));
    switch (below(5)) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 3:
        bytes.replace(at, length, length, random() % 2 == 0 ? '\xff' : '9');
        break;
      default:
        bytes.resize(at + 1);
        break;
    }
  }
  return bytes;
}

void expect_sound(const ImportedMesh& imported) {
  const TriangleMesh& mesh = imported.mesh;
  std::size_t covered = 0;
  for (const Part& part : mesh.parts) {
    ASSERT_EQ(part.first_triangle, covered);
    covered += part.triangle_count;
  }
  ASSERT_EQ(covered, mesh.size());
  ASSERT_GT(mesh.size(), 0U);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.vertices.size());
  }
  for (const Eigen::Vector3f& vertex : mesh.vertices) ASSERT_TRUE(vertex.allFinite());
}

// Ten mutations a format, or as many as CRASHRANK_MUTATIONS says.
TEST(Mutation, DamagedFilesAreRefusedOrGiveASoundMesh) {
  const char* asked = std::getenv("CRASHRANK_MUTATIONS");
  const int rounds = asked != nullptr ? std::atoi(asked) : 10;
  const test::Soup soup = test::eighths_soup();
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.obj", test::as_obj(soup)},        {"text.stl", test::as_stl_text(soup)},
      {"a.stl", test::as_stl_binary(soup)}, {"text.ply", test::as_ply_text(soup)},
      {"a.ply", test::as_ply_binary(soup)}, {"a.off", test::as_off(soup)},
      {"a.glb", test::as_glb(soup)},        {"quantised.glb", test::quantised_box()},
      {"sparse.glb", test::sparse_box()},   {"meshopt.glb", test::meshopt_box()},
      {"draco.glb", test::draco_box()},     {"a.gltf", test::as_gltf(soup)},
      {"a.dae", test::as_collada(soup)},    {"a.fbx", test::as_fbx(soup, 1.0)},
      {"a.3ds", test::as_3ds(soup)},        {"a.ac", test::as_ac3d(soup)}};
  const test::ScratchDir dir;
  std::size_t loaded = 0;
  std::size_t crashed = 0;
  std::string names;
  for (int round = 0; round < rounds; ++round) {
    std::mt19937_64 random(1000 + static_cast<unsigned>(round));
    for (const auto& [name, bytes] : files) {
      SCOPED_TRACE(name + ", seed " + std::to_string(1000 + round));
      const Result<ImportedMesh> imported = import_mesh(dir.write(name, mutated(bytes, random)));
      if (imported.ok()) {
        ++loaded;
        expect_sound(*imported);
        continue;
      }
      EXPECT_NE(imported.error().code, ErrorCode::internal) << imported.error().message();
      if (imported.error().reason.find("SIG") != std::string::npos) {
        ++crashed;
        names += " " + name;
      }
    }
  }
  std::cout << files.size() * static_cast<std::size_t>(rounds) << " damaged files: " << loaded
            << " loaded, " << crashed << " crashed the parser:" << names << '\n';
  EXPECT_GT(loaded, 0U);
}

}  // namespace
}  // namespace crashrank
