#include "mesh/importer/gltf_accessors.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace crashrank::importer {
namespace {

std::string accessor_name(int number) { return "accessor " + std::to_string(number); }

template <class T> T read_as(const unsigned char* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

bool is_unsigned(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// 0 for those that the format does not have.
std::size_t component_bytes(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

double GltfElements::value(std::size_t element, std::size_t component) const {
  const unsigned char* const at = begin + element * stride;
  const auto whole = [&](auto zero) {
    using T = decltype(zero);
    const auto number = static_cast<double>(read_as<T>(at + component * sizeof(T)));
    if (!normalized) return number;
    return std::max(number / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
  };
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return whole(std::int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return whole(std::uint8_t{});
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return whole(std::int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return whole(std::uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return whole(std::uint32_t{});
    case TINYGLTF_COMPONENT_TYPE_DOUBLE:  // of Draco's, decoded
      return read_as<double>(at + component * sizeof(double));
    default:
      return static_cast<double>(read_as<float>(at + component * sizeof(float)));
  }
}

Eigen::Vector3d GltfElements::vector(std::size_t element) const {
  return {value(element, 0), value(element, 1), value(element, 2)};
}

std::uint32_t GltfElements::index(std::size_t element) const {
  const unsigned char* const at = begin + element * stride;
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *at;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return read_as<std::uint16_t>(at);
    default:
      return read_as<std::uint32_t>(at);
  }
}

std::size_t gltf_number(const tinygltf::Value& object, const char* key, std::size_t otherwise) {
  if (!object.Has(key) || !object.Get(key).IsInt()) return otherwise;
  const int number = object.Get(key).GetNumberAsInt();
  return number < 0 ? std::numeric_limits<std::size_t>::max() : static_cast<std::size_t>(number);
}

const tinygltf::Value* gltf_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

unsigned char* GltfAccessors::keep(std::size_t size) {
  kept_.emplace_back(size);
  return kept_.back().data();
}

Result<GltfBytes> GltfAccessors::slice(int buffer, std::size_t offset, std::size_t size,
                                       const std::string& place) const {
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= file_.buffers.size()) {
    return gltf_error(place, "it names buffer " + std::to_string(buffer) + ", but there are " +
                                 std::to_string(file_.buffers.size()));
  }
  const GltfBytes& whole = file_.buffers[static_cast<std::size_t>(buffer)];
  if (offset > whole.size || size > whole.size - offset) {
    return gltf_error(
        place, "it is out of range: its buffer has " + std::to_string(whole.size) + " bytes");
  }
  return GltfBytes{whole.begin + offset, size};
}

Result<GltfAccessors::View> GltfAccessors::view(int number) {
  const std::string place = "buffer view " + std::to_string(number);
  if (number < 0 || static_cast<std::size_t>(number) >= file_.model.bufferViews.size()) {
    return gltf_error(place, "there is none of that number");
  }
  const tinygltf::BufferView& source = file_.model.bufferViews[static_cast<std::size_t>(number)];
  if (const tinygltf::Value* compression =
          gltf_extension(source.extensions, "EXT_meshopt_compression")) {
    if (const auto known = decompressed_.find(number); known != decompressed_.end()) {
      return known->second;
    }
    Result<View> decompressed = decompress(source, *compression, place);
    if (decompressed) decompressed_[number] = *decompressed;
    return decompressed;
  }
  const Result<GltfBytes> bytes = slice(source.buffer, source.byteOffset, source.byteLength, place);
  if (!bytes) return bytes.error();
  return View{*bytes, source.byteStride};
}

/// The elements before a sparse accessor's substitutions: zeros where it has no buffer view.
Result<GltfElements> GltfAccessors::dense(int number, const tinygltf::Accessor& accessor,
                                          std::size_t element_bytes) {
  GltfElements elements{nullptr, accessor.count, element_bytes, accessor.componentType,
                        accessor.normalized};
  if (accessor.bufferView < 0) {
    const std::size_t most = std::max(request_.vertices, 3 * request_.triangles);
    if (accessor.count > most) {
      return make_error(
          ErrorCode::limit_exceeded,
          accessor_name(number) + " has " + std::to_string(accessor.count) + " elements",
          "simplify the mesh or raise the limit");
    }
    elements.begin = keep(accessor.count * element_bytes);
    return elements;
  }
  const Result<View> source = view(accessor.bufferView);
  if (!source) return source.error();
  if (source->stride != 0) elements.stride = source->stride;
  const std::size_t size = source->bytes.size;
  if (accessor.byteOffset > size || element_bytes > size - accessor.byteOffset ||
      elements.stride < element_bytes ||
      (size - accessor.byteOffset - element_bytes) / elements.stride < accessor.count - 1) {
    return gltf_error(accessor_name(number),
                      std::to_string(accessor.count) +
                          " elements are out of range of its buffer view, which has " +
                          std::to_string(size) + " bytes");
  }
  elements.begin = source->bytes.begin + accessor.byteOffset;
  return elements;
}

/// Applies the substitutions of a sparse accessor to its elements, one after the other.
Status GltfAccessors::overwrite(const tinygltf::Accessor& accessor, std::size_t element_bytes,
                                unsigned char* elements, const std::string& place) {
  const auto& sparse = accessor.sparse;
  const std::size_t index_bytes = component_bytes(sparse.indices.componentType);
  const auto offset = [](int value) { return static_cast<std::size_t>(std::max(value, 0)); };
  const Result<View> indices = view(sparse.indices.bufferView);
  if (!indices) return indices.error();
  const Result<View> values = view(sparse.values.bufferView);
  if (!values) return values.error();
  const auto room = [](const View& source, std::size_t begin, std::size_t each) {
    return begin > source.bytes.size ? 0 : (source.bytes.size - begin) / each;
  };
  const std::size_t count = offset(sparse.count);
  if (!is_unsigned(sparse.indices.componentType) ||
      room(*indices, offset(sparse.indices.byteOffset), index_bytes) < count ||
      room(*values, offset(sparse.values.byteOffset), element_bytes) < count) {
    return gltf_error(place, "its sparse elements are out of range of their buffer views");
  }
  const GltfElements targets{indices->bytes.begin + offset(sparse.indices.byteOffset), count,
                             index_bytes, sparse.indices.componentType, false};
  const unsigned char* from = values->bytes.begin + offset(sparse.values.byteOffset);
  for (std::size_t i = 0; i < count; ++i, from += element_bytes) {
    if (targets.index(i) >= accessor.count) {
      return gltf_error(
          place, "its sparse index " + std::to_string(targets.index(i)) + " is out of range");
    }
    std::memcpy(elements + targets.index(i) * element_bytes, from, element_bytes);
  }
  return Success{};
}

Result<GltfElements> GltfAccessors::elements(int number, int type) {
  const std::string place = accessor_name(number);
  if (number < 0 || static_cast<std::size_t>(number) >= file_.model.accessors.size()) {
    return gltf_error(place, "there is none of that number");
  }
  const tinygltf::Accessor& accessor = file_.model.accessors[static_cast<std::size_t>(number)];
  const std::size_t component = component_bytes(accessor.componentType);
  if (accessor.type != type || component == 0) {
    return gltf_error(place, "its elements have another type than what uses them");
  }
  if (accessor.count == 0) return gltf_error(place, "it has no elements");
  const auto components =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  const std::size_t element_bytes = components * component;
  if (const auto known = sparse_.find(number); known != sparse_.end()) return known->second;
  Result<GltfElements> elements = dense(number, accessor, element_bytes);
  if (!elements || !accessor.sparse.isSparse) return elements;
  unsigned char* const copy = keep(accessor.count * element_bytes);
  for (std::size_t i = 0; i < accessor.count; ++i) {
    std::memcpy(copy + i * element_bytes, elements->begin + i * elements->stride, element_bytes);
  }
  if (const Status done = overwrite(accessor, element_bytes, copy, place); !done) {
    return done.error();
  }
  elements->begin = copy;
  elements->stride = element_bytes;
  sparse_[number] = *elements;
  return elements;
}

Result<GltfElements> GltfAccessors::indices(int number) {
  Result<GltfElements> found = elements(number, TINYGLTF_TYPE_SCALAR);
  if (found && !is_unsigned(found->component_type)) {
    return gltf_error(accessor_name(number), "indices are unsigned integers, these are not");
  }
  return found;
}

}  // namespace crashrank::importer
