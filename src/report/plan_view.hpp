#pragma once

#include "base/convex_hull.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

using Outline = std::vector<Eigen::Vector2d>;

/// What is seen of a mesh from above, in body coordinates, counter-clockwise.
Outline outline_of(const TriangleMesh& mesh);

/// Draws candidates from above at the moment of their first contact: outlines of all bodies near
/// it, the ego's way there, what is damaged, the closing velocity, and where two others
/// collide later. Prepared once a ranking.
class PlanView {
public:
  PlanView(const Scenario& scenario, View<const Model> models, const RankResult& result);

  /// An SVG element; `place` is the candidate's in the ranking.
  std::string draw(std::size_t place) const;

private:
  const Outline& outline_of_actor(std::size_t actor) const {
    return outlines_[scenario_.actors[actor].model];
  }

  const Scenario& scenario_;
  View<const Model> models_;
  const RankResult& result_;
  std::vector<Outline> outlines_;  ///< by model, body coordinates
  std::vector<Motion> motions_;    ///< by actor
};

}  // namespace crashrank::detail
