#include "validate_plot.hpp"

#include "chart.hpp"
#include "crash_test_table.hpp"

#include "crashrank/internal/report/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace crashrank::cli {
namespace {

struct Quantity {
  const char* name;
  const char* unit;
  std::vector<ComparedValue> ComparedShape::*values;
};

constexpr std::array<Quantity, 2> compared_quantities{
    {{"delta-v", "km/h", &ComparedShape::delta_v},
     {"change of yaw rate", "degrees/s", &ComparedShape::yaw_rate}}};

/// The line through the origin with this slope, as far as the panel goes; both axes are the same.
std::string ray(const ChartPanel& panel, double slope, const ChartStroke& stroke) {
  const double longer = std::max(1.0, slope);
  const double from = panel.x.lowest / longer;
  const double to = panel.x.highest / longer;
  return panel.line(from, slope * from, to, slope * to, stroke);
}

std::string point(const ChartPanel& panel, const ComparedValue& value, bool is_full) {
  constexpr const char* colour = "#0b5394";
  return fmt::format(
      "<circle cx='{:.1f}' cy='{:.1f}' r='4' fill='{}' fill-opacity='0.7' stroke='{}'>"
      "<title>{}: measured {:.1f}, simulated {:.1f}</title></circle>\n",
      panel.x_px(value.measured), panel.y_px(value.simulated), is_full ? colour : "none", colour,
      escape_xml(value.test), value.measured, value.simulated);
}

}  // namespace

void ComparedShape::add(const std::string& test, double delta_v_mps,
                        const std::optional<double>& measured_mps, double yaw_rate_dps,
                        const std::optional<double>& measured_dps) {
  if (measured_mps) {
    delta_v.push_back({test, kmh_per_mps * *measured_mps, kmh_per_mps * delta_v_mps});
  }
  if (measured_dps) yaw_rate.push_back({test, *measured_dps, yaw_rate_dps});
}

std::string validate_plot(const std::string& title, const std::vector<ComparedShape>& shapes) {
  constexpr ChartStroke equal{"#000000"};
  constexpr ChartStroke fifth{"#990000", "6 4"};
  constexpr double side = 360.0;
  constexpr double beside = 80.0;
  constexpr double top = 80.0;
  std::string svg;
  double left = beside;
  for (const Quantity& quantity : compared_quantities) {
    double least = 0.0;
    double most = 0.0;
    bool is_empty = true;
    for (const ComparedShape& shape : shapes) {
      for (const ComparedValue& value : shape.*quantity.values) {
        least = std::min({least, value.measured, value.simulated});
        most = std::max({most, value.measured, value.simulated});
        is_empty = false;
      }
    }
    if (is_empty) continue;
    const ChartAxis axis = chart_axis(least, most);
    const ChartPanel panel{left, top, side, side, axis, axis};
    svg += panel.frame(quantity.name, fmt::format("measured [{}]", quantity.unit),
                       fmt::format("simulated [{}]", quantity.unit));
    svg += ray(panel, 1.0, equal) + ray(panel, 0.8, fifth) + ray(panel, 1.2, fifth);
    for (const ComparedShape& shape : shapes) {
      for (const ComparedValue& value : shape.*quantity.values) {
        svg += point(panel, value, &shape == shapes.data());
      }
    }
    left += side + beside;
  }
  std::string words = "full: " + shapes.front().name;
  if (shapes.size() > 1) words += ", hollow: " + shapes.back().name;
  const double key_y = top + side + 62.0;
  svg += chart_key(beside, key_y, equal, "equal");
  svg += chart_key(beside + 120.0, key_y, fifth, "20 % above and below");
  return chart_picture(left, key_y + 20.0, title, words, svg);
}

}  // namespace crashrank::cli
