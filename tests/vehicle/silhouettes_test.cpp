#include "crashrank/internal/vehicle/silhouettes.hpp"

#include "base/random.hpp"
#include "crashrank/vehicle/vehicle.hpp"
#include "oracle/shipped_models.hpp"
#include "tree/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace crashrank {
namespace {

/// Ends of the interval of a node that holds a value, or is nearest to it.
SilhouetteNode interval_of(const Silhouettes& all, const Silhouette& s, std::uint32_t node,
                           float value) {
  SilhouetteNode best = all.nodes[s.first + node];
  for (std::uint32_t layer = 1; layer < s.layers; ++layer) {
    const SilhouetteNode& other = all.nodes[s.first + layer * s.count + node];
    if (std::min(other.greatest_m - value, value - other.least_m) >
        std::min(best.greatest_m - value, value - best.least_m)) {
      best = other;
    }
  }
  return best;
}

/// Greatest and least coordinate of the body around a value at a place along a silhouette's axis.
SilhouetteNode sample(const Silhouettes& all, const Silhouette& s, double place, double value) {
  const double at = (place - static_cast<double>(s.low_m)) * static_cast<double>(s.nodes_per_m);
  EXPECT_GE(at, 0.0);
  const auto i = static_cast<std::uint32_t>(at);
  EXPECT_LT(i + 1, s.count);
  const auto t = static_cast<float>(at - i);
  const SilhouetteNode p = interval_of(all, s, i, static_cast<float>(value));
  const SilhouetteNode q = interval_of(all, s, i + 1, static_cast<float>(value));
  return {p.greatest_m + t * (q.greatest_m - p.greatest_m),
          p.least_m + t * (q.least_m - p.least_m)};
}

TEST(Silhouettes, OfABoxAreItsFaces) {
  constexpr std::uint64_t seed = 401;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  test::Random random(seed);
  for (int i = 0; i < 20; ++i) {
    const double length = random.uniform(0.2, 8.0);
    const double width = random.uniform(0.2, 3.0);
    const double x = random.uniform(-2, 2);
    const double y = random.uniform(-2, 2);
    const Result<Profile> profile =
        make_profile(test::box_mesh({0.5 * length, 0.5 * width, 0.5}, {x, y, 0.5}));
    ASSERT_TRUE(profile);
    const Silhouettes s = make_silhouettes(*profile);
    // Outlines keep to within a quarter of a cell of their raster.
    const double off_m = 0.25 * std::clamp(std::max(length, width) / 250.0, 0.002, 0.02);
    EXPECT_NEAR(s.width_m(), std::min(length, width), 2.0 * off_m);
    for (std::size_t band = lowest_pressing_band; band < profile_bands; ++band) {
      if (profile_edges_m[band] >= 1.0) {
        EXPECT_EQ(s.along_x[band].count, 0U);
        EXPECT_EQ(s.along_y[band].count, 0U);
        continue;
      }
      for (int k = 0; k < 50; ++k) {
        const SilhouetteNode ends =
            sample(s, s.along_x[band], y + width * random.uniform(-0.499, 0.499), x);
        ASSERT_NEAR(ends.greatest_m, x + 0.5 * length, off_m);
        ASSERT_NEAR(ends.least_m, x - 0.5 * length, off_m);
        const SilhouetteNode flanks =
            sample(s, s.along_y[band], x + length * random.uniform(-0.499, 0.499), y);
        ASSERT_NEAR(flanks.greatest_m, y + 0.5 * width, off_m);
        ASSERT_NEAR(flanks.least_m, y - 0.5 * width, off_m);
      }
    }
  }
}

bool presses(const PieceBlock& block, std::uint32_t piece) {
  return (block.presses >> (piece - block.first) & 1) != 0;
}

bool has_opposite_within_m(const Profile& profile, std::size_t band, std::uint32_t i,
                           double most_m) {
  const OutlinePiece& a = profile.pieces[i];
  const auto first = profile.pieces.begin() + profile.first[band];
  return std::any_of(first, profile.pieces.begin() + profile.first[band + 1], [&](const auto& b) {
    return a.normal_x * b.normal_x + a.normal_y * b.normal_y < 0.0F &&
           static_cast<double>(std::hypot(b.x - a.x, b.y - a.y)) <= most_m;
  });
}

TEST(Silhouettes, FacesOfANarrowGapDoNotPress) {
  constexpr std::uint64_t seed = 402;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  test::Random random(seed);
  for (const double gap_m : {0.1, 0.25, 0.35, 0.6}) {
    for (int i = 0; i < 10; ++i) {
      // Two boxes of 2 x 1 m side by side, turned.
      const double turn = random.uniform(-3, 3);
      TriangleMesh mesh;
      for (const double side : {-1.0, 1.0}) {
        const TriangleMesh box =
            test::box_mesh({1.0, 0.5, 0.5}, {0.0, side * (0.5 + 0.5 * gap_m), 0.5});
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto& v : box.vertices) {
          mesh.vertices.emplace_back(std::cos(turn) * static_cast<double>(v.x()) -
                                         std::sin(turn) * static_cast<double>(v.y()),
                                     std::sin(turn) * static_cast<double>(v.x()) +
                                         std::cos(turn) * static_cast<double>(v.y()),
                                     v.z());
        }
        for (auto t : box.triangles) {
          for (auto& corner : t) corner += first;
          mesh.triangles.push_back(t);
        }
      }
      const Profile profile = *make_profile(mesh);
      const Silhouettes s = make_silhouettes(profile);
      double length_m = 0.0;
      for (const PieceBlock& block : s.blocks) {
        if (block.band != 3) continue;
        for (std::uint32_t k = block.first; k < block.first + block.count; ++k) {
          if (presses(block, k)) length_m += static_cast<double>(profile.pieces[k].length_m);
        }
      }
      EXPECT_NEAR(length_m, gap_m <= static_cast<double>(folding_gap_m) ? 8.0 : 12.0, 0.4) << gap_m;
    }
  }
}

TEST(Silhouettes, BlocksCoverAllPiecesThatPressAndGroupsHoldThem) {
  for (const char* name : {"sedan", "hatch", "truck", "motorcycle", "pedestrian", "pole", "tram",
                           "semitrailer", "wheelchair"}) {
    const Result<TriangleMesh> mesh =
        oracle::read_obj(std::string(CRASHRANK_MODEL_FOLDER "/") + name + ".obj");
    ASSERT_TRUE(mesh);
    const Result<Profile> profile = make_profile(*mesh);
    ASSERT_TRUE(profile);
    const Silhouettes s = make_silhouettes(*profile);
    std::vector<int> covered(profile->pieces.size(), 0);
    for (const PieceBlock& block : s.blocks) {
      ASSERT_GT(block.count, 0U);
      ASSERT_LE(block.count, 16U);
      ASSERT_GE(block.first, profile->first[block.band]);
      ASSERT_LE(block.first + block.count, profile->first[block.band + 1U]);
      for (std::uint32_t i = block.first; i < block.first + block.count; ++i) {
        const OutlinePiece& piece = profile->pieces[i];
        if (presses(block, i)) ++covered[i];
        ASSERT_GE(piece.x, s.min_x);
        ASSERT_LE(piece.x, s.max_x);
        ASSERT_GE(piece.y, s.min_y);
        ASSERT_LE(piece.y, s.max_y);
      }
    }
    for (std::size_t band = 0; band < profile_bands; ++band) {
      for (std::uint32_t i = profile->first[band]; i < profile->first[band + 1]; ++i) {
        const bool may_fold = has_opposite_within_m(*profile, band, i, 0.45);
        ASSERT_LE(covered[i], band < lowest_pressing_band ? 0 : 1) << name;
        ASSERT_TRUE(band < lowest_pressing_band || covered[i] == 1 || may_fold) << name;
      }
    }
    std::size_t grouped = 0;
    for (const BlockGroup& group : s.groups) {
      const BandBounds& bounds = s.bands[group.band];
      // Silhouettes are read on nodes.
      const float node_m = 1.0F / s.along_x[group.band].nodes_per_m;
      for (std::size_t lane = 0; lane < 8; ++lane) {
        if (group.half_x[lane] < 0.0F) continue;
        const PieceBlock& block = s.blocks[group.first + lane];
        ++grouped;
        ASSERT_EQ(block.band, group.band) << name;
        for (std::uint32_t i = block.first; i < block.first + block.count; ++i) {
          const OutlinePiece& piece = profile->pieces[i];
          ASSERT_LE(std::abs(piece.x - group.x[lane]), group.half_x[lane] + 1e-5F) << name;
          ASSERT_LE(std::abs(piece.y - group.y[lane]), group.half_y[lane] + 1e-5F) << name;
          ASSERT_GE(piece.x, bounds.min_x - node_m) << name;
          ASSERT_LE(piece.x, bounds.max_x + node_m) << name;
          ASSERT_GE(piece.y, bounds.min_y - node_m) << name;
          ASSERT_LE(piece.y, bounds.max_y + node_m) << name;
        }
      }
    }
    ASSERT_EQ(grouped, s.blocks.size()) << name;
    std::printf("%s: %zu pieces in %zu blocks\n", name, profile->pieces.size(), s.blocks.size());
  }
}

TEST(Silhouettes, FewPiecesLieOutsideThem) {
  for (const char* name : {"sedan", "truck", "motorcycle", "pedestrian"}) {
    const Profile profile =
        *make_profile(*oracle::read_obj(std::string(CRASHRANK_MODEL_FOLDER "/") + name + ".obj"));
    const Silhouettes s = make_silhouettes(profile);
    const double step = 1.0 / static_cast<double>(s.along_x[2].nodes_per_m);
    std::size_t outside = 0;
    double furthest = 0.0;
    for (std::size_t band = lowest_pressing_band; band < profile_bands; ++band) {
      for (std::uint32_t i = profile.first[band]; i < profile.first[band + 1]; ++i) {
        const OutlinePiece& piece = profile.pieces[i];
        const auto x = static_cast<double>(piece.x);
        const auto y = static_cast<double>(piece.y);
        const SilhouetteNode ends = sample(s, s.along_x[band], y, x);
        const SilhouetteNode flanks = sample(s, s.along_y[band], x, y);
        const float beyond =
            std::max(std::max(piece.x - ends.greatest_m, ends.least_m - piece.x),
                     std::max(piece.y - flanks.greatest_m, flanks.least_m - piece.y));
        // Where an outline turns or ends between two nodes, interpolation cuts its corner.
        outside += static_cast<double>(beyond) > 0.5 * step ? 1U : 0U;
        furthest = std::max(furthest, static_cast<double>(beyond));
      }
    }
    const double share = static_cast<double>(outside) / static_cast<double>(profile.pieces.size());
    std::printf("%s: %.2f %% of the pieces over half a node outside, furthest %.3f m\n", name,
                100.0 * share, furthest);
    EXPECT_LT(share, 0.25) << name << ": the goal is none";
  }
}

TEST(Silhouettes, OfNothingAreEmpty) {
  const Silhouettes s = make_silhouettes(Profile{});
  EXPECT_TRUE(s.nodes.empty());
  EXPECT_TRUE(s.blocks.empty());
}

}  // namespace
}  // namespace crashrank
