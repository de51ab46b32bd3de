#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/rank/anytime/ranker.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bench {

/// A scenario with its models, and variants of it in which the others stand and move a little
/// otherwise.
struct Situations {
  std::string name;
  crashrank::Scenario scenario;
  std::vector<crashrank::Model> models;
  std::vector<crashrank::Candidate> candidates;
  std::vector<std::vector<crashrank::Motion>> motions;  ///< of the plans, by variant
  std::size_t triangles = 0;                            ///< of the largest model
  double load_s = 0.0;                                  ///< making the meshes
  double build_s = 0.0;                                 ///< and their trees
};

/// Reads a scenario and makes its shipped models at about that many triangles each (0: as shipped).
crashrank::Result<Situations> make_situations(const std::string& file, std::size_t triangles,
                                              std::size_t variants, std::uint64_t seed);

/// A Ranker of the scenario with room for its candidates.
crashrank::Result<crashrank::Ranker> prepare_ranker(const Situations& situations,
                                                    const std::string& measure, unsigned workers);

}  // namespace bench
