#pragma once

#include "crashrank/base/result.hpp"

#include <string>

namespace crashrank::detail {

/// Path of the crashrank-import program: `chosen` if not empty, else the environment's
/// CRASHRANK_IMPORTER, else the one beside the running executable, else the one of the installation
/// that the executable belongs to, else `of_package`, else the installed one. Errors: internal.
Result<std::string> find_importer(const std::string& chosen, const std::string& of_package);

}  // namespace crashrank::detail
