#include "crashrank/internal/report/table.hpp"

#include "crashrank/internal/report/escape.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <utility>

namespace crashrank {
namespace {

/// The title, or its words one to a line.
std::vector<std::string> head_lines(const std::string& title, bool breaks) {
  if (!breaks) return {title};
  std::vector<std::string> lines;
  std::istringstream words(title);
  for (std::string word; words >> word;) lines.push_back(word);
  return lines.empty() ? std::vector<std::string>{title} : lines;
}

/// The text, or its beginning and an ellipsis.
std::string cut(const std::string& text, std::size_t width) {
  if (display_width(text) <= width) return text;
  std::size_t end = 0;
  for (std::size_t characters = 0; end < text.size(); ++end) {
    const bool begins = (static_cast<unsigned char>(text[end]) & 0xC0U) != 0x80U;
    if (begins && ++characters == width) break;
  }
  while (end > 0 && text[end - 1] == ' ') --end;
  return text.substr(0, end) + "…";
}

std::size_t total_width(const std::vector<std::size_t>& widths) {
  return std::accumulate(widths.begin(), widths.end(), 2 * (widths.size() - 1));
}

}  // namespace

Table::Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

void Table::add_row(std::vector<std::string> cells) {
  cells.resize(columns_.size());
  for (std::string& cell : cells) cell = escape_terminal(cell);
  rows_.push_back(std::move(cells));
}

Table::Layout Table::layout(std::size_t width) const {
  const auto natural = [&](bool breaks_titles) {
    std::vector<std::size_t> widths(columns_.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      for (const std::string& line : head_lines(columns_[i].title, breaks_titles)) {
        widths[i] = std::max(widths[i], display_width(line));
      }
      for (const std::vector<std::string>& row : rows_) {
        widths[i] = std::max(widths[i], display_width(row[i]));
      }
    }
    return widths;
  };
  Layout made;
  made.columns.resize(columns_.size());
  std::iota(made.columns.begin(), made.columns.end(), std::size_t{0});
  made.widths = natural(false);
  if (width == 0 || total_width(made.widths) <= width) return made;
  made.breaks_titles = true;
  made.widths = natural(true);
  const auto narrowest = [&] {
    std::vector<std::size_t> widths;
    for (std::size_t k = 0; k < made.columns.size(); ++k) {
      const std::size_t least = columns_[made.columns[k]].narrowest;
      widths.push_back(least == 0 ? made.widths[k] : std::min(least, made.widths[k]));
    }
    return widths;
  };
  while (total_width(narrowest()) > width) {
    const auto leaves = std::min_element(
        made.columns.begin(), made.columns.end(), [&](std::size_t p, std::size_t q) {
          return columns_[p].leaves > 0 &&
                 (columns_[q].leaves == 0 || columns_[p].leaves < columns_[q].leaves);
        });
    if (columns_[*leaves].leaves == 0) break;
    made.widths.erase(made.widths.begin() + (leaves - made.columns.begin()));
    made.columns.erase(leaves);
  }
  const std::vector<std::size_t> least = narrowest();
  while (total_width(made.widths) > width) {
    std::size_t widest = least.size();
    for (std::size_t k = 0; k < least.size(); ++k) {
      if (made.widths[k] == least[k]) continue;
      if (widest == least.size() || made.widths[k] > made.widths[widest]) widest = k;
    }
    if (widest == least.size()) break;
    --made.widths[widest];
  }
  return made;
}

std::string Table::text(bool bold_titles, std::size_t width) const {
  const Layout shown = layout(width);
  const auto line = [&](const auto& cell) {
    std::string out;
    for (std::size_t k = 0; k < shown.columns.size(); ++k) {
      const std::string text = cut(cell(shown.columns[k]), shown.widths[k]);
      const std::string pad(shown.widths[k] - display_width(text), ' ');
      if (k > 0) out += "  ";
      out += columns_[shown.columns[k]].right ? pad + text : text + pad;
    }
    out.erase(out.find_last_not_of(' ') + 1);
    return out;
  };
  std::vector<std::vector<std::string>> heads;
  std::size_t head_count = 1;
  for (const Column& column : columns_) {
    heads.push_back(head_lines(column.title, shown.breaks_titles));
    head_count = std::max(head_count, heads.back().size());
  }
  std::string out;
  for (std::size_t row = 0; row < head_count; ++row) {
    // Titles stand on the rows.
    const std::string head = line([&](std::size_t i) {
      const std::size_t above = head_count - heads[i].size();
      return row < above ? std::string() : heads[i][row - above];
    });
    out += (bold_titles ? "\x1b[1m" + head + "\x1b[0m" : head) + '\n';
  }
  for (const std::vector<std::string>& row : rows_) {
    out += line([&](std::size_t i) -> const std::string& { return row[i]; }) + '\n';
  }
  return out;
}

}  // namespace crashrank
