#include "scenario/read_harm.hpp"

#include "scenario/key_ranges.hpp"

#include <optional>
#include <string>

namespace crashrank::detail {
namespace {

using namespace ranges;

/// [least, most], the first no greater than the second.
void read_range(const JsonObject& object, const char* key, NumberRange range, double& least,
                double& most) {
  const nlohmann::json* ends = object.array(key, 2, 2);
  if (ends == nullptr) return;
  const double first =
      checked_number((*ends)[0], object.path_of(key) + "[0]", range, object.refusals(), least);
  const double last =
      checked_number((*ends)[1], object.path_of(key) + "[1]", range, object.refusals(), most);
  if (first > last) object.refuse(key, "ends before it begins", "write it as [least, most]");
  least = first;
  most = last;
}

void read_weights(const JsonObject& parent, HarmWeights& w) {
  if (parent.has("weights")) {
    const JsonObject object(parent.at("weights"), parent.path_of("weights"), parent.refusals(),
                            {"ego_occupant", "other_occupant", "pedestrian", "cyclist",
                             "motorcyclist", "property_per_mj"});
    w.ego_occupant = object.number("ego_occupant", weight, w.ego_occupant);
    w.other_occupant = object.number("other_occupant", weight, w.other_occupant);
    w.pedestrian = object.number("pedestrian", weight, w.pedestrian);
    w.cyclist = object.number("cyclist", weight, w.cyclist);
    w.motorcyclist = object.number("motorcyclist", weight, w.motorcyclist);
    w.property_per_mj = object.number("property_per_mj", weight, w.property_per_mj);
  }
  if (parent.has("people")) {
    const JsonObject object(parent.at("people"), parent.path_of("people"), parent.refusals(),
                            {"ego", "car", "truck", "bus"});
    w.people_in_ego = object.number("ego", people, w.people_in_ego);
    w.people_in_car = object.number("car", people, w.people_in_car);
    w.people_in_truck = object.number("truck", people, w.people_in_truck);
    w.people_in_bus = object.number("bus", people, w.people_in_bus);
  }
}

/// A number, or null for the mean person.
void read_mean_or(const JsonObject& object, const char* key, NumberRange range,
                  std::optional<double>& value) {
  if (!object.has(key)) return;
  if (object.at(key).is_null()) {
    value.reset();
  } else {
    value = object.number(key, range, 0.0);
  }
}

void read_ranges(const JsonObject& parent, HarmRanges& r) {
  if (!parent.has("ranges")) return;
  const JsonObject object(parent.at("ranges"), parent.path_of("ranges"), parent.refusals(),
                          {"friction", "strength", "restitution", "risk_speed", "all_models"});
  read_range(object, "friction", friction, r.least_friction, r.most_friction);
  read_range(object, "strength", strength, r.least_strength, r.most_strength);
  read_range(object, "restitution", restitution, r.least_restitution, r.most_restitution);
  read_range(object, "risk_speed", risk_speed, r.least_risk_speed, r.most_risk_speed);
  r.all_models = object.flag("all_models", r.all_models);
}

}  // namespace

void read_harm(const JsonObject& object, HarmOptions& harm) {
  constexpr std::size_t name_characters = 128;
  if (object.has("risk_model")) {
    const Result<RiskModel> model =
        risk_model_from_name(object.text("risk_model", name_characters));
    if (model) {
      harm.model = *model;
    } else {
      object.refuse("risk_model", model.error().reason, model.error().remedy);
    }
  }
  read_weights(object, harm.weights);
  if (object.has("pedestrian")) {
    const JsonObject person(object.at("pedestrian"), object.path_of("pedestrian"),
                            object.refusals(), {"age_years", "male_share"});
    read_mean_or(person, "age_years", age, harm.pedestrian.age_years);
    read_mean_or(person, "male_share", share, harm.pedestrian.male_share);
  }
  harm.friction = object.number("friction", friction, harm.friction);
  read_ranges(object, harm.ranges);
  if (object.has("after_contact")) {
    const Result<AfterContact> after =
        after_contact_from_name(object.text("after_contact", name_characters));
    if (after) {
      harm.after_contact = *after;
    } else {
      object.refuse("after_contact", after.error().reason, after.error().remedy);
    }
  }
  if (object.has("after_impact")) {
    // Without effect, but no nonsense either.
    const JsonObject after(object.at("after_impact"), object.path_of("after_impact"),
                           object.refusals(), {"deceleration_mps2", "longest_s", "most_contacts"});
    after.number("deceleration_mps2", former_deceleration, 0.0);
    after.number("longest_s", former_time, 0.0);
    after.count("most_contacts", former_contacts, 1);
  }
  harm.least_struck_share = object.number("least_struck_share", share, harm.least_struck_share);
}

}  // namespace crashrank::detail
