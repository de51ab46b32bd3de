#include "crashrank/model/make_model.hpp"
#include "crashrank/tree/build.hpp"
#include "model/model_file_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>

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
using test::sample_box;
using test::with_other_head;

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

TEST_F(ModelFile, RefusesForgedMasses) {
  // 0.3 x 0.2 x 0.25 m; an even block of it and 12 kg has 0.13 kg m2.
  StoredModel stored = sample_box();
  stored.stated = {12.0, Eigen::Vector3d(0.1, 0.1, 0.1), 0.13};
  const Bytes bytes = encoded(stored);
  ASSERT_TRUE(decoded(bytes).ok());
  const auto accepted = [&](const std::function<void(detail::ModelHeader&)>& change) {
    return decoded(with_other_head(bytes, change), false).ok();
  };
  const auto refuse = [&](const std::string& place,
                          const std::function<void(detail::ModelHeader&)>& change) {
    const Result<LoadedModel> loaded = decoded(with_other_head(bytes, change), false);
    ASSERT_FALSE(loaded.ok()) << place;
    EXPECT_EQ(loaded.error().code, ErrorCode::bad_input);
    EXPECT_EQ(loaded.error().place, place);
    EXPECT_NE(loaded.error().reason, "");
    EXPECT_EQ(loaded.error().remedy, "compile it again from its mesh");
  };
  for (const double wrong : {-0.0, -1.0, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    refuse("mass", [&](detail::ModelHeader& h) { h.mass_kg = wrong; });
    refuse("yaw inertia", [&](detail::ModelHeader& h) { h.yaw_inertia_kgm2 = wrong; });
  }
  for (const double wrong : {0.0012, 0.391, 1e9, 1e-300}) {
    refuse("yaw inertia", [&](detail::ModelHeader& h) { h.yaw_inertia_kgm2 = wrong; });
  }
  for (const double possible : {0.0, 0.0014, 0.389}) {
    EXPECT_TRUE(accepted([&](detail::ModelHeader& h) { h.yaw_inertia_kgm2 = possible; }));
  }
  // Without a mass the inertia is checked where the body's mass is known.
  EXPECT_TRUE(accepted([](detail::ModelHeader& h) {
    h.mass_kg = 0.0;
    h.yaw_inertia_kgm2 = 1e9;
  }));
  constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max();
  for (const std::int32_t wrong : {-2, 300'003, largest, -largest - 1}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      refuse("centre of mass", [&](detail::ModelHeader& h) { h.center_of_mass_um[axis] = wrong; });
    }
  }
  refuse("head", [](detail::ModelHeader& h) { h.flags &= ~2U; });
  for (unsigned bit = 2; bit < 32; ++bit) {
    refuse("head", [&](detail::ModelHeader& h) { h.flags |= 1U << bit; });
  }
  EXPECT_TRUE(accepted([](detail::ModelHeader& h) {
    h.flags &= ~2U;
    h.center_of_mass_um = {};
  }));
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
  refuse(bands, [](detail::ModelHeader& h) { h.first_piece[10] = h.first_piece[11] + 1; });
  refuse("its inner outlines do not lie within their bands",
         [](detail::ModelHeader& h) { h.first_inner_piece[2] = h.first_piece[3] + 1; });
  refuse(bands, [](detail::ModelHeader& h) { h.first_piece[1] = 0xffffffffU; });
  for (const float wrong : {std::nanf(""), infinity, -infinity, -1e-6F, 2.0F}) {
    refuse(areas, [&](detail::ModelHeader& h) { h.band_area_m2[2] = wrong; });
  }
  ASSERT_EQ(head.first_piece[10], head.first_piece[11]) << "a band without a piece has no area";
  refuse(areas, [](detail::ModelHeader& h) { h.band_area_m2[10] = 0.1F; });
  for (const double wrong : {std::nan(""), -0.1, 1.3, 1e300, -HUGE_VAL, HUGE_VAL}) {
    refuse(ground, [&](detail::ModelHeader& h) { h.ground_m = wrong; });
  }

  // Another number of pieces does not fit the size of the file; one that does is limited.
  const Bytes fewer =
      with_other_head(bytes, [](detail::ModelHeader& h) { h.first_piece[11] -= 64; });
  expect_refused(fewer, "head", "the numbers of elements do not add up to the size of the file");
  Bytes many = with_other_head(
      bytes, [](detail::ModelHeader& h) { h.first_piece[11] = max_profile_pieces + 1; });
  many.resize(detail::layout_of(head_of(many)).end, 0);
  many = with_other_head(many, [&](detail::ModelHeader& h) { h.file_bytes = many.size(); });
  expect_refused(many, "head", "there are more than 2 million outline pieces");
}

}  // namespace
}  // namespace crashrank
