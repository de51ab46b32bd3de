#pragma once

#include "oracle/triangle_oracle.hpp"
#include "oracle/triangle_pairs.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace oracle {

/// A triangle test on trial.
using TriangleTest = bool (*)(const Triangle& a, const Triangle& b);

struct CampaignOptions {
  std::uint64_t pairs = 200'000;
  std::uint64_t seed = 1;
  double adversarial = 0.5;  ///< share of pairs that are not plainly random
  bool rational = true;      ///< judged by the rational oracle
  bool cgal = true;          ///< judged by CGAL
  int print_first = 5;       ///< wrong answers written to stderr, corners in hexadecimal
  bool progress = false;     ///< a percentage on stderr
};

/// What came out for one family of pairs, or for all.
struct Tally {
  std::uint64_t pairs = 0;
  std::uint64_t touching = 0;
  std::uint64_t oracles_differ = 0;
  std::uint64_t order_matters = 0;          ///< the answer for (b, a) is not that for (a, b)
  std::array<std::uint64_t, 2> missed{};    ///< by oracle: rational, CGAL
  std::array<std::uint64_t, 2> invented{};  ///< by oracle

  Tally& operator+=(const Tally& other);
  /// Wrong answers as counted by one oracle: 0 rational, 1 CGAL.
  std::uint64_t wrong(std::size_t oracle) const { return missed[oracle] + invented[oracle]; }
  bool clean() const { return wrong(0) + wrong(1) + oracles_differ + order_matters == 0; }
};

struct CampaignResult {
  std::array<Tally, family_count> family;
  Tally all() const;
};

/// Holds a triangle test against the oracles over a seeded stream of pairs.
CampaignResult run_campaign(TriangleTest test, const CampaignOptions& options);

/// The counts as a table on stdout.
void print(const CampaignResult& result);

}  // namespace oracle
