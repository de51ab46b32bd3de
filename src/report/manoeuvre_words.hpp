#pragma once

#include "crashrank/rank/rank.hpp"

#include <string>

namespace crashrank::detail {

/// The greatest demand of a manoeuvre: "takes 1.32 times the grip".
std::string demand_words(const ManoeuvreDemand& demand);

/// What a candidate without contact hits, with its least distance and time gap and its time to
/// collision: "nothing, 0.84 m from kerb, 1.20 s from van, 0.17 s before a crash with lorry at the
/// horizon"; "not known yet" before contacts are searched.
std::string passing_words(const Scenario& scenario, const CandidateResult& ranked);

/// When and how fast a wheel leaves the road: "leaves the road after 1.31 s at 17.2 m/s"; empty
/// where none does.
std::string leaving_words(const CandidateResult& ranked);
/// Probability of that; empty if it does so in every future, or in none.
std::string leaving_probability(const CandidateResult& ranked);
/// Whether it leaves the road before its first contact in the likeliest future.
bool leaves_in_likeliest(const CandidateResult& ranked);

/// What marks a row besides its crash, "cannot be followed, off the road, 0.17 s before a crash";
/// empty without anything.
std::string manoeuvre_mark(const CandidateResult& ranked);

/// What is to be said of a candidate besides its crash, sentences: "It takes 0.89 times the grip.
/// It stays 0.26 m from all others (the nearest is kerb), and is at 20.0 m/s at the horizon."
std::string manoeuvre_words(const Scenario& scenario, const CandidateResult& ranked);

/// Which tie-break decides between equal scores; the two are not tied.
std::string tie_words(const Scenario& scenario, const CandidateResult& first,
                      const CandidateResult& second);

}  // namespace crashrank::detail
