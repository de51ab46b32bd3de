#include "mesh/importer/reply.hpp"

#include "mesh/import_protocol.hpp"
#include "mesh/text.hpp"

#include <algorithm>
#include <cstdio>

namespace crashrank::importer {
namespace {

template <class T> bool put(const T* data, std::size_t count) {
  return count == 0 || std::fwrite(data, sizeof(T), count, stdout) == count;
}

template <class T> bool put(const T& value) { return put(&value, 1); }

bool put_text(const std::string& text) {
  const auto length = static_cast<std::uint32_t>(text.size());
  return put(length) && put(text.data(), text.size());
}

std::string line(const std::string& text) { return detail::printable(text, 1000); }

bool finish(bool sent) { return sent && put(detail::import_trailer) && std::fflush(stdout) == 0; }

}  // namespace

bool send(const TriangleMesh& mesh, std::uint64_t dropped_triangles,
          const std::vector<std::string>& warnings) {
  detail::ImportHeader header;
  header.warnings = std::min(warnings.size(), detail::max_import_warnings);
  header.parts = mesh.parts.size();
  header.vertices = mesh.vertices.size();
  header.triangles = mesh.triangles.size();
  header.dropped_triangles = dropped_triangles;
  bool sent = put(header);
  for (std::size_t i = 0; i < header.warnings; ++i) sent = sent && put_text(line(warnings[i]));
  for (const Part& part : mesh.parts) {
    sent = sent && put(part.triangle_count) && put_text(part.name);
  }
  return finish(sent && put(mesh.vertices.data(), mesh.vertices.size()) &&
                put(mesh.triangles.data(), mesh.triangles.size()));
}

bool send(const Error& error) {
  detail::ImportHeader header;
  header.status = error.code == ErrorCode::limit_exceeded ? detail::ImportStatus::limit_exceeded
                  : error.code == ErrorCode::bad_input    ? detail::ImportStatus::bad_input
                                                          : detail::ImportStatus::internal;
  return finish(put(header) && put_text(line(error.place)) && put_text(line(error.reason)) &&
                put_text(line(error.remedy)));
}

}  // namespace crashrank::importer
