#include "crashrank/base/version.hpp"

namespace crashrank {

const char* library_version() noexcept { return CRASHRANK_VERSION_STRING; }

}  // namespace crashrank
