#pragma once

#include "crashrank/motion/motion.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Draws the dimensions of a Latin hypercube (McKay, Beckman & Conover 1979): [0, 1) is cut into as
/// many equal strata as there are samples, and each sample takes a number of one.
class Strata {
public:
  /// Room for so many samples: nothing allocates after it.
  void prepare(std::size_t samples);
  std::size_t samples() const noexcept { return order_.size(); }
  /// One number in [0, 1) for each sample, valid until the next draw.
  const std::vector<double>& draw(std::uint64_t seed);
  /// The errors of a body's state, one for each sample: of four dimensions of that seed.
  void draw(std::uint64_t seed, const StateUncertainty& uncertainty, StateError* errors);

private:
  std::vector<std::uint32_t> order_;
  std::vector<double> shares_;
};

/// Seed of what has that name.
std::uint64_t seed_of(const std::string& name);
/// Seed of something that is no actor: differs from that of every name.
std::uint64_t reserved_seed(const std::string& name);

/// The number that a normally distributed one of mean 0 and standard deviation 1 stays below with
/// that probability, in (0, 1); relative error about 1e-16 (Wichura 1988, Algorithm AS 241,
/// PPND16).
double normal_deviate(double probability);

}  // namespace crashrank::detail
