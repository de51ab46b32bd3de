#include "mesh/importer/gltf_accessors.hpp"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

// Buffer views of EXT_meshopt_compression and primitives of KHR_draco_mesh_compression.

namespace crashrank::importer {
namespace {

constexpr const char* draco_name = "KHR_draco_mesh_compression";

std::string text_member(const tinygltf::Value& object, const char* key,
                        const std::string& otherwise) {
  return object.Has(key) && object.Get(key).IsString() ? object.Get(key).Get<std::string>()
                                                       : otherwise;
}

// The library asserts what these check.
bool fits(const std::string& mode, const std::string& filter, std::size_t stride,
          std::size_t count) {
  if (mode != "ATTRIBUTES") {
    return (stride == 2 || stride == 4) && filter == "NONE" &&
           (mode == "INDICES" || (mode == "TRIANGLES" && count % 3 == 0));
  }
  if (stride == 0 || stride > 256 || stride % 4 != 0) return false;
  return filter == "NONE" || filter == "EXPONENTIAL" || (filter == "QUATERNION" && stride == 8) ||
         (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8));
}

bool decode(const std::string& mode, const std::string& filter, std::size_t stride,
            std::size_t count, const GltfBytes& from, unsigned char* to) {
  if (mode == "TRIANGLES") {
    return meshopt_decodeIndexBuffer(to, count, stride, from.begin, from.size) == 0;
  }
  if (mode == "INDICES") {
    return meshopt_decodeIndexSequence(to, count, stride, from.begin, from.size) == 0;
  }
  if (meshopt_decodeVertexBuffer(to, count, stride, from.begin, from.size) != 0) return false;
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(to, count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(to, count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(to, count, stride);
  return true;
}

}  // namespace

Result<GltfAccessors::View> GltfAccessors::decompress(const tinygltf::BufferView& source,
                                                      const tinygltf::Value& compression,
                                                      const std::string& place) {
  const std::size_t stride = gltf_number(compression, "byteStride", 0);
  const std::size_t count = gltf_number(compression, "count", 0);
  const std::string mode = text_member(compression, "mode", {});
  const std::string filter = text_member(compression, "filter", "NONE");
  const std::string name = "EXT_meshopt_compression";
  if (!fits(mode, filter, stride, count) || source.byteLength / stride < count) {
    return gltf_error(place, name + ": its mode, filter, byteStride and count do not fit together");
  }
  if (source.byteLength > request_.memory_bytes) {
    return make_error(ErrorCode::limit_exceeded,
                      place + " has " + std::to_string(source.byteLength) + " bytes",
                      "simplify the mesh or raise the limit");
  }
  const Result<GltfBytes> from = slice(
      static_cast<int>(gltf_number(compression, "buffer", file_.buffers.size())),
      gltf_number(compression, "byteOffset", 0), gltf_number(compression, "byteLength", 0), place);
  if (!from) return from.error();
  unsigned char* const to = keep(count * stride);
  if (!decode(mode, filter, stride, count, *from, to)) {
    return gltf_error(place, name + ": its data are damaged");
  }
  return View{{to, count * stride}, mode == "ATTRIBUTES" ? stride : 0};
}

/// What the components of a normalised accessor of integers are divided by, else 0.
double GltfAccessors::normalization(int number) const {
  if (number < 0 || static_cast<std::size_t>(number) >= file_.model.accessors.size()) return 0.0;
  const tinygltf::Accessor& accessor = file_.model.accessors[static_cast<std::size_t>(number)];
  if (!accessor.normalized) return 0.0;
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return 127.0;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 255.0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return 32767.0;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 65535.0;
    default:
      return 0.0;
  }
}

Result<const draco::Mesh*> GltfAccessors::draco_mesh(const tinygltf::Value& compression) {
  const auto number = static_cast<int>(gltf_number(compression, "bufferView", 0x7fffffff));
  if (const auto known = draco_.find(number); known != draco_.end()) return known->second.get();
  const Result<View> source = view(number);
  if (!source) return source.error();
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(source->bytes.begin), source->bytes.size);
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) {
    return gltf_error("buffer view " + std::to_string(number),
                      std::string(draco_name) + ": " + decoded.status().error_msg_string());
  }
  std::shared_ptr<draco::Mesh> mesh = std::move(decoded).value();
  if (mesh->num_faces() > request_.triangles || mesh->num_points() > request_.vertices) {
    return make_error(ErrorCode::limit_exceeded,
                      "a Draco primitive of " + std::to_string(mesh->num_faces()) + " triangles",
                      "simplify the mesh or raise the limit");
  }
  return (draco_[number] = std::move(mesh)).get();
}

Result<GltfElements> GltfAccessors::draco_faces(const tinygltf::Primitive& primitive) {
  const tinygltf::Value* const compression = gltf_extension(primitive.extensions, draco_name);
  if (compression == nullptr) return GltfElements{};
  const Result<const draco::Mesh*> mesh = draco_mesh(*compression);
  if (!mesh) return mesh.error();
  GltfElements faces{nullptr, std::size_t{3} * (*mesh)->num_faces(), sizeof(std::uint32_t),
                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, false};
  unsigned char* to = keep(faces.count * faces.stride);
  faces.begin = to;
  for (draco::FaceIndex face(0); face < (*mesh)->num_faces(); ++face) {
    for (const draco::PointIndex& point : (*mesh)->face(face)) {
      const std::uint32_t index = point.value();
      std::memcpy(to, &index, sizeof index);
      to += sizeof index;
    }
  }
  return faces;
}

Result<GltfElements> GltfAccessors::attribute(const tinygltf::Primitive& primitive,
                                              const std::string& name, int type) {
  const auto accessor = primitive.attributes.find(name);
  if (accessor == primitive.attributes.end()) return gltf_error(name, "it is missing");
  const tinygltf::Value* const compression = gltf_extension(primitive.extensions, draco_name);
  if (compression == nullptr || !compression->Has("attributes") ||
      !compression->Get("attributes").Has(name)) {
    return elements(accessor->second, type);
  }
  const Result<const draco::Mesh*> mesh = draco_mesh(*compression);
  if (!mesh) return mesh.error();
  const auto id = static_cast<std::uint32_t>(
      gltf_number(compression->Get("attributes"), name.c_str(), 0xffffffff));
  const draco::PointAttribute* const source = (*mesh)->GetAttributeByUniqueId(id);
  const auto components =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  const std::string place = std::string(draco_name) + ", attribute " + name;
  if (source == nullptr || static_cast<std::size_t>(source->num_components()) != components) {
    return gltf_error(place, "the compressed data have none such");
  }
  GltfElements found{nullptr, (*mesh)->num_points(), components * sizeof(double),
                     TINYGLTF_COMPONENT_TYPE_DOUBLE, false};
  const double largest = source->normalized() ? 0.0 : normalization(accessor->second);
  unsigned char* to = keep(found.count * found.stride);
  found.begin = to;
  for (draco::PointIndex point(0); point < (*mesh)->num_points(); ++point) {
    std::array<double, 4> values{};
    if (source->mapped_index(point).value() >= source->size() || components > values.size() ||
        !source->ConvertValue<double>(source->mapped_index(point),
                                      static_cast<std::int8_t>(components), values.data())) {
      return gltf_error(place, "its data are damaged");
    }
    if (largest > 0.0) {
      for (double& value : values) value = std::max(value / largest, -1.0);
    }
    std::memcpy(to, values.data(), found.stride);
    to += found.stride;
  }
  return found;
}

}  // namespace crashrank::importer
