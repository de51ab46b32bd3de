#include "c/handles.hpp"
#include "c/motions.hpp"
#include "c/sized.hpp"

#include <utility>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

Result<ActorMotion> read_motion(const crashrank_motion& motion) {
  const Result<crashrank_motion> given = c::read_sized("crashrank_motion", motion);
  if (!given) return given.error();
  return c::to_motion(*given, "crashrank_motion");
}

}  // namespace

crashrank_status crashrank_scenario_add_prediction(crashrank_scenario* scenario, size_t actor,
                                                   double probability,
                                                   const crashrank_motion* motion,
                                                   crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"motion", motion}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    if (actor >= scenario->scenario.actors.size()) {
      return refuse(CRASHRANK_USAGE, "actor: the scenario has no such actor", error);
    }
    Result<ActorMotion> made = read_motion(*motion);
    if (!made) return refuse(made.error(), error);
    Prediction prediction;
    static_cast<ActorMotion&>(prediction) = std::move(*made);
    prediction.probability = probability;
    scenario->scenario.actors[actor].predictions.push_back(std::move(prediction));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_set_existence(crashrank_scenario* scenario, size_t actor,
                                                  double probability, crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}})) return refuse_null(null, error);
  if (actor >= scenario->scenario.actors.size()) {
    return refuse(CRASHRANK_USAGE, "actor: the scenario has no such actor", error);
  }
  scenario->scenario.actors[actor].existence_probability = probability;
  return CRASHRANK_OK;
}

crashrank_status crashrank_scenario_set_ego_uncertainty(crashrank_scenario* scenario,
                                                        double position_m, double heading_rad,
                                                        double speed_mps, crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}})) return refuse_null(null, error);
  scenario->scenario.ego.uncertainty = {position_m, heading_rad, speed_mps};
  return CRASHRANK_OK;
}

crashrank_status crashrank_scenario_set_perception(crashrank_scenario* scenario, size_t actor,
                                                   double position_m, double heading_rad,
                                                   double speed_mps, crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}})) return refuse_null(null, error);
  if (actor >= scenario->scenario.actors.size()) {
    return refuse(CRASHRANK_USAGE, "actor: the scenario has no such actor", error);
  }
  scenario->scenario.actors[actor].perception = {position_m, heading_rad, speed_mps};
  return CRASHRANK_OK;
}

crashrank_status crashrank_scenario_add_future(crashrank_scenario* scenario, double probability,
                                               crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}})) return refuse_null(null, error);
  return guarded(error, [&]() -> crashrank_status {
    scenario->scenario.futures.push_back({probability, {}, {}});
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_add_future_motion(crashrank_scenario* scenario, size_t future,
                                                      size_t actor, const crashrank_motion* motion,
                                                      crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"motion", motion}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    if (future >= scenario->scenario.futures.size()) {
      return refuse(CRASHRANK_USAGE, "future: the scenario has no such future", error);
    }
    if (actor >= scenario->scenario.actors.size()) {
      return refuse(CRASHRANK_USAGE, "actor: the scenario has no such actor", error);
    }
    Result<ActorMotion> made = read_motion(*motion);
    if (!made) return refuse(made.error(), error);
    scenario->scenario.futures[future].motions.push_back({actor, std::move(*made)});
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_add_future_absence(crashrank_scenario* scenario, size_t future,
                                                       size_t actor, crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}})) return refuse_null(null, error);
  return guarded(error, [&]() -> crashrank_status {
    if (future >= scenario->scenario.futures.size()) {
      return refuse(CRASHRANK_USAGE, "future: the scenario has no such future", error);
    }
    if (actor >= scenario->scenario.actors.size()) {
      return refuse(CRASHRANK_USAGE, "actor: the scenario has no such actor", error);
    }
    scenario->scenario.futures[future].absent.push_back(actor);
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_set_risk(crashrank_scenario* scenario, const char* risk,
                                             crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"risk", risk}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Result<RiskMeasure> read = risk_from_name(risk);
    if (!read) return refuse(read.error(), error);
    scenario->scenario.risk = *read;
    return CRASHRANK_OK;
  });
}
