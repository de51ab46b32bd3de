#pragma once

#include "crashrank/dispatch/study/study.hpp"

#include <string>

namespace crashrank::cli {

/// The figures of a sweep as one SVG: speedup and relative data transfer by distribution depth, a
/// line a policy, trimmed where memory ran out. Replayed values where there are fewer processors
/// than workers, measured ones elsewhere; the drawing says which.
std::string sweep_plot(const Sweep& sweep, const std::string& title, std::uint32_t workers);

}  // namespace crashrank::cli
