#include "crash_test_table.hpp"

#include <fmt/format.h>

#include <charconv>
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

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.emplace_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

Error bad(std::string place, std::string reason, std::string remedy) {
  Error error = make_error(ErrorCode::bad_input, std::move(reason), std::move(remedy));
  error.place = std::move(place);
  return error;
}

constexpr const char* name_columns = "name the columns in the first line";

}  // namespace

std::string TestLine::text(const std::string& column) const {
  const auto found = columns_->find(column);
  if (found == columns_->end() || found->second >= fields_.size()) return {};
  return fields_[found->second];
}

std::optional<double> TestLine::optional_number(const std::string& column, double low,
                                                double high) {
  const std::string word = text(column);
  if (word.empty()) return std::nullopt;
  double value = 0.0;
  const char* const last = word.data() + word.size();
  const auto end = std::from_chars(word.data(), last, value);
  const std::string remedy = fmt::format("write a number from {:g} to {:g}", low, high);
  if (end.ec != std::errc{} || end.ptr != last) {
    refuse(column, "is not a number", remedy);
    return low;
  }
  if (!(value >= low && value <= high)) {
    refuse(column, "is out of range", remedy);
    return low;
  }
  return value;
}

double TestLine::number(const std::string& column, double low, double high) {
  const std::optional<double> value = optional_number(column, low, high);
  if (!value) {
    refuse(column, "is missing", fmt::format("write a number from {:g} to {:g}", low, high));
  }
  return value.value_or(low);
}

void TestLine::refuse(const std::string& column, const std::string& reason,
                      const std::string& remedy) {
  if (!status_) return;
  status_ = bad("line " + std::to_string(line_), column + " " + reason, remedy);
}

Result<TestTable> TestTable::parse(const std::string& text) {
  TestTable table;
  std::string_view rest = text;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    const std::string_view whole = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (whole.empty() || whole.front() == '#') continue;
    std::vector<std::string> fields = fields_of(whole);
    if (table.columns_.empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i) table.columns_.emplace(fields[i], i);
      table.header_line_ = line;
      continue;
    }
    if (table.rows_.size() == most_rows) {
      return make_error(ErrorCode::limit_exceeded,
                        "has more than " + std::to_string(most_rows) + " rows", "split the file");
    }
    table.rows_.push_back({line, std::move(fields)});
  }
  if (table.columns_.empty()) return bad("line 1", "has no header line", name_columns);
  return table;
}

Status TestTable::require(const std::vector<std::string>& columns) const {
  for (const std::string& column : columns) {
    if (!has(column)) {
      return bad("line " + std::to_string(header_line_), "has no column " + column, name_columns);
    }
  }
  return Success{};
}

std::vector<TestLine> TestTable::lines() const {
  std::vector<TestLine> lines;
  for (const Fields& row : rows_) lines.emplace_back(columns_, row.values, row.line);
  return lines;
}

}  // namespace crashrank::cli
