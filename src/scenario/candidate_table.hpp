#pragma once

#include "crashrank/scenario/scenario.hpp"

#include <string>
#include <vector>

namespace crashrank::detail {

/// Appends the candidates of a table of timed poses: text in comma-separated values whose first
/// line names the columns candidate, t_s, x_m, y_m and yaw_deg, in any order and with z_m,
/// pitch_deg and roll_deg where wanted; then one pose a line, those of a candidate one after the
/// other with rising times from 0. A name that holds a comma or a quote stands in quotes, its
/// quotes doubled. Ranges and limits as in a scenario's own list. `file` only names it in errors:
/// bad_input or limit_exceeded, with line and column. O(n log n) in the text; on an error `listed`
/// may hold a part of the candidates.
Status add_candidate_table(const std::string& text, const std::string& file,
                           std::vector<ListedCandidate>& listed);

}  // namespace crashrank::detail
