#include "sweep_plot.hpp"

#include "chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace crashrank::cli {
namespace {

struct PolicyStyle {
  Policy policy;
  ChartStroke stroke;
};

// Told apart by dashes as well as by colours.
constexpr std::array<PolicyStyle, 5> styles{{{Policy::best_match, {"#0b5394", ""}},
                                             {Policy::random, {"#b45f06", "2 3"}},
                                             {Policy::lowest, {"#990000", "8 3"}},
                                             {Policy::best_match_load, {"#38761d", "8 3 2 3"}},
                                             {Policy::late_match, {"#000000", ""}}}};

/// What a panel shows of a row, as measured and as a replay finds it.
struct SweptValue {
  const char* title;
  double SweepRow::*measured;
  double SweepRow::*replayed;
};

constexpr std::array<SweptValue, 2> swept{
    {{"speedup", &SweepRow::speedup, &SweepRow::replayed_speedup},
     {"relative data transfer", &SweepRow::relative_transfer,
      &SweepRow::replayed_relative_transfer}}};

/// False where the dispatch was trimmed or had nothing to share.
bool is_drawn(const SweepRow& row) { return row.end == DispatchEnd::ok && row.jobs > 0.0; }

std::string curve(const Sweep& sweep, const ChartPanel& panel, const PolicyStyle& style,
                  double SweepRow::*value) {
  std::string svg;
  std::string points;
  std::string dots;
  const auto flush = [&] {
    if (points.empty()) return;
    svg += fmt::format(
        "<polyline points='{}' fill='none' stroke='{}' stroke-width='2' "
        "stroke-dasharray='{}'/>{}\n",
        points, style.stroke.colour, style.stroke.dash, dots);
    points.clear();
    dots.clear();
  };
  for (const SweepRow& row : sweep.rows) {
    if (row.policy != style.policy) continue;
    if (!is_drawn(row)) {
      flush();
      continue;
    }
    const double x = panel.x_px(row.depth);
    const double y = panel.y_px(row.*value);
    points += fmt::format("{:.1f},{:.1f} ", x, y);
    dots += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.5' fill='{}'/>", x, y,
                        style.stroke.colour);
  }
  flush();
  return svg;
}

}  // namespace

std::string sweep_plot(const Sweep& sweep, const std::string& title, std::uint32_t workers) {
  const bool replayed = sweep.processors < workers;
  std::uint32_t first = max_distribution_depth;
  std::uint32_t last = 1;
  for (const SweepRow& row : sweep.rows) {
    first = std::min(first, row.depth);
    last = std::max(last, row.depth);
  }
  const ChartAxis depths{static_cast<double>(first), static_cast<double>(std::max(last, first + 1)),
                         1.0};
  constexpr double top = 80.0;
  constexpr double height = 280.0;
  double left = 60.0;
  std::string svg;
  for (const SweptValue& shown : swept) {
    const auto value = replayed ? shown.replayed : shown.measured;
    double most = 1.0;  // the speed of one worker, the bytes of both models
    for (const SweepRow& row : sweep.rows) {
      if (is_drawn(row)) most = std::max(most, row.*value);
    }
    const ChartPanel panel{left, top, 360.0, height, depths, chart_axis(0.0, most)};
    svg += panel.frame(shown.title, "distribution depth", {});
    svg += panel.line(depths.lowest, 1.0, depths.highest, 1.0, {"#555555", "4 4"});
    for (const PolicyStyle& style : styles) svg += curve(sweep, panel, style, value);
    left += 440.0;
  }
  double x = 60.0;
  for (const PolicyStyle& style : styles) {
    const bool drawn = std::any_of(sweep.rows.begin(), sweep.rows.end(),
                                   [&](const SweepRow& row) { return row.policy == style.policy; });
    if (!drawn) continue;
    svg += chart_key(x, top + height + 60.0, style.stroke, policy_name(style.policy));
    x += 160.0;
  }
  const std::string how = replayed ? fmt::format("replayed on {} virtual cores", workers)
                                   : fmt::format("measured with {} workers on {} processors",
                                                 workers, sweep.processors);
  return chart_picture(900.0, 440.0, title, how, svg);
}

}  // namespace crashrank::cli
