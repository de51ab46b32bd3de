#pragma once

#include "crashrank/rank/rank.hpp"

#include <string>

namespace crashrank::detail {

/// The greatest demand of a manoeuvre: "takes 1.32 times the grip".
std::string demand_words(const ManoeuvreDemand& demand);

/// How far a candidate that touches nothing stays from all others, and whether it leaves the road:
/// "nothing, 0.84 m and 1.2 s apart, leaves the road after 1.31 s".
std::string passing_words(const CandidateResult& ranked);

/// When and how fast a wheel leaves the road: "leaves the road after 1.31 s at 17.2 m/s"; empty
/// where none does.
std::string leaving_words(const CandidateResult& ranked);

/// What a reader may want to know of the rows but the crash, plain text, one line each: empty
/// without anything to tell.
std::string manoeuvre_mark(const CandidateResult& ranked);

/// Which tie-break decides between equal scores; the two are not tied.
std::string tie_words(const CandidateResult& first, const CandidateResult& second);

}  // namespace crashrank::detail
