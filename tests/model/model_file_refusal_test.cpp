#include "crashrank/model/make_model.hpp"
#include "model/model_file_checks.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using test::Bytes;
using test::decoded;
using test::encoded;
using test::expect_refused;
using test::head_of;
using test::loaded_pieces;
using test::ModelFile;
using test::sample;
using test::with_other_head;

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
  wrong.stated.mass_kg = NAN;
  EXPECT_TRUE(refused(wrong));
  wrong = sample(9);
  wrong.stated.mass_kg = -1.0;
  EXPECT_TRUE(refused(wrong));
  wrong = sample(9);
  wrong.stated.center_of_mass_m->x() = 2.0;
  EXPECT_TRUE(refused(wrong)) << "a centre of mass beside the body";
  wrong = sample(9);
  wrong.stated.yaw_inertia_kgm2 = 1e5;
  EXPECT_TRUE(refused(wrong)) << "more than a ring's inertia";
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

TEST_F(ModelFile, StoresWhatIsStatedOfTheMass) {
  const StatedMass all{1400.0, Eigen::Vector3d(0.1, -0.000001, 0.25), 40.5};
  const StatedMass origin{std::nullopt, Eigen::Vector3d(0.0, 0.0, 0.0), std::nullopt};
  const StatedMass inertia{std::nullopt, std::nullopt, 1e-3};
  for (const StatedMass& stated : {StatedMass{}, all, origin, inertia}) {
    StoredModel stored = test::sample_box();
    stored.stated = stated;
    const Bytes bytes = encoded(stored);
    const Result<LoadedModel> loaded = decoded(bytes);
    ASSERT_TRUE(loaded.ok()) << loaded.error().message();
    const StatedMass& found = loaded->stored.stated;
    EXPECT_EQ(found.mass_kg, stated.mass_kg);
    EXPECT_EQ(found.center_of_mass_m, stated.center_of_mass_m);
    EXPECT_EQ(found.yaw_inertia_kgm2, stated.yaw_inertia_kgm2);
    EXPECT_EQ(encoded(loaded->stored), bytes);
  }
  // Parts of a micrometre are rounded away, once.
  StoredModel stored = test::sample_box();
  stored.stated.center_of_mass_m = Eigen::Vector3d(0.1000004, 0.1999996, 0.0);
  const Bytes bytes = encoded(stored);
  const Result<LoadedModel> loaded = decoded(bytes);
  ASSERT_TRUE(loaded.ok());
  EXPECT_EQ(loaded->stored.stated.center_of_mass_m, Eigen::Vector3d(0.1, 0.2, 0.0));
  EXPECT_EQ(encoded(loaded->stored), bytes);
}

// A flat plate on the ground has no outline, and yet can be collided with.
TEST_F(ModelFile, StoresAMeshWithoutOutlinesWithAnEmptyProfile) {
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
  ASSERT_NE(loaded->stored.model.profile, nullptr);
  EXPECT_TRUE(loaded->stored.model.profile->pieces.empty());
  EXPECT_EQ(encoded(loaded->stored), bytes);
  expect_refused(with_other_head(bytes, [](detail::ModelHeader& h) { h.band_area_m2[4] = 1.0F; }),
                 "profile", "it has no piece");
  expect_refused(with_other_head(bytes, [](detail::ModelHeader& h) { h.ground_m = -0.0; }),
                 "profile", "it has no piece");

  // Only where there is none: a model has one file.
  const Bytes whole = encoded(sample(60));
  Bytes without = with_other_head(whole, [](detail::ModelHeader& h) {
    h.first_piece = {};
    h.first_inner_piece = {};
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

}  // namespace
}  // namespace crashrank
