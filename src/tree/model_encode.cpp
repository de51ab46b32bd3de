#include "base/crc32c.hpp"
#include "base/utf8.hpp"
#include "crashrank/base/guarded.hpp"
#include "crashrank/tree/validate_wide.hpp"
#include "tree/model_layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
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

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const CodePoint point = decode_utf8(text);
    if (!point.valid) return false;
    text.remove_prefix(point.bytes);
  }
  return true;
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
  // A float is finite when its exponent is not all ones: the largest of all magnitudes tells.
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
  if (!finite || !(mass.mass_kg >= 0.0) || !std::isfinite(mass.mass_kg) || !(mass.area_m2 >= 0.0) ||
      !std::isfinite(mass.area_m2)) {
    return broken("mass properties", "a number is not finite, or a mass or area negative");
  }
  if (Status status = check(stored.transform); !status) {
    return broken("transform", status.error().reason);
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
  return check_parts(stored.model.mesh);
}

namespace {

template <class T> std::array<T, 3> three(const Eigen::Matrix<T, 3, 1>& v) {
  return {v.x(), v.y(), v.z()};
}

ModelHeader header_of(const StoredModel& stored, std::size_t name_bytes) {
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
  header.axes_are_world = model.tree.axes_are_world ? 1 : 0;
  for (int i = 0; i < 9; ++i) {
    header.axes[static_cast<std::size_t>(i)] = model.tree.axes(i % 3, i / 3);
  }
  header.mass_kg = stored.mass.mass_kg;
  header.area_m2 = stored.mass.area_m2;
  header.volume_m3 = stored.mass.volume_m3;
  header.center_m = three(stored.mass.center_m);
  header.inertia_per_kg_m2 = stored.mass.inertia_per_kg_m2;
  header.scale = stored.transform.scale;
  header.origin_m = three(stored.transform.origin_m);
  header.up = static_cast<std::uint32_t>(stored.transform.up);
  header.forward = static_cast<std::uint32_t>(stored.transform.forward);
  return header;
}

template <class T>
void put(std::vector<unsigned char>& bytes, const SectionPlace& place, View<const T> items) {
  if (place.bytes != 0) std::memcpy(bytes.data() + place.offset, items.data(), place.bytes);
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
  ModelHeader header = header_of(stored, names.size());
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
