#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::cli {

struct DamageOptions {
  std::string folder;
  std::size_t top = 5;              ///< colliding candidates, best first; 0: all
  std::vector<std::string> inputs;  ///< files that must not be replaced
  std::string report;               ///< where a page will be written; may be empty
  unsigned workers = 1;             ///< threads that share the candidates
};

/// Whether the folder is there or can be made, before the work for it is begun; nothing is made.
/// Errors: not_found; usage where the report has its name.
Status check_damage_folder(const DamageOptions& options);

/// Writes, for the first candidates that collide, into the folder, made when missing:
/// RRR-CANDIDATE.png with all bodies at their first contacts, RRR-CANDIDATE-ego.png, .glb and .ply
/// of the ego alone, and RRR-CANDIDATE-N-OTHER.glb and .ply for each other body, with its damage
/// from all contacts, those between others included; RRR is the place in the ranking, N counts the
/// bodies by their first contacts. Names are made safe, so that nothing is written outside the
/// folder. An interruption leaves no file that is not complete. Errors: usage where one of the
/// files would replace an input, the report or a file of another kind, and then nothing is written;
/// not_found or internal, naming the file.
Status write_damage(const DamageOptions& options, const Scenario& scenario,
                    View<const Model> models, const RankResult& result);

}  // namespace crashrank::cli
