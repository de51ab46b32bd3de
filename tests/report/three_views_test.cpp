#include "crashrank/report/ranking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

/// A body without symmetry, 4 x 2 x 1 m: a wedge that falls towards the front and the left, with a
/// mast over the rear right corner.
TriangleMesh wedge() {
  TriangleMesh mesh;
  mesh.vertices = {{-1, -0.8F, 0.2F}, {3, -0.8F, 0.2F}, {3, 1.2F, 0.2F},   {-1, 1.2F, 0.2F},
                   {-1, -0.8F, 0.9F}, {3, -0.8F, 0.4F}, {-1, -0.8F, 1.2F}, {-0.6F, -0.5F, 0.6F}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {1, 2, 5},
                    {0, 4, 3}, {2, 3, 5}, {3, 4, 5}, {4, 7, 6}};
  mesh.parts = {{"wedge", 0, 8}, {"mast", 8, 1}};
  return mesh;
}

using Range = std::pair<int, int>;  ///< first, and one past the last

struct Silhouette {
  Range x;
  Range y;
  int width() const { return x.second - x.first; }
  int height() const { return y.second - y.first; }
};

using Pixel = std::array<std::uint8_t, 3>;

Pixel pixel(const Image& image, int x, int y) {
  const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(x));
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

bool is_body(const Image& image, int x, int y) { return pixel(image, x, y) != pixel(image, 0, 0); }

/// Runs of numbers below `end` for which `hit` holds.
template <typename Hit> std::vector<Range> runs(int end, const Hit& hit) {
  std::vector<Range> found;
  for (int i = 0; i < end; ++i) {
    if (!hit(i)) continue;
    if (found.empty() || found.back().second != i) found.emplace_back(i, i);
    found.back().second = i + 1;
  }
  return found;
}

/// Top, side and front view.
std::vector<Silhouette> silhouettes(const Image& image) {
  std::vector<Silhouette> found;
  for (const Range& rows : runs(image.height, [&](int y) {
         for (int x = 0; x < image.width; ++x) {
           if (is_body(image, x, y)) return true;
         }
         return false;
       })) {
    for (const Range& columns : runs(image.width, [&](int x) {
           for (int y = rows.first; y < rows.second; ++y) {
             if (is_body(image, x, y)) return true;
           }
           return false;
         })) {
      found.push_back({columns, rows});
    }
  }
  return found;
}

Image draw(const TriangleMesh& mesh, bool marks) {
  ThreeViewOptions options;
  options.width_px = 600;
  options.height_px = 450;
  options.marks = marks;
  return *draw_three_views(mesh, options);
}

TEST(ThreeViews, SilhouettesHaveTheBoundsOfTheMesh) {
  for (const float size : {1e-3F, 1.0F, 1e3F}) {
    TriangleMesh mesh = wedge();
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= size;
    const Eigen::Vector3f extent = wedge().bounds().extent();
    const std::vector<Silhouette> views = silhouettes(draw(mesh, false));
    ASSERT_EQ(views.size(), 3U);
    const auto px = static_cast<float>(views[0].width()) / extent.x();
    EXPECT_GT(px, 40.0F);  // for a metre: the sheet is made use of
    EXPECT_NEAR(static_cast<float>(views[0].height()), px * extent.y(), 2.0F);
    EXPECT_NEAR(static_cast<float>(views[1].width()), px * extent.x(), 2.0F);
    EXPECT_NEAR(static_cast<float>(views[1].height()), px * extent.z(), 2.0F);
    EXPECT_NEAR(static_cast<float>(views[2].width()), px * extent.y(), 2.0F);
    EXPECT_NEAR(static_cast<float>(views[2].height()), px * extent.z(), 2.0F);
    EXPECT_EQ(views[0].x.first, views[1].x.first);
    EXPECT_EQ(views[1].y, views[2].y);
  }
}

TEST(ThreeViews, ForwardIsRightInTheSideViewAndLeftIsUpInTheTopView) {
  const Image image = draw(wedge(), false);
  const std::vector<Silhouette> views = silhouettes(image);
  ASSERT_EQ(views.size(), 3U);
  // The mast stands at the rear right: at the side view's left and at the front view's left.
  EXPECT_TRUE(is_body(image, views[1].x.first + 2, views[1].y.first + 20));
  EXPECT_FALSE(is_body(image, views[1].x.second - 3, views[1].y.first + 20));
  EXPECT_TRUE(is_body(image, views[2].x.first + 1, views[2].y.first + 20));
  EXPECT_FALSE(is_body(image, views[2].x.second - 3, views[2].y.first + 20));
}

TEST(ThreeViews, AMirroredMeshGivesAMirroredPicture) {
  const std::vector<std::array<bool, 2>> turned_by_view{
      {false, true}, {false, false}, {true, false}};
  TriangleMesh mirrored = wedge();
  for (Eigen::Vector3f& vertex : mirrored.vertices) vertex.y() *= -1.0F;
  const Image one = draw(wedge(), false);
  const Image two = draw(mirrored, false);
  const std::vector<Silhouette> a = silhouettes(one);
  const std::vector<Silhouette> b = silhouettes(two);
  ASSERT_EQ(a.size(), 3U);
  ASSERT_EQ(b.size(), 3U);
  for (std::size_t view = 0; view < 3; ++view) {
    ASSERT_NEAR(a[view].width(), b[view].width(), 1);
    ASSERT_NEAR(a[view].height(), b[view].height(), 1);
    const int width = std::min(a[view].width(), b[view].width());
    const int height = std::min(a[view].height(), b[view].height());
    int differ = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const int u = turned_by_view[view][0] ? b[view].x.second - 1 - x : b[view].x.first + x;
        const int v = turned_by_view[view][1] ? b[view].y.second - 1 - y : b[view].y.first + y;
        differ += is_body(one, a[view].x.first + x, a[view].y.first + y) != is_body(two, u, v);
      }
    }
    EXPECT_LE(differ, 2 * (width + height)) << view;  // a pixel along the outline
  }
}

TEST(ThreeViews, TheScaleIsThatOfTheBody) {
  TriangleMesh mesh = wedge();
  const float length_m = mesh.bounds().extent().x();
  const std::vector<Silhouette> views = silhouettes(draw(mesh, false));
  const Image image = draw(mesh, true);
  int bar = 0;
  for (int y = image.height - 40; y < image.height; ++y) {
    for (const Range& run : runs(image.width, [&](int x) {
           return pixel(image, x, y) == Pixel{0, 0, 0};
         })) {
      bar = std::max(bar, run.second - run.first);
    }
  }
  EXPECT_NEAR(static_cast<float>(bar), static_cast<float>(views[0].width()) / length_m, 1.5F);
}

TEST(ThreeViews, EveryLetterOfACaptionIsDrawn) {
  for (const char letter : std::string("0123456789abcdefghiklmnoprstuvwxyz+-=.,:")) {
    ThreeViewOptions options;
    options.width_px = 600;
    options.height_px = 450;
    options.caption = std::string(1, letter);
    EXPECT_NE(draw_three_views(wedge(), options)->rgb, draw(wedge(), true).rgb) << letter;
  }
}

TEST(ThreeViews, PartsDifferInColour) {
  TriangleMesh mesh = wedge();
  const Image two_parts = draw(mesh, false);
  mesh.parts = {{"wedge", 0, 9}};
  const Image one_part = draw(mesh, false);
  EXPECT_NE(one_part.rgb, two_parts.rgb);
}

TEST(ThreeViews, WhatMakesNoPictureIsRefused) {
  EXPECT_FALSE(draw_three_views(TriangleMesh{}).ok());
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{399, 900}, {1200, 4097}}) {
    ThreeViewOptions options;
    options.width_px = width;
    options.height_px = height;
    EXPECT_FALSE(draw_three_views(wedge(), options).ok());
  }
}

TEST(ThreeViews, BodiesOfAnyShapeAndPlaceFitTheSheet) {
  for (const Eigen::Vector3f& size : std::vector<Eigen::Vector3f>{
           {1, 1, 0}, {0, 1, 1}, {1e-3F, 1e-3F, 30}, {1e4F, 1, 1}, {1, 1e4F, 1e-3F}}) {
    for (const float away : {0.0F, 1.0F, 50.0F}) {
      TriangleMesh mesh = wedge();
      for (Eigen::Vector3f& vertex : mesh.vertices) {
        vertex = (vertex.cwiseProduct(size).array() + away).matrix();
      }
      ThreeViewOptions options;
      options.width_px = options.height_px = 400;
      options.rear_axle_x_m = static_cast<double>(mesh.bounds().center().x());
      EXPECT_TRUE(draw_three_views(mesh, options).ok());
    }
  }
}

}  // namespace
}  // namespace crashrank
