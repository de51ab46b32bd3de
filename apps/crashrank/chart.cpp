#include "chart.hpp"

#include "crashrank/internal/report/escape.hpp"

#include <fmt/format.h>

#include <cmath>

namespace crashrank::cli {
namespace {

/// The least of 1, 2, 5 times a power of ten that covers a range in at most eight steps.
double tick_step(double range) {
  const double step = std::pow(10.0, std::floor(std::log10(range / 8.0)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (range / (step * factor) <= 8.0) return step * factor;
  }
  return step * 10.0;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  if (text.empty()) return {};
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>\n", x, y, anchor,
                     escape_xml(text));
}

std::string line_at(double x0, double y0, double x1, double y1, const ChartStroke& stroke) {
  return fmt::format(
      "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='{}' stroke-dasharray='{}'/>\n",
      x0, y0, x1, y1, stroke.colour, stroke.dash);
}

int tick_count(const ChartAxis& axis) {
  return static_cast<int>(std::lround((axis.highest - axis.lowest) / axis.step));
}

}  // namespace

ChartAxis chart_axis(double least, double most) {
  const double step = tick_step(least < most ? most - least : 1.0);
  const double lowest = step * std::floor(least / step);
  return {lowest, std::fmax(step * std::ceil(most / step), lowest + step), step};
}

double ChartPanel::x_px(double value) const {
  return left + width * (value - x.lowest) / (x.highest - x.lowest);
}

double ChartPanel::y_px(double value) const {
  return top + height * (y.highest - value) / (y.highest - y.lowest);
}

std::string ChartPanel::frame(const std::string& title, const std::string& x_title,
                              const std::string& y_title) const {
  constexpr ChartStroke grid{"#dddddd"};
  const double bottom = top + height;
  std::string svg;
  for (int i = 0; i <= tick_count(x); ++i) {
    const double value = x.lowest + i * x.step;
    svg += line_at(x_px(value), top, x_px(value), bottom, grid);
    svg += text_at(x_px(value), bottom + 16.0, "middle", fmt::format("{:.6g}", value));
  }
  for (int i = 0; i <= tick_count(y); ++i) {
    const double value = y.lowest + i * y.step;
    svg += line_at(left, y_px(value), left + width, y_px(value), grid);
    svg += text_at(left - 6.0, y_px(value) + 4.0, "end", fmt::format("{:.6g}", value));
  }
  svg += fmt::format(
      "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='none' stroke='#888888'/>\n",
      left, top, width, height);
  svg += text_at(left, top - 8.0, "start", title);
  svg += text_at(left + width / 2.0, bottom + 34.0, "middle", x_title);
  if (y_title.empty()) return svg;
  return svg + fmt::format("<g transform='translate({:.1f} {:.1f}) rotate(-90)'>{}</g>\n",
                           left - 48.0, top + height / 2.0, text_at(0.0, 0.0, "middle", y_title));
}

std::string ChartPanel::line(double x0, double y0, double x1, double y1,
                             const ChartStroke& stroke) const {
  return line_at(x_px(x0), y_px(y0), x_px(x1), y_px(y1), stroke);
}

std::string chart_key(double x, double y, const ChartStroke& stroke, const std::string& what) {
  return line_at(x, y - 4.0, x + 28.0, y - 4.0, stroke) + text_at(x + 34.0, y, "start", what);
}

std::string chart_picture(double width, double height, const std::string& title,
                          const std::string& subtitle, const std::string& content) {
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0:g}' height='{1:g}' "
      "viewBox='0 0 {0:g} {1:g}' font-family='sans-serif' font-size='12'>\n"
      "<rect width='{0:g}' height='{1:g}' fill='white'/>\n"
      "<text x='20' y='24' font-size='15'>{2}</text>\n"
      "<text x='20' y='43' fill='#555555'>{3}</text>\n{4}</svg>\n",
      width, height, escape_xml(title), escape_xml(subtitle), content);
}

}  // namespace crashrank::cli
