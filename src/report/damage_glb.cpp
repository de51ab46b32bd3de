#include "crashrank/base/box.hpp"
#include "crashrank/report/ranking.hpp"
#include "report/bytes.hpp"
#include "report/glb.hpp"
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

/// The document's parts while its arrays grow.
struct Writer {
  detail::GlbArrays arrays;
  Json meshes = Json::array();
  Json nodes = Json::array();
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
  const std::size_t position = writer.arrays.add(positions, detail::gltf_vertices,
                                                 {{"componentType", detail::gltf_float},
                                                  {"count", count},
                                                  {"type", "VEC3"},
                                                  {"min", corner(box.min)},
                                                  {"max", corner(box.max)}});
  Json primitives = Json::array();
  for (std::size_t state = 0; state < indices.size(); ++state) {
    if (indices[state].empty()) continue;
    const std::size_t accessor = writer.arrays.add(indices[state], detail::gltf_indices,
                                                   {{"componentType", detail::gltf_uint32},
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

}  // namespace

Result<std::string> damage_glb(const TriangleMesh& mesh, View<const std::uint32_t> damaged) {
  const std::vector<bool> flags = detail::damage_flags(mesh, damaged);
  std::vector<std::uint32_t> place(mesh.vertices.size(), std::numeric_limits<std::uint32_t>::max());
  Writer writer;
  for (const Part& part : mesh.parts) add_part(writer, mesh, part, flags, place);

  Json children = Json::array();
  for (std::size_t i = 0; i < writer.nodes.size(); ++i) children.push_back(i);
  writer.nodes.push_back(
      {{"name", "body"}, {"rotation", detail::gltf_axes()}, {"children", std::move(children)}});
  Json document{{"asset", {{"version", "2.0"}, {"generator", "crashrank"}}},
                {"scene", 0},
                {"scenes", Json::array({{{"nodes", Json::array({writer.nodes.size() - 1})}}})},
                {"nodes", std::move(writer.nodes)},
                {"meshes", std::move(writer.meshes)},
                {"materials", Json::array({material("intact", detail::intact_colour),
                                           material("damaged", detail::damaged_colour)})}};
  return detail::glb_file(std::move(document), std::move(writer.arrays));
}

}  // namespace crashrank
