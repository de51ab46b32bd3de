#include "crashrank/report/ranking.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace crashrank {
namespace {

/// Corners at ±1; triangles 2k and 2k+1 are the faces -x, +x, -y, +y, -z, +z.
TriangleMesh cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const auto side = [i](int bit) { return (i >> bit & 1) != 0 ? 1.0F : -1.0F; };
    mesh.vertices.emplace_back(side(0), side(1), side(2));
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  mesh.parts = {{"cube", 0, 12}};
  return mesh;
}

PictureOptions small() {
  PictureOptions options;
  options.width_px = 120;
  options.height_px = 90;
  return options;
}

bool is_red(const std::uint8_t* p) { return p[0] > 90 && p[0] > 2 * p[1] && p[0] > 2 * p[2]; }

std::size_t red_pixels(const Image& image) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) count += is_red(&image.rgb[i]) ? 1U : 0U;
  return count;
}

TEST(Picture, DamageIsSeenFromItsOwnSideOnly) {
  const TriangleMesh mesh = cube();
  const std::vector<std::uint32_t> front{2, 3};  // +x
  const PictureBody body{&mesh, {}, front};
  PictureOptions options = small();
  options.azimuth_deg = 0.0;
  const Result<Image> from_front = draw_picture({&body, 1}, options);
  options.azimuth_deg = 180.0;
  const Result<Image> from_behind = draw_picture({&body, 1}, options);
  ASSERT_TRUE(from_front.ok());
  ASSERT_TRUE(from_behind.ok());
  EXPECT_GT(red_pixels(*from_front), 500U);
  EXPECT_EQ(red_pixels(*from_behind), 0U);
}

TEST(Picture, ANearerBodyHidesAFartherOne) {
  const TriangleMesh mesh = cube();
  const std::vector<std::uint32_t> all{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  PictureBody hidden{&mesh, {}, all};
  PictureBody before{&mesh, {}, {}};
  hidden.pose.translation = {-6, 0, 0};
  PictureOptions options = small();
  options.azimuth_deg = 0.0;
  options.elevation_deg = 0.0;
  const std::vector<PictureBody> both{before, hidden};
  const Result<Image> one = draw_picture({&hidden, 1}, options);
  const Result<Image> two = draw_picture(both, options);
  ASSERT_TRUE(one.ok());
  ASSERT_TRUE(two.ok());
  EXPECT_GT(red_pixels(*one), 500U);
  EXPECT_EQ(red_pixels(*two), 0U);
}

TEST(Picture, TheCameraGoesWhereTheDamageIs) {
  const TriangleMesh mesh = cube();
  for (const auto& [face, direction] :
       std::vector<std::pair<std::uint32_t, double>>{{2, 0.0}, {6, 90.0}, {4, -90.0}}) {
    const std::vector<std::uint32_t> damaged{face, face + 1};
    const PictureBody body{&mesh, {}, damaged};
    EXPECT_NEAR(azimuth_of_damage_deg(body), direction, 1e-3);
  }
}

TEST(Picture, OfEightPlacesTheOneThatShowsMostDamage) {
  const TriangleMesh mesh = cube();
  const std::vector<std::uint32_t> damaged{2, 3};  // +x, beside which another body stands
  PictureBody before{&mesh, {}, {}};
  before.pose.translation = {4, 2, 0};
  const std::vector<PictureBody> both{{&mesh, {}, damaged}, before};
  const Result<double> azimuth_deg = azimuth_of_most_damage_deg(both);
  ASSERT_TRUE(azimuth_deg.ok());
  const auto red_from = [&](double from_deg) {
    PictureOptions options = small();
    options.azimuth_deg = from_deg;
    const Result<Image> image = draw_picture(both, options);
    return image.ok() ? static_cast<double>(red_pixels(*image)) : -1.0;
  };
  const double shown = red_from(*azimuth_deg);
  EXPECT_GT(shown, 100.0);
  for (const double turn_deg : {35.0, -35.0, 70.0, -70.0, 110.0, -110.0, 150.0, -150.0}) {
    EXPECT_GE(1.2 * shown, red_from(turn_deg)) << turn_deg;
  }
  EXPECT_LT(red_from(35.0), 0.9 * shown);  // the first of them is not the best here
}

TEST(Picture, TheSameInputDrawsTheSamePicture) {
  const TriangleMesh mesh = cube();
  const PictureBody body{&mesh, {}, {}};
  const Result<Image> one = draw_picture({&body, 1}, small());
  const Result<Image> two = draw_picture({&body, 1}, small());
  ASSERT_TRUE(one.ok());
  ASSERT_TRUE(two.ok());
  EXPECT_EQ(one->rgb, two->rgb);
  EXPECT_EQ(one->rgb.size(), 3U * 120U * 90U);
}

TEST(Picture, WhatMakesNoPictureIsRefused) {
  const TriangleMesh mesh = cube();
  const TriangleMesh nothing;
  const PictureBody body{&mesh, {}, {}};
  const PictureBody empty{&nothing, {}, {}};
  EXPECT_FALSE(draw_picture({}, small()).ok());
  EXPECT_FALSE(draw_picture({&empty, 1}, small()).ok());
  for (const auto& spoil :
       std::vector<void (*)(PictureOptions&)>{[](PictureOptions& o) { o.width_px = 15; },
                                              [](PictureOptions& o) { o.height_px = 4097; },
                                              [](PictureOptions& o) { o.elevation_deg = 90; },
                                              [](PictureOptions& o) { o.azimuth_deg = NAN; },
                                              [](PictureOptions& o) { o.field_of_view_deg = 0; }}) {
    PictureOptions options = small();
    spoil(options);
    EXPECT_FALSE(draw_picture({&body, 1}, options).ok());
  }
}

TEST(Png, HoldsTheSizeAndEndsWhole) {
  Image image;
  image.width = 3;
  image.height = 2;
  image.rgb.assign(18, 200);
  const Result<std::string> bytes = png(image);
  ASSERT_TRUE(bytes.ok());
  EXPECT_EQ(bytes->substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ((*bytes)[19], 3);  // IHDR: width and height, big-endian
  EXPECT_EQ((*bytes)[23], 2);
  EXPECT_EQ(bytes->substr(bytes->size() - 8, 4), "IEND");
}

}  // namespace
}  // namespace crashrank
