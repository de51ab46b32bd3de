#include "crashrank/report/ranking.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace crashrank {
namespace {

/// Two triangles that share an edge, each a part; the names want escaping.
TriangleMesh two_parts() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 3}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.parts = {{"hood \"<\\>\"", 0, 1}, {"door", 1, 1}};
  return mesh;
}

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

float f32(const std::string& bytes, std::size_t at) {
  const std::uint32_t bits = u32(bytes, at);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

TEST(DamageGlb, HoldsWhatTheFormatAsksFor) {
  const std::vector<std::uint32_t> damaged{1};
  const Result<std::string> glb = damage_glb(two_parts(), damaged);
  ASSERT_TRUE(glb.ok());
  EXPECT_EQ(glb->substr(0, 4), "glTF");
  EXPECT_EQ(u32(*glb, 4), 2U);
  EXPECT_EQ(u32(*glb, 8), glb->size());
  const std::size_t json_bytes = u32(*glb, 12);
  EXPECT_EQ(json_bytes % 4, 0U);
  EXPECT_EQ(glb->substr(16, 4), "JSON");
  const auto document = nlohmann::json::parse(glb->substr(20, json_bytes));
  const std::size_t binary = 20 + json_bytes;
  EXPECT_EQ(u32(*glb, binary), document["buffers"][0]["byteLength"]);
  EXPECT_EQ(glb->substr(binary + 4, 3), "BIN");
  EXPECT_EQ(binary + 8 + u32(*glb, binary), glb->size());

  ASSERT_EQ(document["meshes"].size(), 2U);
  EXPECT_EQ(document["meshes"][0]["name"], "hood \"<\\>\"");
  const auto material_of = [&](std::size_t mesh) {
    EXPECT_EQ(document["meshes"][mesh]["primitives"].size(), 1U);
    return document["materials"][document["meshes"][mesh]["primitives"][0]["material"]
                                     .get<std::size_t>()]["name"]
        .get<std::string>();
  };
  EXPECT_EQ(material_of(0), "intact");
  EXPECT_EQ(material_of(1), "damaged");

  // Indices stay inside their part's vertices, and min and max are those of the positions.
  for (const auto& mesh : document["meshes"]) {
    const auto& primitive = mesh["primitives"][0];
    const auto& positions =
        document["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    const auto& indices = document["accessors"][primitive["indices"].get<std::size_t>()];
    const auto begin = [&](const auto& accessor) {
      return binary + 8 +
             document["bufferViews"][accessor["bufferView"].template get<std::size_t>()]
                     ["byteOffset"]
                         .template get<std::size_t>();
    };
    EXPECT_EQ(positions["count"], 3);
    EXPECT_EQ(indices["count"], 3);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT(u32(*glb, begin(indices) + 4 * i), 3U);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float x = f32(*glb, begin(positions) + 12 * i + 4 * axis);
        EXPECT_GE(x, positions["min"][axis].get<float>());
        EXPECT_LE(x, positions["max"][axis].get<float>());
      }
    }
  }
}

TEST(DamagePly, ColoursFollowTheTriangles) {
  const std::vector<std::uint32_t> damaged{1};
  const TriangleMesh mesh = two_parts();
  const std::string ply = damage_ply(mesh, damaged);
  EXPECT_EQ(ply.substr(0, 4), "ply\n");
  EXPECT_NE(ply.find("element vertex 6\n"),
            std::string::npos);  // the shared edge stands in it twice
  EXPECT_NE(ply.find("element face 2\n"), std::string::npos);
  const std::size_t vertices = ply.find("end_header\n") + 11;
  constexpr std::size_t vertex_bytes = 15;
  constexpr std::size_t face_bytes = 13;
  const std::size_t faces = vertices + 6 * vertex_bytes;
  ASSERT_EQ(ply.size(), faces + 2 * face_bytes);
  for (std::size_t t = 0; t < 2; ++t) {
    EXPECT_EQ(ply[faces + t * face_bytes], 3);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = vertices + vertex_bytes * u32(ply, faces + t * face_bytes + 1 + 4 * k);
      const Eigen::Vector3f& corner = mesh.vertices[mesh.triangles[t][k]];
      EXPECT_EQ(Eigen::Vector3f(f32(ply, at), f32(ply, at + 4), f32(ply, at + 8)), corner);
      const auto red = static_cast<unsigned char>(ply[at + 12]);
      const auto green = static_cast<unsigned char>(ply[at + 13]);
      EXPECT_EQ(red > 2 * green, t == 1);
    }
  }
}

TEST(DamageModels, EverythingOrNothingMayBeDamaged) {
  const TriangleMesh mesh = two_parts();
  const std::vector<std::uint32_t> all{0, 1};
  EXPECT_TRUE(damage_glb(mesh, {}).ok());
  EXPECT_TRUE(damage_glb(mesh, all).ok());
  EXPECT_NE(damage_ply(mesh, all), damage_ply(mesh, {}));
}

}  // namespace
}  // namespace crashrank
