#include "mesh/importer/faces.hpp"

#include "mesh/importer/polygon.hpp"

#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <Eigen/Core>

#include <algorithm>
#include <memory>
#include <vector>

namespace crashrank::importer {
namespace {

bool has_faces(const aiScene& scene, unsigned mesh) {
  return scene.mMeshes != nullptr && scene.mMeshes[mesh] != nullptr &&
         scene.mMeshes[mesh]->mFaces != nullptr;
}

std::string place_of(const aiMesh& mesh, unsigned face) {
  return "mesh '" + std::string(mesh.mName.data, mesh.mName.length) + "', face " +
         std::to_string(face);
}

void set_corners(aiFace& face, unsigned a, unsigned b, unsigned c) {
  face.mIndices = std::make_unique<unsigned[]>(3).release();
  face.mNumIndices = 3;
  face.mIndices[0] = a;
  face.mIndices[1] = b;
  face.mIndices[2] = c;
}

class FaceTriangulator {
public:
  void triangulate(aiMesh& mesh) {
    std::size_t faces = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      faces += std::max(3U, mesh.mFaces[f].mNumIndices) - 2;
    }
    if (faces == mesh.mNumFaces) return;
    // Nothing is freed: the process ends soon.
    aiFace* const triangles = std::make_unique<aiFace[]>(faces).release();
    std::size_t next = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices <= 3) {
        std::swap(triangles[next].mIndices, mesh.mFaces[f].mIndices);
        triangles[next++].mNumIndices = face.mNumIndices;
        continue;
      }
      if (!cut(mesh, face) && crossing_.count++ == 0) crossing_.first = place_of(mesh, f);
      for (const PolygonTriangulator::Corners& t : polygon_.triangles()) {
        set_corners(triangles[next++], face.mIndices[t[0]], face.mIndices[t[1]],
                    face.mIndices[t[2]]);
      }
    }
    mesh.mFaces = triangles;
    mesh.mNumFaces = static_cast<unsigned>(faces);
  }

  const CrossingPolygons& crossing() const { return crossing_; }

private:
  bool cut(const aiMesh& mesh, const aiFace& face) {
    corners_.clear();
    bool finite = true;
    for (unsigned c = 0; c < face.mNumIndices; ++c) {
      const aiVector3D& v = mesh.mVertices[face.mIndices[c]];
      corners_.emplace_back(v.x, v.y, v.z);
      finite = finite && corners_.back().allFinite();
    }
    // Refused later, by the vertex: no polygon that can be cut.
    if (!finite) corners_.assign(corners_.size(), Eigen::Vector3d::Zero());
    return polygon_.triangulate(corners_);
  }

  std::vector<Eigen::Vector3d> corners_;
  PolygonTriangulator polygon_;
  CrossingPolygons crossing_;
};

}  // namespace

Result<std::uint64_t> clear_bad_faces(aiScene& scene, const Request& request) {
  std::uint64_t cleared = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    if (!has_faces(scene, m)) continue;
    aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices > request.polygon_corners) {
        Error error =
            make_error(ErrorCode::limit_exceeded,
                       "a polygon of " + std::to_string(face.mNumIndices) + " corners, more than " +
                           std::to_string(request.polygon_corners),
                       "triangulate the mesh before exporting it");
        error.place = place_of(mesh, f);
        return error;
      }
      bool inside = face.mIndices != nullptr && mesh.mVertices != nullptr;
      for (unsigned c = 0; inside && c < face.mNumIndices; ++c) {
        inside = face.mIndices[c] < mesh.mNumVertices;
      }
      if (inside) continue;
      if (face.mNumIndices >= 3) ++cleared;
      face.mNumIndices = 0;
    }
  }
  return cleared;
}

CrossingPolygons triangulate_faces(aiScene& scene) {
  FaceTriangulator triangulator;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    if (has_faces(scene, m)) triangulator.triangulate(*scene.mMeshes[m]);
  }
  return triangulator.crossing();
}

}  // namespace crashrank::importer
