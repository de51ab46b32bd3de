#include "crashrank/vehicle/vehicle.hpp"

#include <array>
#include <utility>

namespace crashrank {
namespace {

constexpr std::array<std::pair<Surface, const char*>, 6> surfaces{{
    {Surface::sheet_metal, "sheet-metal"},
    {Surface::steel, "steel"},
    {Surface::concrete, "concrete"},
    {Surface::wood, "wood"},
    {Surface::rubber, "rubber"},
    {Surface::person, "person"},
}};

}  // namespace

const char* surface_name(Surface surface) noexcept {
  for (const auto& [value, name] : surfaces) {
    if (value == surface) return name;
  }
  return surfaces.front().second;
}

Result<Surface> surface_from_name(const std::string& name) {
  std::string known;
  for (const auto& [value, text] : surfaces) {
    if (name == text) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  return make_error(ErrorCode::usage, "'" + name + "' is not a surface", "choose one of " + known);
}

}  // namespace crashrank
