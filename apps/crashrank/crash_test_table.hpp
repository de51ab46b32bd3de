#pragma once

#include "crashrank/base/result.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace crashrank::cli {

inline constexpr double kmh_per_mps = 3.6;

/// A line of a table of crash tests, read by the names of the columns. Keeps the first error.
class TestLine {
public:
  TestLine(const std::map<std::string, std::size_t>& columns, std::vector<std::string> fields,
           std::size_t line)
      : columns_(&columns), fields_(std::move(fields)), line_(line) {}

  /// The field without blanks; empty where the line ends before it.
  std::string text(const std::string& column) const;
  /// A number in [low, high], empty where the field is. Errors are kept.
  std::optional<double> optional_number(const std::string& column, double low, double high);
  /// A number in [low, high]; an empty field is an error.
  double number(const std::string& column, double low, double high);

  /// Keeps an error of a column unless there is one already.
  void refuse(const std::string& column, const std::string& reason, const std::string& remedy);
  /// The first error: bad_input with line and column.
  const Status& status() const { return status_; }

private:
  const std::map<std::string, std::size_t>* columns_;
  std::vector<std::string> fields_;
  std::size_t line_;
  Status status_ = Success{};
};

/// Comma-separated lines under a header line that names their columns, in any order. Lines that are
/// empty or begin with # are comments. Unknown columns are ignored.
class TestTable {
public:
  /// Errors: bad_input without a header line; limit_exceeded beyond 10,000 rows.
  static Result<TestTable> parse(const std::string& text);

  bool has(const std::string& column) const { return columns_.count(column) != 0; }
  /// Errors: bad_input naming the first column that is missing.
  Status require(const std::vector<std::string>& columns) const;
  /// All rows. They refer to the table.
  std::vector<TestLine> lines() const;

private:
  struct Fields {
    std::size_t line = 0;
    std::vector<std::string> values;
  };
  std::map<std::string, std::size_t> columns_;
  std::size_t header_line_ = 1;
  std::vector<Fields> rows_;
};

}  // namespace crashrank::cli
