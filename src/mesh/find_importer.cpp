#include "mesh/find_importer.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace crashrank::detail {
namespace {

constexpr const char* program = "crashrank-import";

bool runnable(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

Result<std::string> insist(const std::string& path, const std::string& named_by) {
  if (runnable(path)) return path;
  return make_error(ErrorCode::internal,
                    "the importer '" + path + "', named by " + named_by + ", cannot be run",
                    "name the crashrank-import program");
}

}  // namespace

Result<std::string> find_importer(const std::string& chosen, const std::string& of_package) {
  if (!chosen.empty()) return insist(chosen, "the caller");
  // A program with raised privileges must not let its caller choose what it runs.
  const char* from_environment = ::secure_getenv("CRASHRANK_IMPORTER");
  if (from_environment != nullptr && *from_environment != '\0') {
    return insist(from_environment, "CRASHRANK_IMPORTER");
  }
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    for (const char* place : {".", CRASHRANK_IMPORTER_FROM_BINDIR}) {
      const std::string path = (self.parent_path() / place / program).lexically_normal().string();
      if (runnable(path)) return path;
    }
  }
  if (runnable(of_package)) return of_package;
  std::string installed = std::string(CRASHRANK_IMPORTER_DIR) + "/" + program;
  if (runnable(installed)) return installed;
  return make_error(ErrorCode::internal,
                    "the program crashrank-import is neither beside this program nor installed",
                    "install it, or name it in the environment variable CRASHRANK_IMPORTER");
}

}  // namespace crashrank::detail
