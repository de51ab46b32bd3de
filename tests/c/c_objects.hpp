#pragma once

#include "crashrank/crashrank.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <vector>

/// Objects of the C interface that free themselves, and what several of its tests put into them.
namespace c_objects {

template <auto Free> struct With {
  template <class T> void operator()(T* object) const { Free(object); }
};
using Models = std::unique_ptr<crashrank_models, With<crashrank_models_free>>;
using Query = std::unique_ptr<crashrank_query, With<crashrank_query_free>>;
using Scenario = std::unique_ptr<crashrank_scenario, With<crashrank_scenario_free>>;
using Ranker = std::unique_ptr<crashrank_ranker, With<crashrank_ranker_free>>;
using Ranking = std::unique_ptr<crashrank_ranking, With<crashrank_ranking_free>>;

/// Two crossing triangles and one apart.
inline const std::vector<float> vertices{0,  0,    0,    1, 0,    0,    0, 1, 0, 0.2F, 0.2F,
                                         -1, 0.2F, 0.2F, 1, 0.3F, 0.4F, 0, 9, 9, 9};
inline const std::vector<uint32_t> triangles{0, 1, 2, 3, 4, 5, 6, 6, 6};

inline constexpr double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

inline Models make_models() {
  crashrank_models* made = nullptr;
  EXPECT_EQ(crashrank_models_create(&made, nullptr), CRASHRANK_OK);
  return Models(made);
}

inline crashrank_status add(crashrank_models* models, const std::vector<crashrank_part>& parts = {},
                            crashrank_error* error = nullptr) {
  return crashrank_models_add(models, vertices.data(), vertices.size() / 3, triangles.data(),
                              triangles.size() / 3, parts.data(), parts.size(), error);
}

}  // namespace c_objects
