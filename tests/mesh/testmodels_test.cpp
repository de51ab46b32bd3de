#include "crashrank/mesh/import.hpp"

#include <assimp/config.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <vector>

// Real files, from Debian's assimp-testmodels, held against the parser called in the plainest way.
namespace crashrank {
namespace {

namespace fs = std::filesystem;

constexpr const char* models = "/usr/share/assimp/models";

std::vector<std::string> model_files() {
  const std::set<std::string> wanted{".obj", ".stl", ".ply", ".off", ".gltf",
                                     ".glb", ".dae", ".fbx", ".3ds", ".ac"};
  std::vector<std::string> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(models, error)) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (wanted.count(extension) > 0) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

using Polygon = std::vector<Eigen::Vector3d>;

void walk(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& parent,
          std::vector<Polygon>& polygons) {
  Eigen::Matrix4d here;
  for (unsigned row = 0; row < 4; ++row) {
    for (unsigned column = 0; column < 4; ++column) {
      here(static_cast<int>(row), static_cast<int>(column)) =
          static_cast<double>(node.mTransformation[row][column]);
    }
  }
  here = parent * here;
  const bool mirrored = here.topLeftCorner<3, 3>().determinant() < 0.0;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const unsigned size = mesh.mFaces[f].mNumIndices;
      if (size < 3) continue;
      Polygon polygon;
      for (unsigned c = 0; c < size; ++c) {
        const aiVector3D& v = mesh.mVertices[mesh.mFaces[f].mIndices[c]];
        polygon.emplace_back((here * Eigen::Vector4d(v.x, v.y, v.z, 1.0)).head<3>());
      }
      if (mirrored) std::reverse(polygon.begin() + 1, polygon.end());
      polygons.push_back(polygon);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    walk(scene, *node.mChildren[i], here, polygons);
  }
}

std::vector<Polygon> plainly_read(const std::string& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(file, 0);
  std::vector<Polygon> polygons;
  if (scene == nullptr) return polygons;
  Eigen::Matrix4d outermost = Eigen::Matrix4d::Identity();
  float centimetres = 1.0F;
  const fs::path path(file);
  if (path.extension() == ".fbx" || path.extension() == ".FBX") {
    scene->mMetaData->Get("UnitScaleFactor", centimetres);
    outermost.topLeftCorner<3, 3>() *= static_cast<double>(centimetres) / 100.0;
  }
  if (path.extension() == ".3ds" || path.extension() == ".3DS") {
    outermost << 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1;  // y up back to z up
  }
  walk(*scene, *scene->mRootNode, outermost, polygons);
  return polygons;
}

// Corners of a triangle are those of its file; a polygon's triangles use its corners alone and have
// its vector area, which no way of cutting it up changes.
void expect_same_surface(const TriangleMesh& mesh, const std::vector<Polygon>& expected,
                         double tolerance) {
  std::size_t next = 0;
  double worst = 0.0;
  for (const Polygon& polygon : expected) {
    ASSERT_LE(next + polygon.size() - 2, mesh.size());
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    double size = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector3d& after = polygon[(i + 1) % polygon.size()];
      area -= (polygon[i] - polygon[0]).cross(after - polygon[0]);
      size += (after - polygon[i]).norm();
    }
    for (std::size_t t = 0; t < polygon.size() - 2; ++t, ++next) {
      const Triangle got = mesh.triangle(next);
      const Eigen::Vector3d first = got.corner[0].cast<double>() - polygon[0];
      area += (got.corner[1].cast<double>() - polygon[0] - first)
                  .cross(got.corner[2].cast<double>() - polygon[0] - first);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto distance = [&](const Eigen::Vector3d& corner) {
          return (got.corner[c].cast<double>() - corner).cwiseAbs().maxCoeff();
        };
        double least = distance(polygon.size() == 3 ? polygon[c] : polygon[0]);
        for (const Eigen::Vector3d& corner : polygon) {
          if (polygon.size() > 3) least = std::min(least, distance(corner));
        }
        worst = std::max(worst, least);
      }
    }
    ASSERT_LE(area.cwiseAbs().maxCoeff(), 4.0 * size * tolerance);
  }
  EXPECT_EQ(next, mesh.size());
  EXPECT_LE(worst, tolerance);
}

TEST(TestModels, EveryFileEndsAndLoadedOnesHoldTheParsersFacesInOrder) {
  const std::vector<std::string> files = model_files();
  if (files.empty()) GTEST_SKIP() << "the package assimp-testmodels is not installed";
  std::size_t loaded = 0;
  std::size_t triangles = 0;
  std::size_t not_compared = 0;
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Result<ImportedMesh> imported = import_mesh(file);
    if (!imported) {
      EXPECT_NE(imported.error().code, ErrorCode::internal) << imported.error().message();
      continue;
    }
    ++loaded;
    triangles += imported->mesh.size();
    const std::vector<Polygon> expected = plainly_read(file);
    // Assimp refuses some glTF files for what concerns materials alone, and does not apply skins.
    if (expected.empty() || file.find("skin") != std::string::npos) {
      ++not_compared;
      continue;
    }
    // Assimp takes quaternions of glTF as they are rounded in the file.
    const double relative = file.find("glTF2") != std::string::npos ? 4e-6 : 1e-6;
    const double tolerance = relative * imported->quality.extent_m.maxCoeff() +
                             relative * imported->mesh.bounds().max.cwiseAbs().maxCoeff();
    expect_same_surface(imported->mesh, expected, tolerance);
  }
  std::cout << files.size() << " files, " << loaded << " loaded with " << triangles
            << " triangles, " << not_compared << " of them not compared\n";
  EXPECT_GT(loaded, 80U);
  EXPECT_LT(not_compared, 10U);
}

TEST(TestModels, TheMilkTruckHasItsParts) {
  const std::string truck = std::string(models) + "/glTF/CesiumMilkTruck/CesiumMilkTruck.gltf";
  if (!fs::exists(truck)) GTEST_SKIP() << "the package assimp-testmodels is not installed";
  const Result<ImportedMesh> imported = import_mesh(truck);
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  std::string names;
  for (const Part& part : imported->mesh.parts) names += part.name + ";";
  EXPECT_NE(names.find("glass"), std::string::npos) << names;
  EXPECT_GE(imported->mesh.parts.size(), 3U);
  EXPECT_GT(imported->mesh.size(), 1000U);
}

}  // namespace
}  // namespace crashrank
