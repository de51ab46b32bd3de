#pragma once

#include "crashrank/base/result.hpp"
#include "mesh/importer/affine.hpp"
#include "mesh/importer/gltf_accessors.hpp"

#include <vector>

namespace crashrank::importer {

/// A node whose mesh is shown, once for each of its instances.
struct GltfVisit {
  int node = 0;
  Affine to_file;
};

/// The nodes of a file's default scene, else its first one, else all nodes where it has no scenes.
struct GltfNodes {
  std::vector<Affine> to_file;    ///< of every node that is reached or not
  std::vector<GltfVisit> visits;  ///< those with meshes: depth first, instances in order
};

/// Walks the nodes without recursion: their depth is the file's to choose. Hidden ones
/// (KHR_node_visibility) and what hangs on them are left out; EXT_mesh_gpu_instancing counts.
/// Errors: bad_input for nodes that form no forest and transforms that are not finite and affine;
/// limit_exceeded for more instances than parts are allowed.
Result<GltfNodes> walk_gltf_nodes(const tinygltf::Model& model, GltfAccessors& accessors,
                                  const Request& request);

}  // namespace crashrank::importer
