#pragma once

#include "crashrank/motion/motion.hpp"

#include <cstddef>

namespace crashrank::detail {

/// Order of motions by what they do, whatever they were written as: negative if `a` precedes `b`,
/// positive if it follows, 0 if both have the same poses and velocities at all times. Compared at
/// times 0, 0.25, 1, 3, 10 and 100 s: the faster one precedes, then the one that turns further to
/// the left, then the greater coordinates of position and orientation; after these times the states
/// at the kinks. A total order of finite motions. Allocates nothing.
int compare_motions(const Motion& a, const Motion& b);

/// Probabilities are equal within this share of the greater one: sums of equal parts round.
inline constexpr double probability_rounding = 1e-9;

/// Index of the greatest of `count` > 0 probabilities, the first of equal ones. `probability_of`
/// returns the probability at an index.
template <class Probability>
std::size_t likeliest_of(std::size_t count, const Probability& probability_of) {
  double most = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    if (probability_of(k) > most) most = probability_of(k);
  }
  std::size_t first = 0;
  while (first + 1 < count && probability_of(first) < most * (1.0 - probability_rounding)) ++first;
  return first;
}

}  // namespace crashrank::detail
