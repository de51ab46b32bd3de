#pragma once

#include "crashrank/internal/base/export.hpp"

#include <cstddef>
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
    /// Where the table is too wide, cells are cut to no fewer characters; 0: never.
    std::size_t narrowest = 0;
    int leaves = 0;  ///< left out where that is not enough, 1 first; 0: never
  };

  /// An empty table with these columns.
  explicit Table(std::vector<Column> columns);

  /// Cells beyond the columns are dropped, missing ones stay empty.
  void add_row(std::vector<std::string> cells);

  /// Lines end in '\n' and have no trailing spaces. `bold_titles` writes ANSI codes: for terminals
  /// that want them only. A table wider than `width` characters, 0: any, has its titles broken at
  /// spaces, then cells cut and columns left out; it stays too wide where that is not enough.
  std::string text(bool bold_titles = false, std::size_t width = 0) const;

private:
  /// Widths of the columns that are shown, by their indices.
  struct Layout {
    bool breaks_titles = false;
    std::vector<std::size_t> columns;
    std::vector<std::size_t> widths;
  };
  Layout layout(std::size_t width) const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace crashrank
