#include "scenario_file.hpp"

#include "streams.hpp"

#include <cstddef>
#include <filesystem>
#include <system_error>

namespace crashrank::cli {

std::string shown_name(const std::string& scenario) {
  return is_standard(scenario) ? "standard input" : scenario;
}

Error name_allow(Error error) {
  const std::string call = "allow its folder when calling";
  const std::size_t at = error.remedy.find(call);
  if (at != std::string::npos) {
    error.remedy.replace(at, call.size(), "allow its folder with --allow FOLDER");
  }
  return error;
}

void add_allowed_folders(CLI::App& command, std::vector<std::string>& folders) {
  const CLI::Validator folder(
      [](const std::string& text) {
        std::error_code ignored;
        return std::filesystem::is_directory(text, ignored)
                   ? std::string()
                   : "'" + text + "' is no folder: name one that is there";
      },
      "", "folder");
  command
      .add_option("--allow", folders,
                  "Another folder that meshes may be read from; may be repeated")
      ->check(folder)
      ->type_name("FOLDER")
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace crashrank::cli
