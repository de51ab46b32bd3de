#include "c/harm.hpp"

#include "c/enums.hpp"
#include "c/handles.hpp"
#include "c/sized.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "scenario/scenario_check.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace crashrank::c {
namespace {

/// Calls `each` with every number that C has and the library's of the same meaning.
template <class InC, class Options, class Each>
void for_each_number(InC& harm, Options& options, const Each& each) {
  auto& weights = options.weights;
  each(harm.weights_ego_occupant, weights.ego_occupant);
  each(harm.weights_other_occupant, weights.other_occupant);
  each(harm.weights_pedestrian, weights.pedestrian);
  each(harm.weights_cyclist, weights.cyclist);
  each(harm.weights_motorcyclist, weights.motorcyclist);
  each(harm.weights_property_per_mj, weights.property_per_mj);
  each(harm.people_ego, weights.people_in_ego);
  each(harm.people_car, weights.people_in_car);
  each(harm.people_truck, weights.people_in_truck);
  each(harm.people_bus, weights.people_in_bus);
  each(harm.friction, options.friction);
  auto& ranges = options.ranges;
  each(harm.ranges_friction[0], ranges.least_friction);
  each(harm.ranges_friction[1], ranges.most_friction);
  each(harm.ranges_strength[0], ranges.least_strength);
  each(harm.ranges_strength[1], ranges.most_strength);
  each(harm.ranges_restitution[0], ranges.least_restitution);
  each(harm.ranges_restitution[1], ranges.most_restitution);
  each(harm.ranges_risk_speed[0], ranges.least_risk_speed);
  each(harm.ranges_risk_speed[1], ranges.most_risk_speed);
}

/// What a curve assumes of the mean person is below 0 in C.
std::optional<double> unless_mean(double value) {
  return value < 0.0 ? std::nullopt : std::optional<double>(value);
}

/// The member of a key path: "harm.weights.pedestrian" is "crashrank_harm.weights_pedestrian".
std::string member_of(std::string path) {
  path.erase(0, path.find('.') + 1);
  std::replace(path.begin(), path.end(), '.', '_');
  return "crashrank_harm." + path;
}

}  // namespace

crashrank_harm to_c(const HarmOptions& options) {
  crashrank_harm harm{};
  harm.size = sizeof harm;
  harm.risk_model = to_c(options.model);
  harm.after_contact = to_c(options.after_contact);
  harm.pedestrian_age_years = options.pedestrian.age_years.value_or(-1.0);
  harm.pedestrian_male_share = options.pedestrian.male_share.value_or(-1.0);
  harm.ranges_all_models = options.ranges.all_models ? 1 : 0;
  for_each_number(harm, options, [](double& in_c, double number) { in_c = number; });
  return harm;
}

Result<HarmOptions> from_c(const crashrank_harm& harm, const HarmOptions& otherwise) {
  HarmOptions options = otherwise;
  const Result<RiskModel> model = from_c<RiskModel>(harm.risk_model, "crashrank_harm.risk_model");
  if (!model) return model.error();
  const Result<AfterContact> after =
      from_c<AfterContact>(harm.after_contact, "crashrank_harm.after_contact");
  if (!after) return after.error();
  options.model = *model;
  options.after_contact = *after;
  options.pedestrian.age_years = unless_mean(harm.pedestrian_age_years);
  options.pedestrian.male_share = unless_mean(harm.pedestrian_male_share);
  options.ranges.all_models = harm.ranges_all_models != 0;
  for_each_number(harm, options, [](double in_c, double& number) { number = in_c; });
  const Status sound = detail::check_harm(options, "harm");
  if (sound) return options;
  Error error = sound.error();
  error.place = member_of(error.place);
  return error;
}

bool same_harm(const HarmOptions& a, const HarmOptions& b) {
  bool same = a.model == b.model && a.after_contact == b.after_contact &&
              a.pedestrian.age_years == b.pedestrian.age_years &&
              a.pedestrian.male_share == b.pedestrian.male_share &&
              a.ranges.all_models == b.ranges.all_models;
  const crashrank_harm of_a = to_c(a);
  for_each_number(of_a, b, [&](double x, double y) { same = same && x == y; });
  return same;
}

}  // namespace crashrank::c

namespace {

using namespace crashrank;
using c::guarded;
using c::refuse;
using c::refuse_null;

}  // namespace

crashrank_status crashrank_scenario_get_harm(const crashrank_scenario* scenario,
                                             crashrank_harm* harm, crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"harm", harm}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    const Status sized = c::check_size("crashrank_harm", *harm);
    if (!sized) return refuse(sized.error(), error);
    c::write_sized(c::to_c(scenario->scenario.harm), *harm);
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_set_harm(crashrank_scenario* scenario,
                                             const crashrank_harm* harm, crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"harm", harm}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    // A member that the caller does not know is not the caller's to reset.
    HarmOptions& current = scenario->scenario.harm;
    const Result<crashrank_harm> given = c::read_sized("crashrank_harm", *harm, c::to_c(current));
    if (!given) return refuse(given.error(), error);
    const Result<HarmOptions> options = c::from_c(*given, current);
    if (!options) return refuse(options.error(), error);
    current = *options;
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_load_profile(crashrank_scenario* scenario, const char* file,
                                                 crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"file", file}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    HarmOptions& current = scenario->scenario.harm;
    const Result<HarmOptions> options = load_profile_file(file, current);
    if (!options) return refuse(options.error(), error);
    current = *options;
    return CRASHRANK_OK;
  });
}

crashrank_status crashrank_scenario_set_profile_from_text(crashrank_scenario* scenario,
                                                          const char* text, size_t length,
                                                          const char* name,
                                                          crashrank_error* error) {
  if (const char* null = c::first_null({{"scenario", scenario}, {"text", text}, {"name", name}})) {
    return refuse_null(null, error);
  }
  return guarded(error, [&]() -> crashrank_status {
    HarmOptions& current = scenario->scenario.harm;
    const Result<HarmOptions> options = parse_profile(std::string(text, length), name, current);
    if (!options) return refuse(options.error(), error);
    current = *options;
    return CRASHRANK_OK;
  });
}
