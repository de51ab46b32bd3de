#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// Changes (a letter more, less, other, or two neighbours swapped) that make one word of the other:
/// optimal string alignment, three rows at a time. O(product of the lengths).
inline std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t other = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + other});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

/// The known word that `word` was most likely meant to be, the first of equals: one that goes on
/// after it with '_' or '-', such as a unit, else the one with the fewest changes. Empty where that
/// takes more than one change in two or three letters, two in four to eight, or a third of more.
inline std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 64;  // the distance is quadratic, and no known word is this long
  if (word.empty() || word.size() > longest) return {};
  for (const std::string& candidate : known) {
    const bool goes_on = candidate.size() > word.size() && candidate.rfind(word, 0) == 0;
    if (goes_on && (candidate[word.size()] == '_' || candidate[word.size()] == '-')) {
      return candidate;
    }
  }
  std::string best;
  std::size_t least = std::max(word.size() / 3, std::min<std::size_t>(2, word.size() / 2)) + 1;
  for (const std::string& candidate : known) {
    const std::size_t changes = edit_distance(word, candidate);
    if (changes < least) {
      least = changes;
      best = candidate;
    }
  }
  return best;
}

}  // namespace crashrank::detail
