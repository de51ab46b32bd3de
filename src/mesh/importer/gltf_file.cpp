#include "mesh/importer/gltf_file.hpp"

#include "mesh/importer/content.hpp"
#include "mesh/text.hpp"

#include <nlohmann/json.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

namespace crashrank::importer {
namespace {

using Json = nlohmann::json;

constexpr const char* meshopt_name = "EXT_meshopt_compression";
constexpr const char* draco_extension = "KHR_draco_mesh_compression";
constexpr const char* data_header = "data:application/octet-stream;base64,";

std::string numbered(const char* what, std::size_t number) {
  return std::string(what) + " " + std::to_string(number);
}

std::uint32_t number_at(const std::string& bytes, std::size_t offset) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

/// The parts of a binary file: a header of mark, version and length, then chunks of length, type
/// and content, of which the first is JSON and the second the first buffer. Numbers are u32.
struct Chunks {
  std::string_view json;
  GltfBytes buffer;
};

Result<Chunks> split_binary(const std::string& bytes) {
  constexpr std::uint32_t json_type = 0x4e4f534a;
  constexpr std::uint32_t buffer_type = 0x004e4942;
  constexpr std::size_t header = 12;
  constexpr std::size_t chunk_header = 8;
  Chunks chunks;
  if (bytes.size() < header + chunk_header) return gltf_error({}, "it ends within its header");
  if (number_at(bytes, 8) > bytes.size()) {
    return gltf_error({}, "its header promises " + std::to_string(number_at(bytes, 8)) +
                              " bytes, and it has " + std::to_string(bytes.size()));
  }
  for (std::size_t at = header; at + chunk_header <= bytes.size();) {
    const std::size_t size = number_at(bytes, at);
    const std::uint32_t type = number_at(bytes, at + 4);
    const std::size_t begin = at + chunk_header;
    if (size > bytes.size() - begin) return gltf_error({}, "it ends within a chunk");
    if (at == header && type != json_type) return gltf_error({}, "its first chunk is not JSON");
    if (at == header) {
      chunks.json = std::string_view(bytes).substr(begin, size);
    } else if (type == buffer_type && chunks.buffer.begin == nullptr) {
      chunks.buffer = {reinterpret_cast<const unsigned char*>(bytes.data()) + begin, size};
    }
    at = begin + size;
  }
  return chunks;
}

Json* member(Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

Json* extension(Json& object, const char* name) {
  Json* const all = member(object, "extensions");
  return all == nullptr ? nullptr : member(*all, name);
}

template <class Visit> void each(Json* array, const Visit& visit) {
  if (array == nullptr || !array->is_array()) return;
  for (Json& element : *array) visit(element);
}

std::size_t size_member(Json& object, const char* key) {
  const Json* const value = member(object, key);
  return value != nullptr && value->is_number_unsigned() ? value->get<std::size_t>() : 0;
}

bool is_fallback(Json& buffer) {
  Json* const compression = extension(buffer, meshopt_name);
  const Json* const fallback = compression == nullptr ? nullptr : member(*compression, "fallback");
  return fallback != nullptr && fallback->is_boolean() && fallback->get<bool>();
}

Result<std::vector<unsigned char>> read_uri(const std::string& uri, FolderIo& files) {
  std::vector<unsigned char> bytes;
  if (uri.compare(0, 5, "data:") == 0) {
    const std::size_t comma = uri.find(',');
    std::string type;
    if (comma == std::string::npos || uri.find(";base64") > comma ||
        !tinygltf::DecodeDataURI(&bytes, type, data_header + uri.substr(comma + 1), 0, false)) {
      return gltf_error({}, "its data: URI holds no base64");
    }
    return bytes;
  }
  std::string fault;
  if (!files.read(uri, bytes, fault)) {
    return make_error(ErrorCode::bad_input,
                      files.refused().empty() ? "a buffer " + fault : files.refused().front(),
                      "put every file that the mesh names into its folder");
  }
  return bytes;
}

Status read_buffers(Json& root, const GltfBytes& chunk, GltfFile& file, FolderIo& files) {
  Json* const buffers = member(root, "buffers");
  if (buffers == nullptr || !buffers->is_array()) return Success{};
  file.owned.reserve(buffers->size());
  for (std::size_t i = 0; i < buffers->size(); ++i) {
    Json& buffer = (*buffers)[i];
    const std::size_t promised = size_member(buffer, "byteLength");
    const Json* const uri = member(buffer, "uri");
    GltfBytes bytes;
    if (is_fallback(buffer)) {
      file.buffers.push_back(bytes);
      continue;
    }
    if (uri != nullptr && uri->is_string()) {
      Result<std::vector<unsigned char>> read = read_uri(uri->get<std::string>(), files);
      if (!read) {
        if (read.error().place.empty()) read.error().place = numbered("buffer", i);
        return read.error();
      }
      file.owned.push_back(std::move(*read));
      bytes = {file.owned.back().data(), file.owned.back().size()};
    } else if (i == 0) {
      bytes = chunk;
    }
    if (bytes.size < promised) {
      return gltf_error(numbered("buffer", i), "it has " + std::to_string(bytes.size) +
                                                   " bytes, its byteLength promises " +
                                                   std::to_string(promised));
    }
    bytes.size = promised;
    file.buffers.push_back(bytes);
  }
  return Success{};
}

/// What tinygltf would read or refuse without need.
void leave_out_what_no_surface_needs(Json& root) {
  for (const char* key : {"buffers", "images", "textures", "samplers", "animations", "cameras"}) {
    root.erase(key);
  }
  each(member(root, "meshes"), [](Json& mesh) {
    each(member(mesh, "primitives"), [](Json& primitive) {
      if (extension(primitive, draco_extension) != nullptr) primitive.erase("indices");
    });
  });
}

bool is_version_1(Json& root) {
  Json* const asset = member(root, "asset");
  const Json* const version = asset == nullptr ? nullptr : member(*asset, "version");
  if (version == nullptr) return false;
  if (version->is_number()) return version->get<double>() < 2.0;
  return version->is_string() && version->get<std::string>().compare(0, 2, "1.") == 0;
}

std::string first_line(std::string text) {
  text.resize(text.find('\n') == std::string::npos ? text.size() : text.find('\n'));
  text.resize(text.find_last_not_of(". ") + 1);
  return text.empty() ? "the parser gave up" : text;
}

Result<Json> parse_json(std::string_view text) {
  // No geometry lies deep, or in extras; what writes the JSON again recurses.
  constexpr int deepest = 64;
  const auto keep = [](int depth, Json::parse_event_t event, Json& value) {
    return depth < deepest && (event != Json::parse_event_t::key || value != "extras");
  };
  try {
    Json root = Json::parse(text, keep);
    if (!root.is_object()) return gltf_error({}, "its JSON is no object");
    return root;
  } catch (const Json::exception& failure) {
    // "[json.exception.parse_error.101] parse error at line ..."
    const std::string what = failure.what();
    return gltf_error({}, "its JSON cannot be read: " + what.substr(what.find("] ") + 2));
  }
}

}  // namespace

Error gltf_error(std::string place, std::string reason) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), "export the file again");
  error.place = std::move(place);
  return error;
}

Result<GltfFile> read_gltf_file(const Request& request, std::size_t skip, FolderIo& files) {
  struct stat status {};
  if (::fstat(STDIN_FILENO, &status) != 0) return gltf_error({}, "it cannot be read");
  GltfFile file;
  file.bytes = read_at(STDIN_FILENO, skip,
                       std::min(request.file_bytes, static_cast<std::size_t>(status.st_size)));
  Chunks chunks{file.bytes, {}};
  if (file.bytes.compare(0, 4, "glTF") == 0) {
    file.version_1 = file.bytes.size() >= 8 && number_at(file.bytes, 4) == 1;
    if (file.version_1) return file;
    const Result<Chunks> split = split_binary(file.bytes);
    if (!split) return split.error();
    chunks = *split;
  }
  std::string text;
  {
    Result<Json> root = parse_json(chunks.json);
    if (!root) return root.error();
    file.version_1 = is_version_1(*root);
    if (file.version_1) return file;
    if (const Status read = read_buffers(*root, chunks.buffer, file, files); !read) {
      return read.error();
    }
    leave_out_what_no_surface_needs(*root);
    text = root->dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  if (text.size() > std::numeric_limits<unsigned>::max()) {
    return gltf_error({}, "its JSON is larger than 4 GiB");
  }
  tinygltf::TinyGLTF reader;
  std::string fault;
  std::string warning;
  if (!reader.LoadASCIIFromString(&file.model, &fault, &warning, text.data(),
                                  static_cast<unsigned>(text.size()), "", tinygltf::NO_REQUIRE)) {
    return gltf_error({}, first_line(fault));
  }
  if (file.model.asset.version.compare(0, 2, "2.") != 0) {
    return gltf_error("asset", "its version " + detail::quoted(file.model.asset.version, 40) +
                                   " is not supported: 1.0 and 2.0 are");
  }
  return file;
}

}  // namespace crashrank::importer
