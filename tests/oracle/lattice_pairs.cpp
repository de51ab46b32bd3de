#include "oracle/lattice_pairs.hpp"

namespace oracle {
namespace {

constexpr std::int64_t weight_sum = 16;

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

}  // namespace

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

}  // namespace oracle
