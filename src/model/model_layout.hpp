#pragma once

#include "crashrank/model/model.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "model files are read in place: this needs a little-endian processor"
#endif

namespace crashrank::detail {

/// First bytes of every model file, of any version. The high bit, the line ends and the end-of-file
/// mark show what a transfer as text does to a file (as PNG's signature does).
inline constexpr std::array<unsigned char, 8> model_magic{0x93, 'C',  'R',  'M',
                                                          '\r', '\n', 0x1a, '\n'};

/// Bits of `ModelHeader::flags`.
enum HeaderFlag : std::uint32_t {
  flag_axes_are_world = 1,            ///< the boxes stand along the body's axes
  flag_center_of_mass_is_stated = 2,  ///< (0, 0, 0) can be stated
};

/// The head of a model file, as it lies there: no gap between members. All numbers little-endian.
struct ModelHeader {
  std::array<unsigned char, 8> magic;
  std::uint32_t version;
  std::uint32_t checksum;  ///< CRC-32C of what follows this member up to the corners
  std::uint64_t file_bytes;
  std::uint32_t parts;
  std::uint32_t name_bytes;
  std::uint32_t vertices;
  std::uint32_t triangles;
  std::uint32_t nodes;
  std::uint32_t wide_nodes;  ///< 0: no wide tree, then no clusters either
  std::uint32_t clusters;
  std::uint32_t tree_depth;
  std::uint32_t wide_depth;
  std::uint32_t flags;         ///< of `HeaderFlag`
  std::array<double, 9> axes;  ///< of the boxes, one after the other
  double mass_kg;              ///< 0: not stated
  double area_m2;
  double volume_m3;
  std::array<double, 3> center_m;
  std::array<double, 6> inertia_per_kg_m2;
  double scale;
  std::array<double, 3> origin_m;
  std::uint32_t up;
  std::uint32_t forward;
  double ground_m;  ///< the members of the profile; 0, all of them, where there is none
  /// Of each band, then the number of pieces.
  std::array<std::uint32_t, profile_bands + 1> first_piece;
  std::array<std::uint32_t, profile_bands> first_inner_piece;
  std::array<float, profile_bands> band_area_m2;
  std::array<std::int32_t, 3> center_of_mass_um;  ///< µm; 0 where it is not stated
  std::uint32_t unused;                           ///< 0
  double yaw_inertia_kgm2;                        ///< 0: not stated
  double unused_too;                              ///< 0
};
static_assert(sizeof(ModelHeader) == 448);
static_assert(offsetof(ModelHeader, axes) == 64 && offsetof(ModelHeader, ground_m) == 272);
static_assert(offsetof(ModelHeader, band_area_m2) == 372);
static_assert(offsetof(ModelHeader, center_of_mass_um) == 416);
static_assert(offsetof(ModelHeader, yaw_inertia_kgm2) == 432);

/// Where the checksum begins. It ends where the corners begin: they and the clusters repeat what
/// other sections hold, and are compared with it bit for bit.
inline constexpr std::size_t checked_from = offsetof(ModelHeader, file_bytes);

/// An entry of the section of parts; names follow each other in the section of names, without ends.
struct StoredPart {
  std::uint32_t triangles;
  std::uint32_t name_bytes;
};

static_assert(sizeof(StoredPart) == 8 && sizeof(Eigen::Vector3f) == 12 && sizeof(Node) == 32);
static_assert(sizeof(Triangle) == 36 && sizeof(WideLanes) == 8);
static_assert(sizeof(std::array<std::uint32_t, 3>) == 12 && sizeof(OutlinePiece) == 52);

enum Section : std::size_t {
  section_parts,
  section_names,
  section_vertices,
  section_triangles,
  section_nodes,
  section_order,
  section_wide_nodes,
  section_lanes,
  section_pieces,
  section_corners,
  section_clusters,
  section_count
};

inline constexpr std::array<const char*, section_count> section_names_of{
    "parts",      "names", "vertices",       "triangles", "nodes",   "order",
    "wide nodes", "lanes", "outline pieces", "corners",   "clusters"};

/// Sections begin at multiples of this; what lies between them is 0.
inline constexpr std::size_t section_alignment = 64;

struct SectionPlace {
  std::size_t offset = 0;
  std::size_t bytes = 0;
};

struct ModelLayout {
  std::array<SectionPlace, section_count> section;
  std::size_t end = 0;
};

/// Where the sections of a file with this header lie: their sizes follow from the counts, and each
/// begins where the one before ends, rounded up. Below 2^44 whatever the counts are.
inline ModelLayout layout_of(const ModelHeader& header) {
  const auto bytes = [](std::uint64_t count, std::size_t size) { return count * size; };
  const std::array<std::uint64_t, section_count> sizes{
      bytes(header.parts, sizeof(StoredPart)),
      bytes(header.name_bytes, 1),
      bytes(header.vertices, sizeof(Eigen::Vector3f)),
      bytes(header.triangles, sizeof(std::array<std::uint32_t, 3>)),
      bytes(header.nodes, sizeof(Node)),
      bytes(header.triangles, sizeof(std::uint32_t)),
      bytes(header.wide_nodes, sizeof(WideNode)),
      bytes(header.wide_nodes == 0 ? 0 : header.nodes, sizeof(WideLanes)),
      bytes(header.first_piece.back(), sizeof(OutlinePiece)),
      bytes(header.triangles, sizeof(Triangle)),
      bytes(header.clusters, sizeof(TriangleCluster))};
  ModelLayout layout;
  std::size_t at = sizeof(ModelHeader);
  for (std::size_t i = 0; i < section_count; ++i) {
    layout.section[i] = {at, static_cast<std::size_t>(sizes[i])};
    at += (layout.section[i].bytes + section_alignment - 1) / section_alignment * section_alignment;
  }
  layout.end = at;
  return layout;
}

/// The checksum of a file whose sections lie there.
std::uint32_t checksum_of(View<const unsigned char> bytes, const ModelLayout& layout);

/// What is checked of a stored model beyond its trees, when written and when read: parts that cover
/// the triangles in order with names that are unique, UTF-8 and at most `max_part_name_bytes` long;
/// finite vertices; finite properties; what is stated of the mass as in `check_stated_mass`; a
/// sound profile, or none. Errors: bad_input, limit_exceeded.
Status check_stored(const StoredModel& stored);

/// Longest outline piece in a model file, m.
inline constexpr double max_piece_m = 1e3;

/// Whether `make_profile` ends with this where a mesh has no profile: such a model is stored
/// without one. Other errors (out_of_memory) say nothing of the mesh.
inline bool means_no_profile(const Error& error) {
  return error.code == ErrorCode::bad_input || error.code == ErrorCode::limit_exceeded;
}

/// `load_model` from memory. The checksum need not be compared: for tests that have to reach what
/// it shields.
Result<LoadedModel> decode_model(View<const unsigned char> bytes,
                                 const std::shared_ptr<const void>& keeper, bool compare_checksum);

}  // namespace crashrank::detail
