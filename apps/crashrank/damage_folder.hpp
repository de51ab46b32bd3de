#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/rank/scenario.hpp"
#include "crashrank/tree/model.hpp"

#include <cstddef>
#include <string>

namespace crashrank::cli {

/// Makes the folder when it is missing. Errors: not_found.
Status make_folder(const std::string& folder);

/// Writes, for the first `top` candidates that collide (0: all), into `folder`, made when missing:
/// RRR-CANDIDATE.png with all bodies at first contact, RRR-CANDIDATE-ego.png, .glb and .ply of the
/// ego alone, and RRR-CANDIDATE-N-OTHER.glb and .ply for each body hit; RRR is the rank. Names are
/// made safe, so that nothing is written outside the folder. Errors: not_found or internal, naming
/// the file.
Status write_damage(const std::string& folder, std::size_t top, const Scenario& scenario,
                    View<const Model> models, const RankResult& result);

}  // namespace crashrank::cli
