#include "validate_pairs.hpp"

#include "console.hpp"

#include "crashrank/internal/report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace crashrank::cli {
namespace {

double degrees(double radians) { return radians * (180.0 / std::numbers::pi); }

const BodyOutcome& side_of(const PairOutcome& outcome, std::size_t car) {
  return car == 0 ? outcome.crash.severity.ego : outcome.crash.severity.other;
}

TestErrors errors_of(const std::vector<PairTest>& tests, const std::vector<PairOutcome>& outcomes) {
  TestErrors errors;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const PairedCar& car = tests[i].cars.at(k);
      const BodyOutcome& side = side_of(outcomes[i], k);
      errors.add_delta_v(side.delta_v_mps, car.measured_delta_v_mps);
      errors.add_yaw_rate(degrees(side.yaw_rate_change_radps), car.measured_yaw_rate_dps);
    }
  }
  errors.finish();
  return errors;
}

bool all_agree(const std::vector<PairOutcome>& outcomes) {
  return std::all_of(outcomes.begin(), outcomes.end(),
                     [](const PairOutcome& outcome) { return outcome.roles_agree; });
}

}  // namespace

double relative_error(double simulated, double measured) {
  return measured != 0.0 ? simulated / measured - 1.0 : 0.0;
}

std::string relative_error_text(double simulated, const std::optional<double>& measured) {
  if (!measured) return {};
  const double rounded = std::round(100.0 * relative_error(simulated, *measured));
  return fmt::format("{:+.0f} %", rounded == 0.0 ? 0.0 : rounded);  // -0 prints as 0
}

void TestErrors::add_delta_v(double simulated, const std::optional<double>& measured) {
  if (!measured) return;
  const double off = std::abs(relative_error(simulated, *measured));
  delta_v += off;
  worst_delta_v = std::max(worst_delta_v, off);
  ++delta_v_values;
}

void TestErrors::add_yaw_rate(double simulated, const std::optional<double>& measured) {
  if (!measured) return;
  yaw_rate += std::abs(relative_error(simulated, *measured));
  ++yaw_rate_values;
}

void TestErrors::finish() {
  if (delta_v_values > 0) delta_v /= static_cast<double>(delta_v_values);
  if (yaw_rate_values > 0) yaw_rate /= static_cast<double>(yaw_rate_values);
}

Json TestErrors::json() const {
  const auto or_null = [](double value, std::size_t values) {
    return values > 0 ? Json(value) : Json(nullptr);
  };
  return {{"mean_delta_v_error", or_null(delta_v, delta_v_values)},
          {"worst_delta_v_error", or_null(worst_delta_v, delta_v_values)},
          {"mean_yaw_rate_error", or_null(yaw_rate, yaw_rate_values)}};
}

std::string TestErrors::text(const std::string& what) const {
  if (delta_v_values == 0) return {};
  std::string text = fmt::format("{}: |delta-v| off by {:.1f} % in the mean, {:.1f} % at worst",
                                 what, 100.0 * delta_v, 100.0 * worst_delta_v);
  if (yaw_rate_values > 0) {
    text += fmt::format("; yaw rate by {:.1f} % in the mean", 100.0 * yaw_rate);
  }
  return text + "\n";
}

ComparedShape compare_pairs(const std::vector<PairTest>& tests,
                            const std::vector<PairOutcome>& outcomes, const std::string& shape) {
  ComparedShape compared{shape, {}, {}};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const PairedCar& car = tests[i].cars.at(k);
      const BodyOutcome& side = side_of(outcomes[i], k);
      compared.add(fmt::format("{}, car {}", tests[i].id, k + 1), side.delta_v_mps,
                   car.measured_delta_v_mps, degrees(side.yaw_rate_change_radps),
                   car.measured_yaw_rate_dps);
    }
  }
  return compared;
}

Json pairs_json(const std::vector<PairTest>& tests, const std::vector<PairOutcome>& outcomes) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const PairOutcome& outcome = outcomes[i];
    Json row{{"id", tests[i].id}};
    for (std::size_t k = 0; k < 2; ++k) {
      const PairedCar& car = tests[i].cars.at(k);
      const BodyOutcome& side = side_of(outcome, k);
      const std::string number = std::to_string(k + 1);
      const double delta_v = side.delta_v_mps;
      const double yaw_rate = degrees(side.yaw_rate_change_radps);
      row["delta_v" + number + "_mps"] = delta_v;
      row["yaw_rate" + number + "_dps"] = yaw_rate;
      row["pdof" + number + "_deg"] = side.pdof_deg;
      row["deepest" + number + "_m"] = side.crush_m;
      if (car.measured_delta_v_mps) {
        row["measured_delta_v" + number + "_mps"] = *car.measured_delta_v_mps;
        row["delta_v" + number + "_error"] = relative_error(delta_v, *car.measured_delta_v_mps);
      }
      if (car.measured_yaw_rate_dps) {
        row["measured_yaw_rate" + number + "_dps"] = *car.measured_yaw_rate_dps;
        row["yaw_rate" + number + "_error"] = relative_error(yaw_rate, *car.measured_yaw_rate_dps);
      }
    }
    row["slides"] = outcome.crash.severity.slides;
    row["collides"] = outcome.crash.acts;
    row["duration_s"] = outcome.crash.severity.duration_s;
    row["dissipated_j"] = outcome.crash.severity.dissipated_j;
    row["roles_agree"] = outcome.roles_agree;
    rows.push_back(std::move(row));
  }
  Json document{{"rows", std::move(rows)}};
  document["roles_agree"] = all_agree(outcomes);
  document.update(errors_of(tests, outcomes).json());
  return document;
}

std::string pairs_text(const std::vector<PairTest>& tests,
                       const std::vector<PairOutcome>& outcomes) {
  Table table({{"test"},
               {"car", true},
               {"delta-v km/h: measured", true},
               {"simulated", true},
               {"error", true},
               {"yaw deg/s: measured", true},
               {"simulated", true},
               {"error", true},
               {"slides"}});
  const auto measured = [](const std::optional<double>& value, double scale) {
    return value ? fmt::format("{:.1f}", scale * *value) : std::string();
  };
  for (std::size_t i = 0; i < tests.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const PairedCar& car = tests[i].cars.at(k);
      const BodyOutcome& side = side_of(outcomes[i], k);
      const double delta_v = side.delta_v_mps;
      const double yaw_rate = degrees(side.yaw_rate_change_radps);
      table.add_row({tests[i].id, std::to_string(k + 1),
                     measured(car.measured_delta_v_mps, kmh_per_mps),
                     fmt::format("{:.1f}", kmh_per_mps * delta_v),
                     relative_error_text(delta_v, car.measured_delta_v_mps),
                     measured(car.measured_yaw_rate_dps, 1.0), fmt::format("{:.0f}", yaw_rate),
                     relative_error_text(yaw_rate, car.measured_yaw_rate_dps),
                     outcomes[i].crash.severity.slides ? "yes" : "no"});
    }
  }
  std::string text = table.text(colours_wanted());
  text += errors_of(tests, outcomes).text("both cars");
  text += all_agree(outcomes) ? "roles agree: exchanging the cars changes no bit\n"
                              : "roles do not agree: exchanging the cars changes the result\n";
  return text;
}

}  // namespace crashrank::cli
