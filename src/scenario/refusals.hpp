#pragma once

#include "crashrank/base/result.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace crashrank::detail {

/// Errors found in a document: the first one, or all of them up to `most`. Of a key that was
/// refused, neither the keys that it holds nor those that hold it are refused again: such errors
/// follow from the first.
class Refusals {
public:
  static constexpr std::size_t most = 100;

  /// `all`: reading goes on after an error.
  explicit Refusals(bool all = false) : most_(all ? most : 1) {}

  bool ok() const { return errors_.empty(); }
  /// False where reading may end: another error would not be kept.
  bool goes_on() const { return errors_.size() < most_; }

  void add(Error error) {
    if (!goes_on()) return;
    const bool follows = std::any_of(errors_.begin(), errors_.end(), [&](const Error& known) {
      return holds(known.place, error.place) || holds(error.place, known.place);
    });
    if (!follows) errors_.push_back(std::move(error));
  }

  const std::vector<Error>& errors() const { return errors_; }
  std::vector<Error>& errors() { return errors_; }
  /// The first error.
  Status status() const {
    if (ok()) return Success{};
    return errors_.front();
  }

private:
  static bool holds(const std::string& key, const std::string& below) {
    if (below.compare(0, key.size(), key) != 0) return false;
    return key.empty() || below.size() == key.size() || below[key.size()] == '.' ||
           below[key.size()] == '[';
  }

  std::size_t most_;
  std::vector<Error> errors_;
};

}  // namespace crashrank::detail
