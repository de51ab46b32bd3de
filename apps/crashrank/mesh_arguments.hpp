#pragma once

#include "tree_arguments.hpp"

#include "crashrank/base/result.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/model/model.hpp"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace crashrank::cli {

/// How a command's meshes are to be read, as its options say.
struct MeshArguments {
  std::string suffix;  ///< of the options' names: "-b" for the second of two bodies
  double scale = 1.0;
  std::string up = "+z";
  std::string forward = "+x";
  std::string origin = "0,0,0";
  std::string format;  ///< extension that standard input would have as a file

  /// Adds --scale, --up, --forward, --origin and --format.
  void add_to(CLI::App& command);

  /// Errors: usage.
  Result<ImportTransform> transform() const;
  /// Whether an option asks for other coordinates than the file's.
  bool given() const;
};

/// The same for the second of two bodies: what is not given is as for the first.
struct SecondMeshArguments {
  std::optional<double> scale;
  std::string up;
  std::string forward;

  /// Adds --scale-b, --up-b and --forward-b.
  void add_to(CLI::App& command);

  MeshArguments over(const MeshArguments& first) const;
};

/// Reads one mesh, standard input for "-". Says every warning on stderr when `tell` is set.
/// Errors: usage for options that make no sense together; else as `import_mesh`.
Result<ImportedMesh> load_mesh(const std::string& path, const MeshArguments& arguments, bool tell);

/// What a file turned out to be.
struct MeshOrModel {
  ImportedMesh mesh;                 ///< where it is no model
  std::optional<LoadedModel> model;  ///< with memory of its own
};

/// Reads a mesh, or loads a model file, told by how it begins; either may come on standard input.
/// Errors: usage for a model file together with options that would change its coordinates; else as
/// `import_mesh` and `load_model`.
Result<MeshOrModel> load_mesh_or_model(const std::string& path, const MeshArguments& arguments);

/// A body as a command wants it: from a mesh or from a model file.
struct LoadedBody {
  StoredModel stored;
  double build_s = 0.0;  ///< what building its trees took, 0 for a model file
};

/// Reads a mesh and builds its trees, or loads a model file, told by how it begins. A model file
/// has its frame and trees already: options that would change them are refused (usage). Errors
/// else as `import_mesh`, `make_model` and `load_model`, the file named.
Result<LoadedBody> load_body(const std::string& path, const MeshArguments& arguments,
                             const TreeArguments& trees, bool tell);

/// "-" may stand for one of the inputs only.
Status one_standard_input(const std::vector<std::string>& inputs);

}  // namespace crashrank::cli
