#include "mesh/importer/gltf.hpp"

#include "mesh/importer/gltf_accessors.hpp"
#include "mesh/importer/gltf_nodes.hpp"
#include "mesh/importer/mesh_builder.hpp"
#include "mesh/importer/part_names.hpp"
#include "mesh/text.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace crashrank::importer {
namespace {

using tinygltf::Mesh;
using tinygltf::Model;
using tinygltf::Primitive;

Status check_extensions(const Model& model) {
  constexpr std::array<std::string_view, 5> supported{
      "KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "KHR_draco_mesh_compression",
      "EXT_meshopt_compression", "KHR_node_visibility"};
  constexpr std::array<std::string_view, 11> without_geometry{
      "KHR_materials_", "KHR_texture_",  "KHR_lights_",     "KHR_xmp",
      "KHR_animation_", "EXT_texture_",  "EXT_lights_",     "KHR_technique",
      "MSFT_texture_",  "MSFT_packing_", "ADOBE_materials_"};
  for (const std::string& name : model.extensionsRequired) {
    const auto begins = [&](std::string_view prefix) { return name.rfind(prefix, 0) == 0; };
    if (std::find(supported.begin(), supported.end(), name) != supported.end()) continue;
    if (std::any_of(without_geometry.begin(), without_geometry.end(), begins)) continue;
    Error error = gltf_error("extensionsRequired",
                             "the extension " + detail::quoted(name, 100) + " is not supported");
    error.remedy = "export the file without it";
    return error;
  }
  return Success{};
}

bool is_surface(const Primitive& primitive) {
  return primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
}

/// Positions of a primitive's vertices in the node, or in the file where it has a skin.
class Positions {
public:
  Positions(const GltfFile& file, const GltfNodes& nodes, GltfAccessors& accessors)
      : file_(file), nodes_(nodes), accessors_(accessors) {}

  Status read(const tinygltf::Node& node, const Mesh& mesh, const Primitive& primitive) {
    const Result<GltfElements> base =
        accessors_.attribute(primitive, "POSITION", TINYGLTF_TYPE_VEC3);
    if (!base) return base.error();
    base_ = *base;
    if (Status read = read_morphs(node, mesh, primitive); !read) return read;
    joints_.clear();
    return node.skin < 0 ? Status(Success{}) : read_skin(node.skin, primitive);
  }

  std::size_t count() const { return base_.count; }
  bool skinned() const { return !joints_.empty(); }

  Eigen::Vector3d at(std::size_t vertex) const {
    Eigen::Vector3d position = base_.vector(vertex);
    for (const auto& [weight, offsets] : morphs_) position += weight * offsets.vector(vertex);
    return skinned() ? skin_transform(vertex)(position) : position;
  }

  /// Whether the skin turns the surface over, judged by its first vertex.
  bool skin_mirrors() const { return skin_transform(0).mirrors(); }

private:
  Status read_morphs(const tinygltf::Node& node, const Mesh& mesh, const Primitive& primitive) {
    morphs_.clear();
    const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
    for (std::size_t i = 0; i < std::min(weights.size(), primitive.targets.size()); ++i) {
      const auto offsets = primitive.targets[i].find("POSITION");
      if (weights[i] == 0.0 || offsets == primitive.targets[i].end()) continue;
      const Result<GltfElements> found = accessors_.elements(offsets->second, TINYGLTF_TYPE_VEC3);
      if (!found) return found.error();
      if (found->count != base_.count) {
        return gltf_error("morph target " + std::to_string(i),
                          "it has another number of vertices than its primitive");
      }
      morphs_.emplace_back(weights[i], *found);
    }
    return Success{};
  }

  Status read_skin(int number, const Primitive& primitive) {
    const std::string place = "skin " + std::to_string(number);
    if (static_cast<std::size_t>(number) >= file_.model.skins.size()) {
      return gltf_error(place, "there is none of that number");
    }
    const tinygltf::Skin& skin = file_.model.skins[static_cast<std::size_t>(number)];
    GltfElements inverse;
    if (skin.inverseBindMatrices >= 0) {
      const Result<GltfElements> found =
          accessors_.elements(skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4);
      if (!found) return found.error();
      inverse = *found;
      if (inverse.count < skin.joints.size()) {
        return gltf_error(place, "it has fewer inverse bind matrices than joints");
      }
    }
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      const int joint = skin.joints[i];
      if (joint < 0 || static_cast<std::size_t>(joint) >= nodes_.to_file.size()) {
        return gltf_error(place, "it names a joint that is not there");
      }
      Affine bind;
      for (Eigen::Index k = 0; k < 3 && inverse.count > 0; ++k) {
        const auto row = static_cast<std::size_t>(k);
        for (Eigen::Index c = 0; c < 3; ++c) {
          bind.linear(k, c) = inverse.value(i, 4 * static_cast<std::size_t>(c) + row);
        }
        bind.translation[k] = inverse.value(i, 12 + row);
      }
      joints_.push_back(compose(nodes_.to_file[static_cast<std::size_t>(joint)], bind));
    }
    return read_influences(place, primitive);
  }

  /// JOINTS_0 and WEIGHTS_0, and further sets of four.
  Status read_influences(const std::string& place, const Primitive& primitive) {
    influences_.clear();
    for (std::size_t set = 0;; ++set) {
      const std::string joints = "JOINTS_" + std::to_string(set);
      const std::string weights = "WEIGHTS_" + std::to_string(set);
      if (primitive.attributes.count(joints) == 0 || primitive.attributes.count(weights) == 0) {
        break;
      }
      const Result<GltfElements> numbers =
          accessors_.attribute(primitive, joints, TINYGLTF_TYPE_VEC4);
      if (!numbers) return numbers.error();
      const Result<GltfElements> shares =
          accessors_.attribute(primitive, weights, TINYGLTF_TYPE_VEC4);
      if (!shares) return shares.error();
      if (numbers->count != base_.count || shares->count != base_.count) {
        return gltf_error(place, "joints, weights and vertices differ in number");
      }
      for (std::size_t vertex = 0; vertex < base_.count; ++vertex) {
        for (std::size_t k = 0; k < 4; ++k) {
          const double joint = numbers->value(vertex, k);
          if (!(joint >= 0.0 && joint < static_cast<double>(joints_.size()))) {
            return gltf_error(
                place, "vertex " + std::to_string(vertex) + " names a joint that it does not have");
          }
        }
      }
      influences_.emplace_back(*numbers, *shares);
    }
    if (influences_.empty()) return gltf_error(place, "its primitive has no joints and weights");
    return Success{};
  }

  Affine skin_transform(std::size_t vertex) const {
    Affine sum{Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
    double whole = 0.0;
    for (const auto& [numbers, shares] : influences_) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double share = shares.value(vertex, k);
        const Affine& joint = joints_[static_cast<std::size_t>(numbers.value(vertex, k))];
        sum.linear += share * joint.linear;
        sum.translation += share * joint.translation;
        whole += share;
      }
    }
    // Weights add up to 1 but for rounding; those of vertices without any add up to 0.
    if (whole > 0.0) {
      sum.linear /= whole;
      sum.translation /= whole;
    }
    return sum;
  }

  const GltfFile& file_;
  const GltfNodes& nodes_;
  GltfAccessors& accessors_;
  GltfElements base_;
  std::vector<std::pair<double, GltfElements>> morphs_;
  std::vector<Affine> joints_;  // from the skin's rest to the file; empty without a skin
  std::vector<std::pair<GltfElements, GltfElements>> influences_;  // joints and weights
};

/// Corners of the triangles of a primitive, turned as the format states.
class Corners {
public:
  /// Without indices (`count` 0) the vertices are taken in their order.
  Corners(int mode, const GltfElements& indices, std::size_t vertices)
      : mode_(mode),
        indices_(indices),
        count_(indices.count > 0 ? indices.count : vertices),
        vertices_(vertices) {}

  std::size_t triangles() const {
    if (mode_ == TINYGLTF_MODE_TRIANGLES) return count_ / 3;
    return count_ < 3 ? 0 : count_ - 2;
  }

  /// False where one of them is no vertex.
  bool at(std::size_t triangle, std::array<std::uint32_t, 3>& corners) const {
    std::array<std::size_t, 3> places{3 * triangle, 3 * triangle + 1, 3 * triangle + 2};
    if (mode_ == TINYGLTF_MODE_TRIANGLE_STRIP) {
      const std::size_t odd = triangle % 2;
      places = {triangle + odd, triangle + 1 - odd, triangle + 2};
    }
    if (mode_ == TINYGLTF_MODE_TRIANGLE_FAN) places = {0, triangle + 1, triangle + 2};
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] =
          indices_.count > 0 ? indices_.index(places[c]) : static_cast<std::uint32_t>(places[c]);
      if (corners[c] >= vertices_) return false;
    }
    return true;
  }

private:
  int mode_;
  GltfElements indices_;
  std::size_t count_;
  std::size_t vertices_;
};

class GltfReader {
public:
  GltfReader(const GltfFile& file, const GltfNodes& nodes, GltfAccessors& accessors,
             const Request& request)
      : file_(file),
        nodes_(nodes),
        accessors_(accessors),
        request_(request),
        builder_(request, 1.0) {}

  Result<Parsed> read(const std::string& file_name) {
    const std::vector<std::string> names = part_names(file_name);
    if (names.size() > request_.parts) return too_many();
    Positions positions(file_, nodes_, accessors_);
    auto name = names.begin();
    for (const GltfVisit& visit : nodes_.visits) {
      for (const Primitive& primitive : mesh_of(visit).primitives) {
        if (!is_surface(primitive)) continue;
        if (const Status added = add(visit, primitive, *name++, positions); !added) {
          return added.error();
        }
      }
    }
    Parsed parsed{builder_.take(), dropped_, {}};
    return parsed;
  }

private:
  const tinygltf::Node& node_of(const GltfVisit& visit) const {
    return file_.model.nodes[static_cast<std::size_t>(visit.node)];
  }
  const Mesh& mesh_of(const GltfVisit& visit) const {
    return file_.model.meshes[static_cast<std::size_t>(node_of(visit).mesh)];
  }

  Error too_many() const {
    return make_error(ErrorCode::limit_exceeded,
                      "more than " + std::to_string(request_.triangles) + " triangles or " +
                          std::to_string(request_.parts) + " parts",
                      "simplify the mesh or raise the limit");
  }

  std::vector<std::string> part_names(const std::string& file_name) const {
    std::vector<PartLabels> labels;
    for (const GltfVisit& visit : nodes_.visits) {
      const Mesh& mesh = mesh_of(visit);
      for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
        if (!is_surface(mesh.primitives[p])) continue;
        const auto material = static_cast<std::size_t>(mesh.primitives[p].material);
        std::string mesh_name = mesh.name;
        if (!mesh_name.empty() && mesh.primitives.size() > 1)
          mesh_name.append(1, '-').append(std::to_string(p));
        labels.push_back({node_of(visit).name, std::move(mesh_name),
                          material < file_.model.materials.size()
                              ? file_.model.materials[material].name
                              : std::string()});
        if (labels.size() > request_.parts) break;
      }
    }
    return name_parts(labels, file_name.substr(0, file_name.find_last_of('.')),
                      request_.name_bytes);
  }

  Status add(const GltfVisit& visit, const Primitive& primitive, const std::string& name,
             Positions& positions) {
    Result<GltfElements> indices = accessors_.draco_faces(primitive);
    const bool faces = indices && indices->begin != nullptr;
    if (indices && !faces && primitive.indices >= 0) {
      indices = accessors_.indices(primitive.indices);
    }
    Status read = indices ? positions.read(node_of(visit), mesh_of(visit), primitive)
                          : Status(indices.error());
    if (!read) {
      Error error = read.error();
      error.place = "part '" + name + "'" + (error.place.empty() ? "" : ", " + error.place);
      return error;
    }
    const Corners corners(faces ? TINYGLTF_MODE_TRIANGLES : primitive.mode, *indices,
                          positions.count());
    triangles_ += corners.triangles();
    if (triangles_ > request_.triangles) return too_many();
    const auto position = [&](std::uint32_t vertex) {
      const Eigen::Vector3d at = positions.at(vertex);
      return positions.skinned() ? at : visit.to_file(at);
    };
    // A skin's vertices hang on its joints alone, not on the node.
    const bool mirrored = positions.skinned() ? positions.skin_mirrors() : visit.to_file.mirrors();
    builder_.begin_part(name, positions.count(), mirrored);
    for (std::size_t t = 0; t < corners.triangles(); ++t) {
      std::array<std::uint32_t, 3> triangle{};
      if (corners.at(t, triangle)) {
        builder_.add(triangle, position);
      } else {
        ++dropped_;
      }
    }
    return builder_.end_part();
  }

  const GltfFile& file_;
  const GltfNodes& nodes_;
  GltfAccessors& accessors_;
  const Request& request_;
  MeshBuilder builder_;
  std::size_t triangles_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace

Result<std::optional<Parsed>> parse_gltf(const Request& request, std::size_t skip,
                                         FolderIo& files) {
  const Result<GltfFile> file = read_gltf_file(request, skip, files);
  if (!file) return file.error();
  if (file->version_1) return std::optional<Parsed>{};
  if (const Status known = check_extensions(file->model); !known) return known.error();
  GltfAccessors accessors(*file, request);
  const Result<GltfNodes> nodes = walk_gltf_nodes(file->model, accessors, request);
  if (!nodes) return nodes.error();
  Result<Parsed> parsed = GltfReader(*file, *nodes, accessors, request).read(files.mesh_name());
  if (!parsed) return parsed.error();
  return std::optional<Parsed>(std::move(*parsed));
}

}  // namespace crashrank::importer
