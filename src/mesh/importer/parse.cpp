#include "mesh/importer/parse.hpp"

#include "mesh/importer/content.hpp"
#include "mesh/importer/faces.hpp"
#include "mesh/importer/flatten.hpp"
#include "mesh/importer/folder_io.hpp"
#include "mesh/importer/gltf.hpp"
#include "mesh/importer/obj_fault.hpp"
#include "mesh/importer/ply_check.hpp"
#include "mesh/importer/text_checks.hpp"

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

namespace crashrank::importer {
namespace {

bool reads(const aiImporterDesc& description, const std::string& extension) {
  std::istringstream words(description.mFileExtensions);
  for (std::string word; words >> word;) {
    if (word == extension) return true;
  }
  return false;
}

// A file whose extension's parser declines it would be offered to all the others, which nobody
// asked for: only those of the extension stay. What is taken out is not destroyed, here nor there.
void keep_parsers_of(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    if (description == nullptr || !reads(*description, extension)) {
      importer.UnregisterLoader(importer.GetImporter(i));
    }
  }
}

std::uint64_t polygons_in(const aiScene& scene) {
  std::uint64_t polygons = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      polygons += mesh.mFaces[f].mNumIndices >= 3 ? 1 : 0;
    }
  }
  return polygons;
}

// The number of faces that the lines of an OBJ or OFF file mean, 0 for other formats.
Result<std::uint64_t> check_lines(const Request& request) {
  if (request.extension == "obj") return check_obj_lines(STDIN_FILENO);
  if (request.extension == "off") return check_off_lines(STDIN_FILENO);
  if (request.extension == "ply") {
    const Status whole = check_ply(STDIN_FILENO);
    if (!whole) return whole.error();
  }
  if (request.extension == "ac") {
    const Status sound = check_ac3d_places(STDIN_FILENO);
    if (!sound) return sound.error();
  }
  return std::uint64_t{0};
}

// A warning where lines of faces came to nothing; empty where none did.
std::string passed_over(const aiScene& scene, std::uint64_t lines, const Request& request) {
  const std::uint64_t read = polygons_in(scene);
  if (lines <= read) return {};
  const char* const why = request.extension == "off"
                              ? "they have more than nine corners, or comments stand among them"
                              : "they are indented, cut or have fewer than three corners";
  return std::to_string(lines - read) + " of " + std::to_string(lines) +
         " lines of faces were passed over: " + why + ", and the surface lacks them";
}

void configure(Assimp::Importer& importer) {
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
#ifdef AI_CONFIG_IMPORT_FBX_IGNORE_UP_DIRECTION
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_IGNORE_UP_DIRECTION, true);
#endif
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
}

double number_in(const aiMetadata* metadata, const char* key, double otherwise) {
  double value = otherwise;
  float single = 0.0F;
  int whole = 0;
  if (metadata == nullptr || metadata->Get(key, value)) return value;
  if (metadata->Get(key, single)) return static_cast<double>(single);
  if (metadata->Get(key, whole)) return static_cast<double>(whole);
  return otherwise;
}

// A chunk's number and its bytes within the file; a number of 0 where there is none.
struct Chunk3ds {
  std::uint16_t number = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

// The first chunk of one of these numbers among those from `begin` to `end`.
Chunk3ds find_chunk(std::uint16_t number, std::size_t begin, std::size_t end) {
  constexpr std::size_t head = 6;  // number and size, the head included
  for (std::string bytes; (bytes = read_at(STDIN_FILENO, begin, head)).size() == head;) {
    Chunk3ds chunk;
    std::uint32_t size = 0;
    std::memcpy(&chunk.number, bytes.data(), sizeof chunk.number);
    std::memcpy(&size, bytes.data() + sizeof chunk.number, sizeof size);
    if (size < head || size > end - begin) return {};
    if (chunk.number == number) return {number, begin + head, begin + size};
    begin += size;
  }
  return {};
}

// What the parser divided a 3DS file's coordinates by: its master scale, the length in inches of
// the modeller's units. Coordinates count in file units.
double master_scale() {
  const Chunk3ds file = find_chunk(0x4d4d, 0, std::numeric_limits<std::uint32_t>::max());
  const Chunk3ds editor = find_chunk(0x3d3d, file.begin, file.end);
  const Chunk3ds scale = find_chunk(0x0100, editor.begin, editor.end);
  float value = 0.0F;
  const std::string bytes = read_at(STDIN_FILENO, scale.begin, sizeof value);
  if (scale.number != 0 && bytes.size() == sizeof value) {
    std::memcpy(&value, bytes.data(), sizeof value);
  }
  return value != 0.0F && std::isfinite(value) ? static_cast<double>(value) : 1.0;
}

// FBX states centimetres per unit, 1 where it says nothing; the parser reads it and leaves the
// coordinates alone.
Result<double> metres_per_unit(const aiScene& scene, const Request& request) {
  if (request.extension == "3ds") return master_scale();
  if (request.extension != "fbx") return 1.0;
  const double centimetres = number_in(scene.mMetaData, "UnitScaleFactor", 1.0);
  if (!(centimetres > 0.0) || !std::isfinite(centimetres)) {
    Error error = make_error(ErrorCode::bad_input, "the unit is not a positive length",
                             "export the file again");
    error.place = "UnitScaleFactor";
    return error;
  }
  return centimetres / 100.0;
}

// The 3DS parser turns z up into y up at the root. Axes are the caller's to choose: turned back.
void undo_axis_change(aiScene& scene, const Request& request) {
  if (request.extension != "3ds" || scene.mRootNode == nullptr) return;
  const aiMatrix4x4 back(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  scene.mRootNode->mTransformation = back * scene.mRootNode->mTransformation;
}

Error parser_error(const std::string& text, const FolderIo& files, const Request& request) {
  if (text.find("bad_alloc") != std::string::npos || text.find("memory") != std::string::npos) {
    return out_of_memory(request);
  }
  std::string reason = text.substr(0, text.find_last_not_of(". ") + 1);
  if (reason.empty()) reason = "the parser gave up";
  Error error = make_error(ErrorCode::bad_input, std::move(reason), "export the file again");
  if (request.extension == "obj") {
    if (const std::optional<Error> fault = find_obj_fault(STDIN_FILENO)) error = *fault;
  }
  if (text.find("STL storage representation") != std::string::npos) {
    error.reason = "it is neither a text nor a whole binary STL file";
    if (const std::string bytes = describe_binary_stl(STDIN_FILENO); !bytes.empty()) {
      error.reason += ": " + bytes;
    }
    error.remedy = "name the file after its format, or export it again";
  } else if (request.extension == "stl") {
    if (const std::string cut = describe_stl_cut(STDIN_FILENO); !cut.empty()) error.reason = cut;
  }
  if (!files.refused().empty()) {
    error.reason = files.refused().front();
    error.remedy = "put every file that the mesh names into its folder";
  }
  return error;
}

// What Assimp reads: all formats but glTF 2.
Result<Parsed> parse_with_assimp(const Request& request, const Content& content) {
  const Result<std::uint64_t> face_lines = check_lines(request);
  if (!face_lines) return face_lines.error();

  // Never destroyed: the process ends soon, and the destructor of a very deep node tree recurses.
  Assimp::Importer& importer = *std::make_unique<Assimp::Importer>().release();
  auto owned =
      std::make_unique<FolderIo>(request.path, request.extension, content.skip, request.file_bytes);
  FolderIo& files = *owned;
  importer.SetIOHandler(owned.release());
  keep_parsers_of(importer, request.extension);
  configure(importer);
  if (importer.ReadFile(files.mesh_name(), 0) == nullptr) {
    return parser_error(importer.GetErrorString(), files, request);
  }
  // The importer hands its scene out as const, and post-processes it in place.
  aiScene* scene = const_cast<aiScene*>(importer.GetScene());
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return make_error(ErrorCode::bad_input, "the file holds no scene", "export the file again");
  }
  const std::string holes = passed_over(*scene, *face_lines, request);
  Result<std::uint64_t> dropped = clear_bad_faces(*scene, request);
  if (!dropped) return dropped.error();
  const CrossingPolygons crossing = triangulate_faces(*scene);
  undo_axis_change(*scene, request);
  const Result<double> unit = metres_per_unit(*scene, request);
  if (!unit) return unit.error();
  Result<TriangleMesh> mesh = flatten(*scene, request, *unit, files.mesh_name());
  if (!mesh) return mesh.error();
  if (mesh->triangles.empty() && !holes.empty()) {
    return make_error(ErrorCode::bad_input, "no surface is left: " + holes,
                      request.extension == "off" ? "export triangles"
                                                 : "begin each face with a small f and a blank");
  }
  Parsed parsed{std::move(*mesh), *dropped, {}};
  if (!holes.empty()) parsed.warnings.push_back(holes);
  if (crossing.count > 0) {
    parsed.warnings.push_back(
        (crossing.count == 1
             ? "1 polygon crosses itself: "
             : std::to_string(crossing.count) + " polygons cross themselves, the first is ") +
        crossing.first + "; its surface is a guess: export triangles");
  }
  if (request.extension == "stl") {
    std::string cut = describe_stl_cut(STDIN_FILENO);
    if (!cut.empty()) parsed.warnings.push_back(std::move(cut));
  }
  for (const std::string& file : files.refused()) parsed.warnings.push_back(file);
  return parsed;
}

Result<Parsed> parse_by_format(const Request& request, const Content& content) {
  if (request.extension == "gltf" || request.extension == "glb") {
    FolderIo files(request.path, request.extension, content.skip, request.file_bytes);
    Result<std::optional<Parsed>> parsed = parse_gltf(request, content.skip, files);
    if (!parsed) return parsed.error();
    if (*parsed) return std::move(**parsed);
  }
  return parse_with_assimp(request, content);
}

}  // namespace

Result<Parsed> parse(const Request& request) {
  const Result<Content> content = look_at(STDIN_FILENO, request.extension);
  if (!content) return content.error();
  Result<Parsed> parsed = parse_by_format(request, *content);
  if (!parsed) return parsed;
  if (parsed->mesh.triangles.empty()) {
    return make_error(ErrorCode::bad_input, "the file holds no triangles",
                      "export surfaces, not points or lines");
  }
  if (const std::uint64_t dropped = parsed->dropped_triangles; dropped > 0) {
    parsed->warnings.insert(parsed->warnings.begin(),
                            std::to_string(dropped) +
                                (dropped == 1 ? " face that names a missing vertex was left out"
                                              : " faces that name missing vertices were left out") +
                                "; triangles are numbered without");
  }
  return parsed;
}

}  // namespace crashrank::importer
