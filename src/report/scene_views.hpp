#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <vector>

namespace crashrank::detail {

/// A body as pictures of a candidate show it.
struct SceneView {
  std::size_t model = 0;  ///< index into Scenario::models
  BodyDamage damage;      ///< from all contacts, with the pose to draw it in
};

/// What a candidate's pictures show, the ego first: all bodies that are hit, each where its first
/// contact finds it. Without a contact the ego at the end of its plan and the bodies near it then.
std::vector<SceneView> scene_views(const Scenario& scenario, View<const Model> models,
                                   const RankResult& result, std::size_t place);

}  // namespace crashrank::detail
