#include "crashrank/report/ranking.hpp"
#include "report/bytes.hpp"
#include "report/palette.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <vector>

namespace crashrank {

std::string damage_ply(const TriangleMesh& mesh, View<const std::uint32_t> damaged) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  const std::vector<bool> flags = detail::damage_flags(mesh, damaged);
  const std::array<detail::Colour, 2> colours{detail::intact_colour, detail::damaged_colour};

  std::string vertices;
  std::string faces;
  std::uint32_t count = 0;
  std::array<std::vector<std::uint32_t>, 2> placed;  // by vertex: its place in that colour
  placed.fill(std::vector<std::uint32_t>(mesh.vertices.size(), unused));
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const std::size_t colour = flags[i] ? 1 : 0;
    faces += '\x03';
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      std::uint32_t& place = placed[colour][vertex];
      if (place == unused) {
        place = count++;
        for (int axis = 0; axis < 3; ++axis) detail::put_f32(vertices, mesh.vertices[vertex][axis]);
        const detail::Colour& c = colours[colour];
        for (const float channel : {c.red, c.green, c.blue}) {
          vertices += static_cast<char>(detail::srgb(channel));
        }
      }
      detail::put_u32(faces, place);
    }
  }
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\n"
             "comment metres, x forward, y left, z up; {} of {} triangles damaged (red)\n"
             "element vertex {}\n"
             "property float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\n"
             "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
             damaged.size(), mesh.size(), count, mesh.size()) +
         vertices + faces;
}

}  // namespace crashrank
