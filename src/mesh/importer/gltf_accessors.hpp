#pragma once

#include "crashrank/base/result.hpp"
#include "mesh/importer/gltf_file.hpp"
#include "mesh/importer/request.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace draco {
class Mesh;
}

namespace crashrank::importer {

/// Checked elements of an accessor: all of them lie inside the bytes.
struct GltfElements {
  const unsigned char* begin = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;  ///< bytes from one element to the next
  int component_type = 0;  ///< as in the file
  bool normalized = false;

  /// A component, normalised as the format says.
  double value(std::size_t element, std::size_t component) const;
  /// The first three components.
  Eigen::Vector3d vector(std::size_t element) const;
  /// An unsigned integer.
  std::uint32_t index(std::size_t element) const;
};

/// Elements of a file's accessors, with sparse ones and compressed data resolved. Sizes are checked
/// against the file or the limits before anything is allocated.
class GltfAccessors {
public:
  /// Both must outlive this object.
  GltfAccessors(const GltfFile& file, const Request& request) : file_(file), request_(request) {}

  /// Elements of the type that tinygltf numbers `type`.
  Result<GltfElements> elements(int accessor, int type);

  /// Indices of vertices: unsigned integers.
  Result<GltfElements> indices(int accessor);

  /// An attribute of a primitive that Draco compressed; as `elements` where it did not.
  Result<GltfElements> attribute(const tinygltf::Primitive& primitive, const std::string& name,
                                 int type);

  /// The faces of a primitive that Draco compressed, as indices; no elements where it did not.
  Result<GltfElements> draco_faces(const tinygltf::Primitive& primitive);

private:
  struct View {
    GltfBytes bytes;
    std::size_t stride = 0;  // 0: one element after the other
  };

  Result<GltfBytes> slice(int buffer, std::size_t offset, std::size_t size,
                          const std::string& place) const;
  Result<View> view(int number);
  Result<View> decompress(const tinygltf::BufferView& source, const tinygltf::Value& compression,
                          const std::string& place);
  Result<GltfElements> dense(int number, const tinygltf::Accessor& accessor,
                             std::size_t element_bytes);
  Status overwrite(const tinygltf::Accessor& accessor, std::size_t element_bytes,
                   unsigned char* elements, const std::string& place);
  Result<const draco::Mesh*> draco_mesh(const tinygltf::Value& compression);
  double normalization(int accessor) const;
  unsigned char* keep(std::size_t size);

  const GltfFile& file_;
  const Request& request_;
  std::vector<std::vector<unsigned char>> kept_;
  std::map<int, View> decompressed_;                   // by buffer view
  std::map<int, GltfElements> sparse_;                 // by accessor
  std::map<int, std::shared_ptr<draco::Mesh>> draco_;  // by buffer view
};

/// A whole number of an extension's object, `otherwise` where it has none.
std::size_t gltf_number(const tinygltf::Value& object, const char* key, std::size_t otherwise);

/// The extension of that name; nullptr if there is none.
const tinygltf::Value* gltf_extension(const tinygltf::ExtensionMap& extensions, const char* name);

}  // namespace crashrank::importer
