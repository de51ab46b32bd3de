#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Edges of the height bands of a profile, m over the ground (body z = 0; a mesh that reaches more
/// than 0.3 m below that stands on its lowest point; of one that reaches more than 2.5 m below and
/// above the ground as well, which is a foundation, the uppermost metre below counts). What is
/// higher than the last edge is not part of a profile.
inline constexpr std::array<double, 12> profile_edges_m{0.0, 0.1, 0.2, 0.4, 0.6, 0.8,
                                                        1.0, 1.2, 1.6, 2.2, 3.0, 4.0};
/// Number of height bands.
inline constexpr std::size_t profile_bands = profile_edges_m.size() - 1;
/// Height of a band, m.
constexpr double band_height_m(std::size_t band) {
  return profile_edges_m[band + 1] - profile_edges_m[band];
}
/// Lowest band that presses: what is lower is driven over.
inline constexpr std::size_t lowest_pressing_band = 1;

/// A range of heights over the ground of a body, m; empty where low_m > high_m.
struct HeightRange {
  float low_m = 1e9F;    ///< m
  float high_m = -1e9F;  ///< m

  /// Grows to include a height.
  void grow(float height_m) noexcept {
    low_m = height_m < low_m ? height_m : low_m;
    high_m = height_m > high_m ? height_m : high_m;
  }
  /// Grows to include another range.
  void grow(const HeightRange& other) noexcept {
    low_m = other.low_m < low_m ? other.low_m : low_m;
    high_m = other.high_m > high_m ? other.high_m : high_m;
  }
  /// Returns true if it holds no height.
  bool empty() const noexcept { return low_m > high_m; }
};

/// A short straight piece of an outline seen from above, body coordinates.
struct OutlinePiece {
  float x = 0.0F;         ///< its middle, m
  float y = 0.0F;         ///< m
  float normal_x = 1.0F;  ///< unit, outward
  float normal_y = 0.0F;  ///< unit, outward
  float length_m = 0.0F;  ///< > 0, see `longest_piece_m`
  HeightRange at_edge;    ///< heights of the surface at the piece, within its band
  HeightRange behind;     ///< and up to `profile_depth_m` behind it
  HeightRange along_x;    ///< of all that the body has in the band on lines along x through it
  HeightRange along_y;    ///< and along y
};

/// Depth behind an outline piece for which `OutlinePiece::behind` counts, m.
inline constexpr double profile_depth_m = 0.3;
/// Free space inside an outline that is at least this wide is kept, m.
inline constexpr double least_free_width_m = 0.3;
/// Longest piece that outlines are cut into, m. Bodies longer than 1 km get longer ones: a
/// 20,000th of their length, 100 m at most.
inline constexpr double longest_piece_m = 0.1;
/// Most pieces of a profile.
inline constexpr std::size_t max_profile_pieces = 2'000'000;
/// Largest coordinate of a mesh with a profile, each way, m.
inline constexpr double max_profile_coordinate_m = 1e6;

/// A body's outlines seen from above, one for each height band: the crash simulation reads these
/// instead of the mesh. An outline goes round everything that the body has within the band. Made
/// once a model; gaps in the surface up to two cells (4 cm on bodies over 5 m, less on small ones)
/// are closed. Inner outlines go round free space: space that no way in the plane leads to, at
/// least `least_free_width_m` wide, and either outside the body by its winding number or open to
/// the sky.
struct Profile {
  std::vector<OutlinePiece> pieces;  ///< by rising band, in a band those of outer outlines first
  std::array<std::uint32_t, profile_bands + 1> first{};    ///< of each band, then their number
  std::array<std::uint32_t, profile_bands> first_inner{};  ///< first piece of inner outlines
  /// Volume within the outer outlines of each band over the height of the band, m².
  std::array<float, profile_bands> area_m2{};
  double ground_m = 0.0;  ///< body z of the ground, m

  /// Volume within the outer outlines of all bands, m³.
  CRASHRANK_API double volume_m3() const;
  /// Returns true if the body can press: it has outlines in a band that presses.
  bool presses() const noexcept { return first[lowest_pressing_band] < first[profile_bands]; }
  /// Returns true if it has inner outlines.
  CRASHRANK_API bool has_inner() const noexcept;
  /// The profile without inner outlines: what a vehicle is filled with is structure.
  CRASHRANK_API Profile filled() const;
};

/// Takes the outlines of what a mesh has in each band: its triangles clipped to the band, seen from
/// above. The same bits on every machine. Of the vertices only those that triangles use count.
/// Empty where nothing lies between 0 and 4 m over the ground, or only single sheets that stand
/// upright or lie flat on the ground. O(triangles + cells that they cover + cells of a raster of at
/// most 4 million) a band. Errors: bad_input for vertices that are not finite, too far out or not
/// there, and for a mesh without triangles; limit_exceeded above `max_profile_pieces`.
CRASHRANK_API Result<Profile> make_profile(const TriangleMesh& mesh);

}  // namespace crashrank
