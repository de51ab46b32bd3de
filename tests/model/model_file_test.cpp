#include "crashrank/model/model.hpp"

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/tree/build.hpp"
#include "model/model_file_checks.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using test::Bytes;
using test::decoded;
using test::encoded;
using test::expect_same;
using test::ModelFile;
using test::sample;

namespace fs = std::filesystem;

BuildOptions build_of(int kind) {
  BuildOptions options;
  options.frame = kind % 2 == 0 ? BoxFrame::world : BoxFrame::gaussian;
  options.rule = kind == 2 ? SplitRule::paper : SplitRule::min_relative_segment;
  if (kind == 3) {
    options.leaf_size = 20;  // no wide tree
    options.fill_leaves = true;
  }
  options.reinsertion_passes = kind == 1 ? 2 : 0;
  return options;
}

TEST_F(ModelFile, GivesBackEveryBit) {
  for (int kind = 0; kind < 4; ++kind) {
    const StoredModel stored = sample(300, build_of(kind));
    ASSERT_EQ(stored.model.wide.empty(), kind == 3);
    const std::string file = path("model" + std::to_string(kind));
    ASSERT_TRUE(save_model(stored, file).ok());
    for (const ModelStorage storage : {ModelStorage::copied, ModelStorage::mapped}) {
      LoadModelOptions options;
      options.storage = storage;
      Result<LoadedModel> loaded = load_model(file, options);
      ASSERT_TRUE(loaded.ok()) << loaded.error().message();
      expect_same(stored, loaded->stored);
      EXPECT_TRUE(loaded->stored.model.tree.nodes.borrowed());
      ASSERT_NE(loaded->stored.model.profile, nullptr);
      EXPECT_GT(loaded->stored.model.profile->pieces.size(), 100U);
      EXPECT_EQ(loaded->facts.version, model_file_version);
      EXPECT_EQ(loaded->facts.bytes, fs::file_size(file));
      EXPECT_EQ(encoded(loaded->stored), encoded(stored)) << "written again, it is the same file";
    }
  }
}

TEST_F(ModelFile, AnswersAsTheModelThatWasSaved) {
  const StoredModel stored = sample(400);
  ASSERT_TRUE(save_model(stored, path("model")).ok());
  LoadModelOptions options;
  options.storage = ModelStorage::mapped;
  const Result<LoadedModel> loaded = load_model(path("model"), options);
  ASSERT_TRUE(loaded.ok());
  const Model& model = loaded->stored.model;
  ModelWorkspace workspace;
  std::vector<Pair> pairs;
  std::vector<Pair> expected;
  std::size_t found = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose pose = pose_from_angles({0.1 * i, 0.05, 0.02 * i}, 0.3 * i, 0.1, 0.2);
    const CollideResult was = collide(stored.model, stored.model, pose, expected, workspace);
    const CollideResult is = collide(model, model, pose, pairs, workspace);
    EXPECT_EQ(pairs, expected);
    EXPECT_EQ(was.work.bv_tests, is.work.bv_tests);
    EXPECT_EQ(was.work.primitive_tests, is.work.primitive_tests);
    found += pairs.size();
  }
  EXPECT_GT(found, 100U);
}

TEST_F(ModelFile, OutlivesTheFileAndItsCopiesOutliveIt) {
  const StoredModel stored = sample(50);
  for (const ModelStorage storage : {ModelStorage::copied, ModelStorage::mapped}) {
    ASSERT_TRUE(save_model(stored, path("model"), true).ok());
    LoadModelOptions options;
    options.storage = storage;
    Model copy;
    {
      const Result<LoadedModel> loaded = load_model(path("model"), options);
      ASSERT_TRUE(loaded.ok());
      copy = loaded->stored.model;
      EXPECT_EQ(std::as_const(copy).tree.nodes.data(),
                std::as_const(loaded->stored.model.tree.nodes).data());
    }
    fs::remove(path("model"));
    EXPECT_TRUE(validate(std::as_const(copy).tree, std::as_const(copy).mesh).ok());
    copy.tree.nodes[0].box.max.x() += 1.0F;
    EXPECT_FALSE(copy.tree.nodes.borrowed());
    EXPECT_TRUE(copy.tree.order.borrowed());
  }
}

// In memory of its own, what becomes of the file does not matter.
TEST_F(ModelFile, ACopyDoesNotMindTheFileBeingCut) {
  ASSERT_TRUE(save_model(sample(50), path("model")).ok());
  const Result<LoadedModel> loaded = load_model(path("model"));
  ASSERT_TRUE(loaded.ok());
  fs::resize_file(path("model"), 0);
  const Model& model = loaded->stored.model;
  EXPECT_TRUE(validate(model.tree, model.mesh).ok());
}

TEST_F(ModelFile, IsReplacedWholeOrNotAtAll) {
  const StoredModel first = sample(40);
  const StoredModel second = sample(60);
  ASSERT_TRUE(save_model(first, path("model")).ok());
  const Status refused = save_model(second, path("model"));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
  EXPECT_EQ(refused.error().file, path("model"));
  EXPECT_EQ(read("model"), encoded(first));

  LoadModelOptions mapped;
  mapped.storage = ModelStorage::mapped;
  const Result<LoadedModel> before = load_model(path("model"), mapped);
  ASSERT_TRUE(save_model(second, path("model"), true).ok());
  EXPECT_EQ(read("model"), encoded(second));
  expect_same(before->stored, first);
  EXPECT_EQ(files(), 1U) << "no draft stays behind";

  const Status nowhere = save_model(first, path("no/such/folder/model"));
  ASSERT_FALSE(nowhere.ok());
  EXPECT_EQ(nowhere.error().code, ErrorCode::not_found);
  ::mkdir(path("folder").c_str(), 0700);
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  for (const char* name : {"folder", "pipe"}) {
    const Status kept = save_model(first, path(name), true);
    ASSERT_FALSE(kept.ok()) << name;
    EXPECT_EQ(kept.error().code, ErrorCode::usage) << kept.error().message();
  }
  EXPECT_EQ(files(), 3U);
}

// A profile that is not the one that the mesh has is stored as it is: outlines may come from
// elsewhere.
TEST_F(ModelFile, StoresTheProfileOfTheModel) {
  StoredModel stored = sample(60);
  Profile other = *make_profile(stored.model.mesh);
  for (OutlinePiece& piece : other.pieces) piece.x += 0.03125F;
  other.ground_m = 0.25;
  stored.model.profile = std::make_shared<const Profile>(other);
  const Bytes bytes = encoded(stored);
  const Result<LoadedModel> loaded = decoded(bytes);
  ASSERT_TRUE(loaded.ok());
  expect_same(*loaded->stored.model.profile, other);
  EXPECT_EQ(encoded(loaded->stored), bytes);
}

TEST_F(ModelFile, LoadsFromMemoryOfTheCaller) {
  const Bytes bytes = encoded(sample(12));
  alignas(64) static unsigned char memory[1 << 16];
  ASSERT_LE(bytes.size(), sizeof memory - 64);
  std::copy(bytes.begin(), bytes.end(), memory);
  EXPECT_TRUE(load_model({memory, bytes.size()}, nullptr).ok());
  std::copy(bytes.begin(), bytes.end(), memory + 4);
  const Result<LoadedModel> misplaced = load_model({memory + 4, bytes.size()}, nullptr);
  ASSERT_FALSE(misplaced.ok());
  EXPECT_EQ(misplaced.error().code, ErrorCode::usage);
}

// The same bits from every compiler, processor and number of threads. When this checksum changes,
// files written before mean something else, or another tree is built: then model_file_version has
// to change if it is the file.
TEST_F(ModelFile, IsTheSameFileEverywhere) {
  const TriangleMesh mesh = test::triangle_soup(6000, 0.05F, 77);
  for (const std::uint32_t threads : {1U, 3U}) {
    StoredModel stored;
    stored.mass = shell_properties(mesh);
    BuildOptions options;
    options.threads = threads;
    stored.model = *make_model(mesh, options);
    const Bytes bytes = encoded(stored);
    detail::ModelHeader header{};
    std::memcpy(&header, bytes.data(), sizeof header);
    EXPECT_EQ(header.checksum, 1533358772U) << threads << " threads, " << bytes.size() << " bytes";
  }
}

}  // namespace
}  // namespace crashrank
