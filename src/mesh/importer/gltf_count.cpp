#include "mesh/importer/gltf_count.hpp"

#include "mesh/importer/content.hpp"

#include <nlohmann/json.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace crashrank::importer {
namespace {

using Json = nlohmann::json;

// A binary file is a header of 12 bytes, then chunks of u32 length, u32 type and content, of which
// the first is the JSON.
std::string json_text(int descriptor, std::size_t max_bytes) {
  const std::string head = read_at(descriptor, 0, 20);
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return {};
  const std::size_t size = std::min(max_bytes, static_cast<std::size_t>(status.st_size));
  if (head.compare(0, 4, "glTF") != 0) return read_at(descriptor, 0, size);
  if (head.size() < 20) return {};
  std::uint32_t length = 0;
  std::memcpy(&length, head.data() + 12, sizeof length);
  return read_at(descriptor, 20, std::min<std::size_t>(length, size));
}

std::uint64_t number(const Json& object, const char* key, std::uint64_t otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>()
                                                              : otherwise;
}

const Json& member(const Json& object, const char* key) {
  static const Json nothing;
  const auto found = object.find(key);
  return object.is_object() && found != object.end() ? *found : nothing;
}

std::uint64_t corners(const Json& primitive, const Json& accessors) {
  const std::uint64_t missing = accessors.size();
  std::uint64_t accessor = number(primitive, "indices", missing);
  if (accessor >= missing) accessor = number(member(primitive, "attributes"), "POSITION", missing);
  return accessors.is_array() && accessor < missing
             ? number(accessors[static_cast<std::size_t>(accessor)], "count", 0)
             : 0;
}

}  // namespace

std::uint64_t gltf_triangles(int descriptor, std::size_t max_bytes) {
  const Json root = Json::parse(json_text(descriptor, max_bytes), nullptr, false);
  std::uint64_t triangles = 0;
  for (const Json& mesh : member(root, "meshes")) {
    for (const Json& primitive : member(mesh, "primitives")) {
      const std::uint64_t count = corners(primitive, member(root, "accessors"));
      const std::uint64_t mode = number(primitive, "mode", 4);
      if (mode == 4) triangles += count / 3;
      if ((mode == 5 || mode == 6) && count > 2) triangles += count - 2;
    }
  }
  return triangles;
}

}  // namespace crashrank::importer
