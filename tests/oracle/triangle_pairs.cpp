#include "oracle/triangle_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace oracle {
namespace {

// Exact contacts are made on an integer lattice, where barycentric combinations with weights of
// sum `weight_sum` stay integers, and are then scaled by a power of two. All coordinates stay far
// below 2^53, so the doubles hold exactly what was constructed.
using Lattice = std::array<std::int64_t, 3>;
using LatticeTriangle = std::array<Lattice, 3>;
constexpr std::int64_t weight_sum = 16;

struct LatticePair {
  LatticeTriangle a;
  LatticeTriangle b;
};

Lattice plus(const Lattice& p, const Lattice& q, std::int64_t times = 1) {
  return {p[0] + times * q[0], p[1] + times * q[1], p[2] + times * q[2]};
}

Lattice lattice_point(Random& random, std::int64_t reach) {
  return {random.integer(-reach, reach), random.integer(-reach, reach),
          random.integer(-reach, reach)};
}

std::int64_t reach(Random& random) { return std::int64_t{1} << random.integer(1, 20); }

LatticeTriangle lattice_triangle(Random& random, std::int64_t reach) {
  return {lattice_point(random, reach), lattice_point(random, reach), lattice_point(random, reach)};
}

// Corners divisible by weight_sum.
LatticeTriangle divisible_triangle(Random& random, std::int64_t reach) {
  LatticeTriangle t = lattice_triangle(random, reach);
  for (Lattice& corner : t) {
    for (std::int64_t& x : corner) x *= weight_sum;
  }
  return t;
}

// A point of a divisible triangle: inside, or on an edge or corner where a weight comes out as 0.
Lattice point_of(Random& random, const LatticeTriangle& t) {
  const std::int64_t first = random.integer(0, weight_sum);
  const std::int64_t second = random.integer(0, weight_sum - first);
  const std::array<std::int64_t, 3> weight{first, second, weight_sum - first - second};
  Lattice point{0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) point[k] += weight[i] * t[i][k] / weight_sum;
  }
  return point;
}

Lattice point_of_edge(Random& random, const LatticeTriangle& t) {
  const std::int64_t weight = random.integer(0, weight_sum);
  Lattice point{};
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = t[0][k] / weight_sum * weight + t[1][k] / weight_sum * (weight_sum - weight);
  }
  return point;
}

LatticePair coplanar(Random& random) {
  const std::int64_t r = std::int64_t{1} << random.integer(0, 10);
  const Lattice origin = lattice_point(random, 4 * r);
  Lattice u = lattice_point(random, r);
  Lattice v = lattice_point(random, r);
  if (random.chance(0.3)) {  // a plane across an axis, as sheet metal and ground are
    const auto axis = static_cast<std::size_t>(random.integer(0, 2));
    u[axis] = 0;
    v[axis] = 0;
  } else if (random.chance(0.3)) {  // a plane along an axis: edges that share two coordinates
    const auto axis = static_cast<std::size_t>(random.integer(0, 2));
    u = {0, 0, 0};
    u[axis] = random.integer(1, r);
    v[axis] = 0;
  }
  const std::int64_t grid = random.integer(2, 12);
  LatticePair pair;
  for (LatticeTriangle* t : {&pair.a, &pair.b}) {
    for (Lattice& corner : *t) {
      corner = plus(plus(origin, u, random.integer(-grid, grid)), v, random.integer(-grid, grid));
    }
  }
  return pair;
}

LatticePair contained(Random& random) {
  const LatticeTriangle a = divisible_triangle(random, reach(random));
  return {a, {point_of(random, a), point_of(random, a), point_of(random, a)}};
}

LatticePair shared_corners(Random& random, std::size_t shared) {
  const std::int64_t r = reach(random);
  LatticePair pair{lattice_triangle(random, r), lattice_triangle(random, r)};
  for (std::size_t i = 0; i < shared; ++i) pair.b[i] = pair.a[i];
  return pair;
}

LatticePair vertex_on_face(Random& random) {
  const std::int64_t r = reach(random);
  const LatticeTriangle a = divisible_triangle(random, r);
  const Lattice touch = point_of(random, a);
  return {a,
          {touch, plus(touch, lattice_point(random, weight_sum * r)),
           plus(touch, lattice_point(random, weight_sum * r))}};
}

LatticePair edge_on_edge(Random& random) {
  const std::int64_t r = reach(random);
  const LatticeTriangle a = divisible_triangle(random, r);
  const Lattice touch = point_of_edge(random, a);
  const Lattice direction = lattice_point(random, r);
  return {
      a,
      {plus(touch, direction, -random.integer(0, 4)), plus(touch, direction, random.integer(0, 4)),
       plus(touch, lattice_point(random, weight_sum * r))}};
}

LatticePair sliver(Random& random) {
  const std::int64_t r = reach(random);
  LatticePair pair;
  const Lattice near = lattice_point(random, r);
  for (LatticeTriangle* t : {&pair.a, &pair.b}) {
    const Lattice along = lattice_point(random, r);
    const Lattice start = plus(near, lattice_point(random, 2));
    const std::int64_t length = std::int64_t{1} << random.integer(0, 18);
    *t = {plus(start, along, -length), plus(start, along, length),
          plus(plus(start, along, random.integer(-length, length)), lattice_point(random, 1))};
  }
  return pair;
}

LatticePair zero_area(Random& random) {
  const std::int64_t r = reach(random);
  const LatticeTriangle a = divisible_triangle(random, r);
  const Lattice touch = random.chance(0.7) ? point_of(random, a) : lattice_point(random, r);
  const Lattice along = random.chance(0.5) ? plus(point_of(random, a), touch, -1)
                                           : lattice_point(random, weight_sum * r);
  LatticePair pair{a, {touch, touch, touch}};
  if (random.chance(0.7)) {
    for (Lattice& corner : pair.b) corner = plus(touch, along, random.integer(-2, 2));
  }
  if (random.chance(0.4)) {  // A degenerate as well, through a point of it that B may hold
    const Lattice other = random.chance(0.5) ? plus(a[0], a[1], -1) : lattice_point(random, r);
    for (Lattice& corner : pair.a) corner = plus(touch, other, random.integer(-1, 1));
  }
  return pair;
}

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

LatticePair exact_contact(Random& random) {
  switch (random.integer(0, 6)) {
    case 0:
      return coplanar(random);
    case 1:
      return contained(random);
    case 2:
      return shared_corners(random, 1);
    case 3:
      return shared_corners(random, 2);
    case 4:
      return vertex_on_face(random);
    case 5:
      return edge_on_edge(random);
    default:
      return zero_area(random);
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
