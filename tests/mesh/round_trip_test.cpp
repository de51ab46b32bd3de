#include "crashrank/mesh/import.hpp"

#include "mesh/mesh_writers.hpp"
#include "mesh/scratch_dir.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <functional>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using test::ScratchDir;
using test::Soup;

struct Format {
  const char* file;
  std::function<std::string(const Soup&)> write;
  bool binary;       // gives back every bit
  bool named_parts;  // keeps parts apart and their names
  float tolerance = 0.0F;
};

std::vector<Format> formats() {
  return {
      {"a.obj", test::as_obj, false, true},
      {"text.stl", test::as_stl_text, false, false},
      {"binary.stl", test::as_stl_binary, true, false},
      {"text.ply", test::as_ply_text, false, false},
      {"binary.ply", test::as_ply_binary, true, false},
      {"a.off", test::as_off, false, false},
      {"a.glb", test::as_glb, true, true},
      {"a.gltf", [](const Soup& soup) { return test::as_gltf(soup); }, true, true},
      {"a.dae", [](const Soup& soup) { return test::as_collada(soup); }, false, true},
      {"a.3ds", test::as_3ds, true, true},
      {"a.ac", test::as_ac3d, false, true},
      {"UPPER.STL", test::as_stl_binary, true, false},
  };
}

void expect_same(const Soup& soup, const ImportedMesh& imported) {
  ASSERT_EQ(imported.mesh.size(), test::triangle_count(soup));
  std::size_t index = 0;
  for (const test::SoupPart& part : soup) {
    for (const test::SoupTriangle& triangle : part.triangles) {
      const Triangle got = imported.mesh.triangle(index);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(got.corner[c], triangle[c]) << "triangle " << index << " corner " << c;
      }
      ++index;
    }
  }
}

TEST(RoundTrip, EveryFormatGivesBackTrianglesInOrder) {
  const ScratchDir dir;
  const Soup soup = test::eighths_soup();
  for (const Format& format : formats()) {
    SCOPED_TRACE(format.file);
    const Result<ImportedMesh> imported = import_mesh(dir.write(format.file, format.write(soup)));
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    expect_same(soup, *imported);
    EXPECT_EQ(imported->mesh.vertices.size(), 24U);
    EXPECT_TRUE(imported->quality.watertight);
    EXPECT_EQ(imported->dropped_triangles, 0U);
    if (!format.named_parts) continue;
    ASSERT_EQ(imported->mesh.parts.size(), soup.size());
    for (std::size_t p = 0; p < soup.size(); ++p) {
      EXPECT_EQ(imported->mesh.parts[p].name, soup[p].name);
      EXPECT_EQ(imported->mesh.parts[p].first_triangle, 12 * p);
      EXPECT_EQ(imported->mesh.parts[p].triangle_count, 12U);
    }
  }
}

TEST(RoundTrip, BinaryFormatsKeepEveryBitAndEveryDegenerateTriangle) {
  const ScratchDir dir;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Soup soup = test::ragged_soup(seed, 500);
    for (const Format& format : formats()) {
      if (!format.binary) continue;
      SCOPED_TRACE(std::string(format.file) + ", seed " + std::to_string(seed));
      const Result<ImportedMesh> imported = import_mesh(dir.write(format.file, format.write(soup)));
      ASSERT_TRUE(imported.ok()) << imported.error().message();
      expect_same(soup, *imported);
      EXPECT_GT(imported->quality.degenerate_triangles, 50U);
      EXPECT_GT(imported->quality.duplicate_triangles, 20U);
    }
  }
}

TEST(RoundTrip, PartsWithoutNamesAreCalledAfterTheFile) {
  const ScratchDir dir;
  for (const Format& format : formats()) {
    if (format.named_parts) continue;
    SCOPED_TRACE(format.file);
    const std::string file = format.file;
    const Result<ImportedMesh> imported =
        import_mesh(dir.write(file, format.write(test::eighths_soup())));
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    ASSERT_EQ(imported->mesh.parts.size(), 1U);
    const std::string name = imported->mesh.parts[0].name;
    EXPECT_TRUE(name == file.substr(0, file.find('.')) || name == "mesh") << name;
  }
}

TEST(RoundTrip, FbxUnitsBecomeMetres) {
  const ScratchDir dir;
  const Soup soup = test::eighths_soup();
  for (const double centimetres : {1.0, 100.0, 2.54}) {
    SCOPED_TRACE(centimetres);
    const Result<ImportedMesh> imported =
        import_mesh(dir.write("a.fbx", test::as_fbx(soup, centimetres)));
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    ASSERT_EQ(imported->mesh.size(), 36U);
    for (std::size_t t = 0; t < 12; ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Eigen::Vector3f expected =
            soup[0].triangles[t][c] * static_cast<float>(centimetres) / 100.0F;
        EXPECT_LE((imported->mesh.triangle(t).corner[c] - expected).cwiseAbs().maxCoeff(), 1e-6F);
      }
    }
    EXPECT_EQ(imported->mesh.parts[1].name, "door_left");
  }
}

TEST(RoundTrip, ColladaUnitsBecomeMetresAndAxesStay) {
  const ScratchDir dir;
  const Soup soup = test::eighths_soup();
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    SCOPED_TRACE(up);
    const Result<ImportedMesh> imported =
        import_mesh(dir.write("a.dae", test::as_collada(soup, "0.5", up)));
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    const Eigen::Vector3f expected = 0.5F * soup[0].triangles[3][1];
    EXPECT_EQ(imported->mesh.triangle(3).corner[1], expected);
  }
}

TEST(RoundTrip, MirroringNodesTurnTheirTrianglesOver) {
  const ScratchDir dir;
  const Soup soup = test::eighths_soup();
  const Result<ImportedMesh> imported = import_mesh(
      dir.write("a.dae", test::as_collada(soup, "1", "Z_UP", "-2 0 0 8 0 1 0 0 0 0 1 0 0 0 0 1")));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  double volume = 0.0;
  for (std::size_t t = 0; t < imported->mesh.size(); ++t) {
    const Triangle triangle = imported->mesh.triangle(t);
    const test::SoupTriangle& source = soup[t / 12].triangles[t % 12];
    const auto moved = [](const Eigen::Vector3f& v) {
      return Eigen::Vector3f(-2.0F * v.x() + 8.0F, v.y(), v.z());
    };
    EXPECT_EQ(triangle.corner[0], moved(source[0]));
    EXPECT_EQ(triangle.corner[1], moved(source[2]));
    EXPECT_EQ(triangle.corner[2], moved(source[1]));
    volume += triangle.corner[0].cast<double>().dot(
                  triangle.corner[1].cast<double>().cross(triangle.corner[2].cast<double>())) /
              6.0;
  }
  EXPECT_DOUBLE_EQ(volume, 2.0 * (4.5 * 1.75 * 1.25 + 0.125 * 0.75 + 1.5 * 1.25 * 0.125));
}

TEST(RoundTrip, TransformsAreAppliedInDoubleAndRoundedOnce) {
  const ScratchDir dir;
  const Soup soup = test::ragged_soup(7, 50);
  ImportOptions options;
  options.transform.scale = 0.0254;
  options.transform.up = Axis::plus_y;
  options.transform.forward = Axis::minus_z;
  options.transform.origin_m = {0.1, -0.2, 0.3};
  const Result<ImportedMesh> imported =
      import_mesh(dir.write("a.stl", test::as_stl_binary(soup)), options);
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  for (std::size_t t = 0; t < 50; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3d v = soup[0].triangles[t][c].cast<double>();
      // Forward is −z and up is +y, so left is up × forward = −x.
      const Eigen::Vector3d body(-v.z() * 0.0254 - 0.1, -v.x() * 0.0254 + 0.2,
                                 v.y() * 0.0254 - 0.3);
      EXPECT_EQ(imported->mesh.triangle(t).corner[c], body.cast<float>().eval());
    }
  }
}

}  // namespace
}  // namespace crashrank
