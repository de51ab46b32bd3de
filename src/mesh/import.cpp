#include "crashrank/mesh/import.hpp"

#include "mesh/child_process.hpp"
#include "mesh/find_importer.hpp"
#include "mesh/import_protocol.hpp"
#include "mesh/import_reply.hpp"
#include "mesh/text.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace crashrank {
namespace {

constexpr std::array<std::string_view, 10> extensions{"obj", "stl", "ply", "off", "gltf",
                                                      "glb", "dae", "fbx", "3ds", "ac"};
constexpr const char* formats = "OBJ, STL, PLY, OFF, glTF, GLB, DAE, FBX, 3DS, AC";

// Wall time may be this many times the processor time: on a busy machine the importer waits, and
// what only waits is none of the file's fault.
constexpr double wall_per_processor_time = 15.0;

Result<std::string> extension_of(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return make_error(ErrorCode::bad_input, "it is a folder, not a mesh", "name a file in it");
  }
  const std::size_t slash = path.find_last_of('/');
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  const std::size_t dot = name.find_last_of('.');
  if (dot == std::string::npos || dot + 1 == name.size()) {
    return make_error(ErrorCode::bad_input,
                      "the file name has no extension, which selects the format",
                      std::string("name it after its format: ") + formats);
  }
  std::string extension = name.substr(dot + 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == "crm") {
    return make_error(ErrorCode::bad_input, "it is named as a compiled model, not as a mesh",
                      "read it with load_model, or name the mesh that it was made from");
  }
  if (extension == "json") {
    return make_error(ErrorCode::bad_input, "it is named as a scenario or profile, not as a mesh",
                      "rank it with crashrank rank, or name a mesh");
  }
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
    return make_error(ErrorCode::bad_input,
                      detail::quoted(extension, 40) + " is not a supported mesh format",
                      std::string("convert it to one of ") + formats);
  }
  return extension;
}

struct MeshFile {
  detail::FileDescriptor descriptor;
  std::size_t bytes = 0;
};

Result<MeshFile> open_mesh(const std::string& path, const ImportLimits& limits) {
  if (path.find('\0') != std::string::npos) {
    return make_error(ErrorCode::not_found, "the file name holds a zero byte");
  }
  // Without O_NONBLOCK a named pipe would keep us waiting for its other end.
  MeshFile file{
      detail::FileDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)),
      0};
  if (!file.descriptor.valid()) {
    return make_error(ErrorCode::not_found,
                      "cannot open it: " + std::generic_category().message(errno),
                      "check the path");
  }
  struct stat status {};
  if (::fstat(file.descriptor.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return make_error(ErrorCode::bad_input, "not a regular file");
  }
  file.bytes = static_cast<std::size_t>(status.st_size);
  if (file.bytes == 0) {
    return make_error(ErrorCode::bad_input, "the file is empty", "export the mesh again");
  }
  if (file.bytes > limits.file_bytes) {
    return make_error(ErrorCode::limit_exceeded,
                      "the file has " + std::to_string(file.bytes) + " bytes, more than the " +
                          std::to_string(limits.file_bytes) + " allowed",
                      "simplify the mesh or raise the limit");
  }
  return file;
}

// Shortest text that reads back as the same double, whatever the caller's locale.
std::string number(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

std::vector<std::string> arguments_for(const std::string& importer, const std::string& path,
                                       const std::string& extension, double seconds,
                                       const ImportOptions& options) {
  const ImportLimits& limits = options.limits;
  const ImportTransform& transform = options.transform;
  return {importer,
          "version=" + std::to_string(detail::import_version),
          "path=" + path,
          "extension=" + extension,
          "seconds=" + number(seconds),
          "memory_bytes=" + std::to_string(limits.memory_bytes),
          "file_bytes=" + std::to_string(limits.file_bytes),
          "triangles=" + std::to_string(std::min(limits.triangles, max_triangles)),
          "vertices=" + std::to_string(std::min<std::size_t>(limits.vertices, 0xfffffffe)),
          "parts=" + std::to_string(limits.parts),
          "polygon_corners=" + std::to_string(limits.polygon_corners),
          "name_bytes=" + std::to_string(max_part_name_bytes),
          "scale=" + number(transform.scale),
          "up=" + std::to_string(static_cast<int>(transform.up)),
          "forward=" + std::to_string(static_cast<int>(transform.forward)),
          "origin_x=" + number(transform.origin_m.x()),
          "origin_y=" + number(transform.origin_m.y()),
          "origin_z=" + number(transform.origin_m.z())};
}

// Told when the importer ended without a whole answer.
Error broken_off(detail::ChildProcess& child, double seconds, std::size_t memory_bytes) {
  const std::string how = child.finish();
  const auto whole_seconds = [](double value) { return number(std::ceil(value)); };
  if (child.signal() == SIGXCPU) {
    return make_error(
        ErrorCode::limit_exceeded,
        "reading it takes more than " + whole_seconds(seconds) + " s of processor time",
        "the file is damaged or too large; simplify it");
  }
  if (child.timed_out()) {
    return make_error(ErrorCode::limit_exceeded,
                      "it is not read after " + whole_seconds(wall_per_processor_time * seconds) +
                          " s, most of which the importer waited",
                      "try again when the machine is less busy");
  }
  if (child.signal() != 0) {
    return make_error(ErrorCode::bad_input, "the parser failed on it: " + how,
                      "the file holds something that the parser does not know, is nested too "
                      "deeply, damaged, or needs more than " +
                          std::to_string(memory_bytes >> 20) +
                          " MiB; export it in another way or format");
  }
  return make_error(ErrorCode::internal, "the importer gave no answer: " + how,
                    "check the installation of crashrank-import");
}

Status check_surface(const TriangleMesh& mesh, const MeshQuality& quality) {
  if (mesh.triangles.empty()) {
    return make_error(ErrorCode::bad_input, "the file holds no triangles",
                      "export surfaces, not points or lines");
  }
  if (quality.degenerate_triangles == mesh.size()) {
    return make_error(ErrorCode::bad_input, "every triangle is degenerate: there is no surface",
                      "export the mesh again");
  }
  const double largest = quality.extent_m.maxCoeff();
  // Coordinates were rounded to float32, the extent with them.
  constexpr double rounding = 1e-6;
  if (!(largest >= min_extent_m * (1.0 - rounding) && largest <= max_extent_m * (1.0 + rounding))) {
    return make_error(
        ErrorCode::bad_input,
        "its largest extent is " + number(largest) + " m, outside the range of 1e-6 to 1e6 m",
        "give the scale in metres per file unit");
  }
  return Success{};
}

Result<ImportedMesh> import_file(const std::string& path, const ImportOptions& options) {
  if (Status status = check(options.transform); !status) return status.error();
  const Result<std::string> extension = extension_of(path);
  if (!extension) return extension.error();
  const Result<MeshFile> file = open_mesh(path, options.limits);
  if (!file) return file.error();
  const Result<std::string> importer = detail::find_importer(options.importer, options.header);
  if (!importer) return importer.error();

  const ImportLimits& limits = options.limits;
  const double mebibytes = static_cast<double>(file->bytes) / (1 << 20);
  const double seconds =
      std::clamp(limits.seconds + limits.seconds_per_mebibyte * mebibytes, 0.1, 1e5);
  const auto wall = std::chrono::duration_cast<detail::ChildProcess::Clock::duration>(
      std::chrono::duration<double>(wall_per_processor_time * seconds));
  detail::ChildProcess child;
  const Status started = child.start(arguments_for(*importer, path, *extension, seconds, options),
                                     file->descriptor, detail::ChildProcess::Clock::now() + wall);
  if (!started) return started.error();

  ImportedMesh imported;
  Error failure;
  const auto read = [&child](void* data, std::size_t size) { return child.read(data, size); };
  switch (detail::read_reply(read, limits, imported, failure)) {
    case detail::Reply::complete:
      break;
    case detail::Reply::refused:
      return failure;
    case detail::Reply::broken_off:
      return broken_off(child, seconds, limits.memory_bytes);
  }
  imported.quality = assess(imported.mesh);
  if (Status status = check_surface(imported.mesh, imported.quality); !status) {
    return status.error();
  }
  imported.warnings.insert(imported.warnings.end(), imported.quality.warnings.begin(),
                           imported.quality.warnings.end());
  return imported;
}

}  // namespace

Result<ImportedMesh> import_mesh(const std::string& path, const ImportOptions& options) {
  try {
    Result<ImportedMesh> imported = import_file(path, options);
    if (!imported) imported.error().file = path;
    return imported;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace crashrank
