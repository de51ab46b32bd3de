#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace crashrank::importer {

/// What a file calls one part.
struct PartLabels {
  std::string node;
  std::string mesh;
  std::string material;
};

/// Whether a parser made the name up, or it says nothing.
bool is_generic(std::string_view name);

/// One unique name for each part, in valid UTF-8 of at most `limit` bytes: the node's name, else
/// the mesh's, else the material's, else `fallback`. The first to bear a name keeps it; the others
/// add what sets them apart from it, "body/glass" for another material or mesh, and a number,
/// "wheel.2", where nothing does.
std::vector<std::string> name_parts(const std::vector<PartLabels>& labels,
                                    const std::string& fallback, std::size_t limit);

}  // namespace crashrank::importer
