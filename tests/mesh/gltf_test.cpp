#include "crashrank/mesh/import.hpp"

#include "mesh/gltf_writer.hpp"
#include "mesh/mesh_writers.hpp"
#include "mesh/scratch_dir.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <string>
#include <vector>

// Each construct of glTF 2.0 that decides about the surface, in a small file written by hand, held
// against the text of the format.
namespace crashrank {
namespace {

using test::box_primitive;
using test::GltfWriter;
using test::ScratchDir;

std::string number(int value) { return std::to_string(value); }

Result<ImportedMesh> import_glb(const std::string& bytes) {
  const ScratchDir dir;
  return import_mesh(dir.write("car.glb", bytes));
}

double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    const Triangle triangle = mesh.triangle(t);
    const Eigen::Vector3d a = triangle.corner[0].cast<double>();
    sum += a.dot(triangle.corner[1].cast<double>().cross(triangle.corner[2].cast<double>()));
  }
  return sum / 6.0;
}

void expect_mesh(const std::string& bytes, std::size_t triangles, const Eigen::Vector3d& least,
                 const Eigen::Vector3d& greatest, double cubic_metres, double tolerance_m = 0.0) {
  const Result<ImportedMesh> imported = import_glb(bytes);
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->mesh.size(), triangles);
  const auto bounds = imported->mesh.bounds();
  EXPECT_LE((bounds.min.cast<double>() - least).cwiseAbs().maxCoeff(), tolerance_m)
      << bounds.min.transpose();
  EXPECT_LE((bounds.max.cast<double>() - greatest).cwiseAbs().maxCoeff(), tolerance_m)
      << bounds.max.transpose();
  EXPECT_NEAR(volume(imported->mesh), cubic_metres, 1e-6 + 20.0 * tolerance_m);
}

void expect_refused(const std::string& bytes, const std::string& reason) {
  const Result<ImportedMesh> imported = import_glb(bytes);
  ASSERT_FALSE(imported.ok()) << reason;
  EXPECT_NE(imported.error().message().find(reason), std::string::npos)
      << imported.error().message();
  EXPECT_NE(imported.error().code, ErrorCode::internal);
  EXPECT_EQ(imported.error().message().find('\n'), std::string::npos);
}

// One box in a node with the given members beside its mesh.
GltfWriter box_in_node(const std::string& node, const std::string& mesh = "") {
  GltfWriter writer;
  writer.mesh(box_primitive(writer), mesh);
  writer.node("\"mesh\":0" + node);
  return writer;
}

std::string box_as(int positions, GltfWriter& writer, const std::string& node = "") {
  writer.mesh("\"attributes\":{\"POSITION\":" + number(positions) +
              "},\"indices\":" + number(writer.accessor(test::box_indices(), "SCALAR")));
  writer.node("\"mesh\":0" + node);
  return writer.glb();
}

TEST(Gltf, NodesScaleTurnAndMirror) {
  expect_mesh(box_in_node("").glb(), 12, {-1, -1, 0}, {3, 1, 1}, 8.0);
  expect_mesh(box_in_node(",\"scale\":[-1,1,1]").glb(), 12, {-3, -1, 0}, {1, 1, 1}, 8.0);
  expect_mesh(box_in_node(R"(,"translation":[1,2,3],"scale":[2,1,1])").glb(), 12, {-1, 1, 3},
              {7, 3, 4}, 16.0);
  // A quarter turn about z.
  expect_mesh(box_in_node(R"(,"rotation":[0,0,0.7071067811865476,0.7071067811865476])").glb(), 12,
              {-1, -1, 0}, {1, 3, 1}, 8.0, 1e-6);
  // Column by column: x to y, y to x, a mirror.
  expect_mesh(box_in_node(R"(,"matrix":[0,1,0,0,1,0,0,0,0,0,1,0,5,0,0,1])").glb(), 12, {4, -1, 0},
              {6, 3, 1}, 8.0);
}

TEST(Gltf, NodesHangOnEachOtherInDouble) {
  // 1e8 m away and back: single precision would lose the box.
  GltfWriter writer;
  writer.mesh(box_primitive(writer));
  writer.node(R"("children":[1],"translation":[-100000000,0,0])");
  writer.node(R"("mesh":0,"translation":[100000000.25,0,0])");
  writer.root(0);
  expect_mesh(writer.glb(), 12, {-0.75, -1, 0}, {3.25, 1, 1}, 8.0);
}

TEST(Gltf, SparseAccessorsOverrideTheirBase) {
  const Result<ImportedMesh> imported = import_glb(test::sparse_box());
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->mesh.size(), 12U);
  EXPECT_EQ(imported->quality.extent_m.z(), 2.0);
  // Without a base the others are zero.
  GltfWriter writer;
  const int indices = writer.view(test::bytes_of(std::vector<std::uint16_t>{1, 2}));
  const int values = writer.view(test::bytes_of(std::vector<float>{4, 0, 0, 0, 2, 1}));
  const int accessor = writer.raw_accessor(
      R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":)" +
      number(indices) + R"(,"componentType":5123},"values":{"bufferView":)" + number(values) +
      "}}");
  writer.mesh("\"attributes\":{\"POSITION\":" + number(accessor) + "}");
  writer.node("\"mesh\":0");
  expect_mesh(writer.glb(), 1, {0, 0, 0}, {4, 2, 1}, 0.0);
}

TEST(Gltf, QuantisedPositionsAreNormalisedAsTheFormatSays) {
  expect_mesh(test::quantised_box(), 12, {-1, -1, 0}, {3, 1, 1}, 8.0, 1e-4);
  // In bytes of 4 m / 255, and in whole metres.
  GltfWriter bytes;
  std::vector<std::uint8_t> small;
  std::vector<std::int8_t> whole;
  for (const Eigen::Vector3d& corner : test::box_corners()) {
    for (const double value : {corner.x() + 1.0, corner.y() + 1.0, corner.z(), 0.0}) {
      small.push_back(static_cast<std::uint8_t>(std::lround(value / 4.0 * 255.0)));
    }
    for (const double value : {corner.x(), corner.y(), corner.z(), 0.0}) {
      whole.push_back(static_cast<std::int8_t>(std::lround(value)));
    }
  }
  const int positions = bytes.raw_accessor(
      "\"bufferView\":" + number(bytes.view(test::bytes_of(small), ",\"byteStride\":4")) +
      R"(,"componentType":5121,"normalized":true,"count":8,"type":"VEC3")");
  expect_mesh(box_as(positions, bytes, R"(,"scale":[4,4,4],"translation":[-1,-1,0])"), 12,
              {-1, -1, 0}, {3, 1, 1}, 8.0, 0.01);
  GltfWriter metres;
  const int integers = metres.raw_accessor(
      "\"bufferView\":" + number(metres.view(test::bytes_of(whole), ",\"byteStride\":4")) +
      R"(,"componentType":5120,"count":8,"type":"VEC3")");
  expect_mesh(box_as(integers, metres), 12, {-1, -1, 0}, {3, 1, 1}, 8.0);
}

TEST(Gltf, InstancesEachCount) {
  GltfWriter writer;
  const std::string primitive = box_primitive(writer);
  const int places = writer.accessor(std::vector<float>{0, 0, 0, 10, 0, 0, 0, 0, 5}, "VEC3");
  // None, none, a quarter turn about z in normalised 16 bits.
  const int turns =
      writer.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 23170, 23170},
                      "VEC4", ",\"normalized\":true");
  const int sizes = writer.accessor(std::vector<float>{1, 1, 1, 2, 1, 1, 1, 1, 1}, "VEC3");
  writer.mesh(primitive);
  writer.node(R"("name":"post","mesh":0,"translation":[0,0,1],"extensions":{)"
              R"("EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
              number(places) + ",\"ROTATION\":" + number(turns) + ",\"SCALE\":" + number(sizes) +
              "}}}");
  writer.add(R"("extensionsRequired":["EXT_mesh_gpu_instancing"])");
  const Result<ImportedMesh> imported = import_glb(writer.glb());
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  ASSERT_EQ(imported->mesh.size(), 36U);
  ASSERT_EQ(imported->mesh.parts.size(), 3U);
  EXPECT_EQ(imported->mesh.parts[2].name, "post.3");
  EXPECT_NEAR(volume(imported->mesh), 8.0 + 16.0 + 8.0, 1e-4);
  const auto bounds = imported->mesh.bounds();
  EXPECT_EQ(bounds.max, Eigen::Vector3f(16, 3, 7));
  EXPECT_EQ(bounds.min, Eigen::Vector3f(-1, -1, 1));
}

TEST(Gltf, DefaultWeightsMorph) {
  for (const auto& [mesh, node, height] : std::vector<std::tuple<std::string, std::string, double>>{
           {",\"weights\":[1]", "", 2.0},
           {",\"weights\":[1]", ",\"weights\":[0.5]", 1.5},
           {",\"weights\":[1]", ",\"weights\":[0]", 1.0},
           {"", "", 1.0}}) {
    SCOPED_TRACE(mesh + node);
    GltfWriter writer;
    std::vector<float> offsets(24, 0.0F);
    for (std::size_t corner = 4; corner < 8; ++corner) offsets[3 * corner + 2] = 1.0F;
    const int target = writer.accessor(offsets, "VEC3");
    writer.mesh(box_primitive(writer) + ",\"targets\":[{\"POSITION\":" + number(target) + "}]",
                mesh);
    writer.node("\"mesh\":0" + node);
    expect_mesh(writer.glb(), 12, {-1, -1, 0}, {3, 1, height}, 8.0 * height);
  }
}

TEST(Gltf, HiddenNodesAndWhatHangsOnThemAreLeftOut) {
  GltfWriter writer;
  writer.mesh(box_primitive(writer));
  writer.node("\"mesh\":0");
  writer.node(R"("mesh":0,"translation":[9,0,0],"children":[2],)"
              R"("extensions":{"KHR_node_visibility":{"visible":false}})");
  writer.node(R"("mesh":0,"translation":[0,0,9],)"
              R"("extensions":{"KHR_node_visibility":{"visible":true}})");
  writer.root(0);
  writer.root(1);
  expect_mesh(writer.glb(), 12, {-1, -1, 0}, {3, 1, 1}, 8.0);
}

TEST(Gltf, RequiredExtensionsThatAreNotSupportedAreRefusedByName) {
  GltfWriter unknown = box_in_node("");
  unknown.add(R"("extensionsRequired":["KHR_mesh_quantization","EXT_mesh_of_tomorrow"])");
  expect_refused(unknown.glb(), "the extension 'EXT_mesh_of_tomorrow' is not supported");
  GltfWriter paint = box_in_node("");
  paint.add(R"("extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"])");
  expect_mesh(paint.glb(), 12, {-1, -1, 0}, {3, 1, 1}, 8.0);
}

TEST(Gltf, StripsAndFansTurnAsTheFormatSays) {
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
  for (const auto& [mode, indices, triangles] :
       std::vector<std::tuple<int, std::vector<std::uint8_t>, std::size_t>>{
           {5, {}, 3}, {5, {0, 1, 2, 3}, 2}, {6, {0, 1, 3, 2}, 2}, {6, {0, 1, 3, 4}, 2}}) {
    GltfWriter writer;
    std::string primitive = "\"mode\":" + number(mode) + ",\"attributes\":{\"POSITION\":" +
                            number(writer.accessor(corners, "VEC3")) + "}";
    if (!indices.empty()) primitive += ",\"indices\":" + number(writer.accessor(indices, "SCALAR"));
    writer.mesh(primitive);
    writer.node("\"mesh\":0");
    const Result<ImportedMesh> imported = import_glb(writer.glb());
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    ASSERT_EQ(imported->mesh.size(), triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
      const Triangle triangle = imported->mesh.triangle(t);
      const Eigen::Vector3f normal =
          (triangle.corner[1] - triangle.corner[0]).cross(triangle.corner[2] - triangle.corner[0]);
      EXPECT_GT(normal.z(), 0.0F) << "mode " << mode << ", triangle " << t;
    }
  }
}

TEST(Gltf, TheDefaultSceneAloneIsRead) {
  const auto two_scenes = [](const std::string& scene, bool scenes) {
    GltfWriter writer;
    writer.mesh(box_primitive(writer));
    writer.node("\"mesh\":0");
    writer.node(R"("mesh":0,"translation":[9,0,0])");
    if (scenes) writer.scenes(R"({"nodes":[0]},{"nodes":[1]})");
    if (!scene.empty()) writer.add(scene);
    return writer.glb();
  };
  expect_mesh(two_scenes("\"scene\":1", true), 12, {8, -1, 0}, {12, 1, 1}, 8.0);
  expect_mesh(two_scenes("", true), 12, {-1, -1, 0}, {3, 1, 1}, 8.0);
  expect_mesh(two_scenes("", false), 24, {-1, -1, 0}, {12, 1, 1}, 16.0);
  expect_refused(two_scenes("\"scene\":2", true), "scene 2: there is none of that number");
}

TEST(Gltf, SkinsStandAtRest) {
  // In centimetres, on a joint that makes metres of them, 1 m up; the node itself does not count.
  GltfWriter writer;
  std::vector<float> positions = test::box_positions();
  for (float& value : positions) value *= 100.0F;
  const int shape = writer.accessor(positions, "VEC3");
  const int joints = writer.accessor(std::vector<std::uint8_t>(32, 0), "VEC4");
  std::vector<float> shares(32, 0.0F);
  for (std::size_t vertex = 0; vertex < 8; ++vertex) shares[4 * vertex] = 1.0F;
  const int weights = writer.accessor(shares, "VEC4");
  // From the joint's rest: half a metre down, column by column.
  const int bind =
      writer.accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -50, 1}, "MAT4");
  writer.mesh("\"attributes\":{\"POSITION\":" + number(shape) + ",\"JOINTS_0\":" + number(joints) +
              ",\"WEIGHTS_0\":" + number(weights) +
              "},\"indices\":" + number(writer.accessor(test::box_indices(), "SCALAR")));
  writer.node(R"("mesh":0,"skin":0,"translation":[7,7,7])");
  writer.node(R"("scale":[0.01,0.01,0.01],"translation":[0,0,1])");
  writer.add("\"skins\":[{\"joints\":[1],\"inverseBindMatrices\":" + number(bind) + "}]");
  expect_mesh(writer.glb(), 12, {-1, -1, 0.5}, {3, 1, 1.5}, 8.0, 1e-6);
}

TEST(Gltf, CompressedMeshesAreRead) {
  expect_mesh(test::meshopt_box(), 12, {-1, -1, 0}, {3, 1, 1}, 8.0);
  expect_mesh(test::draco_box(), 12, {-1, -1, 0}, {3, 1, 1}, 8.0, 1e-5);
}

TEST(Gltf, DracoPrimitivesMayHaveMoreThan65536Vertices) {
  const Result<ImportedMesh> imported = import_glb(test::draco_grid(300, 250));
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->mesh.size(), 2U * 299U * 249U);
  EXPECT_EQ(imported->mesh.vertices.size(), 75'000U);
}

TEST(Gltf, IndicesOfEveryWidthAndInterleavedVerticesAreRead) {
  const std::vector<std::uint16_t> indices = test::box_indices();
  GltfWriter writer;
  // Position and normal side by side, the position second.
  std::vector<float> vertices;
  for (const Eigen::Vector3d& corner : test::box_corners()) {
    vertices.insert(vertices.end(),
                    {0.0F, 0.0F, 1.0F, static_cast<float>(corner.x()),
                     static_cast<float>(corner.y()), static_cast<float>(corner.z())});
  }
  const int view = writer.view(test::bytes_of(vertices), ",\"byteStride\":24");
  const int positions =
      writer.raw_accessor("\"bufferView\":" + number(view) +
                          R"(,"byteOffset":12,"componentType":5126,"count":8,"type":"VEC3")");
  const int bytes =
      writer.accessor(std::vector<std::uint8_t>(indices.begin(), indices.end()), "SCALAR");
  const int words =
      writer.accessor(std::vector<std::uint32_t>(indices.begin(), indices.end()), "SCALAR");
  for (const int width : {bytes, words}) {
    writer.mesh("\"attributes\":{\"POSITION\":" + number(positions) +
                "},\"indices\":" + number(width));
  }
  writer.node("\"mesh\":0");
  writer.node(R"("mesh":1,"translation":[0,5,0])");
  expect_mesh(writer.glb(), 24, {-1, -1, 0}, {3, 6, 1}, 16.0);
}

TEST(Gltf, BuffersMayBeLargerThanTheySayAndDataOfAnyType) {
  GltfWriter writer = box_in_node("");
  const ScratchDir dir;
  dir.write("car.bin", writer.buffer() + std::string(100, 'x'));
  const Result<ImportedMesh> named = import_mesh(dir.write("car.gltf", writer.json("car.bin")));
  ASSERT_TRUE(named.ok()) << named.error().message();
  EXPECT_EQ(named->mesh.size(), 12U);
  dir.write("car.bin", writer.buffer().substr(1));
  const Result<ImportedMesh> cut = import_mesh(dir.write("car.gltf", writer.json("car.bin")));
  ASSERT_FALSE(cut.ok());
  EXPECT_NE(cut.error().message().find("byteLength promises"), std::string::npos);
  // Three vertices of zeros but for the last numbers of two: "AACAPw" is 1.0 after two zero bytes.
  GltfWriter triangle;
  triangle.view(std::string(36, '\0'));
  triangle.raw_accessor(R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")");
  triangle.mesh(R"("attributes":{"POSITION":0})");
  triangle.node("\"mesh\":0");
  const std::string zeros(16, 'A');
  const std::string uri = "data:model/bin;base64," + zeros + "AACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
  const Result<ImportedMesh> data = import_mesh(dir.write("data.gltf", triangle.json(uri)));
  ASSERT_TRUE(data.ok()) << data.error().message();
  EXPECT_EQ(data->mesh.size(), 1U);
  EXPECT_EQ(data->quality.extent_m, Eigen::Vector3d(1, 1, 0));
}

TEST(Gltf, MaterialsTexturesAndAnimationsAreNotAskedFor) {
  GltfWriter writer = box_in_node("");
  writer.add(R"("images":[{"uri":"../paint.png"},{"bufferView":99}],"textures":[{"source":7}])");
  writer.add(R"("animations":[{"channels":[],"samplers":[]}],"materials":[{"name":"paint"}])");
  const Result<ImportedMesh> imported = import_glb(writer.glb());
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_TRUE(imported->warnings.empty());
}

TEST(Gltf, FaultsAreNamed) {
  expect_refused(box_in_node(",\"scale\":[1,1]").glb(), "too few or too many numbers");
  expect_refused(box_in_node(R"(,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1])").glb(),
                 "not finite and affine");
  expect_refused(box_in_node(",\"children\":[5]").glb(), "names a child that is not there");
  expect_refused(box_in_node(",\"skin\":3").glb(), "skin 3: there is none");
  GltfWriter twice = box_in_node("");
  twice.node("\"children\":[0]");
  twice.node("\"children\":[0]");
  expect_refused(twice.glb(), "no tree");
  GltfWriter many;
  expect_refused(
      box_as(many.raw_accessor(R"("componentType":5126,"count":4000000000,"type":"VEC3")"), many),
      "accessor 0 has 4000000000 elements");
  GltfWriter wrong;
  expect_refused(box_as(wrong.accessor(test::box_positions(), "SCALAR"), wrong), "another type");
  GltfWriter narrow;
  const int view = narrow.view(test::bytes_of(test::box_positions()), ",\"byteStride\":8");
  expect_refused(box_as(narrow.raw_accessor("\"bufferView\":" + number(view) +
                                            R"(,"componentType":5126,"count":8,"type":"VEC3")"),
                        narrow),
                 "out of range");
  GltfWriter version = box_in_node("");
  std::string json = version.json();
  json.replace(json.find("2.0"), 3, "3.0");
  expect_refused(test::glb(json, version.buffer()), "version '3.0'");
  std::string deep = box_in_node("").json();
  deep.insert(1, R"("extensions":)" + std::string(100'000, '[') + std::string(100'000, ']') + ",");
  EXPECT_TRUE(import_glb(test::glb(deep, box_in_node("").buffer())).ok());
}

TEST(Gltf, DamagedCompressedDataAreNamed) {
  const auto with = [](std::string bytes, const std::string& what, const std::string& by) {
    const std::size_t at = bytes.find(what);
    EXPECT_NE(at, std::string::npos);
    return bytes.replace(at, what.size(), by);
  };
  const std::string meshopt = test::meshopt_box();
  expect_refused(with(meshopt, "\"TRIANGLES\"", "\"ATTRIBUTE\""), "do not fit together");
  expect_refused(with(meshopt, "\"byteStride\":12", "\"byteStride\":13"), "do not fit together");
  expect_refused(with(meshopt, "\"count\":36,\"mode\"", "\"count\":99,\"mode\""), "do not fit");
  // The first byte of compressed vertices has the kind and version of their coding.
  expect_refused(with(meshopt, std::string("BIN\0\xa0", 5), std::string("BIN\0\x11", 5)),
                 "data are damaged");
  expect_refused(with(test::draco_box(), "DRACO", "BRACO"), "KHR_draco_mesh_compression: ");
}

}  // namespace
}  // namespace crashrank
