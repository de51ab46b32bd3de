#include "oracle/shipped_models.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

namespace oracle {

using crashrank::ErrorCode;
using crashrank::TriangleMesh;

crashrank::Result<TriangleMesh> read_obj(const std::string& path) {
  std::ifstream file(path);
  if (!file) return crashrank::make_error(ErrorCode::not_found, path + " cannot be read");
  TriangleMesh mesh;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Eigen::Vector3f v = Eigen::Vector3f::Zero();
      words >> v.x() >> v.y() >> v.z();
      mesh.vertices.push_back(v);
    } else if (kind == "f") {
      std::array<std::uint32_t, 3> face{};
      for (std::uint32_t& index : face) {
        words >> index;
        if (!words || index == 0 || index > mesh.vertices.size()) {
          return crashrank::make_error(ErrorCode::bad_input, path + ": " + line);
        }
        --index;
      }
      mesh.triangles.push_back(face);
    }
  }
  if (mesh.triangles.empty()) {
    return crashrank::make_error(ErrorCode::bad_input, path + " has no triangle");
  }
  return mesh;
}

TriangleMesh reduced(const TriangleMesh& mesh, float cell_m) {
  TriangleMesh result;
  std::map<std::array<int, 3>, std::uint32_t> cells;
  std::vector<std::uint32_t> representative;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    std::array<int, 3> cell{};
    for (int k = 0; k < 3; ++k) {
      cell[static_cast<std::size_t>(k)] = static_cast<int>(std::floor(v[k] / cell_m));
    }
    const auto [found, inserted] =
        cells.try_emplace(cell, static_cast<std::uint32_t>(result.vertices.size()));
    if (inserted) result.vertices.push_back(v);
    representative.push_back(found->second);
  }
  std::size_t flat = 0;
  constexpr std::size_t kept_flat = 10;
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> face{representative[t[0]], representative[t[1]],
                                            representative[t[2]]};
    const bool keeps_area = face[0] != face[1] && face[1] != face[2] && face[2] != face[0];
    if (keeps_area || flat++ < kept_flat) result.triangles.push_back(face);
  }
  return result;
}

TriangleMesh reduced_to(const TriangleMesh& mesh, std::size_t triangles) {
  TriangleMesh result = mesh;
  for (float cell_m = 0.02F; result.size() > triangles; cell_m *= 1.15F) {
    result = reduced(mesh, cell_m);
  }
  return result;
}

}  // namespace oracle
