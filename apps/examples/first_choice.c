#include <crashrank/crashrank.h>

#include <stdio.h>

int main(int argc, char** argv) {
  crashrank_error error;
  crashrank_scenario* scenario = NULL;
  crashrank_models* models = NULL;
  crashrank_ranking* ranking = NULL;
  crashrank_choice best = {0};
  best.size = sizeof best;
  if (argc != 2) return 2;
  if (crashrank_scenario_load(argv[1], &scenario, &error) == CRASHRANK_OK &&
      crashrank_models_create(&models, &error) == CRASHRANK_OK &&
      crashrank_models_import_scenario(models, scenario, &error) == CRASHRANK_OK &&
      crashrank_rank(scenario, models, NULL, &ranking, &error) == CRASHRANK_OK &&
      crashrank_ranking_get(ranking, 0, &best, &error) == CRASHRANK_OK) {
    puts(best.candidate);
    error.status = CRASHRANK_OK;
  } else {
    fprintf(stderr, "%s\n", error.message);
  }
  crashrank_ranking_free(ranking);
  crashrank_models_free(models);
  crashrank_scenario_free(scenario);
  return error.status;
}
