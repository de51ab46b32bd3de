#include "crashrank/mesh/import.hpp"

#include "mesh/scratch_dir.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    const Triangle triangle = mesh.triangle(t);
    const Eigen::Vector3d a = triangle.corner[0].cast<double>();
    const Eigen::Vector3d b = triangle.corner[1].cast<double>();
    sum += 0.5 * (b - a).cross(triangle.corner[2].cast<double>() - a).norm();
  }
  return sum;
}

std::string warnings(const ImportedMesh& imported) {
  std::string text;
  for (const std::string& warning : imported.warnings) text += warning + "\n";
  return text;
}

// An L of six corners and 3 m², whose corners are such that a fan around the last one or ears that
// do not look for corners inside would fill its notch.
constexpr const char* plain = "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n";
constexpr const char* list = "0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0";

std::string obj() {
  return "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 3 4 5 6 1 2\n";
}

std::string ply() {
  return std::string(
             "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
             "property float z\nelement face 1\n"
             "property list uchar int vertex_indices\nend_header\n") +
         plain + "6 2 3 4 5 0 1\n";
}

std::string off() { return std::string("OFF\n6 1 0\n") + plain + "6 2 3 4 5 0 1\n"; }

std::string ac3d() {
  std::string text =
      "AC3Db\nMATERIAL \"m\" rgb 1 1 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 1"
      "  trans 0\nOBJECT world\nkids 1\nOBJECT poly\nname \"l\"\nnumvert 6\n";
  text += plain;
  text += "numsurf 1\nSURF 0x20\nmat 0\nrefs 6\n";
  for (const char* corner : {"2", "3", "4", "5", "0", "1"}) text.append(corner).append(" 0 0\n");
  return text + "kids 0\n";
}

std::string collada(const std::string& surfaces) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="18">)" +
         std::string(list) + R"(</float_array><technique_common>
<accessor source="#a" count="6" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)" +
         surfaces + R"(</mesh></geometry></library_geometries><library_visual_scenes>
<visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string fbx() {
  std::string vertices = list;
  for (char& c : vertices) c = c == ' ' ? ',' : c;
  return "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n  FBXHeaderVersion: 1003\n"
         "  FBXVersion: 7300\n}\nGlobalSettings:  {\n  Version: 1000\n  Properties70:  {\n"
         "    P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n  }\n}\nObjects:  {\n"
         "  Geometry: 1, \"Geometry::l\", \"Mesh\" {\n    Vertices: *18 {\n      a: " +
         vertices +
         "\n    }\n    PolygonVertexIndex: *6 {\n      a: 2,3,4,5,0,-2\n    }\n"
         "    GeometryVersion: 124\n  }\n  Model: 2, \"Model::l\", \"Mesh\" {\n    Version: 232\n"
         "  }\n}\nConnections:  {\n  C: \"OO\",2,0\n  C: \"OO\",1,2\n}\n";
}

TEST(PolygonFormat, AConcavePolygonKeepsItsAreaInEveryFormatThatHasPolygons) {
  const std::vector<std::pair<std::string, std::string>> files{
      {"l.obj", obj()},
      {"l.ply", ply()},
      {"l.off", off()},
      {"l.ac", ac3d()},
      {"list.dae", collada("<polylist count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" "
                           "offset=\"0\"/><vcount>6</vcount><p>2 3 4 5 0 1</p></polylist>")},
      {"polygons.dae", collada("<polygons count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" "
                               "offset=\"0\"/><p>2 3 4 5 0 1</p></polygons>")},
      {"l.fbx", fbx()}};
  const test::ScratchDir dir;
  for (const auto& [name, text] : files) {
    SCOPED_TRACE(name);
    const Result<ImportedMesh> imported = import_mesh(dir.write(name, text));
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    EXPECT_EQ(imported->mesh.size(), 4U);
    EXPECT_NEAR(area(imported->mesh), 3.0, 1e-6);
    EXPECT_EQ(warnings(*imported).find("crosses"), std::string::npos) << warnings(*imported);
  }
}

TEST(PolygonFormat, PolygonsThatCrossThemselvesAreCounted) {
  const test::ScratchDir dir;
  const std::string bow_tie = "o bow\nv 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3 4\n";
  const Result<ImportedMesh> one = import_mesh(dir.write("one.obj", bow_tie));
  ASSERT_TRUE(one.ok()) << one.error().message();
  EXPECT_EQ(one->mesh.size(), 3U);
  EXPECT_NE(warnings(*one).find("1 polygon crosses itself: mesh 'bow', face 1;"), std::string::npos)
      << warnings(*one);
  const Result<ImportedMesh> two = import_mesh(dir.write("two.obj", bow_tie + "f 1 2 3 4\n"));
  ASSERT_TRUE(two.ok()) << two.error().message();
  EXPECT_NE(warnings(*two).find("2 polygons cross themselves"), std::string::npos)
      << warnings(*two);
}

TEST(PolygonFormat, TrianglesOfAPolygonStandInItsPlace) {
  const test::ScratchDir dir;
  const Result<ImportedMesh> imported = import_mesh(dir.write(
      "a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 5\nf 1 2 3 4\nf 2 3 5\n"));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  ASSERT_EQ(imported->mesh.size(), 4U);
  const auto corner = [&](std::size_t t, std::size_t c) {
    return imported->mesh.triangle(t).corner[c];
  };
  EXPECT_EQ(corner(1, 0), Eigen::Vector3f(0, 0, 0));
  EXPECT_EQ(corner(1, 2), Eigen::Vector3f(1, 1, 0));
  EXPECT_EQ(corner(2, 2), Eigen::Vector3f(0, 1, 0));
  EXPECT_EQ(corner(3, 0), Eigen::Vector3f(1, 0, 0));
}

}  // namespace
}  // namespace crashrank
