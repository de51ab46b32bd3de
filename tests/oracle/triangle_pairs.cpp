#include "oracle/triangle_pairs.hpp"

#include "oracle/lattice_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace oracle {
namespace {

Triangle to_doubles(const LatticeTriangle& t, int exponent) {
  Triangle result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[i][k] = std::ldexp(static_cast<double>(t[i][k]), exponent);
    }
  }
  return result;
}

double size(const Triangle& t) {
  double largest = 0.0;
  for (const Point& p : t) {
    for (const double x : p) largest = std::max(largest, std::abs(x));
  }
  return largest;
}

// A power of two that brings the pair somewhere between 1e-6 and 1e6 m.
TrianglePair scaled(Random& random, const LatticePair& pair) {
  TrianglePair result{to_doubles(pair.a, 0), to_doubles(pair.b, 0)};
  const double largest = std::max({size(result.a), size(result.b), 1.0});
  const auto wanted = static_cast<int>(random.integer(-20, 20));
  const int exponent = wanted - std::ilogb(largest);
  result.a = to_doubles(pair.a, exponent);
  result.b = to_doubles(pair.b, exponent);
  return result;
}

// Turns every corner with the same rounded arithmetic: equal corners stay equal, planes and lines
// come out right up to rounding.
void turn(Random& random, TrianglePair& pair) {
  const auto turn_in = [](Point& p, std::size_t i, std::size_t j, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double first = c * p[i] - s * p[j];
    p[j] = s * p[i] + c * p[j];
    p[i] = first;
  };
  const bool about_one_axis = random.chance(0.5);
  const auto axis = static_cast<std::size_t>(random.integer(0, 2));
  const std::size_t next = (axis + 1) % 3;
  const std::size_t last = (axis + 2) % 3;
  const double first_angle = random.real(-3.2, 3.2);
  const double second_angle = random.real(-3.2, 3.2);
  const double scale = std::max(size(pair.a), size(pair.b));
  const Point shift{random.real(-scale, scale), random.real(-scale, scale),
                    random.real(-scale, scale)};
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Point& p : *t) {
      turn_in(p, next, last, first_angle);
      if (!about_one_axis) turn_in(p, axis, next, second_angle);
      for (std::size_t k = 0; k < 3; ++k) p[k] += shift[k];
    }
  }
}

double nudged(double value, std::int64_t ulps) {
  const double toward =
      ulps < 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  for (std::int64_t i = 0; i < std::abs(ulps); ++i) value = std::nextafter(value, toward);
  return value;
}

TrianglePair ulp_touching(Random& random) {
  TrianglePair pair = scaled(random, exact_contact(random));
  if (random.chance(0.5)) turn(random, pair);
  const std::int64_t moves = random.integer(1, 3);
  for (std::int64_t i = 0; i < moves; ++i) {
    Triangle& t = random.chance(0.5) ? pair.a : pair.b;
    const auto corner = static_cast<std::size_t>(random.integer(0, 2));
    double& x = t[corner][static_cast<std::size_t>(random.integer(0, 2))];
    // A coordinate that is 0 has denormal neighbours; they are met now and then, not always.
    if (x != 0.0 || random.chance(0.1)) x = nudged(x, random.integer(-4, 4));
  }
  return pair;
}

Point point_near(Random& random, double reach) {
  return {random.real(-reach, reach), random.real(-reach, reach), random.real(-reach, reach)};
}

Triangle triangle_near(Random& random, const Point& center, double reach) {
  Triangle t;
  for (Point& p : t) {
    p = point_near(random, reach);
    for (std::size_t k = 0; k < 3; ++k) p[k] += center[k];
  }
  return t;
}

// A point of the triangle as double arithmetic finds it.
Point rounded_point_of(Random& random, const Triangle& t) {
  double u = random.real(0.0, 1.0);
  double v = random.real(0.0, 1.0);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  if (random.chance(0.3)) v = 0.0;
  Point p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = t[0][k] + u * (t[1][k] - t[0][k]) + v * (t[2][k] - t[0][k]);
  }
  return p;
}

double any_size(Random& random) { return std::pow(10.0, random.real(-6.0, 6.0)); }

TrianglePair random_pair(Random& random) {
  const double reach = any_size(random);
  const Point center = point_near(random, random.chance(0.5) ? reach : 10.0 * reach);
  Point other = center;
  for (double& x : other) x += random.real(-0.5, 0.5) * reach;
  return {triangle_near(random, center, reach), triangle_near(random, other, reach)};
}

TrianglePair rounded_touch(Random& random) {
  const double reach = any_size(random);
  TrianglePair pair;
  pair.a = triangle_near(random, point_near(random, reach), reach);
  const Point touch = rounded_point_of(random, pair.a);
  pair.b = triangle_near(random, touch, reach);
  if (random.chance(0.5)) {
    pair.b[0] = touch;
  } else {  // the point lies on an edge of B, up to rounding
    for (std::size_t k = 0; k < 3; ++k) pair.b[1][k] = touch[k] - (pair.b[0][k] - touch[k]);
  }
  return pair;
}

// An edge of A runs along a coordinate axis and B lies in A's plane as double arithmetic finds it:
// most terms of an orientation vanish, and the error bound has nothing to hide behind.
TrianglePair along_axis(Random& random) {
  const double reach = any_size(random);
  TrianglePair pair;
  pair.a = triangle_near(random, point_near(random, reach), reach);
  const auto axis = static_cast<std::size_t>(random.integer(0, 2));
  pair.a[1] = pair.a[0];
  pair.a[1][axis] += random.real(-reach, reach);
  for (Point& p : pair.b) {
    const double u = random.real(-0.5, 1.5);
    const double v = random.real(-0.5, 1.5);
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = pair.a[0][k] + u * (pair.a[1][k] - pair.a[0][k]) + v * (pair.a[2][k] - pair.a[0][k]);
    }
  }
  if (random.chance(0.3)) pair.b[0] = triangle_near(random, pair.b[0], reach)[0];
  return pair;
}

TrianglePair mixed_sizes(Random& random) {
  TrianglePair pair;
  const double large = any_size(random);
  pair.a = triangle_near(random, point_near(random, large), large);
  const Point touch = rounded_point_of(random, pair.a);
  pair.b = triangle_near(random, touch, any_size(random));
  if (random.chance(0.3)) pair.b[0] = touch;
  return pair;
}

TrianglePair on_lattice(Random& random, const LatticePair& lattice) {
  TrianglePair pair = scaled(random, lattice);
  if (random.chance(0.4)) turn(random, pair);
  return pair;
}

TrianglePair make(Random& random, Family family) {
  switch (family) {
    case Family::random:
      return random_pair(random);
    case Family::coplanar:
      return on_lattice(random, coplanar(random));
    case Family::contained:
      return on_lattice(random, contained(random));
    case Family::shared_vertex:
      return on_lattice(random, shared_corners(random, 1));
    case Family::shared_edge:
      return on_lattice(random, shared_corners(random, 2));
    case Family::vertex_on_face:
      return on_lattice(random, vertex_on_face(random));
    case Family::edge_on_edge:
      return on_lattice(random, edge_on_edge(random));
    case Family::ulp_touching:
      return ulp_touching(random);
    case Family::rounded_touch:
      return rounded_touch(random);
    case Family::sliver:
      return on_lattice(random, sliver(random));
    case Family::zero_area:
      return on_lattice(random, zero_area(random));
    case Family::along_axis:
      return along_axis(random);
    case Family::mixed_sizes:
      return mixed_sizes(random);
  }
  return {};
}

// No family may depend on which corner comes first or which triangle is called A.
void shuffle(Random& random, TrianglePair& pair) {
  for (Triangle* t : {&pair.a, &pair.b}) {
    std::rotate(t->begin(), t->begin() + random.integer(0, 2), t->end());
    if (random.chance(0.5)) std::swap((*t)[0], (*t)[1]);
  }
  if (random.chance(0.5)) std::swap(pair.a, pair.b);
}

}  // namespace

const char* name(Family family) {
  static constexpr std::array<const char*, family_count> names{
      "random",      "coplanar",   "contained",    "shared-vertex", "shared-edge",
      "vertex-face", "edge-edge",  "ulp-touching", "rounded-touch", "sliver",
      "zero-area",   "along-axis", "mixed-sizes"};
  return names[static_cast<std::size_t>(family)];
}

TrianglePair PairGenerator::next() {
  if (!random_.chance(adversarial_)) return next(Family::random);
  return next(static_cast<Family>(random_.integer(1, static_cast<std::int64_t>(family_count) - 1)));
}

TrianglePair PairGenerator::next(Family family) {
  TrianglePair pair = make(random_, family);
  shuffle(random_, pair);
  pair.family = family;
  return pair;
}

}  // namespace oracle
