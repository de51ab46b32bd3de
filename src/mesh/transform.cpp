#include "crashrank/mesh/triangle_mesh.hpp"

#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

namespace crashrank {

Result<Axis> axis_from_name(const std::string& name) {
  std::string_view letter = name;
  bool minus = false;
  if (letter.size() == 2 && (letter[0] == '+' || letter[0] == '-')) {
    minus = letter[0] == '-';
    letter.remove_prefix(1);
  }
  if (letter.size() == 1) {
    const int index = std::tolower(static_cast<unsigned char>(letter[0])) - 'x';
    if (index >= 0 && index < 3) return static_cast<Axis>(2 * index + (minus ? 1 : 0));
  }
  return make_error(ErrorCode::usage, "'" + name + "' is not an axis", "write +x, -x, +y, ... -z");
}

Status check(const ImportTransform& transform) {
  if (!(transform.scale > 0.0) || !std::isfinite(transform.scale)) {
    return make_error(ErrorCode::usage, "the scale has to be positive and finite",
                      "give metres per file unit");
  }
  if (static_cast<int>(transform.up) / 2 == static_cast<int>(transform.forward) / 2) {
    return make_error(ErrorCode::usage, "up and forward lie on the same axis",
                      "name two different axes of the file");
  }
  if (!transform.origin_m.allFinite()) {
    return make_error(ErrorCode::usage, "the origin has to be finite");
  }
  return Success{};
}

Status transform_mesh(TriangleMesh& mesh, const ImportTransform& transform) {
  if (Status status = check(transform); !status) return status;
  std::vector<Eigen::Vector3f> moved;
  moved.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    moved.emplace_back(apply(transform, vertex.cast<double>()).cast<float>());
    if (!moved.back().allFinite()) {
      return make_error(ErrorCode::bad_input,
                        "the transform moves a vertex beyond the range of float32",
                        "check scale and origin");
    }
  }
  mesh.vertices = std::move(moved);
  return Success{};
}

}  // namespace crashrank
