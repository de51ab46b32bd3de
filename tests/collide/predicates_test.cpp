#include "crashrank/internal/base/predicates.hpp"

#include "crashrank/internal/base/products.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cstring>
#include <random>

namespace crashrank {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Point = Eigen::Vector3d;

int sign_of(const Rational& r) { return r < 0 ? -1 : static_cast<int>(r > 0); }

int rational_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  Rational m[3][3];
  const Point* rows[3] = {&b, &c, &d};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m[i][j] = Rational((*rows[i])[j]) - Rational(a[j]);
  }
  return sign_of(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                 m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                 m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
}

int rational_orient2d(const Point& a, const Point& b, const Point& c, int dropped) {
  const int i = (dropped + 1) % 3;
  const int j = (dropped + 2) % 3;
  return sign_of((Rational(b[i]) - Rational(a[i])) * (Rational(c[j]) - Rational(a[j])) -
                 (Rational(b[j]) - Rational(a[j])) * (Rational(c[i]) - Rational(a[i])));
}

// Doubles of every kind: small integers, neighbours of each other, any exponent, subnormal, zero.
class Numbers {
public:
  explicit Numbers(std::uint64_t seed) : engine_(seed) {}

  double next(int kind) {
    switch (kind) {
      case 0:
        return static_cast<double>(static_cast<int>(engine_() % 9) - 4);
      case 1:
        return std::nextafter(1.0 + static_cast<double>(engine_() % 3), 9.0 * sign());
      case 2: {  // any finite bit pattern
        for (;;) {
          const std::uint64_t bits = engine_();
          double value = 0.0;
          std::memcpy(&value, &bits, sizeof value);
          if (std::isfinite(value)) return value;
        }
      }
      case 3:
        return sign() * std::ldexp(static_cast<double>(engine_() % 5), -1074);
      case 4:
        return sign() * std::ldexp(1.0, static_cast<int>(engine_() % 40) - 20);
      default:
        return static_cast<double>(static_cast<std::int64_t>(engine_())) * 0x1p-63;
    }
  }
  Point point(int kind) { return {next(kind), next(kind), next(kind)}; }
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }

private:
  double sign() { return engine_() % 2 == 0 ? 1.0 : -1.0; }
  std::mt19937_64 engine_;
};

TEST(Predicates, Orient3dEqualsRationals) {
  constexpr std::uint64_t seed = 20260101;
  Numbers numbers(seed);
  std::uint64_t exact = 0;
  int zeros = 0;
  for (int n = 0; n < 30'000; ++n) {
    const int kind = static_cast<int>(numbers.below(6));
    const int other = numbers.below(4) == 0 ? static_cast<int>(numbers.below(6)) : kind;
    const Point a = numbers.point(kind);
    const Point b = numbers.point(other);
    const Point c = numbers.point(kind);
    const Point d = numbers.below(3) == 0 ? Point(a + (b - a) * 0.5) : numbers.point(kind);
    if (!d.allFinite()) continue;
    const int expected = rational_orient3d(a, b, c, d);
    zeros += static_cast<int>(expected == 0);
    ASSERT_EQ(orient3d(a, b, c, d, exact), expected) << "seed " << seed << " case " << n;
  }
  EXPECT_GT(zeros, 100);
  EXPECT_GT(exact, 100U);
}

TEST(Predicates, Orient2dEqualsRationals) {
  constexpr std::uint64_t seed = 20260102;
  Numbers numbers(seed);
  std::uint64_t exact = 0;
  int zeros = 0;
  for (int n = 0; n < 30'000; ++n) {
    const int kind = static_cast<int>(numbers.below(6));
    const int dropped = static_cast<int>(numbers.below(3));
    const Point a = numbers.point(kind);
    const Point b = numbers.point(kind);
    const Point c = numbers.below(3) == 0 ? Point(a + (b - a) * 2.0) : numbers.point(kind);
    if (!c.allFinite()) continue;
    const int expected = rational_orient2d(a, b, c, dropped);
    zeros += static_cast<int>(expected == 0);
    ASSERT_EQ(orient2d(a, b, c, dropped, exact), expected) << "seed " << seed << " case " << n;
  }
  EXPECT_GT(zeros, 100);
  EXPECT_GT(exact, 100U);
}

TEST(Predicates, ExtremesOfDoubleAreDecided) {
  std::uint64_t exact = 0;
  const double big = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const Point o(-big, -big, -big);
  EXPECT_EQ(orient3d(o, {big, 0, tiny}, {0, big, 0}, {tiny, 0, big}, exact),
            rational_orient3d(o, {big, 0, tiny}, {0, big, 0}, {tiny, 0, big}));
  EXPECT_EQ(orient3d({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}, exact), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, -tiny}, exact), -1);
  EXPECT_EQ(orient3d({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {big, big, 0}, exact), 0);
  EXPECT_EQ(exact, 3U);  // the last one has only equal heights, which needs no integers
}

TEST(ExactInteger, ArithmeticEqualsBigIntegers) {
  using Big = boost::multiprecision::cpp_int;
  using detail::ExactInteger;
  constexpr std::uint64_t seed = 20260103;
  std::mt19937_64 engine(seed);
  const auto make = [&](ExactInteger<3>& x) {
    x = {};
    x.size = engine() % 4;
    Big big = 0;
    for (std::size_t i = 0; i < x.size; ++i) {
      // All-ones and all-zero limbs drive the carries.
      const std::uint64_t kind = engine() % 4;
      x.limb[i] = kind == 0 ? ~std::uint64_t{0} : kind == 1 ? 0 : engine();
    }
    if (x.size > 0 && x.limb[x.size - 1] == 0) x.limb[x.size - 1] = 1;
    x.sign = x.size == 0 ? 0 : (engine() % 2 == 0 ? 1 : -1);
    for (std::size_t i = x.size; i-- > 0;) big = (big << 64) + x.limb[i];
    return Big(x.sign < 0 ? -big : big);
  };
  const auto value = [](const auto& x) {
    Big big = 0;
    for (std::size_t i = x.size; i-- > 0;) big = (big << 64) + x.limb[i];
    return Big(x.sign < 0 ? -big : big);
  };
  for (int n = 0; n < 20'000; ++n) {
    ExactInteger<3> x;
    ExactInteger<3> y;
    const Big bx = make(x);
    const Big by = make(y);
    ASSERT_EQ(value(detail::add<4>(x, y)), bx + by) << "seed " << seed << " case " << n;
    ASSERT_EQ(value(detail::add<4>(x, y, true)), bx - by) << "seed " << seed << " case " << n;
    ASSERT_EQ(value(detail::multiply(x, y)), bx * by) << "seed " << seed << " case " << n;
  }
}

}  // namespace
}  // namespace crashrank
