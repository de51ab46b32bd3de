#pragma once

#include "crashrank/motion/motion.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Draws the dimensions of a Latin hypercube sample (McKay, Beckman & Conover 1979): [0, 1) is
/// divided into as many equal strata as there are samples, and each sample gets a number from a
/// different stratum.
class Strata {
public:
  /// Allocates for a number of samples; no other member allocates.
  void prepare(std::size_t samples);
  std::size_t samples() const noexcept { return samples_; }
  /// One number in [0, 1) for each of `count` samples, at most the prepared number; valid until the
  /// next draw.
  const std::vector<double>& draw(std::uint64_t seed, std::size_t count);
  const std::vector<double>& draw(std::uint64_t seed) { return draw(seed, samples_); }
  /// Draws the errors of the state of a body, one for each sample: four dimensions derived from the
  /// seed.
  void draw(std::uint64_t seed, const StateUncertainty& uncertainty, StateError* errors);

private:
  std::size_t samples_ = 0;
  std::vector<std::uint32_t> order_;
  std::vector<double> shares_;
};

/// Seed of an actor, from its name.
std::uint64_t seed_of(const std::string& name);
/// Seed of something that is not an actor: differs from the seed of every name.
std::uint64_t reserved_seed(const std::string& name);

/// Quantile of the standard normal distribution at a probability in (0, 1); relative error about
/// 1e-16 (Wichura 1988, Algorithm AS 241, PPND16).
double normal_deviate(double probability);

}  // namespace crashrank::detail
