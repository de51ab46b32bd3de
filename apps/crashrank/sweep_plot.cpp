#include "sweep_plot.hpp"

#include "crashrank/internal/report/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace crashrank::cli {
namespace {

struct Style {
  Policy policy;
  const char* colour;
  const char* dash;
};

// Told apart by dashes as well as by colours.
constexpr std::array<Style, 5> styles{{{Policy::best_match, "#0b5394", ""},
                                       {Policy::random, "#b45f06", "2 3"},
                                       {Policy::lowest, "#990000", "8 3"},
                                       {Policy::best_match_load, "#38761d", "8 3 2 3"},
                                       {Policy::late_match, "#000000", ""}}};

/// The largest of 1, 2, 5 times a power of ten that gives at most eight steps.
double tick_step(double top) {
  double step = std::pow(10.0, std::floor(std::log10(top / 8.0)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    if (top / (step * factor) <= 8.0) return step * factor;
  }
  return step * 10.0;
}

struct Panel {
  double left;
  const char* label;
  double (*value)(const SweepRow& row, bool replayed);
};

constexpr double top = 56.0;
constexpr double width = 360.0;
constexpr double height = 280.0;

class Plot {
public:
  Plot(const Sweep& sweep, bool replayed) : sweep_(sweep), replayed_(replayed) {
    for (const SweepRow& row : sweep.rows) {
      first_ = std::min(first_, row.depth);
      last_ = std::max(last_, row.depth);
    }
    if (last_ == first_) ++last_;
  }

  void draw(const Panel& panel) {
    double most = 0.0;
    for (const SweepRow& row : sweep_.rows) {
      if (row.end == DispatchEnd::ok && row.jobs > 0.0)
        most = std::max(most, panel.value(row, replayed_));
    }
    if (!(most > 0.0)) most = 1.0;
    const double step = tick_step(most);
    most = step * std::ceil(most / step);
    axes(panel, most, step);
    for (const Style& style : styles) line(panel, style, most);
  }

  void legend() {
    double y = top + height + 56.0;
    double x = 60.0;
    for (const Style& style : styles) {
      const bool drawn =
          std::any_of(sweep_.rows.begin(), sweep_.rows.end(),
                      [&](const SweepRow& row) { return row.policy == style.policy; });
      if (!drawn) continue;
      svg_ += fmt::format(
          "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='{}' stroke-width='2' "
          "stroke-dasharray='{}'/><text x='{:.1f}' y='{:.1f}'>{}</text>\n",
          x, y - 4.0, x + 28.0, y - 4.0, style.colour, style.dash, x + 34.0, y,
          policy_name(style.policy));
      x += 160.0;
    }
  }

  std::string take() { return std::move(svg_); }

private:
  double x_of(const Panel& panel, double depth) const {
    return panel.left + width * (depth - first_) / (last_ - first_);
  }
  static double y_of(double value, double most) { return top + height * (1.0 - value / most); }

  void axes(const Panel& panel, double most, double step) {
    svg_ += fmt::format(
        "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='none' stroke='#888'/>"
        "<text x='{:.1f}' y='{:.1f}'>{}</text>"
        "<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>distribution depth</text>\n",
        panel.left, top, width, height, panel.left, top - 8.0, panel.label,
        panel.left + width / 2.0, top + height + 34.0);
    for (std::uint32_t depth = first_; depth <= last_; ++depth) {
      svg_ += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n",
                          x_of(panel, depth), top + height + 16.0, depth);
    }
    for (int i = 0; i * step <= most * 1.0001; ++i) {
      const double y = y_of(i * step, most);
      svg_ += fmt::format(
          "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='#ddd'/>"
          "<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{:g}</text>\n",
          panel.left, y, panel.left + width, y, panel.left - 6.0, y + 4.0, i * step);
    }
  }

  void line(const Panel& panel, const Style& style, double most) {
    std::string points;
    std::string dots;
    const auto flush = [&] {
      if (points.empty()) return;
      svg_ += fmt::format(
          "<polyline points='{}' fill='none' stroke='{}' stroke-width='2' "
          "stroke-dasharray='{}'/>{}\n",
          points, style.colour, style.dash, dots);
      points.clear();
      dots.clear();
    };
    for (const SweepRow& row : sweep_.rows) {
      if (row.policy != style.policy) continue;
      if (row.end != DispatchEnd::ok || row.jobs == 0.0) {  // trimmed, or nothing to share
        flush();
        continue;
      }
      const double x = x_of(panel, row.depth);
      const double y = y_of(panel.value(row, replayed_), most);
      points += fmt::format("{:.1f},{:.1f} ", x, y);
      dots +=
          fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.5' fill='{}'/>", x, y, style.colour);
    }
    flush();
  }

  const Sweep& sweep_;
  bool replayed_;
  std::uint32_t first_ = max_distribution_depth;
  std::uint32_t last_ = 1;
  std::string svg_;
};

}  // namespace

std::string sweep_plot(const Sweep& sweep, const std::string& title, std::uint32_t workers) {
  const bool replayed = sweep.processors < workers;
  Plot plot(sweep, replayed);
  plot.draw({60.0, "speedup", [](const SweepRow& row, bool of_replay) {
               return of_replay ? row.replayed_speedup : row.speedup;
             }});
  plot.draw({500.0, "relative data transfer", [](const SweepRow& row, bool of_replay) {
               return of_replay ? row.replayed_relative_transfer : row.relative_transfer;
             }});
  plot.legend();
  const std::string how = replayed ? fmt::format("replayed on {} virtual cores", workers)
                                   : fmt::format("measured with {} workers on {} processors",
                                                 workers, sweep.processors);
  return fmt::format(
             "<svg xmlns='http://www.w3.org/2000/svg' width='900' height='420' "
             "viewBox='0 0 900 420' font-family='sans-serif' font-size='12'>\n"
             "<rect width='900' height='420' fill='white'/>\n"
             "<text x='60' y='22' font-size='15'>{}</text>\n"
             "<text x='60' y='38' fill='#555'>{}</text>\n",
             escape_xml(title), how) +
         plot.take() + "</svg>\n";
}

}  // namespace crashrank::cli
