#include "mesh/importer/flatten.hpp"

#include "mesh/importer/affine.hpp"
#include "mesh/importer/mesh_builder.hpp"
#include "mesh/importer/part_names.hpp"

#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <utility>
#include <vector>

namespace crashrank::importer {
namespace {

std::string text_of(const aiString& text) { return {text.data, text.length}; }

Error bad(std::string place, std::string reason) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), "export the file again");
  error.place = std::move(place);
  return error;
}

bool sound(const aiScene& scene, unsigned mesh) {
  return mesh < scene.mNumMeshes && scene.mMeshes != nullptr && scene.mMeshes[mesh] != nullptr;
}

std::size_t triangles_in(const aiMesh& mesh) {
  std::size_t count = 0;
  for (unsigned f = 0; mesh.mFaces != nullptr && f < mesh.mNumFaces; ++f) {
    if (mesh.mFaces[f].mNumIndices == 3) ++count;
  }
  return count;
}

std::string material_of(const aiScene& scene, const aiMesh& mesh) {
  aiString name;
  if (scene.mMaterials != nullptr && mesh.mMaterialIndex < scene.mNumMaterials) {
    scene.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name);
  }
  return text_of(name);
}

// One mesh of one node.
struct Visit {
  const aiNode* node;
  const aiMesh* mesh;
  Affine to_file;
};

Result<std::vector<Visit>> visit_nodes(const aiScene& scene, const Request& request) {
  std::vector<Visit> visits;
  std::vector<std::pair<const aiNode*, Affine>> open{{scene.mRootNode, Affine{}}};
  std::size_t triangles = 0;
  while (!open.empty()) {
    const auto [node, parent] = open.back();
    open.pop_back();
    if (node == nullptr) continue;
    const Affine here = compose(parent, from_assimp(node->mTransformation));
    if (!is_affine(node->mTransformation) || !here.finite()) {
      return bad("node '" + text_of(node->mName) + "'", "its transform is not finite and affine");
    }
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      if (!sound(scene, node->mMeshes[i])) {
        return bad("node '" + text_of(node->mName) + "'", "it names a mesh that is not there");
      }
      const aiMesh* mesh = scene.mMeshes[node->mMeshes[i]];
      const std::size_t count = triangles_in(*mesh);
      if (count == 0) continue;
      triangles += count;
      visits.push_back({node, mesh, here});
      if (triangles > request.triangles || visits.size() > request.parts) {
        return make_error(ErrorCode::limit_exceeded,
                          "more than " + std::to_string(request.triangles) + " triangles or " +
                              std::to_string(request.parts) + " parts",
                          "simplify the mesh or raise the limit");
      }
    }
    for (unsigned i = node->mNumChildren; i-- > 0;) open.emplace_back(node->mChildren[i], here);
  }
  return visits;
}

Status add(const Visit& visit, const std::string& name, MeshBuilder& builder) {
  const aiMesh& source = *visit.mesh;
  if (source.mVertices == nullptr) return bad("part '" + name + "'", "it has no vertices");
  builder.begin_part(name, source.mNumVertices, visit.to_file.mirrors());
  const auto position = [&](std::uint32_t index) {
    const aiVector3D& vertex = source.mVertices[index];
    return visit.to_file(Eigen::Vector3d(vertex.x, vertex.y, vertex.z));
  };
  for (unsigned f = 0; f < source.mNumFaces; ++f) {
    const aiFace& face = source.mFaces[f];
    if (face.mNumIndices != 3) continue;
    builder.add({face.mIndices[0], face.mIndices[1], face.mIndices[2]}, position);
  }
  return builder.end_part();
}

}  // namespace

Result<TriangleMesh> flatten(const aiScene& scene, const Request& request, double metres_per_unit,
                             const std::string& file_name) {
  const Result<std::vector<Visit>> visits = visit_nodes(scene, request);
  if (!visits) return visits.error();
  std::vector<PartLabels> labels;
  labels.reserve(visits->size());
  for (const Visit& visit : *visits) {
    labels.push_back(
        {text_of(visit.node->mName), text_of(visit.mesh->mName), material_of(scene, *visit.mesh)});
    // The OBJ parser names the root after the file.
    if (labels.back().node == file_name) labels.back().node.clear();
  }
  const std::vector<std::string> names =
      name_parts(labels, file_name.substr(0, file_name.find_last_of('.')), request.name_bytes);
  MeshBuilder builder(request, metres_per_unit);
  for (std::size_t i = 0; i < visits->size(); ++i) {
    if (Status status = add((*visits)[i], names[i], builder); !status) return status.error();
  }
  return builder.take();
}

}  // namespace crashrank::importer
