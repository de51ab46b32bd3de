#pragma once

#include "measure.hpp"

#include <string>
#include <vector>

namespace peers {

/// The peers that ratios are given against.
inline constexpr const char* fcl_name = "FCL OBBRSS";
inline constexpr const char* fcl_native_name = "FCL OBBRSS native";

/// Time of `reference` over the time of `row` in the same workload, regime and mode: how many times
/// as fast the row's peer is. 0 when the reference did not run.
double ratio(const std::vector<Row>& rows, const Row& row, const std::string& reference);

/// A table for each workload, regime and mode, fastest first; wrong answers are marked.
std::string to_text(const std::vector<Row>& rows);

/// All rows, one header line.
std::string to_csv(const std::vector<Row>& rows);

/// Bars of the deep / all times, a group a workload, on a logarithmic axis. Peers that miss or
/// invent pairs are hatched.
std::string to_svg(const std::vector<Row>& rows);

}  // namespace peers
