// The importer's answer: a parser that a file has taken over can write anything.

#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "fuzz/target.hpp"
#include "mesh/import_protocol.hpp"
#include "mesh/import_reply.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string>

namespace fuzz {
namespace {

using namespace crashrank;

template <class T> void put(Bytes& bytes, const T& value) {
  // Not `insert`: GCC 12 warns of an overflow in it when it compiles for ThreadSanitizer.
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof value);
  std::memcpy(bytes.data() + size, &value, sizeof value);
}

void put_text(Bytes& bytes, const std::string& text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes.insert(bytes.end(), text.begin(), text.end());
}

Bytes answer(std::uint32_t parts) {
  detail::ImportHeader header{};
  header.magic = detail::import_magic;
  header.version = detail::import_version;
  header.status = detail::ImportStatus::ok;
  header.parts = parts;
  header.warnings = 1;
  header.vertices = 3;
  header.triangles = parts;
  Bytes bytes;
  put(bytes, header);
  put_text(bytes, "a warning");
  for (std::uint32_t i = 0; i < parts; ++i) {
    put(bytes, std::uint32_t{1});
    put_text(bytes, "part " + std::to_string(i));
  }
  for (const float x : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.5F}) put(bytes, x);
  for (std::uint32_t i = 0; i < parts; ++i) put(bytes, std::array<std::uint32_t, 3>{0, 1, 2});
  put(bytes, detail::import_trailer);
  return bytes;
}

}  // namespace

std::vector<Bytes> seeds() { return {answer(1), answer(2), answer(9)}; }

void mutate(Bytes& bytes, std::mt19937_64& random) {
  if (bytes.size() < 4 || random() % 3 == 0) {
    mutate_bytes(bytes, random);
    return;
  }
  const std::size_t at = below(random, bytes.size() / 4) * 4;
  constexpr std::uint32_t telling[] = {0,           1,           2,           3,   9,
                                       0xffffffffU, 0x80000000U, 0x7fc00000U, 256, 257};
  const std::uint32_t word = telling[below(random, std::size(telling))];
  std::memcpy(bytes.data() + at, &word, sizeof word);
}

bool take(const Bytes& bytes) {
  std::size_t at = 0;
  const auto read = [&](void* data, std::size_t size) {
    if (size > bytes.size() - at) return false;
    if (size != 0) std::memcpy(data, bytes.data() + at, size);
    at += size;
    return true;
  };
  ImportLimits limits;
  limits.vertices = 1000;
  limits.triangles = 1000;
  limits.parts = 100;
  ImportedMesh imported;
  Error failure;
  const detail::Reply reply = detail::read_reply(read, limits, imported, failure);
  if (reply == detail::Reply::refused) {
    require(!failure.reason.empty(), "a refusal says nothing");
  }
  if (reply != detail::Reply::complete) return false;
  const TriangleMesh& mesh = imported.mesh;
  std::size_t covered = 0;
  for (const Part& part : mesh.parts) {
    require(part.first_triangle == covered && part.triangle_count > 0, "parts overlap");
    covered += part.triangle_count;
  }
  require(covered == mesh.size(), "parts do not cover the triangles");
  if (mesh.size() == 0) return true;
  require(make_model(mesh).ok(), "no tree can be built over a mesh that was accepted");
  return true;
}

}  // namespace fuzz
