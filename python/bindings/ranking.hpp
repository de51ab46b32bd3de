#pragma once

#include "scenario.hpp"

#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/rank/rank.hpp"

#include <nanobind/nanobind.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crashrank::python {

/// What a ranking's options are in Python. Names are checked where they become options.
struct RankRequest {
  std::string measure;  ///< empty: the scenario's
  std::string risk;     ///< empty: the scenario's
  std::string infeasible = "demote";
  std::string order = "score";
  std::string profile_file;  ///< empty: none
  unsigned workers = 1;
  std::size_t sampled_futures = RankOptions{}.sampled_futures;
  bool motion = false;  ///< RankOptions::records_motion
  bool smooth = false;  ///< RankOptions::smooth
};

/// The library's options. Reads the profile. Throws Failure.
RankOptions options_of(const RankRequest& request, const Scenario& scenario);

/// A ranking with what it was made of.
struct Ranked {
  SharedSituation situation;  ///< whose models it was made with
  Scenario scenario;          ///< as it was ranked
  RankResult result;
  std::vector<std::string> warnings;  ///< of the meshes, and of how the ranking ended
  bool interrupted = false;
  /// With these its report ranks again and records the motion that it plays; absent where there is
  /// none, or where the result has it.
  std::optional<RankOptions> replay;
};

}  // namespace crashrank::python
