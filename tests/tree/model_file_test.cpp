#include "crashrank/tree/model_file.hpp"

#include "crashrank/collide/wide_collide.hpp"
#include "crashrank/tree/validate_wide.hpp"
#include "tree/model_layout.hpp"
#include "tree/sample_meshes.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

// A folder of its own, gone with the test.
class ModelFile : public testing::Test {
protected:
  ModelFile() {
    std::string name = (fs::path(testing::TempDir()) / "crashrank-model-XXXXXX").string();
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

StoredModel sample(std::size_t triangles, const BuildOptions& options = {}) {
  StoredModel stored;
  TriangleMesh mesh = test::triangle_soup(triangles, 0.2F, 31);
  mesh.parts = {{"front \"bumper\"", 0, 1},
                {"T\xc3\xbcr", 1, static_cast<std::uint32_t>(triangles) - 1}};
  stored.mass = shell_properties(mesh);
  stored.mass.mass_kg = 1400.0;
  stored.transform.scale = 0.001;
  stored.transform.up = Axis::plus_y;
  stored.transform.forward = Axis::minus_z;
  stored.transform.origin_m = {1.0, 0.0, 0.25};
  stored.model = *make_model(std::move(mesh), options);
  return stored;
}

/// Of few triangles, and with outlines: those of a soup of few enclose nothing.
StoredModel sample_box() {
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

Bytes encoded(const StoredModel& stored) {
  const Result<Bytes> bytes = encode_model(stored);
  EXPECT_TRUE(bytes.ok());
  return *bytes;
}

/// Loads from a copy that begins where the memory's own alignment does not help.
Result<LoadedModel> decoded(const Bytes& bytes, bool compare_checksum = true) {
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

void expect_same(const Profile& a, const Profile& b) {
  EXPECT_EQ(a.first, b.first);
  EXPECT_EQ(a.area_m2, b.area_m2);
  EXPECT_EQ(a.ground_m, b.ground_m);
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  EXPECT_EQ(std::memcmp(a.pieces.data(), b.pieces.data(), a.pieces.size() * sizeof(OutlinePiece)),
            0);
}

/// A model without a profile is stored with the one that its mesh has.
std::shared_ptr<const Profile> profile_as_stored(const Model& model) {
  if (model.profile != nullptr) return model.profile;
  Result<Profile> made = make_profile(model.mesh);
  return made ? std::make_shared<const Profile>(std::move(*made)) : nullptr;
}

void expect_same(const StoredModel& a, const StoredModel& b) {
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
  EXPECT_EQ(a.mass.mass_kg, b.mass.mass_kg);
  EXPECT_EQ(a.mass.area_m2, b.mass.area_m2);
  EXPECT_EQ(a.mass.volume_m3, b.mass.volume_m3);
  EXPECT_EQ(a.mass.center_m, b.mass.center_m);
  EXPECT_EQ(a.mass.inertia_per_kg_m2, b.mass.inertia_per_kg_m2);
}

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

TEST_F(ModelFile, RefusesWhatCannotBeLoadedAgain) {
  const auto refused = [](const StoredModel& stored) { return !encode_model(stored).ok(); };
  EXPECT_FALSE(refused(sample(9)));
  EXPECT_TRUE(refused(StoredModel{}));
  StoredModel wrong = sample(9);
  wrong.model.mesh.parts[1].name = wrong.model.mesh.parts[0].name;
  EXPECT_TRUE(refused(wrong)) << "two parts of one name";
  wrong = sample(9);
  wrong.model.mesh.parts[1].name = "\xff";
  EXPECT_TRUE(refused(wrong)) << "a name that is not UTF-8";
  wrong = sample(9);
  wrong.model.mesh.parts[1].name.assign(max_part_name_bytes + 1, 'a');
  EXPECT_TRUE(refused(wrong)) << "a name that is too long";
  wrong = sample(9);
  wrong.model.mesh.parts.pop_back();
  EXPECT_TRUE(refused(wrong)) << "parts that do not cover the triangles";
  wrong = sample(9);
  wrong.mass.mass_kg = NAN;
  EXPECT_TRUE(refused(wrong));
  wrong = sample(9);
  wrong.mass.mass_kg = -1.0;
  EXPECT_TRUE(refused(wrong));
  wrong = sample(9);
  wrong.transform.forward = wrong.transform.up;
  EXPECT_TRUE(refused(wrong));
  wrong = sample(9);
  wrong.model.tree.nodes[0].box.max.x() -= 1.0F;
  EXPECT_TRUE(refused(wrong));
  wrong = sample(9);
  wrong.model.wide.clusters[0].corner[0][0] += 1.0F;
  EXPECT_TRUE(refused(wrong));
  StoredModel without_parts = sample(9);
  without_parts.model.mesh.parts.clear();
  EXPECT_FALSE(refused(without_parts));
}

TEST_F(ModelFile, RefusesEveryOtherLength) {
  const Bytes bytes = encoded(sample(20));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Result<LoadedModel> loaded =
        decoded(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
    ASSERT_FALSE(loaded.ok()) << size;
    ASSERT_EQ(loaded.error().code, ErrorCode::bad_input);
  }
  for (const std::size_t more : {1U, 63U, 64U, 4096U}) {
    Bytes longer = bytes;
    longer.resize(bytes.size() + more, 0);
    EXPECT_FALSE(decoded(longer).ok()) << more;
  }
  write("cut", Bytes(bytes.begin(), bytes.end() - 64));
  const Result<LoadedModel> cut = load_model(path("cut"));
  ASSERT_FALSE(cut.ok());
  EXPECT_NE(cut.error().message().find("it was cut"), std::string::npos) << cut.error().message();
}

TEST_F(ModelFile, RefusesEveryFlippedBit) {
  const Bytes bytes = encoded(sample_box());
  ASSERT_TRUE(decoded(bytes).ok());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      Bytes flipped = bytes;
      flipped[i] = static_cast<unsigned char>(flipped[i] ^ 1U << bit);
      ASSERT_FALSE(decoded(flipped).ok()) << "byte " << i << " bit " << bit;
    }
  }
}

detail::ModelHeader head_of(const Bytes& bytes) {
  detail::ModelHeader header{};
  std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

std::size_t loaded_pieces(const Bytes& bytes) { return head_of(bytes).first_piece.back(); }

// Somebody who can forge the checksum: what is then accepted has to be a sound model all the same.
TEST_F(ModelFile, AForgedFileIsRefusedOrSound) {
  const Bytes bytes = encoded(sample_box());
  ASSERT_GT(loaded_pieces(bytes), 50U);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      Bytes forged = bytes;
      forged[i] = static_cast<unsigned char>(forged[i] ^ 1U << bit);
      const Result<LoadedModel> loaded = decoded(forged, false);
      if (!loaded) continue;
      ++accepted;
      const Model& model = loaded->stored.model;
      ASSERT_TRUE(validate(model).ok()) << "byte " << i << " bit " << bit;
    }
  }
  // Names, the properties, the transform and the outlines can be others; boxes can be larger.
  EXPECT_GT(accepted, 100U);
  const std::size_t outlines = sizeof(OutlinePiece) * loaded_pieces(bytes);
  EXPECT_LT(accepted, 8 * (outlines + (bytes.size() - outlines) / 4));
}

Bytes with_other_head(const Bytes& bytes, const std::function<void(detail::ModelHeader&)>& change) {
  Bytes other = bytes;
  detail::ModelHeader header = head_of(bytes);
  change(header);
  std::memcpy(other.data(), &header, sizeof header);
  return other;
}

Bytes with_other_piece(const Bytes& bytes, std::size_t index,
                       const std::function<void(OutlinePiece&)>& change) {
  Bytes other = bytes;
  const std::size_t at = detail::layout_of(head_of(bytes)).section[detail::section_pieces].offset +
                         index * sizeof(OutlinePiece);
  OutlinePiece piece;
  std::memcpy(&piece, other.data() + at, sizeof piece);
  change(piece);
  std::memcpy(other.data() + at, &piece, sizeof piece);
  return other;
}

void expect_refused(const Bytes& bytes, const std::string& place, const std::string& reason) {
  const Result<LoadedModel> loaded = decoded(bytes, false);
  ASSERT_FALSE(loaded.ok()) << place << ": " << reason;
  EXPECT_EQ(loaded.error().place, place);
  EXPECT_EQ(loaded.error().reason, reason);
  EXPECT_EQ(loaded.error().remedy, "compile it again from its mesh");
}

TEST_F(ModelFile, RefusesForgedPieces) {
  const Bytes bytes = encoded(sample(60));
  const std::size_t pieces = loaded_pieces(bytes);
  ASSERT_GT(pieces, 100U);
  const std::size_t last = pieces - 1;
  const auto refuse = [&](std::size_t index, const std::string& reason,
                          const std::function<void(OutlinePiece&)>& change) {
    expect_refused(with_other_piece(bytes, index, change), "outline piece " + std::to_string(index),
                   reason);
  };
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float wrong : {std::nanf(""), infinity, -infinity, 1.4F, -0.2F, 1e30F}) {
    refuse(0, "it does not lie within its mesh", [&](OutlinePiece& p) { p.x = wrong; });
    refuse(last, "it does not lie within its mesh", [&](OutlinePiece& p) { p.y = wrong; });
  }
  for (const float wrong : {std::nanf(""), infinity, -infinity, 1.01F, 1e30F}) {
    refuse(1, "its normal is not a unit vector", [&](OutlinePiece& p) { p.normal_x = wrong; });
    refuse(last, "its normal is not a unit vector", [&](OutlinePiece& p) { p.normal_y = wrong; });
  }
  refuse(2, "its normal is not a unit vector", [](OutlinePiece& p) {
    p.normal_x *= 0.998F;
    p.normal_y *= 0.998F;
  });
  for (const float wrong : {std::nanf(""), infinity, 0.0F, -0.0F, -0.05F, 1000.1F}) {
    refuse(3, "its length is not above 0 and at most 1 km",
           [&](OutlinePiece& p) { p.length_m = wrong; });
  }
  EXPECT_TRUE(
      decoded(with_other_piece(bytes, 3, [](OutlinePiece& p) { p.length_m = 1e3F; }), false).ok());
}

TEST_F(ModelFile, RefusesForgedBands) {
  const Bytes bytes = encoded(sample(60));
  const auto refuse = [&](const std::string& reason,
                          const std::function<void(detail::ModelHeader&)>& change) {
    expect_refused(with_other_head(bytes, change), "profile", reason);
  };
  constexpr const char* bands = "its bands do not follow each other or do not share out its pieces";
  constexpr const char* areas = "the area of a band is negative, not finite or not within its mesh";
  constexpr const char* ground = "its ground is not a finite height within its mesh";
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const detail::ModelHeader head = head_of(bytes);
  ASSERT_LT(head.first_piece[2], head.first_piece[3]);
  refuse(bands, [](detail::ModelHeader& h) { h.first_piece[0] = 1; });
  refuse(bands, [](detail::ModelHeader& h) { std::swap(h.first_piece[2], h.first_piece[3]); });
  refuse(bands, [](detail::ModelHeader& h) { h.first_piece[9] = h.first_piece[10] + 1; });
  refuse(bands, [](detail::ModelHeader& h) { h.first_piece[1] = 0xffffffffU; });
  for (const float wrong : {std::nanf(""), infinity, -infinity, -1e-6F, 2.0F}) {
    refuse(areas, [&](detail::ModelHeader& h) { h.band_area_m2[2] = wrong; });
  }
  ASSERT_EQ(head.first_piece[9], head.first_piece[10]) << "a band without a piece has no area";
  refuse(areas, [](detail::ModelHeader& h) { h.band_area_m2[9] = 0.1F; });
  for (const double wrong : {std::nan(""), -0.1, 1.3, 1e300, -HUGE_VAL, HUGE_VAL}) {
    refuse(ground, [&](detail::ModelHeader& h) { h.ground_m = wrong; });
  }
  refuse("its outlines enclose nothing", [](detail::ModelHeader& h) { h.band_area_m2 = {}; });

  // Another number of pieces does not fit the size of the file; one that does is limited.
  const Bytes fewer =
      with_other_head(bytes, [](detail::ModelHeader& h) { h.first_piece[10] -= 64; });
  expect_refused(fewer, "head", "the numbers of elements do not add up to the size of the file");
  Bytes many = with_other_head(
      bytes, [](detail::ModelHeader& h) { h.first_piece[10] = max_profile_pieces + 1; });
  many.resize(detail::layout_of(head_of(many)).end, 0);
  many = with_other_head(many, [&](detail::ModelHeader& h) { h.file_bytes = many.size(); });
  expect_refused(many, "head", "there are more than 2 million outline pieces");
}

TEST_F(ModelFile, RefusesToWriteAnUnsoundProfile) {
  StoredModel stored = sample(60);
  const Profile sound = *make_profile(stored.model.mesh);
  const auto written = [&](const Profile& profile) {
    stored.model.profile = std::make_shared<const Profile>(profile);
    return encode_model(stored);
  };
  ASSERT_TRUE(written(sound).ok());
  EXPECT_EQ(*written(sound), encoded(sample(60))) << "as the profile that would be made";
  Profile wrong = sound;
  wrong.pieces[7].normal_x = 2.0F;
  EXPECT_EQ(written(wrong).error().message(), "outline piece 7: its normal is not a unit vector");
  wrong = sound;
  wrong.pieces.pop_back();
  EXPECT_FALSE(written(wrong).ok());
  wrong = sound;
  wrong.ground_m = 17.0;
  EXPECT_FALSE(written(wrong).ok());
  EXPECT_EQ(written(Profile{}).error().message(), "profile: it has no piece");
  wrong.pieces.resize(max_profile_pieces + 1);
  EXPECT_EQ(written(wrong).error().code, ErrorCode::limit_exceeded);
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

// A flat plate on the ground has no outline, and yet can be collided with.
TEST_F(ModelFile, StoresAMeshWithoutOutlinesWithoutAProfile) {
  TriangleMesh plate;
  test::add_triangle(plate, {0, 0, 0}, {2, 0, 0}, {2, 2, 0});
  test::add_triangle(plate, {0, 0, 0}, {2, 2, 0}, {0, 2, 0});
  StoredModel stored;
  stored.mass = shell_properties(plate);
  stored.model = *make_model(plate);
  const Bytes bytes = encoded(stored);
  EXPECT_EQ(loaded_pieces(bytes), 0U);
  const Result<LoadedModel> loaded = decoded(bytes);
  ASSERT_TRUE(loaded.ok()) << loaded.error().message();
  EXPECT_EQ(loaded->stored.model.profile, nullptr);
  EXPECT_EQ(encoded(loaded->stored), bytes);
  expect_refused(with_other_head(bytes, [](detail::ModelHeader& h) { h.band_area_m2[4] = 1.0F; }),
                 "profile", "it has no piece");
  expect_refused(with_other_head(bytes, [](detail::ModelHeader& h) { h.ground_m = -0.0; }),
                 "profile", "it has no piece");

  // Only where there is none: a model has one file.
  const Bytes whole = encoded(sample(60));
  Bytes without = with_other_head(whole, [](detail::ModelHeader& h) {
    h.first_piece = {};
    h.band_area_m2 = {};
    h.ground_m = 0.0;
  });
  const auto& from = detail::layout_of(head_of(whole)).section;
  const auto& to = detail::layout_of(head_of(without)).section;
  without.erase(
      without.begin() + static_cast<std::ptrdiff_t>(to[detail::section_corners].offset),
      without.begin() + static_cast<std::ptrdiff_t>(from[detail::section_corners].offset));
  without =
      with_other_head(without, [&](detail::ModelHeader& h) { h.file_bytes = without.size(); });
  expect_refused(without, "profile", "there is none, though the mesh has outlines");
}

TEST_F(ModelFile, SaysWhichVersionItFoundAndWhatToDo) {
  for (const std::uint32_t version : {model_file_version - 1, model_file_version + 1}) {
    Bytes other = encoded(sample(12));
    std::memcpy(other.data() + offsetof(detail::ModelHeader, version), &version, sizeof version);
    // Another version may have another head, and be shorter than this one's.
    for (const std::size_t size : {other.size(), std::size_t{20}}) {
      write("other", Bytes(other.begin(), other.begin() + static_cast<std::ptrdiff_t>(size)));
      const Result<LoadedModel> loaded = load_model(path("other"));
      ASSERT_FALSE(loaded.ok());
      EXPECT_EQ(loaded.error().message(),
                path("other") + ": version: the file has version " + std::to_string(version) +
                    ", this library reads version " + std::to_string(model_file_version) +
                    "; compile it again from its mesh");
    }
  }
}

TEST_F(ModelFile, TellsWhatIsNoModelFile) {
  write("empty", {});
  write("text", {'v', ' ', '0', ' ', '0', ' ', '0', '\n'});
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  ASSERT_TRUE(save_model(sample(5), path("model")).ok());
  EXPECT_TRUE(is_model_file(path("model")));
  EXPECT_FALSE(is_model_file(path("empty")));
  EXPECT_FALSE(is_model_file(path("text")));
  EXPECT_FALSE(is_model_file(path("nowhere")));
  EXPECT_FALSE(is_model_file(path("pipe"))) << "it has to answer, too";
  EXPECT_FALSE(is_model_file(path(".")));
  const std::vector<std::pair<std::string, ErrorCode>> wrong{
      {"empty", ErrorCode::bad_input},   {"text", ErrorCode::bad_input},
      {"pipe", ErrorCode::bad_input},    {".", ErrorCode::bad_input},
      {"nowhere", ErrorCode::not_found},
  };
  for (const ModelStorage storage : {ModelStorage::copied, ModelStorage::mapped}) {
    LoadModelOptions options;
    options.storage = storage;
    for (const auto& [name, code] : wrong) {
      const Result<LoadedModel> loaded = load_model(path(name), options);
      ASSERT_FALSE(loaded.ok()) << name;
      EXPECT_EQ(loaded.error().code, code) << loaded.error().message();
      EXPECT_EQ(loaded.error().file, path(name));
    }
  }
  LoadModelOptions small;
  small.max_bytes = 100;
  EXPECT_EQ(load_model(path("model"), small).error().code, ErrorCode::limit_exceeded);
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
    EXPECT_EQ(header.checksum, 3625693441U) << threads << " threads, " << bytes.size() << " bytes";
  }
}

}  // namespace
}  // namespace crashrank
