#pragma once

#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/tree/build.hpp"
#include "model/model_layout.hpp"
#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::test {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

// A folder of its own, gone with the test.
class ModelFile : public ::testing::Test {
protected:
  ModelFile() {
    std::string name = (fs::path(::testing::TempDir()) / "crashrank-model-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~ModelFile() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const Bytes& bytes) const {
    std::ofstream out(path(name), std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  }
  Bytes read(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

private:
  fs::path folder_;
};

inline StoredModel sample(std::size_t triangles, const BuildOptions& options = {}) {
  StoredModel stored;
  TriangleMesh mesh = triangle_soup(triangles, 0.2F, 31);
  mesh.parts = {{"front \"bumper\"", 0, 1},
                {"T\xc3\xbcr", 1, static_cast<std::uint32_t>(triangles) - 1}};
  stored.mass = shell_properties(mesh);
  stored.stated.mass_kg = 1400.0;
  const Box bounds = mesh.bounds();
  // In whole micrometres, as a file stores it.
  const Eigen::Vector3d middle = bounds.center().cast<double>();
  stored.stated.center_of_mass_m = (1e6 * middle).array().round().matrix() / 1e6;
  const Eigen::Vector3d extent = bounds.extent().cast<double>();
  stored.stated.yaw_inertia_kgm2 = 1400.0 * extent.head<2>().squaredNorm() / 12.0;
  stored.transform.scale = 0.001;
  stored.transform.up = Axis::plus_y;
  stored.transform.forward = Axis::minus_z;
  stored.transform.origin_m = {1.0, 0.0, 0.25};
  stored.model = *make_model(std::move(mesh), options);
  return stored;
}

/// Of few triangles, and with outlines: those of a soup of few enclose nothing.
inline StoredModel sample_box() {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        {(i & 1U) != 0 ? 0.3F : 0.0F, (i & 2U) != 0 ? 0.2F : 0.0F, (i & 4U) != 0 ? 0.25F : 0.0F});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh.parts = {{"lid", 0, 2}, {"walls", 2, 10}};
  StoredModel stored;
  stored.mass = shell_properties(mesh);
  stored.model = *make_model(std::move(mesh));
  return stored;
}

inline Bytes encoded(const StoredModel& stored) {
  const Result<Bytes> bytes = encode_model(stored);
  EXPECT_TRUE(bytes.ok());
  return *bytes;
}

/// Loads from a copy that begins where the memory's own alignment does not help.
inline Result<LoadedModel> decoded(const Bytes& bytes, bool compare_checksum = true) {
  void* memory = nullptr;
  if (::posix_memalign(&memory, 64, bytes.size() + 1) != 0) std::abort();
  const std::shared_ptr<const void> keeper(memory,
                                           [](const void* m) { std::free(const_cast<void*>(m)); });
  std::copy(bytes.begin(), bytes.end(), static_cast<unsigned char*>(memory));
  return detail::decode_model({static_cast<const unsigned char*>(memory), bytes.size()}, keeper,
                              compare_checksum);
}

template <class T> bool same_bytes(const Column<T>& a, const Column<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline void expect_same(const Profile& a, const Profile& b) {
  EXPECT_EQ(a.first, b.first);
  EXPECT_EQ(a.area_m2, b.area_m2);
  EXPECT_EQ(a.ground_m, b.ground_m);
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  EXPECT_EQ(std::memcmp(a.pieces.data(), b.pieces.data(), a.pieces.size() * sizeof(OutlinePiece)),
            0);
}

/// A model without a profile is stored with the one that its mesh has.
inline std::shared_ptr<const Profile> profile_as_stored(const Model& model) {
  if (model.profile != nullptr) return model.profile;
  Result<Profile> made = make_profile(model.mesh);
  return made ? std::make_shared<const Profile>(std::move(*made)) : nullptr;
}

inline void expect_same(const StoredModel& a, const StoredModel& b) {
  const Model& p = a.model;
  const Model& q = b.model;
  EXPECT_TRUE(same_bytes(p.mesh.vertices, q.mesh.vertices));
  EXPECT_TRUE(same_bytes(p.mesh.triangles, q.mesh.triangles));
  ASSERT_EQ(p.mesh.parts.size(), q.mesh.parts.size());
  for (std::size_t i = 0; i < p.mesh.parts.size(); ++i) {
    EXPECT_EQ(p.mesh.parts[i].name, q.mesh.parts[i].name);
    EXPECT_EQ(p.mesh.parts[i].first_triangle, q.mesh.parts[i].first_triangle);
    EXPECT_EQ(p.mesh.parts[i].triangle_count, q.mesh.parts[i].triangle_count);
  }
  EXPECT_EQ(p.tree.axes, q.tree.axes);
  EXPECT_EQ(p.tree.axes_are_world, q.tree.axes_are_world);
  EXPECT_EQ(p.tree.depth, q.tree.depth);
  EXPECT_TRUE(same_bytes(p.tree.nodes, q.tree.nodes));
  EXPECT_TRUE(same_bytes(p.tree.order, q.tree.order));
  EXPECT_TRUE(same_bytes(p.tree.triangles, q.tree.triangles));
  EXPECT_EQ(p.wide.depth, q.wide.depth);
  EXPECT_TRUE(same_bytes(p.wide.nodes, q.wide.nodes));
  EXPECT_TRUE(same_bytes(p.wide.clusters, q.wide.clusters));
  EXPECT_TRUE(same_bytes(p.wide.lanes_of, q.wide.lanes_of));
  const std::shared_ptr<const Profile> outlines = profile_as_stored(p);
  const std::shared_ptr<const Profile> others = profile_as_stored(q);
  ASSERT_EQ(outlines == nullptr, others == nullptr);
  if (outlines != nullptr) expect_same(*outlines, *others);
  EXPECT_EQ(a.transform.scale, b.transform.scale);
  EXPECT_EQ(a.transform.up, b.transform.up);
  EXPECT_EQ(a.transform.forward, b.transform.forward);
  EXPECT_EQ(a.transform.origin_m, b.transform.origin_m);
  EXPECT_EQ(a.stated.mass_kg, b.stated.mass_kg);
  EXPECT_EQ(a.stated.center_of_mass_m, b.stated.center_of_mass_m);
  EXPECT_EQ(a.stated.yaw_inertia_kgm2, b.stated.yaw_inertia_kgm2);
  EXPECT_EQ(a.mass.area_m2, b.mass.area_m2);
  EXPECT_EQ(a.mass.volume_m3, b.mass.volume_m3);
  EXPECT_EQ(a.mass.center_m, b.mass.center_m);
  EXPECT_EQ(a.mass.inertia_per_kg_m2, b.mass.inertia_per_kg_m2);
}

inline detail::ModelHeader head_of(const Bytes& bytes) {
  detail::ModelHeader header{};
  std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

inline std::size_t loaded_pieces(const Bytes& bytes) { return head_of(bytes).first_piece.back(); }

inline Bytes with_other_head(const Bytes& bytes,
                             const std::function<void(detail::ModelHeader&)>& change) {
  Bytes other = bytes;
  detail::ModelHeader header = head_of(bytes);
  change(header);
  std::memcpy(other.data(), &header, sizeof header);
  return other;
}

inline void expect_refused(const Bytes& bytes, const std::string& place,
                           const std::string& reason) {
  const Result<LoadedModel> loaded = decoded(bytes, false);
  ASSERT_FALSE(loaded.ok()) << place << ": " << reason;
  EXPECT_EQ(loaded.error().place, place);
  EXPECT_EQ(loaded.error().reason, reason);
  EXPECT_EQ(loaded.error().remedy, "compile it again from its mesh");
}

}  // namespace crashrank::test
