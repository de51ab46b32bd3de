#pragma once

#include "crashrank/internal/base/export.hpp"

#include <string>
#include <vector>

namespace crashrank {

/// A table for a terminal or a log: titles, then rows, columns two spaces apart. Text stands left,
/// numbers right. Cells are escaped for a terminal as they are added.
class CRASHRANK_API Table {
public:
  /// A column of a table.
  struct Column {
    std::string title;   ///< its head
    bool right = false;  ///< numbers
  };

  /// An empty table with these columns.
  explicit Table(std::vector<Column> columns);

  /// Cells beyond the columns are dropped, missing ones stay empty.
  void add_row(std::vector<std::string> cells);

  /// Lines end in '\n' and have no trailing spaces. `bold_titles` writes ANSI codes: for terminals
  /// that want them only.
  std::string text(bool bold_titles = false) const;

private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace crashrank
