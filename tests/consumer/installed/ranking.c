/* The ranking of ranking.cpp through the C interface. C11, and C++ as well. */
#include <crashrank/crashrank.h>

#include <stdio.h>
#include <string.h>

static int failed(const crashrank_error* error) {
  puts(error->message);
  return 1;
}

static crashrank_status add_box(crashrank_models* models, float x0, float x1, float y, float z,
                                crashrank_error* error) {
  static const uint32_t triangles[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  float vertices[24];
  int i;
  for (i = 0; i < 8; ++i) {
    vertices[3 * i] = (i & 1) != 0 ? x1 : x0;
    vertices[3 * i + 1] = (i & 2) != 0 ? y : -y;
    vertices[3 * i + 2] = (i & 4) != 0 ? z : 0.0F;
  }
  return crashrank_models_add(models, vertices, 8, triangles, 12, NULL, 0, error);
}

static void stand_at(double pose[16], double x) {
  int i;
  for (i = 0; i < 16; ++i) pose[i] = i % 5 == 0 ? 1.0 : 0.0;
  pose[3] = x;
}

int main(void) {
  static const char* const names[3] = {"brake 0", "brake 5", "brake 8"};
  static const double braking[3] = {0.0, 5.0, 8.0};
  crashrank_error error;
  crashrank_models* models = NULL;
  crashrank_scenario* scenario = NULL;
  crashrank_ranking* ranking = NULL;
  crashrank_ego ego;
  crashrank_actor wall;
  crashrank_rank_options options;
  size_t i;

  if (crashrank_abi_version() != CRASHRANK_ABI_VERSION) return 2;
  memset(&ego, 0, sizeof ego);
  memset(&wall, 0, sizeof wall);
  memset(&options, 0, sizeof options);
  ego.size = sizeof ego;
  wall.size = sizeof wall;
  options.size = sizeof options;
  ego.speed_mps = 10.0;
  stand_at(ego.pose, 0.0);
  wall.name = "wall";
  wall.model = 1;
  stand_at(wall.pose, 11.0);
  options.measure = CRASHRANK_MEASURE_CLOSING_ENERGY;

  if (crashrank_models_create(&models, &error) != CRASHRANK_OK ||
      add_box(models, -1.0F, 4.0F, 0.9F, 1.5F, &error) != CRASHRANK_OK ||
      add_box(models, 0.0F, 1.0F, 5.0F, 3.0F, &error) != CRASHRANK_OK ||
      crashrank_scenario_create("wall", &scenario, &error) != CRASHRANK_OK ||
      crashrank_scenario_add_model(scenario, "car", CRASHRANK_KIND_CAR, 1500.0, &error) != CRASHRANK_OK ||
      crashrank_scenario_add_model(scenario, "wall", CRASHRANK_KIND_BUILDING, 0.0, &error) != CRASHRANK_OK ||
      crashrank_scenario_set_ego(scenario, &ego, &error) != CRASHRANK_OK ||
      crashrank_scenario_add_actor(scenario, &wall, &error) != CRASHRANK_OK) {
    return failed(&error);
  }
  for (i = 0; i < 3; ++i) {
    crashrank_candidate candidate;
    memset(&candidate, 0, sizeof candidate);
    candidate.size = sizeof candidate;
    candidate.name = names[i];
    candidate.acceleration_mps2 = -braking[i];
    if (crashrank_scenario_add_candidate(scenario, &candidate, &error) != CRASHRANK_OK) {
      return failed(&error);
    }
  }
  if (crashrank_rank(scenario, models, &options, &ranking, &error) != CRASHRANK_OK) {
    return failed(&error);
  }
  for (i = 0; i < crashrank_ranking_size(ranking); ++i) {
    crashrank_choice choice;
    choice.size = sizeof choice;
    if (crashrank_ranking_get(ranking, i, &choice, &error) != CRASHRANK_OK) return failed(&error);
    printf("%s: %.1f k%s\n", choice.candidate, choice.score / 1e3, crashrank_ranking_unit(ranking));
  }
  crashrank_ranking_free(ranking);
  crashrank_scenario_free(scenario);
  crashrank_models_free(models);
  return 0;
}
