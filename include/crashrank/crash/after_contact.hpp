#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/internal/base/export.hpp"

#include <string>

namespace crashrank {

/// What the wheels of a vehicle do once something has hit it.
enum class AfterContact {
  brakes,    ///< all undamaged wheels brake with one share of their grip, and steer as before
  releases,  ///< undamaged wheels roll freely, and steer as before
  locks,     ///< no wheel turns
};

/// The name in files: "brakes", "releases", "locks".
CRASHRANK_API const char* after_contact_name(AfterContact after) noexcept;
/// Reads a name; the error (usage) lists those there are.
CRASHRANK_API Result<AfterContact> after_contact_from_name(const std::string& name);

}  // namespace crashrank
