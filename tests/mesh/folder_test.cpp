#include "crashrank/mesh/import.hpp"

#include "mesh/mesh_writers.hpp"
#include "mesh/scratch_dir.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <string>

namespace crashrank {
namespace {

using test::ScratchDir;

// A mesh in car/, whose buffer lies at `buffer_path` below the scratch folder and is named `uri`.
Result<ImportedMesh> import_with_buffer(const ScratchDir& dir, const std::string& buffer_path,
                                        const std::string& uri) {
  std::string buffer;
  const std::string json = test::as_gltf(test::eighths_soup(), uri, buffer);
  dir.write(buffer_path, buffer);
  return import_mesh(dir.write("car/a.gltf", json));
}

TEST(Folder, FilesBesideAndBelowTheMeshAreRead) {
  const ScratchDir dir;
  EXPECT_TRUE(import_with_buffer(dir, "car/a.bin", "a.bin").ok());
  EXPECT_TRUE(import_with_buffer(dir, "car/parts/b.bin", "parts/b.bin").ok());
  EXPECT_TRUE(import_with_buffer(dir, "car/my car.bin", "my%20car.bin").ok());
  EXPECT_TRUE(import_with_buffer(dir, "car/c.bin", "parts/../c.bin").ok());
}

TEST(Folder, NothingOutsideItIs) {
  const ScratchDir dir;
  std::string absolute = (dir.path() / "car/a.bin").string();
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("parts/../../outside.bin"),
        std::string("..\\\\outside.bin"), std::string("%2e%2e/outside.bin"), absolute,
        std::string("/etc/passwd")}) {
    SCOPED_TRACE(uri);
    std::filesystem::create_directories(dir.path() / "car/parts");
    dir.write("car/a.bin", std::string(100'000, ' '));
    const Result<ImportedMesh> imported = import_with_buffer(dir, "outside.bin", uri);
    ASSERT_FALSE(imported.ok());
    EXPECT_EQ(imported.error().code, ErrorCode::bad_input);
    EXPECT_NE(imported.error().reason.find("outside"), std::string::npos)
        << imported.error().message();
  }
}

TEST(Folder, LinksAreFollowedOnlyInside) {
  const ScratchDir dir;
  std::filesystem::create_directories(dir.path() / "car");
  std::filesystem::create_symlink("../outside.bin", dir.path() / "car/link.bin");
  const Result<ImportedMesh> outside = import_with_buffer(dir, "outside.bin", "link.bin");
  ASSERT_FALSE(outside.ok());
  EXPECT_NE(outside.error().reason.find("'link.bin' is outside"), std::string::npos)
      << outside.error().message();

  std::filesystem::create_directory_symlink("..", dir.path() / "car/up");
  EXPECT_FALSE(import_with_buffer(dir, "outside.bin", "up/outside.bin").ok());

  std::filesystem::create_symlink("real.bin", dir.path() / "car/inside.bin");
  EXPECT_TRUE(import_with_buffer(dir, "car/real.bin", "inside.bin").ok());
}

TEST(Folder, WhatIsNoRegularFileIsNotOpened) {
  const ScratchDir dir;
  std::filesystem::create_directories(dir.path() / "car/folder.bin");
  ASSERT_EQ(::mkfifo((dir.path() / "car/pipe.bin").c_str(), 0600), 0);
  for (const char* uri : {"folder.bin", "pipe.bin"}) {
    const Result<ImportedMesh> imported = import_with_buffer(dir, "elsewhere.bin", uri);
    ASSERT_FALSE(imported.ok());
    EXPECT_NE(imported.error().reason.find("regular file"), std::string::npos)
        << imported.error().message();
  }
  EXPECT_FALSE(import_mesh((dir.path() / "car").string() + ".obj").ok());
  ASSERT_EQ(::mkfifo((dir.path() / "pipe.obj").c_str(), 0600), 0);
  const Result<ImportedMesh> pipe = import_mesh((dir.path() / "pipe.obj").string());
  ASSERT_FALSE(pipe.ok());
  EXPECT_EQ(pipe.error().reason, "not a regular file");
}

TEST(Folder, BuffersCountAgainstTheLimitOfFiles) {
  const ScratchDir dir;
  std::string buffer;
  const std::string json = test::as_gltf(test::eighths_soup(), "a.bin", buffer);
  dir.write("a.bin", buffer + std::string(100'000, ' '));
  ImportOptions options;
  options.limits.file_bytes = 50'000;
  const Result<ImportedMesh> imported = import_mesh(dir.write("a.gltf", json), options);
  ASSERT_FALSE(imported.ok());
  EXPECT_NE(imported.error().reason.find("larger than"), std::string::npos)
      << imported.error().message();
}

TEST(Folder, MaterialsOutsideAreAWarningAndMissingOnesAreNot) {
  const ScratchDir dir;
  dir.write("secret.mtl", "newmtl secret\nKd 1 0 0\n");
  for (const char* named : {"none.mtl", "../secret.mtl", "/etc/passwd"}) {
    const std::string library = named;
    SCOPED_TRACE(library);
    const Result<ImportedMesh> imported = import_mesh(
        dir.write("car/a.obj", "mtllib " + library + "\n" + test::as_obj(test::eighths_soup())));
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    EXPECT_EQ(imported->mesh.size(), 36U);
    if (library == "none.mtl") {
      EXPECT_TRUE(imported->warnings.empty());
      continue;
    }
    ASSERT_FALSE(imported->warnings.empty());
    EXPECT_NE(imported->warnings[0].find(library), std::string::npos) << imported->warnings[0];
  }
}

TEST(Folder, TexturesAreNeverAskedFor) {
  const ScratchDir dir;
  dir.write("car/paint.mtl", "newmtl paint\nKd 1 0 0\nmap_Kd ../secret.png\n");
  const Result<ImportedMesh> imported =
      import_mesh(dir.write("car/a.obj",
                            "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                            "usemtl paint\nf 1 2 3\n"));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_TRUE(imported->warnings.empty());
  EXPECT_EQ(imported->mesh.parts[0].name, "paint");
}

TEST(Folder, AMeshReachedThroughALinkIsRead) {
  const ScratchDir dir;
  dir.write("real/b.obj", test::as_obj(test::eighths_soup()));
  std::filesystem::create_symlink("real/b.obj", dir.path() / "a.obj");
  EXPECT_TRUE(import_mesh((dir.path() / "a.obj").string()).ok());
}

TEST(Folder, PathsOfEveryShapeWork) {
  const ScratchDir dir;
  dir.write("with space/=&'\"$(x)/a.obj", test::as_obj(test::eighths_soup()));
  EXPECT_TRUE(import_mesh((dir.path() / "with space/=&'\"$(x)/a.obj").string()).ok());
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(dir.path() / "with space/=&'\"$(x)");
  EXPECT_TRUE(import_mesh("a.obj").ok());
  EXPECT_TRUE(import_mesh("./a.obj").ok());
  std::filesystem::current_path(before);
  EXPECT_EQ(import_mesh((dir.path() / "none.obj").string()).error().code, ErrorCode::not_found);
  EXPECT_EQ(import_mesh(std::string("a.obj\0b.obj", 11)).error().code, ErrorCode::not_found);
  EXPECT_FALSE(import_mesh("").ok());
}

}  // namespace
}  // namespace crashrank
