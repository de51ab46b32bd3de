#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Most triangles of a mesh on a page; of those that have more, corners that lie in one cell of a
/// grid become one.
inline constexpr std::size_t most_page_triangles = 7'000;

/// A mesh as the page draws it. Each of its triangles stands for one or more of the mesh's.
class PageMesh {
public:
  explicit PageMesh(const TriangleMesh& mesh, std::size_t most_triangles = most_page_triangles);

  /// Whether it has fewer triangles than the mesh.
  bool is_coarser() const { return triangles_.size() < kept_of_.size(); }

  /// {"triangles", "of", "origin", "step", "positions", "indices", "parts": [[first, count, ego's
  /// colour, others' colour]]}: positions are three uint16 a corner, in steps from the origin;
  /// indices three uint16 a triangle; both in base64, little endian.
  nlohmann::ordered_json json() const;

  /// The page's triangles that stand for damaged ones: lengths of runs, intact and damaged in turn,
  /// seven bits a byte, lowest first, the eighth bit where more follow; in base64.
  std::string damage(View<const std::uint32_t> damaged) const;

private:
  void join_corners(const TriangleMesh& mesh, double cell_m);
  void fill_gaps(const std::vector<std::uint32_t>& cell_of, const TriangleMesh& mesh);

  std::vector<Eigen::Vector3f> corners_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> part_of_;  ///< by triangle
  std::vector<std::uint32_t> kept_of_;  ///< by the mesh's triangle, the one that stands for it
  std::vector<std::string> parts_;
};

}  // namespace crashrank::detail
