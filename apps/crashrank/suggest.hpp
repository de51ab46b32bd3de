#pragma once

#include <string>
#include <vector>

namespace crashrank::cli {

/// The known word that `word` was most likely meant to be, the first of equals; empty when none is
/// near: more than one change (a letter more, less, other, or two swapped) in three letters.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace crashrank::cli
