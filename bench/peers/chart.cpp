#include "table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace peers {
namespace {

constexpr int width = 820;
constexpr int label_width = 170;
constexpr int value_width = 130;
constexpr int bar_height = 18;
constexpr int group_gap = 34;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string label(double x, int y, const std::string& text, const char* more) {
  char head[160];
  std::snprintf(head, sizeof head, "<text x=\"%.1f\" y=\"%d\"%s>", x, y, more);
  return head + escaped(text) + "</text>\n";
}

std::string bar(double x, int y, double length, const char* fill) {
  char text[160];
  std::snprintf(text, sizeof text,
                "<rect x=\"%.1f\" y=\"%d\" width=\"%.1f\" height=\"%d\" fill=\"%s\"/>\n", x, y,
                length, bar_height - 4, fill);
  return text;
}

std::string value_of(const Row& row, double times) {
  char text[64];
  if (times > 0.0) {
    std::snprintf(text, sizeof text, "%.3g \xC2\xB5s  (%.3g\xC3\x97)", row.microseconds, times);
  } else {
    std::snprintf(text, sizeof text, "%.3g \xC2\xB5s", row.microseconds);
  }
  return text;
}

}  // namespace

std::string to_svg(const std::vector<Row>& rows) {
  std::vector<Row> shown;
  for (const Row& row : rows) {
    if (row.regime == Regime::deep && row.mode == Mode::all) shown.push_back(row);
  }
  double least = INFINITY;
  double most = 0.0;
  for (const Row& row : shown) {
    least = std::min(least, row.microseconds);
    most = std::max(most, row.microseconds);
  }
  // The axis begins at the power of ten below the fastest, so that every bar has a length.
  const double start = std::floor(std::log10(least) - 1e-9);
  const double span = std::max(1.0, std::ceil(std::log10(most) + 1e-9) - start);
  const double scale = (width - label_width - value_width) / span;

  std::string body;
  int y = 30;
  for (auto first = shown.begin(); first != shown.end();) {
    const auto last = std::find_if_not(
        first, shown.end(), [&](const Row& row) { return row.workload == first->workload; });
    std::vector<Row> group(first, last);
    std::stable_sort(group.begin(), group.end(),
                     [](const Row& a, const Row& b) { return a.microseconds < b.microseconds; });
    y += group_gap;
    body += label(10, y - 8,
                  group[0].workload + ", " + std::to_string(group[0].triangles) + " triangles",
                  " font-weight=\"bold\"");
    for (const Row& row : group) {
      const bool ours = row.peer.rfind("crashrank", 0) == 0;
      const bool wrong = row.missed + row.invented > 0;
      const double length = (std::log10(row.microseconds) - start) * scale;
      body += label(label_width - 8, y + 12, row.peer, " text-anchor=\"end\"");
      body += bar(label_width, y, length, ours ? "#c23b22" : wrong ? "url(#wrong)" : "#7a8793");
      body += label(label_width + length + 6, y + 12,
                    value_of(row, ratio(rows, row, fcl_name)) + (wrong ? " wrong pairs" : ""), "");
      y += bar_height;
    }
    first = last;
  }
  char head[700];
  std::snprintf(
      head, sizeof head,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"%d\" height=\"%d\" fill=\"#ffffff\"/>\n"
      "<defs><pattern id=\"wrong\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">"
      "<rect width=\"6\" height=\"6\" fill=\"#d8dde1\"/><path d=\"M0 6 L6 0\" "
      "stroke=\"#7a8793\"/></pattern></defs>\n",
      width, y + 20, width, y + 20);
  return head +
         label(10, 20,
               "All intersecting pairs, one body's front deep in the other's side: time a query, "
               "logarithmic (times as fast as FCL)",
               "") +
         body + "</svg>\n";
}

}  // namespace peers
