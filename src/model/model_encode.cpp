#include "base/crc32c.hpp"
#include "base/utf8.hpp"
#include "crashrank/internal/base/guarded.hpp"
#include "crashrank/model/make_model.hpp"
#include "model/model_layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crashrank {
namespace detail {
namespace {

Error broken(std::string place, std::string reason) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason));
  error.place = std::move(place);
  return error;
}

Error broken_part(std::size_t index, std::string reason) {
  return broken("part " + std::to_string(index), std::move(reason));
}

Status check_parts(const TriangleMesh& mesh) {
  std::uint64_t covered = 0;
  std::vector<std::string_view> names;
  names.reserve(mesh.parts.size());
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const Part& part = mesh.parts[i];
    if (part.first_triangle != covered || part.triangle_count == 0) {
      return broken_part(i, "it does not begin where the one before ends, or is empty");
    }
    covered += part.triangle_count;
    if (part.name.size() > max_part_name_bytes) return broken_part(i, "its name is too long");
    if (!is_utf8(part.name)) return broken_part(i, "its name is not UTF-8");
    names.emplace_back(part.name);
  }
  if (!mesh.parts.empty() && covered != mesh.size()) {
    return broken("parts", "they do not cover the triangles");
  }
  std::sort(names.begin(), names.end());
  if (std::adjacent_find(names.begin(), names.end()) != names.end()) {
    return broken("parts", "two of them have the same name");
  }
  return Success{};
}

Status check_vertices(const TriangleMesh& mesh) {
  // A float is finite if its exponent is not all ones: the largest magnitude decides for all.
  std::uint32_t largest = 0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    std::array<std::uint32_t, 3> bits;
    std::memcpy(bits.data(), vertex.data(), sizeof bits);
    for (const std::uint32_t b : bits) largest = std::max(largest, b & 0x7fffffffU);
  }
  if (largest >= 0x7f800000U) return broken("vertices", "a coordinate is not a finite number");
  if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
    return broken("vertices", "there are too many");
  }
  return Success{};
}

Status check_properties(const StoredModel& stored) {
  const ShellProperties& mass = stored.mass;
  bool finite = mass.center_m.allFinite() && std::isfinite(mass.volume_m3);
  for (const double value : mass.inertia_per_kg_m2) finite = finite && std::isfinite(value);
  if (!finite || !(mass.area_m2 >= 0.0) || !std::isfinite(mass.area_m2)) {
    return broken("surface properties", "a number is not finite, or the area negative");
  }
  if (Status status = check(stored.transform); !status) {
    return broken("transform", status.error().reason);
  }
  return Success{};
}

/// Where a mesh's outlines can lie: its box, grown by more than a cell of any raster.
struct OutlineBounds {
  double low_x, low_y, low_z, high_x, high_y, high_z;

  explicit OutlineBounds(const Box& box)
      : low_x(static_cast<double>(box.min.x())),
        low_y(static_cast<double>(box.min.y())),
        low_z(static_cast<double>(box.min.z())),
        high_x(static_cast<double>(box.max.x())),
        high_y(static_cast<double>(box.max.y())),
        high_z(static_cast<double>(box.max.z())) {
    const double beside_m = 0.1 + 0.01 * std::max(high_x - low_x, high_y - low_y);
    low_x -= beside_m;
    low_y -= beside_m;
    high_x += beside_m;
    high_y += beside_m;
  }

  bool hold(const OutlinePiece& piece) const {
    const auto x = static_cast<double>(piece.x);
    const auto y = static_cast<double>(piece.y);
    return x >= low_x && x <= high_x && y >= low_y && y <= high_y &&
           std::max(std::abs(x), std::abs(y)) <= max_profile_coordinate_m * 1.01;
  }
  double area_m2() const { return (high_x - low_x) * (high_y - low_y); }
};

bool is_unit(float x, float y) {
  constexpr double rounding = 1e-3;
  const auto p = static_cast<double>(x);
  const auto q = static_cast<double>(y);
  return std::abs(std::sqrt(p * p + q * q) - 1.0) <= rounding;
}

bool lies_in_band(const HeightRange& range, std::size_t band) {
  constexpr double rounding_m = 1e-6;
  return static_cast<double>(range.low_m) >= profile_edges_m[band] - rounding_m &&
         range.low_m <= range.high_m &&
         static_cast<double>(range.high_m) <= profile_edges_m[band + 1] + rounding_m;
}

Status check_bands(const Profile& profile, double most_area_m2) {
  const auto& first = profile.first;
  if (first.front() != 0 || !std::is_sorted(first.begin(), first.end()) ||
      first.back() != profile.pieces.size()) {
    return broken("profile", "its bands do not follow each other or do not share out its pieces");
  }
  for (std::size_t band = 0; band < profile_bands; ++band) {
    if (profile.first_inner[band] < first[band] || profile.first_inner[band] > first[band + 1]) {
      return broken("profile", "its inner outlines do not lie within their bands");
    }
    const auto area = static_cast<double>(profile.area_m2[band]);
    if (!(area >= 0.0 && area <= most_area_m2) || (area > 0.0 && first[band] == first[band + 1])) {
      return broken("profile", "the area of a band is negative, not finite or not within its mesh");
    }
  }
  return Success{};
}

Status check_profile(const Profile& profile, const TriangleMesh& mesh) {
  if (profile.pieces.empty()) {
    const Result<Profile> made = make_profile(mesh);
    if (made && !made->pieces.empty()) return broken("profile", "it has no piece");
    return Success{};
  }
  if (profile.pieces.size() > max_profile_pieces) {
    Error error = broken("profile", "it has more than 2 million pieces");
    error.code = ErrorCode::limit_exceeded;
    return error;
  }
  const OutlineBounds bounds(mesh.bounds());
  // A body that floats stands over a ground that is below it, one that was sunk on its lowest
  // point.
  if (!(profile.ground_m >= std::min(bounds.low_z, 0.0) &&
        profile.ground_m <= std::max(bounds.high_z, 0.0))) {
    return broken("profile", "its ground is not a finite height within its mesh");
  }
  if (Status status = check_bands(profile, bounds.area_m2()); !status) return status;
  std::size_t band = 0;
  for (std::size_t i = 0; i < profile.pieces.size(); ++i) {
    const OutlinePiece& piece = profile.pieces[i];
    while (i >= profile.first[band + 1]) ++band;
    const auto refuse = [&](const char* reason) {
      return broken("outline piece " + std::to_string(i), reason);
    };
    if (!bounds.hold(piece)) return refuse("it does not lie within its mesh");
    if (!is_unit(piece.normal_x, piece.normal_y)) return refuse("its normal is not a unit vector");
    if (!(piece.length_m > 0.0F && static_cast<double>(piece.length_m) <= max_piece_m)) {
      return refuse("its length is not above 0 and at most 1 km");
    }
    if (!lies_in_band(piece.at_edge, band) || !lies_in_band(piece.behind, band) ||
        !lies_in_band(piece.along_x, band) || !lies_in_band(piece.along_y, band)) {
      return refuse("its heights do not lie within its band");
    }
  }
  return Success{};
}

}  // namespace

std::uint32_t checksum_of(View<const unsigned char> bytes, const ModelLayout& layout) {
  return crc32c(bytes.data() + checked_from, layout.section[section_corners].offset - checked_from);
}

Status check_stored(const StoredModel& stored) {
  if (Status status = check_properties(stored); !status) return status;
  if (Status status = check_vertices(stored.model.mesh); !status) return status;
  if (Status status = check_parts(stored.model.mesh); !status) return status;
  if (Status status = check_stated_mass(stored.stated, stored.model.mesh.bounds()); !status) {
    return status;
  }
  if (stored.model.profile == nullptr) return Success{};
  return check_profile(*stored.model.profile, stored.model.mesh);
}

namespace {

template <class T> std::array<T, 3> three(const Eigen::Matrix<T, 3, 1>& v) {
  return {v.x(), v.y(), v.z()};
}

/// The model's profile; made if it has none; null if its mesh has none. Errors: out_of_memory.
Result<std::shared_ptr<const Profile>> profile_of(const Model& model) {
  if (model.profile != nullptr) return model.profile;
  Result<Profile> made = make_profile(model.mesh);
  if (made && !made->pieces.empty()) {
    return std::shared_ptr<const Profile>(std::make_shared<Profile>(std::move(*made)));
  }
  if (made || means_no_profile(made.error())) return std::shared_ptr<const Profile>();
  return made.error();
}

void store(const StatedMass& stated, ModelHeader& header) {
  constexpr double um_per_m = 1e6;
  header.mass_kg = stated.mass_kg.value_or(0.0);
  header.yaw_inertia_kgm2 = stated.yaw_inertia_kgm2.value_or(0.0);
  if (!stated.center_of_mass_m) return;
  header.flags |= flag_center_of_mass_is_stated;
  for (std::size_t i = 0; i < 3; ++i) {
    const double um = um_per_m * (*stated.center_of_mass_m)[static_cast<Eigen::Index>(i)];
    header.center_of_mass_um[i] = static_cast<std::int32_t>(std::lround(um));
  }
}

ModelHeader header_of(const StoredModel& stored, const Profile* profile, std::size_t name_bytes) {
  const Model& model = stored.model;
  ModelHeader header{};
  header.magic = model_magic;
  header.version = model_file_version;
  header.parts = static_cast<std::uint32_t>(model.mesh.parts.size());
  header.name_bytes = static_cast<std::uint32_t>(name_bytes);
  header.vertices = static_cast<std::uint32_t>(model.mesh.vertices.size());
  header.triangles = static_cast<std::uint32_t>(model.mesh.size());
  header.nodes = static_cast<std::uint32_t>(model.tree.nodes.size());
  header.wide_nodes = static_cast<std::uint32_t>(model.wide.nodes.size());
  header.clusters = static_cast<std::uint32_t>(model.wide.clusters.size());
  header.tree_depth = model.tree.depth;
  header.wide_depth = model.wide.depth;
  if (model.tree.axes_are_world) header.flags |= flag_axes_are_world;
  for (int i = 0; i < 9; ++i) {
    header.axes[static_cast<std::size_t>(i)] = model.tree.axes(i % 3, i / 3);
  }
  store(stored.stated, header);
  header.area_m2 = stored.mass.area_m2;
  header.volume_m3 = stored.mass.volume_m3;
  header.center_m = three(stored.mass.center_m);
  header.inertia_per_kg_m2 = stored.mass.inertia_per_kg_m2;
  header.scale = stored.transform.scale;
  header.origin_m = three(stored.transform.origin_m);
  header.up = static_cast<std::uint32_t>(stored.transform.up);
  header.forward = static_cast<std::uint32_t>(stored.transform.forward);
  if (profile != nullptr && !profile->pieces.empty()) {
    header.ground_m = profile->ground_m;
    header.first_piece = profile->first;
    header.first_inner_piece = profile->first_inner;
    header.band_area_m2 = profile->area_m2;
  }
  return header;
}

template <class T>
void put(std::vector<unsigned char>& bytes, const SectionPlace& place, View<const T> items) {
  const auto* const from = reinterpret_cast<const unsigned char*>(items.data());
  std::copy_n(from, place.bytes, bytes.data() + place.offset);
}

Result<std::vector<unsigned char>> encode(const StoredModel& stored) {
  const Model& model = stored.model;
  if (Status status = check_stored(stored); !status) return status.error();
  if (Status status = validate(model); !status) return status.error();

  std::vector<StoredPart> parts;
  std::string names;
  for (const Part& part : model.mesh.parts) {
    parts.push_back({part.triangle_count, static_cast<std::uint32_t>(part.name.size())});
    names += part.name;
  }
  if (names.size() > std::numeric_limits<std::uint32_t>::max()) {
    return make_error(ErrorCode::limit_exceeded, "the names of the parts are too long together");
  }
  const Result<std::shared_ptr<const Profile>> profile = profile_of(model);
  if (!profile) return profile.error();
  ModelHeader header = header_of(stored, profile->get(), names.size());
  const ModelLayout layout = layout_of(header);
  header.file_bytes = layout.end;

  std::vector<unsigned char> bytes(layout.end, 0);
  std::memcpy(bytes.data(), &header, sizeof header);
  const auto& at = layout.section;
  put<StoredPart>(bytes, at[section_parts], parts);
  put<char>(bytes, at[section_names], {names.data(), names.size()});
  put<Eigen::Vector3f>(bytes, at[section_vertices], model.mesh.vertices);
  put<std::array<std::uint32_t, 3>>(bytes, at[section_triangles], model.mesh.triangles);
  put<Node>(bytes, at[section_nodes], model.tree.nodes);
  put<std::uint32_t>(bytes, at[section_order], model.tree.order);
  put<Triangle>(bytes, at[section_corners], model.tree.triangles);
  put<WideNode>(bytes, at[section_wide_nodes], model.wide.nodes);
  put<TriangleCluster>(bytes, at[section_clusters], model.wide.clusters);
  put<WideLanes>(bytes, at[section_lanes], model.wide.lanes_of);
  if (*profile != nullptr) put<OutlinePiece>(bytes, at[section_pieces], (*profile)->pieces);

  const std::uint32_t checksum = checksum_of(bytes, layout);
  std::memcpy(bytes.data() + offsetof(ModelHeader, checksum), &checksum, sizeof checksum);
  return bytes;
}

}  // namespace
}  // namespace detail

Result<std::vector<unsigned char>> encode_model(const StoredModel& stored) {
  return detail::guarded([&] { return detail::encode(stored); });
}

}  // namespace crashrank
