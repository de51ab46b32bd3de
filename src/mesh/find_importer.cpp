#include "mesh/find_importer.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

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

/// The folder of the executable or shared library that contains this function; empty if unknown.
std::filesystem::path folder_of_this_library() {
  Dl_info where{};
  if (::dladdr(reinterpret_cast<const void*>(&runnable), &where) == 0) return {};
  const std::filesystem::path file = where.dli_fname == nullptr ? "" : where.dli_fname;
  return file.is_absolute() ? file.parent_path() : std::filesystem::path();
}

/// INCLUDEDIR of a header INCLUDEDIR/crashrank/...; empty unless absolute: a relative path would
/// let the working directory choose the program.
std::filesystem::path include_folder_of(const std::string& header) {
  const std::size_t end = header.rfind("/crashrank/");
  if (end == std::string::npos || header.front() != '/') return {};
  return header.substr(0, end);
}

}  // namespace

Result<std::string> find_importer(const std::string& chosen, const std::string& header) {
  if (!chosen.empty()) return insist(chosen, "the caller");
  // A program with raised privileges must not let its caller choose what it runs.
  const char* from_environment = ::secure_getenv("CRASHRANK_IMPORTER");
  if (from_environment != nullptr && *from_environment != '\0') {
    return insist(from_environment, "CRASHRANK_IMPORTER");
  }
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  // Each found by what moves together with the importer: programs, a shared library, and for
  // programs elsewhere that link a static one, the headers.
  const std::pair<std::filesystem::path, const char*> places[] = {
      {self.parent_path(), "."},
      {self.parent_path(), CRASHRANK_IMPORTER_FROM_BINDIR},
      {folder_of_this_library(), CRASHRANK_IMPORTER_FROM_LIBDIR},
      {include_folder_of(header), CRASHRANK_IMPORTER_FROM_INCLUDEDIR},
      {CRASHRANK_IMPORTER_DIR, "."},
  };
  for (const auto& [folder, from_there] : places) {
    if (folder.empty()) continue;
    const std::string path = (folder / from_there / program).lexically_normal().string();
    if (runnable(path)) return path;
  }
  return make_error(ErrorCode::internal,
                    "the program crashrank-import is neither beside this program nor installed",
                    "install it, or name it in the environment variable CRASHRANK_IMPORTER");
}

}  // namespace crashrank::detail
