#include "crashrank/model/make_model.hpp"
#include "model/model_layout.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace crashrank::detail {
namespace {

constexpr const char* compile_again = "compile it again from its mesh";

Error refused(std::string place, std::string reason) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), compile_again);
  error.place = std::move(place);
  return error;
}

Status check_size(const ModelHeader& header, std::size_t found) {
  if (header.file_bytes == found) return Success{};
  return refused("size",
                 "the file has " + std::to_string(found) + " bytes where its head says " +
                     std::to_string(header.file_bytes) +
                     (found < header.file_bytes ? ": it was cut" : ": something was added"));
}

Status check_counts(const ModelHeader& header) {
  constexpr std::uint32_t flags = flag_axes_are_world | flag_center_of_mass_is_stated;
  const bool stated = (header.flags & flag_center_of_mass_is_stated) != 0;
  const bool unused = (!stated && header.center_of_mass_um != std::array<std::int32_t, 3>{}) ||
                      header.unused != 0 || std::bit_cast<std::uint64_t>(header.unused_too) != 0;
  if (unused || (header.flags & ~flags) != 0 || header.up > 5 || header.forward > 5) {
    return refused("head", "it holds what this version never writes");
  }
  if (header.triangles == 0 || header.triangles > max_triangles) {
    return refused("head", "there are no triangles, or too many");
  }
  if ((header.wide_nodes == 0) != (header.clusters == 0)) {
    return refused("head", "there are wide nodes without clusters or the reverse");
  }
  if (header.first_piece.back() > max_profile_pieces) {
    return refused("head", "there are more than 2 million outline pieces");
  }
  return Success{};
}

/// The bytes between sections are zero, so that a model has one file.
Status check_gaps(View<const unsigned char> bytes, const ModelLayout& layout) {
  for (std::size_t i = 0; i < section_count; ++i) {
    const std::size_t end = layout.section[i].offset + layout.section[i].bytes;
    const std::size_t next = i + 1 < section_count ? layout.section[i + 1].offset : layout.end;
    if (std::any_of(bytes.begin() + end, bytes.begin() + next,
                    [](unsigned char byte) { return byte != 0; })) {
      return refused(section_names_of[i], "something lies behind the last one");
    }
  }
  return Success{};
}

template <class T>
Column<T> column(View<const unsigned char> bytes, const SectionPlace& place,
                 const std::shared_ptr<const void>& keeper) {
  static_assert(section_alignment % alignof(T) == 0);
  const auto* const first = reinterpret_cast<const T*>(bytes.data() + place.offset);
  return Column<T>::borrow({first, place.bytes / sizeof(T)}, keeper);
}

Result<std::vector<Part>> read_parts(View<const unsigned char> bytes, const ModelLayout& layout) {
  const SectionPlace& place = layout.section[section_parts];
  const SectionPlace& names = layout.section[section_names];
  std::vector<Part> parts(place.bytes / sizeof(StoredPart));
  std::uint64_t first = 0;
  std::size_t name = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    StoredPart stored{};
    std::memcpy(&stored, bytes.data() + place.offset + i * sizeof stored, sizeof stored);
    if (stored.name_bytes > names.bytes - name || first > max_triangles) {
      return refused("part " + std::to_string(i), "its name or triangles are not there");
    }
    const auto* const text = reinterpret_cast<const char*>(bytes.data() + names.offset + name);
    parts[i].name.assign(text, stored.name_bytes);
    parts[i].first_triangle = static_cast<std::uint32_t>(first);
    parts[i].triangle_count = stored.triangles;
    first += stored.triangles;
    name += stored.name_bytes;
  }
  if (name != names.bytes) return refused("names", "some of them belong to no part");
  return parts;
}

void read_properties(const ModelHeader& header, StoredModel& stored) {
  stored.transform.scale = header.scale;
  stored.transform.up = static_cast<Axis>(header.up);
  stored.transform.forward = static_cast<Axis>(header.forward);
  stored.transform.origin_m = {header.origin_m[0], header.origin_m[1], header.origin_m[2]};
  stored.mass.area_m2 = header.area_m2;
  stored.mass.volume_m3 = header.volume_m3;
  stored.mass.center_m = {header.center_m[0], header.center_m[1], header.center_m[2]};
  stored.mass.inertia_per_kg_m2 = header.inertia_per_kg_m2;
}

/// Absent where the member is 0. A negative zero is stated: `check_stated` refuses it.
std::optional<double> stated_number(double member) {
  if (member == 0.0 && !std::signbit(member)) return std::nullopt;
  return member;
}

StatedMass read_stated(const ModelHeader& header) {
  constexpr double um_per_m = 1e6;
  StatedMass stated;
  stated.mass_kg = stated_number(header.mass_kg);
  stated.yaw_inertia_kgm2 = stated_number(header.yaw_inertia_kgm2);
  if ((header.flags & flag_center_of_mass_is_stated) != 0) {
    const auto& um = header.center_of_mass_um;
    stated.center_of_mass_m = Eigen::Vector3d(um[0], um[1], um[2]) / um_per_m;
  }
  return stated;
}

/// Null where the file holds none.
std::shared_ptr<const Profile> read_profile(const ModelHeader& header,
                                            View<const unsigned char> bytes,
                                            const SectionPlace& place) {
  if (place.bytes == 0) return nullptr;
  auto profile = std::make_shared<Profile>();
  profile->pieces.resize(place.bytes / sizeof(OutlinePiece));
  std::memcpy(profile->pieces.data(), bytes.data() + place.offset, place.bytes);
  profile->first = header.first_piece;
  profile->first_inner = header.first_inner_piece;
  profile->area_m2 = header.band_area_m2;
  profile->ground_m = header.ground_m;
  return profile;
}

/// The profile of a file without outline pieces: of a mesh without outlines an empty one, of a mesh
/// without a profile none. Such a file must be canonical, so that encode(decode(file)) == file.
Result<std::shared_ptr<const Profile>> missing_profile(const ModelHeader& header,
                                                       const TriangleMesh& mesh) {
  const auto* const head = reinterpret_cast<const unsigned char*>(&header);
  if (std::any_of(head + offsetof(ModelHeader, ground_m),
                  head + offsetof(ModelHeader, center_of_mass_um),
                  [](unsigned char byte) { return byte != 0; })) {
    return refused("profile", "it has no piece");
  }
  Result<Profile> made = make_profile(mesh);
  if (!made) {
    if (means_no_profile(made.error())) return std::shared_ptr<const Profile>();
    return made.error();
  }
  if (!made->pieces.empty())
    return refused("profile", "there is none, though the mesh has outlines");
  return std::shared_ptr<const Profile>(std::make_shared<Profile>(std::move(*made)));
}

Error with_remedy(Error error) {
  error.remedy = compile_again;
  return error;
}

}  // namespace

Result<LoadedModel> decode_model(View<const unsigned char> bytes,
                                 const std::shared_ptr<const void>& keeper, bool compare_checksum) {
  if (bytes.size() < model_magic.size() ||
      !std::equal(model_magic.begin(), model_magic.end(), bytes.begin())) {
    return make_error(ErrorCode::bad_input, "is no model file", "make one with crashrank compile");
  }
  ModelHeader header{};
  std::memcpy(&header, bytes.data(), std::min(bytes.size(), sizeof header));
  if (bytes.size() >= checked_from && header.version != model_file_version) {
    return refused("version", "the file has version " + std::to_string(header.version) +
                                  ", this library reads version " +
                                  std::to_string(model_file_version));
  }
  if (bytes.size() < sizeof header) return refused("size", "it was cut within its head");
  assert(reinterpret_cast<std::uintptr_t>(bytes.data()) % section_alignment == 0);
  const ModelLayout layout = layout_of(header);
  if (Status status = check_size(header, bytes.size()); !status) return status.error();
  if (layout.end != bytes.size()) {
    return refused("head", "the numbers of elements do not add up to the size of the file");
  }
  if (compare_checksum && checksum_of(bytes, layout) != header.checksum) {
    return refused("checksum", "the file is damaged");
  }
  if (Status status = check_counts(header); !status) return status.error();
  if (Status status = check_gaps(bytes, layout); !status) return status.error();

  LoadedModel loaded;
  loaded.facts = {header.version, header.checksum, bytes.size()};
  Model& model = loaded.stored.model;
  const auto& at = layout.section;
  Result<std::vector<Part>> parts = read_parts(bytes, layout);
  if (!parts) return parts.error();
  model.mesh.parts = std::move(*parts);
  model.mesh.vertices = column<Eigen::Vector3f>(bytes, at[section_vertices], keeper);
  model.mesh.triangles = column<std::array<std::uint32_t, 3>>(bytes, at[section_triangles], keeper);
  for (int i = 0; i < 9; ++i) {
    model.tree.axes(i % 3, i / 3) = header.axes[static_cast<std::size_t>(i)];
  }
  model.tree.axes_are_world = (header.flags & flag_axes_are_world) != 0;
  model.tree.depth = header.tree_depth;
  model.tree.nodes = column<Node>(bytes, at[section_nodes], keeper);
  model.tree.order = column<std::uint32_t>(bytes, at[section_order], keeper);
  model.tree.triangles = column<Triangle>(bytes, at[section_corners], keeper);
  model.wide.depth = header.wide_depth;
  if (header.wide_nodes != 0) {
    model.wide.nodes = column<WideNode>(bytes, at[section_wide_nodes], keeper);
    model.wide.clusters = column<TriangleCluster>(bytes, at[section_clusters], keeper);
    model.wide.lanes_of = column<WideLanes>(bytes, at[section_lanes], keeper);
  }
  read_properties(header, loaded.stored);
  loaded.stored.stated = read_stated(header);
  model.profile = read_profile(header, bytes, at[section_pieces]);

  if (Status status = check_stored(loaded.stored); !status) return with_remedy(status.error());
  // Constant: mutable access would make the columns copy what they borrow.
  const Model& read = model;
  if (Status status = validate(read); !status) return with_remedy(status.error());
  if (model.profile == nullptr) {
    Result<std::shared_ptr<const Profile>> profile = missing_profile(header, read.mesh);
    if (!profile) return profile.error();
    model.profile = std::move(*profile);
  }
  return loaded;
}

}  // namespace crashrank::detail
