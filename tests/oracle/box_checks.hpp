#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace oracle {

struct BoxCheckOptions {
  std::uint64_t tests = 2000;  ///< configurations of each kind
  std::uint64_t seed = 1;
};

/// One kind of configuration: how many there were and how many the box test got wrong.
struct BoxCheck {
  const char* what = "";
  std::uint64_t tests = 0;
  std::uint64_t wrong = 0;
};

/// Two kinds of contact that must not be separated, six separations that must be seen.
inline constexpr std::size_t box_check_count = 8;

}  // namespace oracle
