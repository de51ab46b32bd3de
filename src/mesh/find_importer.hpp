#pragma once

#include "crashrank/base/result.hpp"

#include <string>

namespace crashrank::detail {

/// Path of the crashrank-import program: `chosen` if not empty, else the environment's
/// CRASHRANK_IMPORTER, else the first that can be run of: beside the running executable, in the
/// installation of that executable, of the file that contains this library, and of `header` (an
/// absolute path below INCLUDEDIR/crashrank, else ignored), and as configured. Errors: internal.
Result<std::string> find_importer(const std::string& chosen, const std::string& header);

}  // namespace crashrank::detail
