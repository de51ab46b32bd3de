#include "mesh/importer/part_names.hpp"

#include "mesh/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <unordered_map>
#include <unordered_set>

namespace crashrank::importer {
namespace {

// FBX transforms come as chains of nodes, "door_$AssimpFbx$_GeometricScaling" for "door".
std::string without_chain(const std::string& name) {
  return name.substr(0, name.find("_$AssimpFbx$_"));
}

// "nodes[3]", "meshes[0]-1", "3DSMesh_2", "2": how glTF's and 3DS's unnamed things are called.
bool is_indexed(std::string_view name) {
  for (const std::string_view prefix : {"", "nodes[", "meshes[", "materials[", "3DSMesh_"}) {
    if (name.substr(0, prefix.size()) != prefix) continue;
    if (name.find_first_not_of("0123456789]-", prefix.size()) == std::string_view::npos) {
      return true;
    }
  }
  return false;
}

}  // namespace

bool is_generic(std::string_view name) {
  constexpr std::array<std::string_view, 6> made_up{
      "DefaultMaterial", "%%%DEFAULT", "defaultobject", "default", "RootNode", "ROOT"};
  if (name.empty() || std::find(made_up.begin(), made_up.end(), name) != made_up.end()) {
    return true;
  }
  // "<STL_BINARY>", "<OFFRoot>"
  if (name.size() > 2 && name.front() == '<' && name.back() == '>' &&
      std::all_of(name.begin() + 1, name.end() - 1, [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
      })) {
    return true;
  }
  return name.substr(0, 17) == "$ColladaAutoName$" || is_indexed(name);
}

std::vector<std::string> name_parts(const std::vector<PartLabels>& labels,
                                    const std::string& fallback, std::size_t limit) {
  constexpr std::size_t room_for_number = 24;
  std::vector<std::string> names;
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, std::size_t> next_number;
  std::unordered_map<std::string, const PartLabels*> first_bearer;
  const auto take = [&](const std::string& name) {
    if (!taken.insert(name).second) return false;
    names.push_back(name);
    return true;
  };
  for (const PartLabels& label : labels) {
    const std::string node = without_chain(label.node);
    std::string base = fallback;
    for (const std::string* name : {&node, &label.mesh, &label.material}) {
      if (is_generic(*name)) continue;
      base = *name;
      break;
    }
    base = detail::to_utf8(base, limit - room_for_number);
    const PartLabels& first = *first_bearer.try_emplace(base, &label).first->second;
    if (take(base)) continue;
    std::string stem = base;
    for (const auto member : {&PartLabels::material, &PartLabels::mesh}) {
      const std::string& name = label.*member;
      if (is_generic(name) || name == base || name == first.*member) continue;
      stem = detail::to_utf8(std::string(base).append("/").append(name), limit - room_for_number);
      break;
    }
    if (take(stem)) continue;
    std::size_t& number = next_number.try_emplace(stem, 2).first->second;
    while (!take(stem + "." + std::to_string(number++))) {
    }
  }
  return names;
}

}  // namespace crashrank::importer
