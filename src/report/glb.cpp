#include "report/glb.hpp"

#include "crashrank/base/box.hpp"
#include "report/bytes.hpp"

#include <cstdint>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t glb_magic = 0x46546c67;
constexpr std::uint32_t json_chunk = 0x4e4f534a;
constexpr std::uint32_t binary_chunk = 0x004e4942;

void put_chunk(std::string& out, std::uint32_t type, const std::string& bytes) {
  put_u32(out, static_cast<std::uint32_t>(bytes.size()));
  put_u32(out, type);
  out += bytes;
}

Json corner(const Eigen::Vector3f& point) { return {point.x(), point.y(), point.z()}; }

}  // namespace

std::size_t GlbArrays::add(const std::string& bytes, int target, Json accessor) {
  Json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  views.push_back(std::move(view));
  binary += bytes;
  accessor["bufferView"] = views.size() - 1;
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

std::size_t GlbArrays::add_positions(View<const Eigen::Vector3f> points) {
  std::string bytes;
  bytes.reserve(12 * points.size());
  Box box;
  for (const Eigen::Vector3f& point : points) {
    for (int axis = 0; axis < 3; ++axis) put_f32(bytes, point[axis]);
    box.grow(point);
  }
  return add(bytes, gltf_vertices,
             {{"componentType", gltf_float},
              {"count", points.size()},
              {"type", "VEC3"},
              {"min", corner(box.min)},
              {"max", corner(box.max)}});
}

std::size_t GlbArrays::add_indices(const std::string& bytes) {
  return add(bytes, gltf_indices,
             {{"componentType", gltf_uint32}, {"count", bytes.size() / 4}, {"type", "SCALAR"}});
}

Json gltf_material(const std::string& name, const Colour& colour) {
  return {{"name", name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {colour.red, colour.green, colour.blue, 1.0}},
            {"metallicFactor", 0.1},
            {"roughnessFactor", 0.6}}}};
}

Json gltf_triangles(std::size_t positions, std::size_t indices, std::size_t material) {
  return {{"attributes", {{"POSITION", positions}}},
          {"indices", indices},
          {"material", material},
          {"mode", 4}};
}

Result<std::string> glb_file(Json document, GlbArrays arrays) {
  document["asset"] = {{"version", "2.0"}, {"generator", "crashrank"}};
  document["scene"] = 0;
  document["scenes"] = Json::array({{{"nodes", Json::array({document["nodes"].size() - 1})}}});
  document["accessors"] = std::move(arrays.accessors);
  document["bufferViews"] = std::move(arrays.views);
  document["buffers"] = Json::array({{{"byteLength", arrays.binary.size()}}});
  std::string json = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');

  constexpr std::size_t header_bytes = 12;
  constexpr std::size_t chunk_header_bytes = 8;
  const std::size_t total =
      header_bytes + 2 * chunk_header_bytes + json.size() + arrays.binary.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    return make_error(ErrorCode::limit_exceeded, "the meshes do not fit into a GLB file of 4 GiB");
  }
  std::string out;
  out.reserve(total);
  put_u32(out, glb_magic);
  put_u32(out, 2);
  put_u32(out, static_cast<std::uint32_t>(total));
  put_chunk(out, json_chunk, json);
  put_chunk(out, binary_chunk, arrays.binary);
  return out;
}

}  // namespace crashrank::detail
