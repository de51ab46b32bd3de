#pragma once

#include <cstdint>
#include <cstdlib>

namespace crashrank::test {

/// A count or seed for a campaign, from an environment variable; `otherwise` where it is not set.
inline std::uint64_t wished(const char* variable, std::uint64_t otherwise) {
  const char* const wish = std::getenv(variable);
  return wish != nullptr ? std::strtoull(wish, nullptr, 10) : otherwise;
}

}  // namespace crashrank::test
