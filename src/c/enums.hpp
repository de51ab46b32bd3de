#pragma once

#include "crashrank/crashrank.h"

#include "crashrank/base/result.hpp"
#include "crashrank/crash/contact_law.hpp"
#include "crashrank/crash/injury.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/scenario/harm_options.hpp"
#include "crashrank/vehicle/vehicle.hpp"

#include <cstdint>
#include <string>
#include <type_traits>

// Values of the C interface's enumerations: the library's, which begin at 0, plus 1, so that 0 is
// left for "not set".

namespace crashrank::c {

/// The value in C.
template <class Enum>
requires std::is_enum_v<Enum>
constexpr std::int32_t to_c(Enum value) { return static_cast<std::int32_t>(value) + 1; }

/// The last value of each, and its name in C.
template <class Enum> struct EnumInC;
template <> struct EnumInC<BodyKind> {
  static constexpr auto last = BodyKind::building;
  static constexpr const char* name = "crashrank_body_kind";
};
template <> struct EnumInC<Surface> {
  static constexpr auto last = Surface::person;
  static constexpr const char* name = "crashrank_surface";
};
template <> struct EnumInC<Measure> {
  static constexpr auto last = Measure::harm;
  static constexpr const char* name = "crashrank_measure";
};
template <> struct EnumInC<RiskModel> {
  static constexpr auto last = RiskModel::joksch_monfort;
  static constexpr const char* name = "crashrank_risk_model";
};
template <> struct EnumInC<AfterContact> {
  static constexpr auto last = AfterContact::locks;
  static constexpr const char* name = "crashrank_after_contact";
};
template <> struct EnumInC<RankOrder> {
  static constexpr auto last = RankOrder::upper;
  static constexpr const char* name = "crashrank_order";
};
template <> struct EnumInC<Infeasible> {
  static constexpr auto last = Infeasible::keep;
  static constexpr const char* name = "crashrank_infeasible";
};

static_assert(to_c(EnumInC<Infeasible>::last) == CRASHRANK_INFEASIBLE_KEEP);
static_assert(to_c(EnumInC<RankOrder>::last) == CRASHRANK_ORDER_UPPER);
static_assert(to_c(EnumInC<BodyKind>::last) == CRASHRANK_KIND_BUILDING);
static_assert(to_c(EnumInC<Surface>::last) == CRASHRANK_SURFACE_PERSON);
static_assert(to_c(EnumInC<Measure>::last) == CRASHRANK_MEASURE_HARM);
static_assert(to_c(EnumInC<RiskModel>::last) == CRASHRANK_RISK_MODEL_JOKSCH_MONFORT);
static_assert(to_c(EnumInC<AfterContact>::last) == CRASHRANK_AFTER_CONTACT_LOCKS);

/// Whether the enumeration has that value.
template <class Enum> constexpr bool has_value(std::int32_t value) {
  return value >= 1 && value <= to_c(EnumInC<Enum>::last);
}

/// The library's value. `member` names the argument or member in the error: usage.
template <class Enum> Result<Enum> from_c(std::int32_t value, const char* member) {
  if (has_value<Enum>(value)) return static_cast<Enum>(value - 1);
  Error error = make_error(
      ErrorCode::usage, "is " + std::to_string(value) + ", no value of " + EnumInC<Enum>::name,
      "give one of its values, 1 to " + std::to_string(to_c(EnumInC<Enum>::last)));
  error.place = member;
  return error;
}

}  // namespace crashrank::c
