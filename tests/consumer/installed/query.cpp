#define ASK ask_everything
#define LAYOUT layout
#include "query_body.hpp"

crashrank::TriangleMesh bumpy_sheet(int n) {
  crashrank::TriangleMesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const float x = static_cast<float>(i) * 0.1F;
      const float y = static_cast<float>(j) * 0.1F;
      mesh.vertices.emplace_back(x, y, static_cast<float>((i * 7 + j * 13) % 11) * 0.013F);
    }
  }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  mesh.parts.push_back({"sheet", 0, static_cast<std::uint32_t>(mesh.triangles.size())});
  return mesh;
}
