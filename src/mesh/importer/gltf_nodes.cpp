#include "mesh/importer/gltf_nodes.hpp"

#include "mesh/text.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <string>
#include <utility>

namespace crashrank::importer {
namespace {

using tinygltf::Model;
using tinygltf::Node;

std::string name_of(const Model& model, int node) {
  const std::string& name = model.nodes[static_cast<std::size_t>(node)].name;
  std::string text = "node " + std::to_string(node);
  if (!name.empty()) text.append(1, ' ').append(detail::quoted(name, 100));
  return text;
}

Affine from_parts(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation,
                  const Eigen::Vector3d& scale) {
  Affine affine;
  // The format wants a unit quaternion; those that files hold are rounded.
  affine.linear = rotation.normalized().toRotationMatrix() * scale.asDiagonal();
  affine.translation = translation;
  return affine;
}

Result<Affine> local_transform(const Model& model, int number) {
  const Node& node = model.nodes[static_cast<std::size_t>(number)];
  const auto length = [](const std::vector<double>& values, std::size_t wanted) {
    return values.empty() || values.size() == wanted;
  };
  if (!length(node.matrix, 16) || !length(node.translation, 3) || !length(node.rotation, 4) ||
      !length(node.scale, 3)) {
    return gltf_error(name_of(model, number), "its transform has too few or too many numbers");
  }
  Affine affine;
  if (!node.matrix.empty()) {
    const Eigen::Map<const Eigen::Matrix4d> matrix(node.matrix.data());
    if (matrix(3, 0) != 0.0 || matrix(3, 1) != 0.0 || matrix(3, 2) != 0.0 || matrix(3, 3) != 1.0) {
      return gltf_error(name_of(model, number), "its transform is not finite and affine");
    }
    affine.linear = matrix.topLeftCorner<3, 3>();
    affine.translation = matrix.topRightCorner<3, 1>();
    return affine;
  }
  const auto vector = [](const std::vector<double>& values, double otherwise) {
    return values.empty() ? Eigen::Vector3d::Constant(otherwise).eval()
                          : Eigen::Vector3d(values[0], values[1], values[2]);
  };
  const std::vector<double>& q = node.rotation;
  const Eigen::Quaterniond rotation =
      q.empty() ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  return from_parts(vector(node.translation, 0.0), rotation, vector(node.scale, 1.0));
}

/// The parent of each node, −1 for those without. Errors where a node has two.
Result<std::vector<int>> parents_of(const Model& model) {
  std::vector<int> parents(model.nodes.size(), -1);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const auto number = static_cast<int>(i);
    for (const int child : model.nodes[i].children) {
      if (child < 0 || static_cast<std::size_t>(child) >= model.nodes.size()) {
        return gltf_error(name_of(model, number), "it names a child that is not there");
      }
      int& parent = parents[static_cast<std::size_t>(child)];
      if (child == number || parent == number) {
        return gltf_error(name_of(model, number),
                          "the nodes are recursive: it names a child twice "
                          "or itself");
      }
      if (parent >= 0) {
        return gltf_error(name_of(model, child),
                          "the nodes are no tree: " + name_of(model, parent) + " and " +
                              name_of(model, number) + " have it as child");
      }
      parent = number;
    }
  }
  return parents;
}

Result<std::vector<int>> roots_of(const Model& model, const std::vector<int>& parents) {
  std::vector<int> roots;
  if (model.scenes.empty()) {
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] < 0) roots.push_back(static_cast<int>(i));
    }
    return roots;
  }
  const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
  if (static_cast<std::size_t>(scene) >= model.scenes.size()) {
    return gltf_error("scene " + std::to_string(scene), "there is none of that number");
  }
  std::vector<bool> seen(parents.size(), false);
  for (const int root : model.scenes[static_cast<std::size_t>(scene)].nodes) {
    const auto index = static_cast<std::size_t>(root);
    if (root < 0 || index >= parents.size() || seen[index]) {
      return gltf_error(
          "scene " + std::to_string(scene),
          "it names node " + std::to_string(root) + ", which is not there or named twice");
    }
    if (parents[index] >= 0) {
      return gltf_error("scene " + std::to_string(scene),
                        "it names " + name_of(model, root) +
                            " as a root: the nodes are recursive, or it is a child of another");
    }
    seen[index] = true;
    roots.push_back(root);
  }
  return roots;
}

bool is_hidden(const Node& node) {
  const tinygltf::Value* const visibility = gltf_extension(node.extensions, "KHR_node_visibility");
  return visibility != nullptr && visibility->Has("visible") &&
         visibility->Get("visible").IsBool() && !visibility->Get("visible").Get<bool>();
}

/// The transforms of a node's instances relative to the node, where it has the extension.
class Instances {
public:
  Instances(const tinygltf::Value& attributes, GltfAccessors& accessors)
      : attributes_(attributes), accessors_(accessors) {}

  Result<std::vector<Affine>> read(std::size_t most) {
    const Result<GltfElements> translation = attribute("TRANSLATION", TINYGLTF_TYPE_VEC3);
    if (!translation) return translation.error();
    const Result<GltfElements> rotation = attribute("ROTATION", TINYGLTF_TYPE_VEC4);
    if (!rotation) return rotation.error();
    const Result<GltfElements> scale = attribute("SCALE", TINYGLTF_TYPE_VEC3);
    if (!scale) return scale.error();
    std::size_t count = 0;
    for (const GltfElements* elements : {&*translation, &*rotation, &*scale}) {
      if (elements->count > 0 && count > 0 && elements->count != count) {
        return gltf_error("EXT_mesh_gpu_instancing", "its attributes differ in length");
      }
      if (elements->count > 0) count = elements->count;
    }
    if (count > most) {
      return make_error(ErrorCode::limit_exceeded,
                        std::to_string(count) + " instances of one node, more than " +
                            std::to_string(most) + " parts",
                        "simplify the mesh or raise the limit");
    }
    std::vector<Affine> instances;
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
      if (rotation->count > 0) {
        turn = Eigen::Quaterniond(rotation->value(i, 3), rotation->value(i, 0),
                                  rotation->value(i, 1), rotation->value(i, 2));
      }
      instances.push_back(from_parts(
          translation->count > 0 ? translation->vector(i) : Eigen::Vector3d::Zero().eval(), turn,
          scale->count > 0 ? scale->vector(i) : Eigen::Vector3d::Ones().eval()));
    }
    return instances;
  }

private:
  Result<GltfElements> attribute(const char* name, int type) {
    if (!attributes_.Has(name)) return GltfElements{};
    return accessors_.elements(static_cast<int>(gltf_number(attributes_, name, 0x7fffffff)), type);
  }

  const tinygltf::Value& attributes_;
  GltfAccessors& accessors_;
};

Result<std::vector<Affine>> instances_of(const Model& model, int number, GltfAccessors& accessors,
                                         std::size_t most) {
  const Node& node = model.nodes[static_cast<std::size_t>(number)];
  const tinygltf::Value* const extension =
      gltf_extension(node.extensions, "EXT_mesh_gpu_instancing");
  if (extension == nullptr) return std::vector<Affine>{Affine{}};
  if (!extension->Has("attributes") || !extension->Get("attributes").IsObject()) {
    return gltf_error(name_of(model, number), "EXT_mesh_gpu_instancing: it has no attributes");
  }
  return Instances(extension->Get("attributes"), accessors).read(most);
}

}  // namespace

Result<GltfNodes> walk_gltf_nodes(const Model& model, GltfAccessors& accessors,
                                  const Request& request) {
  const Result<std::vector<int>> parents = parents_of(model);
  if (!parents) return parents.error();
  const Result<std::vector<int>> roots = roots_of(model, *parents);
  if (!roots) return roots.error();
  struct Open {
    int node;
    int parent;
    bool shown;
  };
  std::vector<Open> open;
  const auto push = [&](const std::vector<int>& nodes, int parent, bool shown) {
    for (std::size_t i = nodes.size(); i-- > 0;) open.push_back({nodes[i], parent, shown});
  };
  // Joints of skins may stand in other scenes, or be hidden: they are walked after the scene.
  std::vector<int> others;
  for (std::size_t i = 0; i < parents->size(); ++i) {
    if ((*parents)[i] < 0) others.push_back(static_cast<int>(i));
  }
  push(others, -1, false);
  push(*roots, -1, true);
  GltfNodes nodes;
  nodes.to_file.resize(model.nodes.size());
  std::vector<bool> seen(model.nodes.size(), false);
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const auto index = static_cast<std::size_t>(next.node);
    if (seen[index]) continue;
    seen[index] = true;
    const Node& node = model.nodes[index];
    const Result<Affine> local = local_transform(model, next.node);
    if (!local) return local.error();
    const Affine here = next.parent < 0
                            ? *local
                            : compose(nodes.to_file[static_cast<std::size_t>(next.parent)], *local);
    if (!here.finite()) {
      return gltf_error(name_of(model, next.node), "its transform is not finite and affine");
    }
    nodes.to_file[index] = here;
    const bool shown = next.shown && !is_hidden(node);
    push(node.children, next.node, shown);
    if (!shown || node.mesh < 0) continue;
    if (static_cast<std::size_t>(node.mesh) >= model.meshes.size()) {
      return gltf_error(name_of(model, next.node), "it names a mesh that is not there");
    }
    const Result<std::vector<Affine>> instances =
        instances_of(model, next.node, accessors, request.parts - nodes.visits.size());
    if (!instances) return instances.error();
    for (const Affine& instance : *instances) {
      nodes.visits.push_back({next.node, compose(here, instance)});
    }
    if (nodes.visits.size() > request.parts) {
      return make_error(ErrorCode::limit_exceeded,
                        "more than " + std::to_string(request.parts) + " parts",
                        "simplify the mesh or raise the limit");
    }
  }
  return nodes;
}

}  // namespace crashrank::importer
