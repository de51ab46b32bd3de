#include "crashrank/report/ranking.hpp"
#include "report/bytes.hpp"
#include "report/glb.hpp"
#include "report/palette.hpp"

#include <nlohmann/json.hpp>

#include <array>
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

void add_part(Writer& writer, const TriangleMesh& mesh, const Part& part,
              const std::vector<bool>& damaged, std::vector<std::uint32_t>& place) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<Eigen::Vector3f> positions;
  std::array<std::string, 2> indices;  // intact, damaged
  const std::uint32_t end = part.first_triangle + part.triangle_count;
  for (std::uint32_t i = part.first_triangle; i < end; ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (place[vertex] == unused) {
        place[vertex] = static_cast<std::uint32_t>(positions.size());
        positions.push_back(mesh.vertices[vertex]);
      }
      detail::put_u32(indices[damaged[i] ? 1 : 0], place[vertex]);
    }
  }
  for (std::uint32_t i = part.first_triangle; i < end; ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) place[vertex] = unused;
  }
  if (positions.empty()) return;
  const std::size_t position = writer.arrays.add_positions(positions);
  Json primitives = Json::array();
  for (std::size_t state = 0; state < indices.size(); ++state) {
    if (indices[state].empty()) continue;
    primitives.push_back(
        detail::gltf_triangles(position, writer.arrays.add_indices(indices[state]), state));
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
  Json document{
      {"nodes", std::move(writer.nodes)},
      {"meshes", std::move(writer.meshes)},
      {"materials", Json::array({detail::gltf_material("intact", detail::intact_colour),
                                 detail::gltf_material("damaged", detail::damaged_colour)})}};
  return detail::glb_file(std::move(document), std::move(writer.arrays));
}

}  // namespace crashrank
