#include "crash_test_rows.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

namespace crashrank::cli {
namespace {

constexpr std::size_t most_rows = 10'000;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\"";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

Error bad(std::size_t line, std::string reason, std::string remedy = {}) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), std::move(remedy));
  error.place = "line " + std::to_string(line);
  return error;
}

/// One line's fields by the names of the columns. The first trouble stays.
class Row {
public:
  Row(const std::map<std::string, std::size_t>& columns, std::vector<std::string_view> fields,
      std::size_t line)
      : columns_(columns), fields_(std::move(fields)), line_(line) {}

  std::string_view text(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end() || found->second >= fields_.size()) return {};
    return fields_[found->second];
  }

  std::optional<double> optional_number(const std::string& column, double low, double high) {
    const std::string_view word = text(column);
    if (word.empty()) return std::nullopt;
    double value = 0.0;
    const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end.ec != std::errc{} || end.ptr != word.data() + word.size()) {
      refuse(column + " is not a number");
    } else if (!(value >= low && value <= high)) {
      refuse(column + " is out of range");
    }
    return value;
  }

  double number(const std::string& column, double low, double high) {
    const std::optional<double> value = optional_number(column, low, high);
    if (!value) refuse(column + " is missing");
    return value.value_or(low);
  }

  void refuse(const std::string& reason) {
    if (status_) status_ = bad(line_, reason);
  }
  const Status& status() const { return status_; }

private:
  const std::map<std::string, std::size_t>& columns_;
  std::vector<std::string_view> fields_;
  std::size_t line_;
  Status status_ = Success{};
};

Result<CrashTestRow> parse_row(Row row) {
  constexpr double longest = 30.0;
  constexpr double fastest = 150.0;
  CrashTestRow parsed;
  CrashTest& test = parsed.test;
  test.id = std::string(row.text("id"));
  test.length_m = row.number("length_m", 0.5, longest);
  test.width_m = row.number("width_m", 0.3, longest);
  test.height_m = row.number("height_m", 0.3, longest);
  test.wheelbase_m = row.number("wheelbase_m", 0.3, longest);
  test.mass_kg = row.number("mass_kg", 1.0, 1e6);
  test.izz_kgm2 = row.optional_number("izz_kgm2", 0.1, 1e8);
  const Result<Barrier> barrier = barrier_from_name(std::string(row.text("barrier")));
  if (barrier) {
    test.barrier = *barrier;
  } else {
    row.refuse(barrier.error().reason + ", only wall, flat, pole and deformable");
  }
  test.radius_m = row.optional_number("radius_m", 0.0, 5.0).value_or(0.0);
  if (test.barrier == Barrier::pole && !(test.radius_m > 0.0)) {
    row.refuse("a pole needs a radius_m above 0");
  }
  test.overlap = row.number("overlap", 0.0, 1.0);
  test.speed_mps = row.number("speed_mps", 0.1, fastest);
  parsed.measured_delta_v_mps = row.optional_number("measured_delta_v_mps", 0.0, fastest);
  parsed.measured_yaw_rate_dps = row.optional_number("measured_yaw_rate_dps", -1e4, 1e4);
  if (!(test.wheelbase_m < test.length_m)) row.refuse("wheelbase_m is not below length_m");
  if (!row.status()) return row.status().error();
  return parsed;
}

}  // namespace

Result<std::vector<CrashTestRow>> parse_crash_tests(const std::string& text) {
  std::map<std::string, std::size_t> columns;
  std::vector<CrashTestRow> rows;
  std::string_view rest = text;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    const std::string_view whole = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (whole.empty() || whole.front() == '#') continue;
    const std::vector<std::string_view> fields = fields_of(whole);
    if (columns.empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i) columns.emplace(fields[i], i);
      for (const char* needed : {"id", "length_m", "width_m", "height_m", "wheelbase_m", "mass_kg",
                                 "barrier", "overlap", "speed_mps"}) {
        if (columns.count(needed) == 0) {
          return bad(line, std::string("has no column ") + needed,
                     "name the columns in the first line");
        }
      }
      continue;
    }
    if (rows.size() == most_rows) {
      return make_error(ErrorCode::limit_exceeded,
                        "has more than " + std::to_string(most_rows) + " rows");
    }
    Result<CrashTestRow> row = parse_row(Row(columns, fields, line));
    if (!row) return row.error();
    rows.push_back(std::move(*row));
  }
  if (columns.empty()) return bad(1, "has no header line", "name the columns in the first line");
  return rows;
}

}  // namespace crashrank::cli
