#pragma once

#include "crashrank/motion/time_of_impact.hpp"
#include "crashrank/scenario/harm_options.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank {

/// Method by which the futures of a ranking are chosen.
enum class FutureMethod {
  certain,  ///< every actor exists and follows one motion: there is one future
  joint,    ///< the scenario lists joint futures
  all,      ///< all combinations of independent predictions
  sampled,  ///< a stratified sample of them, the same for all candidates and in every run
};

/// A future of a sample.
struct DrawnFuture {
  double probability = 0.0;  ///< for which it stands
  /// Futures of one stratum have the same predictions and absences and differ in errors of states;
  /// a sample that is not divided in that way is one stratum.
  std::uint32_t stratum = 0;
};

/// Predictions and absences to which the probabilities of a sample are fitted: over the drawn
/// futures each of them has the probability that the scenario states.
struct FittedChoices {
  std::size_t actors = 0;  ///< number of them; 0: nothing is fitted
  /// what each of them does, as a number from 0; those of one drawn future are neighbours
  std::vector<std::uint32_t> choices;
};

/// The futures of a ranking.
struct FutureSummary {
  FutureMethod method = FutureMethod::certain;  ///< how they were chosen
  /// number of evaluated futures; with `sampled` the likeliest one is added
  std::size_t futures = 1;
  std::size_t sampled = 0;  ///< number of drawn futures
  /// the drawn futures, which come first; those of a stratum are neighbours
  std::vector<DrawnFuture> drawn;
  FittedChoices fitted;  ///< to which their probabilities are fitted
  /// Number of predictions and absences that no drawn future has: 0 but with very many improbable
  /// ones.
  std::size_t undrawn = 0;
  double combinations = 1.0;  ///< number of combinations that the scenario allows
  /// Number of actors with several choices that no candidate or crash comes near. They have their
  /// likeliest choice in every future and do not multiply the number of futures.
  std::size_t left_out = 0;
  RiskMeasure risk;               ///< measure that combines the scores of all futures
  bool has_state_errors = false;  ///< positions, headings and speeds are drawn with errors
  bool smooth = false;            ///< RankOptions::smooth was requested
};

/// Outcome of a candidate in futures that are equivalent for it: all bodies that act in its crash,
/// or could have, move alike in them.
struct FutureOutcome {
  /// of these futures together; 0 for the likeliest future next to a sample
  double probability = 0.0;
  std::size_t futures = 1;    ///< number of these futures
  bool is_likeliest = false;  ///< the likeliest future is one of them
  double score = 0.0;         ///< in the measure's unit
  bool collides = false;      ///< the ego has a contact
  /// if it collides: first body that the ego hits, index into Scenario::actors
  std::size_t actor = 0;
  ImpactState state = ImpactState::none;  ///< of that contact
  double time_of_impact_s = 0.0;          ///< from the decision
  double closing_speed_mps = 0.0;         ///< of the points that touch first, m/s
  /// Largest closing speed of all contacts, including those between other bodies, m/s.
  double fastest_contact_mps = 0.0;
  bool leaves_road = false;            ///< a wheel leaves the road before the first contact
  bool contact_without_force = false;  ///< of one of the ego's contacts, see Contact
  std::size_t unforced_actor = 0;      ///< with that body, if so: index into Scenario::actors
  /// number of contacts with a force, including those between other bodies
  std::size_t contacts = 0;
};

}  // namespace crashrank
