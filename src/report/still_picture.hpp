#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>

namespace crashrank::detail {

/// The scene of a candidate as a PNG file's bytes, from beside the ego's damage. Errors: those of
/// `draw_picture` and `png`.
Result<std::string> still_picture(const Scenario& scenario, View<const Model> models,
                                  const RankResult& result, std::size_t place);

}  // namespace crashrank::detail
