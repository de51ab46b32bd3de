#pragma once

#include "crashrank/crashrank.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
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

/// A struct of the C interface with its size set and all else 0.
template <class Struct> Struct sized() {
  Struct made{};
  made.size = sizeof made;
  return made;
}

/// A scenario file and the models of its shapes.
struct Loaded {
  Scenario scenario;
  Models models;
};

inline Loaded load(const std::string& file) {
  crashrank_error error{};
  crashrank_scenario* made = nullptr;
  EXPECT_EQ(crashrank_scenario_load(file.c_str(), &made, &error), CRASHRANK_OK) << error.message;
  Loaded loaded{Scenario(made), make_models()};
  EXPECT_EQ(crashrank_models_import_scenario(loaded.models.get(), loaded.scenario.get(), &error),
            CRASHRANK_OK)
      << error.message;
  return loaded;
}

/// Scores by candidate, in the order of the ranking.
using Scores = std::vector<std::pair<std::string, double>>;

inline Scores scores_in_c(const Loaded& loaded) {
  crashrank_error error{};
  auto options = sized<crashrank_rank_options>();
  options.measure = CRASHRANK_MEASURE_HARM;
  crashrank_ranking* made = nullptr;
  EXPECT_EQ(crashrank_rank(loaded.scenario.get(), loaded.models.get(), &options, &made, &error),
            CRASHRANK_OK)
      << error.message;
  const Ranking ranking(made);
  Scores scores;
  for (size_t i = 0; i < crashrank_ranking_size(made); ++i) {
    auto choice = sized<crashrank_choice>();
    EXPECT_EQ(crashrank_ranking_get(made, i, &choice, &error), CRASHRANK_OK);
    scores.emplace_back(choice.candidate, choice.score);
  }
  return scores;
}

/// A box of 4 by 1.8 by 1.4 m on the ground: a body with an outline.
inline crashrank_status add_box(crashrank_models* models, crashrank_error* error = nullptr) {
  static const std::vector<float> corners{-2,    -0.9F, 0,    2,    -0.9F, 0,     2,    0.9F,
                                          0,     -2,    0.9F, 0,    -2,    -0.9F, 1.4F, 2,
                                          -0.9F, 1.4F,  2,    0.9F, 1.4F,  -2,    0.9F, 1.4F};
  static const std::vector<uint32_t> faces{0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                           1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  static const std::vector<crashrank_part> whole{{"box", 12}};
  return crashrank_models_add(models, corners.data(), corners.size() / 3, faces.data(),
                              faces.size() / 3, whole.data(), whole.size(), error);
}

}  // namespace c_objects
