#include "crashrank/scenario/harm_options.hpp"

#include "scenario/number_range.hpp"

#include <charconv>
#include <cmath>

namespace crashrank {
namespace {

const char* kind_name(RiskKind kind) {
  switch (kind) {
    case RiskKind::expected:
      return "expected";
    case RiskKind::cvar:
      return "cvar";
    case RiskKind::worst:
      return "worst";
    case RiskKind::quantile:
      return "quantile";
  }
  return "expected";
}

bool has_level(RiskKind kind) { return kind == RiskKind::cvar || kind == RiskKind::quantile; }

}  // namespace

Result<RiskMeasure> risk_from_name(const std::string& name) {
  constexpr const char* remedy =
      "choose expected, worst, cvar:X or quantile:X with X above 0 and below 1, as cvar:0.9";
  const std::size_t colon = name.find(':');
  const std::string head = name.substr(0, colon);
  for (const RiskKind kind :
       {RiskKind::expected, RiskKind::cvar, RiskKind::worst, RiskKind::quantile}) {
    if (head != kind_name(kind) || has_level(kind) != (colon != std::string::npos)) continue;
    if (!has_level(kind)) return RiskMeasure{kind, 0.0};
    const char* const end = name.data() + name.size();
    double level = 0.0;
    const auto [rest, error] =
        std::from_chars(name.data() + colon + 1, end, level, std::chars_format::fixed);
    if (error == std::errc{} && rest == end && level > 0.0 && level < 1.0) {
      return RiskMeasure{kind, level};
    }
  }
  return make_error(ErrorCode::usage, "'" + name + "' is not a risk measure", remedy);
}

std::string risk_name(const RiskMeasure& risk) {
  const std::string name = kind_name(risk.kind);
  return has_level(risk.kind) ? name + ":" + detail::number_text(risk.level) : name;
}

}  // namespace crashrank
