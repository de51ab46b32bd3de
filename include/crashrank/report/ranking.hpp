#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "crashrank/tree/model.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank {

// A ranking told to programs and to people. Both take what `rank` was given and what it answered.

/// One JSON document, keys in a fixed order, numbers in the shortest form that reads back to the
/// same bits; what is infinite or not known is null. Every candidate is listed, best first. In a
/// candidate's entry `other` and the time and speed beside it are those of its first contact, the
/// damage of `ego` and `other` that of all its contacts together, `other` being all other bodies.
/// `contacts` lists the ego's and those between others by their begins, each with its own damage.
/// Units stand in the keys; angles are degrees. `warnings` are those given, such as the importer's,
/// then `ranking_doubts`.
CRASHRANK_API std::string ranking_json(const Scenario& scenario, View<const Model> models,
                                       const RankResult& result,
                                       View<const std::string> warnings = {});

/// What the table shows.
struct RankingTextOptions {
  std::size_t top = 0;   ///< most candidates shown, 0 for all
  bool colours = false;  ///< ANSI codes for the titles
};

/// A table, best candidate first, and lines about what is not in it: contacts between others that
/// hurt somebody among them. Names are escaped for a
/// terminal.
CRASHRANK_API std::string ranking_text(const Scenario& scenario, View<const Model> models,
                                       const RankResult& result,
                                       const RankingTextOptions& options = {});

/// What makes places of an answer doubtful though nothing is wrong with it, one sentence each,
/// names as they are: contacts faster than the crash model reaches, more contacts than
/// are simulated, bodies that overlap at the start, listed manoeuvres beyond the grip of the tyres,
/// timed poses that end while their body moves or begin at another speed than the ego's, meshes
/// that seem turned or have a size or mass that no body of their kind has, bodies that float, keys
/// of the scenario that are without effect. At most the squared number of bodies.
CRASHRANK_API std::vector<std::string> ranking_doubts(const Scenario& scenario,
                                                      View<const Model> models,
                                                      const RankResult& result);

/// Why an answer is partial and whether its first place is proved, as a warning; `bounded`: it was
/// ranked within a budget.
CRASHRANK_API std::string why_partial(const RankResult& result, bool bounded);

/// How far an interrupted ranking came, as a warning: how many candidates have a score.
CRASHRANK_API std::string ranking_progress(const RankResult& result);

}  // namespace crashrank
