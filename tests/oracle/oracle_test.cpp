#include "oracle/triangle_oracle.hpp"
#include "oracle/triangle_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using oracle::Family;
using oracle::Triangle;

struct Case {
  std::string what;
  Triangle a;
  Triangle b;
  bool touches;
};

const Triangle floor_tile{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
const double above = std::nextafter(0.0, 1.0);
const double past_two = std::nextafter(2.0, 3.0);
const double before_two = std::nextafter(2.0, 1.0);

const std::vector<Case> cases{
    {"pierced", floor_tile, {{{1, 1, -1}, {1, 1, 1}, {9, 9, 1}}}, true},
    {"passes the hypotenuse", floor_tile, {{{3, 3, -1}, {3, 3, 1}, {9, 9, 1}}}, false},
    {"stands on the face", floor_tile, {{{1, 1, 0}, {1, 2, 3}, {2, 1, 3}}}, true},
    {"stands a denormal above", floor_tile, {{{1, 1, above}, {1, 2, 3}, {2, 1, 3}}}, false},
    {"stands on the hypotenuse", floor_tile, {{{2, 2, 0}, {5, 5, 3}, {6, 5, 3}}}, true},
    {"an ulp past the hypotenuse", floor_tile, {{{past_two, 2, 0}, {5, 5, 3}, {6, 5, 3}}}, false},
    {"an ulp inside it", floor_tile, {{{before_two, 2, 0}, {5, 5, 3}, {6, 5, 3}}}, true},
    {"edge crosses edge", floor_tile, {{{2, 0, -1}, {2, 0, 1}, {2, -3, 0}}}, true},
    {"corner on corner", floor_tile, {{{4, 0, 0}, {9, 0, 1}, {9, 1, 1}}}, true},
    {"common edge, folded", floor_tile, {{{0, 0, 0}, {4, 0, 0}, {0, -4, 3}}}, true},
    {"coplanar, apart", floor_tile, {{{5, 5, 0}, {9, 5, 0}, {5, 9, 0}}}, false},
    {"coplanar, overlapping", floor_tile, {{{1, 1, 0}, {9, 1, 0}, {1, 9, 0}}}, true},
    {"coplanar, inside", floor_tile, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}, true},
    {"coplanar, edges cross and no corner inside",
     {{{0, 0, 0}, {6, 0, 0}, {3, 6, 0}}},
     {{{0, 4, 0}, {6, 4, 0}, {3, -2, 0}}},
     true},
    {"coplanar, touching along the hypotenuse",
     floor_tile,
     {{{3, 1, 0}, {1, 3, 0}, {5, 5, 0}}},
     true},
    {"coplanar, touching corner to edge", floor_tile, {{{2, 2, 0}, {6, 5, 0}, {5, 6, 0}}}, true},
    {"parallel planes", floor_tile, {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}, false},
    {"the same triangle", floor_tile, floor_tile, true},
    {"planes cross, intervals apart", floor_tile, {{{5, 1, -1}, {7, 1, -1}, {6, 1, 5}}}, false},
    {"segment pierces", floor_tile, {{{1, 1, -1}, {1, 1, 1}, {1, 1, 0.5}}}, true},
    {"segment misses", floor_tile, {{{5, 1, -1}, {5, 1, 1}, {5, 1, 0.5}}}, false},
    {"segment in the plane, through", floor_tile, {{{-1, 1, 0}, {9, 1, 0}, {0, 1, 0}}}, true},
    {"segment in the plane, past", floor_tile, {{{5, -1, 0}, {5, 9, 0}, {5, 1, 0}}}, false},
    {"segment ends on the face", floor_tile, {{{1, 1, 0}, {1, 1, 5}, {1, 1, 5}}}, true},
    {"segments cross",
     {{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}}},
     {{{0, -1, 0}, {0, 1, 0}, {0, 1, 0}}},
     true},
    {"segments pass",
     {{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}}},
     {{{0, -1, above}, {0, 1, above}, {0, 1, above}}},
     false},
    {"segments on one line, overlapping",
     {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
     {{{1, 1, 1}, {3, 3, 3}, {3, 3, 3}}},
     true},
    {"segments on one line, end to end",
     {{{0, 0, 0}, {1, 1, 1}, {1, 1, 1}}},
     {{{1, 1, 1}, {3, 3, 3}, {2, 2, 2}}},
     true},
    {"segments on one line, apart",
     {{{0, 0, 0}, {1, 1, 1}, {1, 1, 1}}},
     {{{2, 2, 2}, {3, 3, 3}, {3, 3, 3}}},
     false},
    {"segments parallel",
     {{{0, 0, 0}, {1, 1, 1}, {1, 1, 1}}},
     {{{1, 0, 0}, {2, 1, 1}, {2, 1, 1}}},
     false},
    {"point on the face", floor_tile, {{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, true},
    {"point above", floor_tile, {{{1, 1, above}, {1, 1, above}, {1, 1, above}}}, false},
    {"point beside, in the plane", floor_tile, {{{3, 3, 0}, {3, 3, 0}, {3, 3, 0}}}, false},
    {"point on a segment",
     {{{0, 0, 0}, {2, 2, 2}, {0, 0, 0}}},
     {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}},
     true},
    {"point past a segment",
     {{{0, 0, 0}, {2, 2, 2}, {0, 0, 0}}},
     {{{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}},
     false},
    {"equal points",
     {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}},
     {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}},
     true},
    {"different points",
     {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}},
     {{{1, 2, 4}, {1, 2, 4}, {1, 2, 4}}},
     false},
    {"zeros of both signs",
     {{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}},
     {{{-0.0, -0.0, -0.0}, {-0.0, -0.0, -0.0}, {-0.0, -0.0, -0.0}}},
     true},
};

// Every order of the corners of both, and both orders of the two.
template <class Check> void for_all_orders(const Case& item, Check check) {
  Triangle a = item.a;
  Triangle b = item.b;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  do {
    do {
      check(a, b);
      check(b, a);
    } while (std::next_permutation(b.begin(), b.end()));
  } while (std::next_permutation(a.begin(), a.end()));
}

TEST(Oracles, KnowTheHandMadeCases) {
  for (const Case& item : cases) {
    for_all_orders(item, [&item](const Triangle& a, const Triangle& b) {
      EXPECT_EQ(oracle::rational_intersects(a, b), item.touches) << item.what;
      EXPECT_EQ(oracle::cgal_intersects(a, b), item.touches) << item.what;
    });
  }
}

TEST(Oracles, AgreeOnEveryFamilyAndSeeBothAnswersThere) {
  constexpr std::uint64_t seed = 20160601;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  oracle::PairGenerator generator(seed, 1.0);
  for (std::size_t f = 0; f < oracle::family_count; ++f) {
    const auto family = static_cast<Family>(f);
    int hits = 0;
    constexpr int pairs = 1500;
    for (int i = 0; i < pairs; ++i) {
      const oracle::TrianglePair pair = generator.next(family);
      const bool truth = oracle::rational_intersects(pair.a, pair.b);
      ASSERT_EQ(truth, oracle::cgal_intersects(pair.a, pair.b))
          << "seed " << seed << ", family " << name(family) << ", pair " << i;
      hits += truth ? 1 : 0;
    }
    EXPECT_GT(hits, pairs / 50) << name(family);
    EXPECT_LE(hits, pairs) << name(family);
    // Some families touch by construction as long as nothing was rounded.
    const bool always = family == Family::shared_vertex || family == Family::shared_edge;
    EXPECT_EQ(hits == pairs, always) << name(family) << ": " << hits;
  }
}

TEST(Oracles, TheStreamIsTheSameForASeedAndOtherForAnother) {
  oracle::PairGenerator first(7, 0.5);
  oracle::PairGenerator same(7, 0.5);
  oracle::PairGenerator other(8, 0.5);
  int different = 0;
  for (int i = 0; i < 100; ++i) {
    const oracle::TrianglePair pair = first.next();
    const oracle::TrianglePair copy = same.next();
    EXPECT_EQ(pair.a, copy.a);
    EXPECT_EQ(pair.b, copy.b);
    different += pair.a != other.next().a ? 1 : 0;
  }
  EXPECT_EQ(different, 100);
}

}  // namespace
