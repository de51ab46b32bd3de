#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"

#include <string>

namespace crashrank {

/// Outer material of a body. Selects the friction of a contact, together with that of the body it
/// touches.
enum class Surface {
  sheet_metal,  ///< painted panels of a vehicle
  steel,        ///< guard rails, steel poles, machinery
  concrete,     ///< walls, barriers, masonry
  wood,         ///< trees, timber posts, fences
  rubber,       ///< tyres, crash cushions
  person,       ///< clothing and skin
};

/// "sheet-metal", "steel", "concrete", "wood", "rubber", "person", as in scenario files.
CRASHRANK_API const char* surface_name(Surface surface) noexcept;

/// Inverse of `surface_name`. Errors: usage; the remedy lists the names.
CRASHRANK_API Result<Surface> surface_from_name(const std::string& name);

}  // namespace crashrank
