#pragma once

#include "crashrank/base/view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Things of one kind: how many there are, and words about the first few.
struct Counted {
  static constexpr std::size_t described = 3;
  std::size_t count = 0;
  std::string first;

  void add(const std::string& words);
  std::string examples() const;
  std::string many(const char* one, const char* more) const;
};

/// Adds one sentence for each kind of body that is improbable: boxes in place of meshes, meshes
/// that seem turned or are too large or small for their kind, stated masses that no body of the
/// kind has, bodies that float, and two that are not the ego and overlap at time 0. At most the
/// squared number of bodies.
void doubt_bodies(const Scenario& scenario, View<const Model> models, const RankResult& result,
                  std::vector<std::string>& doubts);

}  // namespace crashrank::detail
