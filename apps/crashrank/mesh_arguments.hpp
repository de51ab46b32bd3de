#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/import.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace crashrank::cli {

/// How a command's meshes are to be read, as its options say.
struct MeshArguments {
  double scale = 1.0;
  std::string up = "+z";
  std::string forward = "+x";
  std::string origin = "0,0,0";
  std::string format;  ///< extension that standard input would have as a file

  /// Adds --scale, --up, --forward, --origin and --format.
  void add_to(CLI::App& command);

  /// Errors: usage.
  Result<ImportTransform> transform() const;
};

/// Reads one mesh, standard input for "-". Says every warning on stderr when `tell` is set.
/// Errors: usage for options that make no sense together; else as `import_mesh`.
Result<ImportedMesh> load_mesh(const std::string& path, const MeshArguments& arguments, bool tell);

/// "-" may stand for one of the inputs only.
Status one_standard_input(const std::vector<std::string>& inputs);

}  // namespace crashrank::cli
