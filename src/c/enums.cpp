#include "c/enums.hpp"

namespace {

/// The name of a value, NULL if the enumeration has no such value.
template <class Enum, class NameOf> const char* name_in_c(int32_t value, const NameOf& name_of) {
  return crashrank::c::has_value<Enum>(value) ? name_of(static_cast<Enum>(value - 1)) : nullptr;
}

}  // namespace

const char* crashrank_body_kind_name(crashrank_body_kind kind) {
  return name_in_c<crashrank::BodyKind>(kind, crashrank::body_kind_name);
}

const char* crashrank_surface_name(crashrank_surface surface) {
  return name_in_c<crashrank::Surface>(surface, crashrank::surface_name);
}

const char* crashrank_risk_model_name(crashrank_risk_model model) {
  return name_in_c<crashrank::RiskModel>(model, crashrank::risk_model_name);
}

const char* crashrank_after_contact_name(crashrank_after_contact after) {
  return name_in_c<crashrank::AfterContact>(after, crashrank::after_contact_name);
}

const char* crashrank_measure_name(crashrank_measure measure) {
  return name_in_c<crashrank::Measure>(measure, crashrank::measure_name);
}
