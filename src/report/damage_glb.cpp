#include "crashrank/base/box.hpp"
#include "crashrank/report/ranking.hpp"
#include "report/bytes.hpp"
#include "report/palette.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the glTF 2.0 specification.
constexpr int float_component = 5126;
constexpr int uint32_component = 5125;
constexpr int vertex_target = 34962;
constexpr int index_target = 34963;
constexpr std::uint32_t glb_magic = 0x46546c67;
constexpr std::uint32_t json_chunk = 0x4e4f534a;
constexpr std::uint32_t binary_chunk = 0x004e4942;

/// Collects the document's arrays while the binary chunk grows.
struct Writer {
  std::string binary;
  Json views = Json::array();
  Json accessors = Json::array();
  Json meshes = Json::array();
  Json nodes = Json::array();

  std::size_t add_accessor(const std::string& bytes, int target, Json accessor) {
    views.push_back({{"buffer", 0},
                     {"byteOffset", binary.size()},
                     {"byteLength", bytes.size()},
                     {"target", target}});
    binary += bytes;
    accessor["bufferView"] = views.size() - 1;
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }
};

Json corner(const Eigen::Vector3f& point) { return {point.x(), point.y(), point.z()}; }

Json material(const char* name, detail::Colour colour) {
  return {{"name", name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {colour.red, colour.green, colour.blue, 1.0}},
            {"metallicFactor", 0.1},
            {"roughnessFactor", 0.6}}}};
}

void add_part(Writer& writer, const TriangleMesh& mesh, const Part& part,
              const std::vector<bool>& damaged, std::vector<std::uint32_t>& place) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::string positions;
  std::array<std::string, 2> indices;  // intact, damaged
  std::uint32_t count = 0;
  Box box;
  const std::uint32_t end = part.first_triangle + part.triangle_count;
  for (std::uint32_t i = part.first_triangle; i < end; ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (place[vertex] == unused) {
        place[vertex] = count++;
        const Eigen::Vector3f& point = mesh.vertices[vertex];
        for (int axis = 0; axis < 3; ++axis) detail::put_f32(positions, point[axis]);
        box.grow(point);
      }
      detail::put_u32(indices[damaged[i] ? 1 : 0], place[vertex]);
    }
  }
  for (std::uint32_t i = part.first_triangle; i < end; ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) place[vertex] = unused;
  }
  if (count == 0) return;
  const std::size_t position = writer.add_accessor(positions, vertex_target,
                                                   {{"componentType", float_component},
                                                    {"count", count},
                                                    {"type", "VEC3"},
                                                    {"min", corner(box.min)},
                                                    {"max", corner(box.max)}});
  Json primitives = Json::array();
  for (std::size_t state = 0; state < indices.size(); ++state) {
    if (indices[state].empty()) continue;
    const std::size_t accessor = writer.add_accessor(indices[state], index_target,
                                                     {{"componentType", uint32_component},
                                                      {"count", indices[state].size() / 4},
                                                      {"type", "SCALAR"}});
    primitives.push_back({{"attributes", {{"POSITION", position}}},
                          {"indices", accessor},
                          {"material", state},
                          {"mode", 4}});
  }
  writer.meshes.push_back({{"name", part.name}, {"primitives", std::move(primitives)}});
  writer.nodes.push_back({{"name", part.name}, {"mesh", writer.meshes.size() - 1}});
}

void put_chunk(std::string& out, std::uint32_t type, const std::string& bytes) {
  detail::put_u32(out, static_cast<std::uint32_t>(bytes.size()));
  detail::put_u32(out, type);
  out += bytes;
}

}  // namespace

Result<std::string> damage_glb(const TriangleMesh& mesh, View<const std::uint32_t> damaged) {
  const std::vector<bool> flags = detail::damage_flags(mesh, damaged);
  std::vector<std::uint32_t> place(mesh.vertices.size(), std::numeric_limits<std::uint32_t>::max());
  Writer writer;
  for (const Part& part : mesh.parts) add_part(writer, mesh, part, flags, place);

  Json children = Json::array();
  for (std::size_t i = 0; i < writer.nodes.size(); ++i) children.push_back(i);
  // Forward x, left y, up z become glTF's z, x, y: a turn by -120 degrees about (1, 1, 1).
  writer.nodes.push_back(
      {{"name", "body"}, {"rotation", {-0.5, -0.5, -0.5, 0.5}}, {"children", std::move(children)}});
  Json document{{"asset", {{"version", "2.0"}, {"generator", "crashrank"}}},
                {"scene", 0},
                {"scenes", Json::array({{{"nodes", Json::array({writer.nodes.size() - 1})}}})},
                {"nodes", std::move(writer.nodes)},
                {"meshes", std::move(writer.meshes)},
                {"materials", Json::array({material("intact", detail::intact_colour),
                                           material("damaged", detail::damaged_colour)})},
                {"accessors", std::move(writer.accessors)},
                {"bufferViews", std::move(writer.views)},
                {"buffers", Json::array({{{"byteLength", writer.binary.size()}}})}};
  std::string json = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');

  constexpr std::size_t header_bytes = 12;
  constexpr std::size_t chunk_header_bytes = 8;
  const std::size_t total =
      header_bytes + 2 * chunk_header_bytes + json.size() + writer.binary.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    return make_error(ErrorCode::limit_exceeded, "the mesh does not fit into a GLB file of 4 GiB");
  }
  std::string out;
  out.reserve(total);
  detail::put_u32(out, glb_magic);
  detail::put_u32(out, 2);
  detail::put_u32(out, static_cast<std::uint32_t>(total));
  put_chunk(out, json_chunk, json);
  put_chunk(out, binary_chunk, writer.binary);
  return out;
}

}  // namespace crashrank
