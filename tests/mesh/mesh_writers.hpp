#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

// Writers of every format that can be imported, by hand, so that what comes back is held against
// something that the parser had no part in.
namespace crashrank::test {

using SoupTriangle = std::array<Eigen::Vector3f, 3>;

struct SoupPart {
  std::string name;
  std::vector<SoupTriangle> triangles;
};

using Soup = std::vector<SoupPart>;

std::size_t triangle_count(const Soup& soup);

/// Closed boxes with named parts; coordinates are multiples of 1/8, which every text format gives
/// back exactly.
Soup eighths_soup();

/// Triangles with coordinates of full precision, degenerate and duplicate ones among them; for the
/// binary formats.
Soup ragged_soup(unsigned seed, std::size_t triangles);

std::string as_obj(const Soup& soup);
std::string as_stl_text(const Soup& soup);
std::string as_stl_binary(const Soup& soup);
std::string as_ply_text(const Soup& soup);
std::string as_ply_binary(const Soup& soup);
std::string as_off(const Soup& soup);
std::string as_glb(const Soup& soup);
/// JSON with the buffer inside as a data URI.
std::string as_gltf(const Soup& soup);
/// JSON that names `uri`, with the buffer in `buffer`.
std::string as_gltf(const Soup& soup, const std::string& uri, std::string& buffer);
/// `unit` is metres per unit, as the attribute is written; `root` 16 numbers, row-major.
std::string as_collada(const Soup& soup, const std::string& unit = "1",
                       const std::string& up_axis = "Z_UP",
                       const std::string& matrix = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
/// `unit` is centimetres per unit.
std::string as_fbx(const Soup& soup, double unit);
std::string as_3ds(const Soup& soup);
std::string as_ac3d(const Soup& soup);

/// A GLB from its JSON and binary chunk.
std::string glb(std::string json, std::string buffer);

}  // namespace crashrank::test
