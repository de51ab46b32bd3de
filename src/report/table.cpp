#include "crashrank/internal/report/table.hpp"

#include "crashrank/internal/report/escape.hpp"

#include <algorithm>
#include <utility>

namespace crashrank {

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

void Table::add_row(std::vector<std::string> cells) {
  cells.resize(columns_.size());
  for (std::string& cell : cells) cell = escape_terminal(cell);
  rows_.push_back(std::move(cells));
}

std::string Table::text(bool bold_titles) const {
  std::vector<std::size_t> width;
  width.reserve(columns_.size());
  for (const Column& column : columns_) width.push_back(display_width(column.title));
  for (const std::vector<std::string>& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i)
      width[i] = std::max(width[i], display_width(row[i]));
  }
  const auto line = [&](const auto& cell) {
    std::string out;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string& text = cell(i);
      const std::string pad(width[i] - display_width(text), ' ');
      if (i > 0) out += "  ";
      out += columns_[i].right ? pad + text : text + pad;
    }
    out.erase(out.find_last_not_of(' ') + 1);
    return out;
  };
  std::string out = line([&](std::size_t i) -> const std::string& { return columns_[i].title; });
  if (bold_titles) out = "\x1b[1m" + out + "\x1b[0m";
  out += '\n';
  for (const std::vector<std::string>& row : rows_) {
    out += line([&](std::size_t i) -> const std::string& { return row[i]; }) + '\n';
  }
  return out;
}

}  // namespace crashrank
