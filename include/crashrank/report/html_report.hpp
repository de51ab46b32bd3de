#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "crashrank/tree/model.hpp"

#include <cstddef>
#include <string>

namespace crashrank {

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
/// where it was not. Names come from strangers' files and are escaped. The same ranking gives the
/// same bytes, but for the time that it took.
/// Cost: about 40 bytes a triangle of each model shown, and as many bits a candidate.
CRASHRANK_API std::string html_report(const Scenario& scenario, View<const Model> models,
                                      const RankResult& result,
                                      const HtmlReportOptions& options = {});

}  // namespace crashrank
