#include "table.hpp"

#include "crashrank/internal/report/table.hpp"

#include <algorithm>
#include <cstdio>

namespace peers {
namespace {

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string time_of(double microseconds) {
  return number(microseconds, microseconds < 1.0 ? 4 : microseconds < 100.0 ? 2 : 0);
}

std::string times(double ratio) {
  if (ratio == 0.0) return "-";
  return number(ratio, ratio < 10.0 ? 2 : ratio < 100.0 ? 1 : 0);
}

bool same_race(const Row& a, const Row& b) {
  return a.workload == b.workload && a.regime == b.regime && a.mode == b.mode;
}

std::string verdict(const Row& row) {
  if (row.missed + row.invented == 0) return "";
  return "WRONG: " + std::to_string(row.missed) + " missed, " + std::to_string(row.invented) +
         " invented";
}

}  // namespace

double ratio(const std::vector<Row>& rows, const Row& row, const std::string& reference) {
  for (const Row& other : rows) {
    if (same_race(row, other) && other.peer == reference) {
      return other.microseconds / row.microseconds;
    }
  }
  return 0.0;
}

std::string to_text(const std::vector<Row>& rows) {
  std::string text;
  for (auto first = rows.begin(); first != rows.end();) {
    const auto last =
        std::find_if_not(first, rows.end(), [&](const Row& row) { return same_race(row, *first); });
    std::vector<Row> race(first, last);
    std::stable_sort(race.begin(), race.end(),
                     [](const Row& a, const Row& b) { return a.microseconds < b.microseconds; });
    text += first->workload + ", " + std::to_string(first->triangles) +
            " triangles: " + regime_names[static_cast<std::size_t>(first->regime)] + " / " +
            mode_names[static_cast<std::size_t>(first->mode)] + "\n";
    crashrank::Table table({{"peer"},
                            {"us", true},
                            {"x FCL", true},
                            {"x FCL native", true},
                            {first->mode == Mode::any ? "yes" : "pairs", true},
                            {""}});
    for (const Row& row : race) {
      table.add_row({row.peer, time_of(row.microseconds), times(ratio(rows, row, fcl_name)),
                     times(ratio(rows, row, fcl_native_name)), std::to_string(row.pairs),
                     verdict(row)});
    }
    text += table.text() + "\n";
    first = last;
  }
  return text;
}

std::string to_csv(const std::vector<Row>& rows) {
  std::string text =
      "mesh,triangles,regime,mode,peer,microseconds,times_fcl,times_fcl_native,pairs,missed,"
      "invented\n";
  for (const Row& row : rows) {
    std::string mesh = row.workload;
    std::replace(mesh.begin(), mesh.end(), ',', ' ');
    std::string peer = row.peer;
    std::replace(peer.begin(), peer.end(), ',', ' ');
    std::string mode = mode_names[static_cast<std::size_t>(row.mode)];
    mode.erase(std::remove(mode.begin(), mode.end(), ','), mode.end());
    text += mesh + "," + std::to_string(row.triangles) + "," +
            regime_names[static_cast<std::size_t>(row.regime)] + "," + mode + "," + peer + "," +
            number(row.microseconds, 4) + "," + number(ratio(rows, row, fcl_name), 3) + "," +
            number(ratio(rows, row, fcl_native_name), 3) + "," + std::to_string(row.pairs) + "," +
            std::to_string(row.missed) + "," + std::to_string(row.invented) + "\n";
  }
  return text;
}

}  // namespace peers
