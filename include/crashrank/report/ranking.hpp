#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank {

// A ranking as JSON and as text. Both take the arguments and the result of `rank`.

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

/// A table, best candidate first, and lines about what is not in it, such as
/// contacts between others that injure people. Names are escaped for a
/// terminal.
CRASHRANK_API std::string ranking_text(const Scenario& scenario, View<const Model> models,
                                       const RankResult& result,
                                       const RankingTextOptions& options = {});

/// Reasons to doubt places of a valid answer, one sentence each, names not escaped: contacts faster
/// than the crash model reaches, more contacts than are simulated, bodies that overlap at the
/// start, listed manoeuvres beyond the grip of the tyres, timed poses that end while their body
/// moves or begin at another speed than the ego's, meshes that seem turned or have a size or mass
/// that no body of their kind has, bodies that float, keys of the scenario that are without effect.
/// At most the squared number of bodies.
CRASHRANK_API std::vector<std::string> ranking_doubts(const Scenario& scenario,
                                                      View<const Model> models,
                                                      const RankResult& result);

/// Why an answer is partial and whether its first place is proved, as a warning; `bounded`: it was
/// ranked within a budget.
CRASHRANK_API std::string why_partial(const RankResult& result, bool bounded);

/// Progress of an interrupted ranking, as a warning: the number of candidates with a score.
CRASHRANK_API std::string ranking_progress(const RankResult& result);

/// What the page shows.
struct HtmlReportOptions {
  /// Candidates drawn in plan and in 3-D, best first, and the worst one; 0 for all. Every candidate
  /// is in the table.
  std::size_t drawn = 24;
  /// Models of more triangles than this are left out of the 3-D view; the report says so.
  std::size_t model_triangles = 400'000;
};

/// One page for people, from what `rank` was given and what it answered: the ranked table, why the
/// first beats the second, and for each drawn candidate a plan of the moment of impact, what is
/// damaged by part, and both bodies in 3-D with the damage in red. The page is a single file that
/// asks nothing of the network; it holds three.js where the library was built with it, and says so
/// where it was not. Names come from files that are not trusted and are escaped. The same ranking
/// gives the same bytes, but for the time that it took. Cost: about 40 bytes a triangle of each
/// model shown, and as many bits a candidate.
CRASHRANK_API std::string html_report(const Scenario& scenario, View<const Model> models,
                                      const RankResult& result,
                                      const HtmlReportOptions& options = {});

}  // namespace crashrank
