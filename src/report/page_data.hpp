#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

struct PageData {
  std::string json;         ///< safe inside a script element
  bool is_coarser = false;  ///< a mesh is drawn with fewer triangles than it has
};

/// What the page's script plays and lists, as JSON; page/data.js reads it. `asked` is the scenario
/// with all its predictions, `scenario` its likeliest future; `places` are the rows whose crash is
/// drawn. Names are escaped as for a terminal.
PageData page_data(const Scenario& asked, const Scenario& scenario, View<const Model> models,
                   const RankResult& result, const std::vector<std::string>& scores,
                   const std::vector<std::size_t>& places, std::size_t model_triangles);

}  // namespace crashrank::detail
