#include "oracle/triangle_oracle.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace oracle {
namespace {

namespace mp = boost::multiprecision;

// Grows without bound; the first 512 bits need no allocation.
using Integer = mp::number<mp::cpp_int_backend<512>, mp::et_off>;

// A double as mantissa · 2^exponent with an odd mantissa, or 0.
struct Scaled {
  std::int64_t mantissa = 0;
  int exponent = std::numeric_limits<int>::max();
};

Scaled scaled(double value) {
  if (value == 0.0) return {};
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  auto mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  exponent -= 53;
  while (mantissa % 2 == 0) {
    mantissa /= 2;
    ++exponent;
  }
  return {mantissa, exponent};
}

using IntegerPoint = std::array<Integer, 3>;

// All six corners multiplied by one power of two that makes every coordinate an integer. Whether
// two bodies share a point does not change with their common scale.
std::array<IntegerPoint, 6> to_integers(const Triangle& a, const Triangle& b) {
  std::array<std::array<Scaled, 3>, 6> parts;
  int least = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      parts[i][k] = scaled(i < 3 ? a[i][k] : b[i - 3][k]);
      least = std::min(least, parts[i][k].exponent);
    }
  }
  std::array<IntegerPoint, 6> points;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Scaled& part = parts[i][k];
      points[i][k] = part.mantissa;
      if (part.mantissa != 0) points[i][k] <<= static_cast<unsigned>(part.exponent - least);
    }
  }
  return points;
}

constexpr std::size_t unknowns = 4;

// constant + Σ coefficient·unknown, required to be at least 0.
struct Inequality {
  Integer constant = 0;
  std::vector<Integer> coefficient;
};

// Fourier-Motzkin: eliminates one unknown after the other, keeping exactly the values of the others
// for which some value of the eliminated one exists.
bool feasible(std::vector<Inequality> system, std::size_t remaining) {
  while (remaining > 0) {
    const std::size_t last = --remaining;
    std::vector<Inequality> next;
    std::vector<const Inequality*> lower;
    std::vector<const Inequality*> upper;
    for (const Inequality& row : system) {
      const int sign = row.coefficient[last].sign();
      if (sign > 0) lower.push_back(&row);
      if (sign < 0) upper.push_back(&row);
      if (sign == 0) next.push_back(row);
    }
    for (const Inequality* low : lower) {
      for (const Inequality* high : upper) {
        const Integer& p = low->coefficient[last];
        const Integer q = -high->coefficient[last];
        Inequality row;
        row.constant = low->constant * q + high->constant * p;
        row.coefficient.resize(last);
        for (std::size_t k = 0; k < last; ++k) {
          row.coefficient[k] = low->coefficient[k] * q + high->coefficient[k] * p;
        }
        next.push_back(std::move(row));
      }
    }
    system = std::move(next);
  }
  return std::all_of(system.begin(), system.end(),
                     [](const Inequality& row) { return row.constant.sign() >= 0; });
}

// The equations A(u, v) = B(s, t), one row a coordinate: coefficients of u, v, s, t, right side.
struct Equations {
  std::array<std::array<Integer, unknowns + 1>, 3> row;
  std::array<std::size_t, 3> pivot_of_row{};  // the unknown that row i solves for, for i < rank
  std::size_t rank = 0;
  Integer pivot = 1;  // common value of all pivots after the elimination

  bool is_pivot(std::size_t column) const {
    return std::find(pivot_of_row.begin(), pivot_of_row.begin() + static_cast<std::ptrdiff_t>(rank),
                     column) != pivot_of_row.begin() + static_cast<std::ptrdiff_t>(rank);
  }
};

// Fraction-free Gauss-Jordan elimination (Bareiss): every division is exact and all pivots end up
// with one common value. Returns false when the equations contradict each other.
bool eliminate(Equations& equations) {
  auto& row = equations.row;
  for (std::size_t column = 0; column < unknowns && equations.rank < 3; ++column) {
    std::size_t found = equations.rank;
    while (found < 3 && row[found][column] == 0) ++found;
    if (found == 3) continue;
    const std::size_t r = equations.rank;
    std::swap(row[found], row[r]);
    const Integer pivot = row[r][column];
    for (std::size_t i = 0; i < 3; ++i) {
      if (i == r) continue;
      const Integer factor = row[i][column];
      for (std::size_t k = 0; k <= unknowns; ++k) {
        row[i][k] = (row[i][k] * pivot - row[r][k] * factor) / equations.pivot;
      }
    }
    equations.pivot = pivot;
    equations.pivot_of_row[equations.rank++] = column;
  }
  for (std::size_t i = equations.rank; i < 3; ++i) {
    if (row[i][unknowns] != 0) return false;
  }
  return true;
}

// Each unknown times the common pivot, as an expression in the free unknowns.
std::array<Inequality, unknowns> solve(const Equations& equations,
                                       const std::vector<std::size_t>& free_unknowns) {
  std::array<Inequality, unknowns> solution;
  for (Inequality& expression : solution) expression.coefficient.resize(free_unknowns.size());
  for (std::size_t f = 0; f < free_unknowns.size(); ++f) {
    solution[free_unknowns[f]].coefficient[f] = equations.pivot;
  }
  for (std::size_t i = 0; i < equations.rank; ++i) {
    Inequality& expression = solution[equations.pivot_of_row[i]];
    expression.constant = equations.row[i][unknowns];
    for (std::size_t f = 0; f < free_unknowns.size(); ++f) {
      expression.coefficient[f] = -equations.row[i][free_unknowns[f]];
    }
  }
  return solution;
}

}  // namespace

bool rational_intersects(const Triangle& a, const Triangle& b) {
  const std::array<IntegerPoint, 6> p = to_integers(a, b);
  Equations equations;
  for (std::size_t k = 0; k < 3; ++k) {
    equations.row[k] = {p[1][k] - p[0][k], p[2][k] - p[0][k], p[3][k] - p[4][k], p[3][k] - p[5][k],
                        p[3][k] - p[0][k]};
  }
  if (!eliminate(equations)) return false;

  std::vector<std::size_t> free_unknowns;
  for (std::size_t k = 0; k < unknowns; ++k) {
    if (!equations.is_pivot(k)) free_unknowns.push_back(k);
  }
  std::array<Inequality, unknowns> solution = solve(equations, free_unknowns);
  if (equations.pivot < 0) {
    equations.pivot = -equations.pivot;
    for (Inequality& expression : solution) {
      expression.constant = -expression.constant;
      for (Integer& coefficient : expression.coefficient) coefficient = -coefficient;
    }
  }

  // u, v, s, t at least 0; 1 - u - v and 1 - s - t too.
  std::vector<Inequality> system(solution.begin(), solution.end());
  for (std::size_t first : {std::size_t{0}, std::size_t{2}}) {
    Inequality rest;
    rest.constant = equations.pivot - solution[first].constant - solution[first + 1].constant;
    for (std::size_t f = 0; f < free_unknowns.size(); ++f) {
      rest.coefficient.push_back(-solution[first].coefficient[f] -
                                 solution[first + 1].coefficient[f]);
    }
    system.push_back(std::move(rest));
  }
  return feasible(std::move(system), free_unknowns.size());
}

}  // namespace oracle
