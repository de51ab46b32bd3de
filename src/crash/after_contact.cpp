#include "crashrank/crash/contact_law.hpp"

#include <array>

namespace crashrank {
namespace {

constexpr std::array<const char*, 3> after_names{"brakes", "releases", "locks"};

}  // namespace

const char* after_contact_name(AfterContact after) noexcept {
  return after_names[static_cast<std::size_t>(after)];
}

Result<AfterContact> after_contact_from_name(const std::string& name) {
  for (std::size_t i = 0; i < after_names.size(); ++i) {
    if (name == after_names[i]) return static_cast<AfterContact>(i);
  }
  return make_error(ErrorCode::usage, "\"" + name + "\" is no state of the wheels after a contact",
                    "choose one of brakes, releases, locks");
}

}  // namespace crashrank
