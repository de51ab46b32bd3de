#include "report/glb.hpp"

#include "report/bytes.hpp"

#include <cstdint>
#include <limits>
#include <utility>

namespace crashrank::detail {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t glb_magic = 0x46546c67;
constexpr std::uint32_t json_chunk = 0x4e4f534a;
constexpr std::uint32_t binary_chunk = 0x004e4942;

void put_chunk(std::string& out, std::uint32_t type, const std::string& bytes) {
  put_u32(out, static_cast<std::uint32_t>(bytes.size()));
  put_u32(out, type);
  out += bytes;
}

}  // namespace

std::size_t GlbArrays::add(const std::string& bytes, int target, Json accessor) {
  Json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  views.push_back(std::move(view));
  binary += bytes;
  accessor["bufferView"] = views.size() - 1;
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

Result<std::string> glb_file(Json document, GlbArrays arrays) {
  document["accessors"] = std::move(arrays.accessors);
  document["bufferViews"] = std::move(arrays.views);
  document["buffers"] = Json::array({{{"byteLength", arrays.binary.size()}}});
  std::string json = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');

  constexpr std::size_t header_bytes = 12;
  constexpr std::size_t chunk_header_bytes = 8;
  const std::size_t total =
      header_bytes + 2 * chunk_header_bytes + json.size() + arrays.binary.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    return make_error(ErrorCode::limit_exceeded, "the mesh does not fit into a GLB file of 4 GiB");
  }
  std::string out;
  out.reserve(total);
  put_u32(out, glb_magic);
  put_u32(out, 2);
  put_u32(out, static_cast<std::uint32_t>(total));
  put_chunk(out, json_chunk, json);
  put_chunk(out, binary_chunk, arrays.binary);
  return out;
}

}  // namespace crashrank::detail
