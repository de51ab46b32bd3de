#include "crashrank/mesh/import.hpp"

#include "mesh/mesh_writers.hpp"
#include "mesh/scratch_dir.hpp"

#include <gtest/gtest.h>

namespace crashrank {
namespace {

using test::ScratchDir;

constexpr const char* two_triangles =
    "o body\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0.5\n"
    "f 1 2 3\nf 1 3 4\n";

TEST(Import, ReadsTrianglesInFileOrder) {
  const ScratchDir dir;
  const Result<ImportedMesh> imported = import_mesh(dir.write("a.obj", two_triangles));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  ASSERT_EQ(imported->mesh.size(), 2U);
  EXPECT_EQ(imported->mesh.vertices.size(), 4U);
  EXPECT_EQ(imported->mesh.triangle(1).corner[2], Eigen::Vector3f(0, 1, 0.5F));
  ASSERT_EQ(imported->mesh.parts.size(), 1U);
  EXPECT_EQ(imported->mesh.parts[0].name, "body");
  EXPECT_EQ(imported->mesh.parts[0].triangle_count, 2U);
}

TEST(Import, NodesCalledLikeTheFileKeepTheirName) {
  const ScratchDir dir;
  test::Soup soup = test::eighths_soup();
  soup[0].name = "truck";
  const Result<ImportedMesh> imported = import_mesh(dir.write("truck.glb", test::as_glb(soup)));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->mesh.parts[0].name, "truck");
  EXPECT_EQ(imported->mesh.parts[1].name, "door_left");
}

}  // namespace
}  // namespace crashrank
