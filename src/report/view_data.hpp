#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

struct ViewData {
  std::string json;       ///< safe inside a script element
  bool left_out = false;  ///< a model was too large
};

/// What the page's 3-D view draws, as JSON:
/// {"models": {"INDEX": {"positions", "indices", "parts": [[first, count, "#rrggbb"]]}},
///  "scenes": {"PLACE": {"point": [x,y,z], "normal": [x,y,z], "bodies": [{"model", "pose": [12],
///  "damaged"}]}}}
/// positions are float32 and indices uint32 in base64, little endian; damaged is a bit a triangle,
/// lowest bit first; pose is a row-major 3 x 4 matrix, body to world. The first body is the ego.
ViewData view_data(const Scenario& scenario, View<const Model> models, const RankResult& result,
                   const std::vector<std::size_t>& places, std::size_t model_triangles);

}  // namespace crashrank::detail
