#include "rank/strata.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace crashrank::detail {
namespace {

constexpr std::uint64_t sample_seed = 0x6372617368;
constexpr std::uint64_t fnv_prime = 0x100000001b3;

/// Next number of the sequence that `state` represents (splitmix64; Steele, Lea & Flood 2014).
std::uint64_t next_word(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t word = state;
  word = (word ^ (word >> 30U)) * 0xbf58476d1ce4e5b9U;
  word = (word ^ (word >> 27U)) * 0x94d049bb133111ebU;
  return word ^ (word >> 31U);
}

/// Next number in [0, 1).
double next_share(std::uint64_t& state) {
  return static_cast<double>(next_word(state) >> 11U) * 0x1.0p-53;
}

std::uint64_t fnv1a(const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * fnv_prime;
  return hash;
}

/// Ratio of two polynomials; coefficients in ascending order.
double ratio(const std::array<double, 8>& above, const std::array<double, 8>& below, double x) {
  double p = 0.0;
  double q = 0.0;
  for (std::size_t i = above.size(); i-- > 0;) {
    p = p * x + above[i];
    q = q * x + below[i];
  }
  return p / q;
}

}  // namespace

std::uint64_t seed_of(const std::string& name) { return fnv1a(name) ^ sample_seed; }

std::uint64_t reserved_seed(const std::string& name) {
  constexpr std::uint64_t no_character = 0x100;
  return ((fnv1a(name) ^ no_character) * fnv_prime) ^ sample_seed;
}

void Strata::prepare(std::size_t samples) {
  samples_ = samples;
  order_.resize(samples);
  shares_.resize(samples);
}

const std::vector<double>& Strata::draw(std::uint64_t seed, std::size_t count) {
  std::uint64_t state = seed;
  order_.resize(count);
  shares_.resize(count);
  std::iota(order_.begin(), order_.end(), 0U);
  for (std::size_t k = count; k > 1; --k) {
    std::swap(order_[k - 1], order_[next_word(state) % k]);
  }
  for (std::size_t f = 0; f < count; ++f) {
    shares_[f] = (static_cast<double>(order_[f]) + next_share(state)) / static_cast<double>(count);
  }
  return shares_;
}

void Strata::draw(std::uint64_t seed, const StateUncertainty& uncertainty, StateError* errors) {
  std::uint64_t dimension = seed;
  const auto draw_one = [&](double deviation, double StateError::*error) {
    // Each dimension starts from a hashed word and not from a later state of the sequence of the
    // seed: sequences with shifted starts would contain the same numbers.
    std::uint64_t state = ++dimension;
    const std::vector<double>& shares = draw(next_word(state));
    constexpr double least = 0x1.0p-53;
    for (std::size_t f = 0; f < shares.size(); ++f) {
      const double share = std::clamp(shares[f], least, 1.0 - least);
      errors[f].*error = deviation > 0.0 ? deviation * normal_deviate(share) : 0.0;
    }
  };
  draw_one(uncertainty.position_m, &StateError::x_m);
  draw_one(uncertainty.position_m, &StateError::y_m);
  draw_one(uncertainty.heading_rad, &StateError::heading_rad);
  draw_one(uncertainty.speed_mps, &StateError::speed_mps);
}

double normal_deviate(double probability) {
  constexpr std::array<double, 8> a{3.3871328727963666080,   1.3314166789178437745e2,
                                    1.9715909503065514427e3, 1.3731693765509461125e4,
                                    4.5921953931549871457e4, 6.7265770927008700853e4,
                                    3.3430575583588128105e4, 2.5090809287301226727e3};
  constexpr std::array<double, 8> b{1.0,
                                    4.2313330701600911252e1,
                                    6.8718700749205790830e2,
                                    5.3941960214247511077e3,
                                    2.1213794301586595867e4,
                                    3.9307895800092710610e4,
                                    2.8729085735721942674e4,
                                    5.2264952788528545610e3};
  constexpr std::array<double, 8> c{1.42343711074968357734,    4.63033784615654529590,
                                    5.76949722146069140550,    3.64784832476320460504,
                                    1.27045825245236838258,    2.41780725177450611770e-1,
                                    2.27238449892691845833e-2, 7.74545014278341407640e-4};
  constexpr std::array<double, 8> d{1.0,
                                    2.05319162663775882187,
                                    1.67638483018380384940,
                                    6.89767334985100004550e-1,
                                    1.48103976427480074590e-1,
                                    1.51986665636164571966e-2,
                                    5.47593808499534494600e-4,
                                    1.05075007164441684324e-9};
  constexpr std::array<double, 8> e{6.65790464350110377720,    5.46378491116411436990,
                                    1.78482653991729133580,    2.96560571828504891230e-1,
                                    2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                    2.71155556874348757815e-5, 2.01033439929228813265e-7};
  constexpr std::array<double, 8> f{1.0,
                                    5.99832206555887937690e-1,
                                    1.36929880922735805310e-1,
                                    1.48753612908506148525e-2,
                                    7.86869131145613259100e-4,
                                    1.84631831751005468180e-5,
                                    1.42151175831644588870e-7,
                                    2.04426310338993978564e-15};
  const double q = probability - 0.5;
  if (std::abs(q) <= 0.425) return q * ratio(a, b, 0.180625 - q * q);
  const double r = std::sqrt(-std::log(q < 0.0 ? probability : 1.0 - probability));
  const double tail = r <= 5.0 ? ratio(c, d, r - 1.6) : ratio(e, f, r - 5.0);
  return std::copysign(tail, q);
}

}  // namespace crashrank::detail
