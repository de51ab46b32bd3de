#include "c/handles.hpp"
#include "c/sized.hpp"

#include <string>
#include <utility>
#include <vector>

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

std::vector<Eigen::Vector2d> to_ring(const double* corners, size_t count) {
  std::vector<Eigen::Vector2d> ring;
  ring.reserve(count);
  for (size_t i = 0; i < count; ++i) ring.emplace_back(corners[2 * i], corners[2 * i + 1]);
  return ring;
}

Status check_count(size_t count) {
  if (count <= road_limits::corners) return Success{};
  return make_error(
      ErrorCode::usage,
      "count: a road has at most " + std::to_string(road_limits::corners) + " corners",
      "simplify it");
}

}  // namespace

crashrank_status crashrank_scenario_set_ego_limits(crashrank_scenario* scenario,
                                                   const crashrank_ego_limits* limits,
                                                   crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"limits", limits}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Result<crashrank_ego_limits> given = c::read_sized("crashrank_ego_limits", *limits);
    if (!given) return refuse(given.error(), error);
    const ScenarioEgo standard;
    const auto stated = [](double number, double otherwise) {
      return number != 0.0 ? number : otherwise;
    };
    ScenarioEgo& ego = scenario->scenario.ego;
    ego.max_acceleration_mps2 =
        stated(given->max_acceleration_mps2, standard.max_acceleration_mps2);
    ego.max_steering_rad = stated(given->max_steering_rad, standard.max_steering_rad);
    ego.max_steering_rate_radps =
        stated(given->max_steering_rate_radps, standard.max_steering_rate_radps);
    ego.max_deceleration_mps2.reset();
    if (given->max_deceleration_mps2 != 0.0) {
      ego.max_deceleration_mps2 = given->max_deceleration_mps2;
    }
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_add_area(crashrank_scenario* scenario, const double* corners,
                                             size_t count, crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"corners", corners}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    if (const Status few = check_count(count); !few) return refuse(few.error(), error);
    scenario->scenario.road.drivable.push_back({to_ring(corners, count), {}});
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_add_hole(crashrank_scenario* scenario, size_t area,
                                             const double* corners, size_t count,
                                             crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"corners", corners}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    if (const Status few = check_count(count); !few) return refuse(few.error(), error);
    std::vector<Area>& areas = scenario->scenario.road.drivable;
    if (area >= areas.size()) {
      return refuse(CRASHRANK_USAGE, "area: the road has no such area", error);
    }
    areas[area].holes.push_back(to_ring(corners, count));
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_set_off_road(crashrank_scenario* scenario,
                                                 double harm_per_leaving, double grip,
                                                 crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}})) return refuse_null(null, error);
  Road& road = scenario->scenario.road;
  road.harm_per_leaving = harm_per_leaving;
  road.off_road_grip.reset();
  if (grip != 0.0) road.off_road_grip = grip;
  return CRASHRANK_OK;
}
