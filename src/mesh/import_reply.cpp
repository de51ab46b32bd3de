#include "mesh/import_reply.hpp"

#include "mesh/import_protocol.hpp"
#include "mesh/text.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_set>

namespace crashrank::detail {
namespace {

// Memory is asked for as the data come, not as they are promised.
constexpr std::size_t elements_a_read = 1 << 16;

class ReplyReader {
public:
  explicit ReplyReader(const ReadBytes& read) : read_(read) {}

  bool sound() const { return sound_; }

  template <class T> T value() {
    T value{};
    sound_ = sound_ && read_(&value, sizeof value);
    return value;
  }

  std::string text(std::size_t limit) {
    const auto length = value<std::uint32_t>();
    if (!sound_ || length > limit) {
      sound_ = false;
      return {};
    }
    std::string text(length, '\0');
    sound_ = read_(text.data(), text.size());
    return text;
  }

  template <class T> void array(Column<T>& column, std::size_t count) {
    std::vector<T> to;
    while (sound_ && to.size() < count) {
      const std::size_t have = to.size();
      const std::size_t more = std::min(elements_a_read, count - have);
      to.resize(have + more);
      sound_ = read_(to.data() + have, more * sizeof(T));
    }
    column = std::move(to);
  }

private:
  const ReadBytes& read_;
  bool sound_ = true;
};

bool within(const ImportHeader& header, const ImportLimits& limits) {
  return header.warnings <= max_import_warnings && header.parts <= limits.parts &&
         header.vertices <= limits.vertices && header.triangles <= limits.triangles &&
         header.triangles <= max_triangles;
}

// Parts cover the triangles in order with unique names, indices are in range, vertices finite.
bool consistent(const TriangleMesh& mesh) {
  std::unordered_set<std::string> names;
  std::uint64_t covered = 0;
  for (const Part& part : mesh.parts) {
    if (part.first_triangle != covered || part.triangle_count == 0) return false;
    covered += part.triangle_count;
    if (!names.insert(part.name).second) return false;
    if (to_utf8(part.name, max_part_name_bytes) != part.name) return false;
  }
  if (covered != mesh.triangles.size()) return false;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= mesh.vertices.size()) return false;
    }
  }
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Eigen::Vector3f& vertex) { return vertex.allFinite(); });
}

ErrorCode code_of(ImportStatus status) {
  switch (status) {
    case ImportStatus::bad_input:
      return ErrorCode::bad_input;
    case ImportStatus::limit_exceeded:
      return ErrorCode::limit_exceeded;
    default:
      return ErrorCode::internal;
  }
}

}  // namespace

Reply read_reply(const ReadBytes& read, const ImportLimits& limits, ImportedMesh& imported,
                 Error& failure) {
  ReplyReader reader(read);
  const auto header = reader.value<ImportHeader>();
  if (!reader.sound()) return Reply::broken_off;
  if (header.magic != import_magic || header.version != import_version) {
    failure = make_error(ErrorCode::internal, "the importer is of another version",
                         "install crashrank-import and the library together");
    return Reply::refused;
  }
  const Error nonsense =
      make_error(ErrorCode::bad_input, "the parser lost its way in it", "export the file again");
  if (header.status != ImportStatus::ok) {
    failure.code = code_of(header.status);
    failure.place = printable(reader.text(max_import_text));
    failure.reason = printable(reader.text(max_import_text));
    failure.remedy = printable(reader.text(max_import_text));
    if (reader.value<std::uint64_t>() != import_trailer) return Reply::broken_off;
    if (failure.reason.empty()) failure = nonsense;
    return Reply::refused;
  }

  if (!within(header, limits)) {
    failure = nonsense;
    return Reply::refused;
  }
  for (std::uint64_t i = 0; i < header.warnings; ++i) {
    imported.warnings.push_back(printable(reader.text(max_import_text)));
  }
  std::uint64_t first = 0;
  for (std::uint64_t i = 0; i < header.parts && reader.sound(); ++i) {
    Part part;
    part.first_triangle = static_cast<std::uint32_t>(first);
    part.triangle_count = reader.value<std::uint32_t>();
    part.name = reader.text(max_part_name_bytes);
    first += part.triangle_count;
    if (first > header.triangles) {
      failure = nonsense;
      return Reply::refused;
    }
    imported.mesh.parts.push_back(std::move(part));
  }
  static_assert(sizeof(Eigen::Vector3f) == 12);
  reader.array(imported.mesh.vertices, header.vertices);
  reader.array(imported.mesh.triangles, header.triangles);
  imported.dropped_triangles = header.dropped_triangles;
  if (reader.value<std::uint64_t>() != import_trailer || !reader.sound()) return Reply::broken_off;
  if (!consistent(imported.mesh)) {
    failure = nonsense;
    return Reply::refused;
  }
  return Reply::complete;
}

}  // namespace crashrank::detail
