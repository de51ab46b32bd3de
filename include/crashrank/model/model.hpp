#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/internal/tree/wide_tree.hpp"
#include "crashrank/mesh/profile.hpp"
#include "crashrank/mesh/properties.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crashrank {

/// A body ready for collision: its surface and the trees over it. Prepared once, read by any number
/// of threads.
struct Model {
  TriangleMesh mesh;   ///< its surface
  AabbTree tree;       ///< the binary tree over it
  WideTree wide = {};  ///< what the vector engine reads; empty where only the scalar one can serve
  /// Its outlines, which crash simulations read; null: `rank` makes them when it needs them. Model
  /// files hold them.
  std::shared_ptr<const Profile> profile = nullptr;
};

/// Mass properties that a model file states. Absent ones are derived, see `describe_vehicle`.
struct StatedMass {
  std::optional<double> mass_kg;                    ///< with all aboard, > 0
  std::optional<Eigen::Vector3d> center_of_mass_m;  ///< body coordinates, m
  /// About the vertical axis through the centre of mass, kg·m².
  std::optional<double> yaw_inertia_kgm2;
};

/// Checks that a yaw inertia is at least 1 % of that of an even block over the body's bounds and at
/// most that of a ring: all mass at the ends of their diagonal. `extent_m` is length, width,
/// height. Errors: bad_input; the place is "yaw inertia".
CRASHRANK_API Status check_yaw_inertia(double yaw_inertia_kgm2, double mass_kg,
                                       const Eigen::Vector3d& extent_m);

/// Checks the stated mass properties of a body with these bounds: a finite mass above 0; a centre
/// of mass within the bounds, to 1 µm, and at most 2 km from the origin each way; a finite yaw
/// inertia above 0, and as `check_yaw_inertia` where a mass is stated. Errors: bad_input; the place
/// is "mass", "centre of mass" or "yaw inertia".
CRASHRANK_API Status check_stated_mass(const StatedMass& stated, const Box& bounds);

/// The version of model files that this library writes, and the only one that it reads.
inline constexpr std::uint32_t model_file_version = 4;

/// A body as a model file stores it: ready for queries and for ranking, with its import transform,
/// what is stated of its mass and the properties of its surface. docs/model-file.md has the file
/// byte by byte.
struct StoredModel {
  Model model;  ///< ready for queries; its profile is null where its mesh has no outline
  /// How the file that the mesh came from was turned into body coordinates; done already.
  ImportTransform transform;
  ShellProperties mass;  ///< of its surface
  /// As given when it was compiled. A file stores the centre of mass in whole micrometres.
  StatedMass stated;
};

/// Properties of a model file besides its contents.
struct ModelFileFacts {
  std::uint32_t version = 0;   ///< of the format
  std::uint32_t checksum = 0;  ///< CRC-32C
  std::size_t bytes = 0;       ///< of the file
};

/// A model file, loaded.
struct LoadedModel {
  StoredModel stored;    ///< what is in it
  ModelFileFacts facts;  ///< version, checksum and size
};

/// Where the bytes of a loaded model lie.
enum class ModelStorage {
  /// In memory of their own, read from the file: whatever happens to the file later does not
  /// matter.
  copied,
  /// In the file, mapped: no copy, and processes that load the same file share its memory. The file
  /// must not be written to or cut while the model lives: contents that change after they were
  /// checked cause undefined behaviour, and reading beyond the end of a truncated file ends the
  /// process (SIGBUS). `save_model` and `crashrank compile` never write into a file that exists,
  /// and a file may be replaced by renaming another onto it. For files on a partition that is
  /// mounted read-only.
  mapped,
};

/// How a model file is loaded.
struct LoadModelOptions {
  ModelStorage storage = ModelStorage::copied;   ///< where its bytes lie
  std::size_t max_bytes = std::size_t{4} << 30;  ///< of a file, limit_exceeded above
};

/// Loads a model file and checks all of it: version, size, checksum, then every number, index,
/// range, name and box, so that a loaded file is as valid as a model just built. The memory used is
/// at most a small multiple of the file's size.
///
/// The columns of the model borrow the bytes that were loaded (see Column) and keep them; copies of
/// the model share them. O(file); blocks on the file system. Safe from any thread. Errors:
/// not_found; bad_input for files that are no model files, of another version, truncated, extended,
/// damaged or forged; limit_exceeded; out_of_memory.
CRASHRANK_API Result<LoadedModel> load_model(const std::string& path,
                                             const LoadModelOptions& options = {});

/// The same from memory that holds the bytes of a model file and does not change during the life of
/// `keeper`; without a keeper, for ever. Errors also: usage unless `bytes` begins at a multiple of
/// 64.
CRASHRANK_API Result<LoadedModel> load_model(View<const unsigned char> bytes,
                                             std::shared_ptr<const void> keeper);

/// The bytes of a model file: the same for the same model on every machine. Checks first what
/// `load_model` would refuse. Makes the profile if the model has none; a mesh without outline
/// (see `make_profile`) is stored without one: queries work on it, in `rank` it is no crash
/// partner. Errors: bad_input, limit_exceeded, out_of_memory.
CRASHRANK_API Result<std::vector<unsigned char>> encode_model(const StoredModel& stored);

/// Writes a model file, as a whole or not at all: it is written beside its place under another
/// name, brought to the disk and renamed. Blocks on the file system.
/// Errors: as `encode_model`; usage when there is something at `path` and `overwrite` is not set,
/// or it is a folder, device or pipe; not_found when the folder cannot be written to; internal when
/// the disk is full.
CRASHRANK_API Status save_model(const StoredModel& stored, const std::string& path,
                                bool overwrite = false);

/// True if a file is to be read by `load_model`: it begins as a model file does, or has the suffix
/// `.crm`, so that a missing or damaged one is reported as a model file. False for other unreadable
/// files.
CRASHRANK_API bool is_model_file(const std::string& path);

}  // namespace crashrank
