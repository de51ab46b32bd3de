#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Edges of the height bands in which a body's outline is taken, m over the ground (body z = 0; a
/// mesh that reaches more than 0.3 m below that stands on its lowest point). What is higher than
/// the last edge is not part of a profile.
inline constexpr std::array<double, 11> profile_edges_m{0.0, 0.2, 0.4, 0.6, 0.8, 1.0,
                                                        1.2, 1.6, 2.2, 3.0, 4.0};
/// Number of height bands.
inline constexpr std::size_t profile_bands = profile_edges_m.size() - 1;

/// A short straight piece of an outline seen from above, body coordinates.
struct OutlinePiece {
  float x = 0.0F;         ///< its middle, m
  float y = 0.0F;         ///< m
  float normal_x = 1.0F;  ///< unit, outward
  float normal_y = 0.0F;  ///< unit, outward
  float length_m = 0.0F;  ///< > 0, see `longest_piece_m`
};

/// Longest piece that outlines are cut into, m. Bodies longer than 1 km get longer ones: a
/// 20,000th of their length, 100 m at most.
inline constexpr double longest_piece_m = 0.1;
/// Most pieces of a profile.
inline constexpr std::size_t max_profile_pieces = 2'000'000;
/// Largest coordinate of a mesh with a profile, each way, m.
inline constexpr double max_profile_coordinate_m = 1e6;

/// A body's outlines seen from above, one for each height band: the crash simulation reads these
/// instead of the mesh. Made once a model; holes in the surface up to two cells (4 cm on bodies
/// over 5 m, less on small ones) are closed, what lies inside is left out.
struct Profile {
  std::vector<OutlinePiece> pieces;                      ///< by rising band
  std::array<std::uint32_t, profile_bands + 1> first{};  ///< of each band, then their number
  std::array<float, profile_bands> area_m2{};            ///< enclosed in each band, m²
  double ground_m = 0.0;                                 ///< body z of the ground, m

  /// Volume between the outlines of all bands, m³.
  CRASHRANK_API double volume_m3() const;
};

/// Takes the outlines of a mesh at the middle of each band: the same bits on every machine. Of the
/// vertices only those that triangles use count. O(triangles + cells that the section passes +
/// cells of a raster of at most 4 million) a band. Errors: bad_input for vertices that are not
/// finite, too far out or not there; limit_exceeded above `max_profile_pieces`. Without pieces if
/// no band has an outline that encloses anything: a single sheet, a flat plate on the ground, a
/// body higher than 4 m over the ground throughout.
CRASHRANK_API Result<Profile> make_profile(const TriangleMesh& mesh);

}  // namespace crashrank
