#include "model.hpp"

#include "arrays.hpp"
#include "error.hpp"

#include "base/convex_hull.hpp"
#include "crashrank/mesh/import.hpp"
#include "crashrank/mesh/properties.hpp"
#include "crashrank/mesh/triangle_mesh.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>
#include <tuple>
#include <utility>

namespace crashrank::python {
namespace {

using PartTuple = std::tuple<std::string, std::uint32_t, std::uint32_t>;
using VertexArray = nb::ndarray<nb::numpy, const float, nb::shape<-1, 3>>;
using FaceArray = nb::ndarray<nb::numpy, const std::uint32_t, nb::shape<-1, 3>>;
using PointArray = nb::ndarray<nb::numpy, double, nb::shape<-1, 2>>;

SharedBody make_body(const Given<float, nb::shape<-1, 3>>& vertices,
                     const Given<std::uint32_t, nb::shape<-1, 3>>& faces,
                     const std::vector<PartTuple>& parts) {
  TriangleMesh mesh;
  std::vector<Eigen::Vector3f> points(vertices.shape(0));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float* const at = vertices.data() + 3 * i;
    points[i] = {at[0], at[1], at[2]};
  }
  std::vector<std::array<std::uint32_t, 3>> corners(faces.shape(0));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t* const at = faces.data() + 3 * i;
    corners[i] = {at[0], at[1], at[2]};
  }
  mesh.vertices = std::move(points);
  mesh.triangles = std::move(corners);
  for (const auto& [name, first, count] : parts) mesh.parts.push_back({name, first, count});

  const nb::gil_scoped_release unlocked;
  auto body = std::make_shared<Body>();
  body->stored.model = shareable(value_of(make_model(std::move(mesh))));
  body->stored.mass = shell_properties(body->stored.model.mesh);
  return body;
}

std::shared_ptr<Body> load_compiled(const std::string& path) {
  LoadedModel loaded = value_of(load_model(path));
  auto body = std::make_shared<Body>();
  body->stored = std::move(loaded.stored);
  return body;
}

SharedBody load_body(const std::string& path, double scale, const std::string& up,
                     const std::string& forward, std::array<double, 3> origin_m) {
  ImportOptions options;
  options.importer = importer_path();
  options.transform.scale = scale;
  options.transform.up = value_of(axis_from_name(up));
  options.transform.forward = value_of(axis_from_name(forward));
  options.transform.origin_m = {origin_m[0], origin_m[1], origin_m[2]};
  check(check(options.transform));
  const ImportTransform none;
  const bool given = scale != none.scale || options.transform.up != none.up ||
                     options.transform.forward != none.forward ||
                     options.transform.origin_m != none.origin_m;

  const nb::gil_scoped_release unlocked;
  if (is_model_file(path)) {
    if (given) {
      throw Failure({ErrorCode::usage,
                     path,
                     {},
                     "a model file is in body coordinates already",
                     "give scale, up, forward and origin when its mesh is loaded"});
    }
    return load_compiled(path);
  }
  ImportedMesh imported = value_of(import_mesh(path, options));
  Result<Model> model = make_model(std::move(imported.mesh));
  if (!model) {
    if (model.error().file.empty()) model.error().file = path;
    throw Failure(model.error());
  }
  auto body = std::make_shared<Body>();
  body->stored.model = shareable(std::move(*model));
  body->stored.transform = options.transform;
  body->stored.mass = shell_properties(body->stored.model.mesh);
  body->warnings = std::move(imported.warnings);
  return body;
}

void save_body(const Body& body, const std::string& path, bool overwrite,
               std::optional<double> mass_kg) {
  const nb::gil_scoped_release unlocked;
  if (!mass_kg) return check(save_model(body.stored, path, overwrite));
  StoredModel stated = body.stored;
  stated.stated.mass_kg = mass_kg;
  check(check_stated_mass(stated.stated, stated.model.mesh.bounds()));
  check(save_model(stated, path, overwrite));
}

VertexArray vertices_of(const Body& body) {
  const TriangleMesh& mesh = body.model().mesh;
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const auto* const data = reinterpret_cast<const float*>(mesh.vertices.data());
  return VertexArray(data, {mesh.vertices.size(), 3});
}

FaceArray faces_of(const Body& body) {
  const TriangleMesh& mesh = body.model().mesh;
  const auto* const data = reinterpret_cast<const std::uint32_t*>(mesh.triangles.data());
  return FaceArray(data, {mesh.triangles.size(), 3});
}

std::array<std::array<double, 3>, 2> bounds_of(const Body& body) {
  const Box box = body.model().mesh.bounds();
  std::array<std::array<double, 3>, 2> corners{};
  for (int i = 0; i < 3; ++i) {
    corners[0][static_cast<std::size_t>(i)] = static_cast<double>(box.min[i]);
    corners[1][static_cast<std::size_t>(i)] = static_cast<double>(box.max[i]);
  }
  return corners;
}

std::vector<PartTuple> parts_of(const Body& body) {
  std::vector<PartTuple> parts;
  for (const Part& part : body.model().mesh.parts) {
    parts.emplace_back(part.name, part.first_triangle, part.triangle_count);
  }
  return parts;
}

PointArray outline_of(const Body& body) {
  std::vector<double> corners = outline_corners(body.model().mesh);
  const std::size_t count = corners.size() / 2;
  return make_array<double, nb::shape<-1, 2>>(std::move(corners), {count, 2});
}

std::string& importer() {
  static std::string path;
  return path;
}

}  // namespace

std::string importer_path() { return importer(); }

std::vector<double> outline_corners(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    points.emplace_back(static_cast<double>(vertex.x()), static_cast<double>(vertex.y()));
  }
  std::vector<double> corners;
  for (const Eigen::Vector2d& corner : detail::convex_hull(std::move(points))) {
    corners.push_back(corner.x());
    corners.push_back(corner.y());
  }
  return corners;
}

void bind_models(nb::module_& module) {
  nb::class_<Body>(module, "Body", "A mesh with the trees over it; never changes.")
      .def_prop_ro("vertices", &vertices_of, "float32, body coordinates, m; looks into the body.")
      .def_prop_ro("faces", &faces_of, "Corner indices by triangle; looks into the body.")
      .def_prop_ro("bounds", &bounds_of, "Lowest and highest corner of the box, m.")
      .def_prop_ro("parts", &parts_of, "Name, first triangle and number of triangles of each.")
      .def_prop_ro("outline", &outline_of, nb::rv_policy::automatic,
                   "Convex hull seen from above, m.")
      .def_prop_ro(
          "mass_kg", [](const Body& body) { return body.stored.stated.mass_kg; },
          "As the model file states it.")
      .def_ro("warnings", &Body::warnings, "What was found in the file that it came from.");
  module.def("make_body", &make_body, nb::arg("vertices").noconvert(), nb::arg("faces").noconvert(),
             nb::arg("parts"), "Copies the arrays and builds the trees.");
  module.def("load_body", &load_body, nb::arg("path"), nb::arg("scale"), nb::arg("up"),
             nb::arg("forward"), nb::arg("origin_m"), "Reads a mesh or a model file.");
  module.def("save_body", &save_body, nb::arg("body"), nb::arg("path"), nb::arg("overwrite"),
             nb::arg("mass_kg").none(), "Writes a model file.");
  module.def(
      "set_importer", [](const std::string& path) { importer() = path; }, nb::arg("path"),
      "Names the program that parses mesh files; empty: the library looks for it.");
}

}  // namespace crashrank::python
