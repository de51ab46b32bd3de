#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crashrank {

/// Rows from the top, pixels from the left, three bytes sRGB each.
struct Image {
  int width = 0;                  ///< pixels
  int height = 0;                 ///< pixels
  std::vector<std::uint8_t> rgb;  ///< three bytes a pixel, rows from the top
};

/// A body in a picture.
struct PictureBody {
  const TriangleMesh* mesh = nullptr;  ///< not null
  Pose pose;                           ///< body to world
  View<const std::uint32_t> damaged;   ///< triangles drawn in the colour of damage
};

/// How large a picture is, and from where.
struct PictureOptions {
  int width_px = 1200;  ///< pixels
  int height_px = 750;  ///< pixels
  /// Where the camera stands, seen from the middle of the scene, in world axes: degrees
  /// counter-clockwise from +x, and degrees above the ground.
  double azimuth_deg = 40.0;
  double elevation_deg = 22.0;      ///< of the camera above the ground
  double field_of_view_deg = 28.0;  ///< across the picture's width
  bool edges = true;                ///< draw the triangles' edges where they are large enough
};

/// Draws the bodies in perspective on a light ground, shaded, with damaged triangles in red: the
/// still picture that figure 1 of Wiseman & Grinberg 2016 is. Parts whose names speak of glass,
/// tyres or lamps get colours of such; the first body's paint is blue, the others' sand. The same
/// input draws the same picture on one machine; colours may differ by a step between machines.
/// Cost: a second or two for 1200 x 750 and 100,000 triangles; memory about 100 bytes a pixel.
/// Errors: usage for no triangle, a width or height outside 16 to 4096, angles that are not finite,
/// a field of view outside 1 to 120 or an elevation outside -89 to 89 degrees.
CRASHRANK_API Result<Image> draw_picture(View<const PictureBody> bodies,
                                         const PictureOptions& options = {});

/// Where a body's damage lies: the mean direction of its damaged triangles, seen from the body's
/// middle, as an azimuth in world axes; 0 without damage. A camera 30 to 60 degrees beside it
/// shows the damage and the body's length.
CRASHRANK_API double azimuth_of_damage_deg(const PictureBody& body);

/// Returns the number of pixels in the colour of damage, however shaded.
CRASHRANK_API std::size_t count_damage(const Image& image);

/// The image as a PNG file's bytes. Errors: internal when libpng fails.
CRASHRANK_API Result<std::string> png(const Image& image);

// A body with its damaged triangles highlighted, as in figure 1 of Wiseman & Grinberg 2016, in
// formats that every mesh viewer reads. Both return the file's bytes; `damaged` holds indices of
// triangles, each at most once, in any order, all within the mesh. Linear in the mesh; safe from
// any thread.

/// glTF 2.0 binary. Each part is a node of its name; its intact and its damaged triangles have a
/// material each, named "intact" and "damaged". Coordinates stay in body axes under one root node
/// that turns them into glTF's (y up, z forward). Errors: limit_exceeded above 4 GiB.
CRASHRANK_API Result<std::string> damage_glb(const TriangleMesh& mesh,
                                             View<const std::uint32_t> damaged);

/// Binary PLY with coloured vertices, in body coordinates, triangles in the mesh's order. Vertices
/// that both intact and damaged triangles use stand in it twice, once in each colour.
CRASHRANK_API std::string damage_ply(const TriangleMesh& mesh, View<const std::uint32_t> damaged);

}  // namespace crashrank
