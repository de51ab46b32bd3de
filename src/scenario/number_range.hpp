#pragma once

#include <cstdio>
#include <string>

namespace crashrank::detail {

/// A closed range of numbers; `above` excludes the lower end.
struct NumberRange {
  double lowest;
  double highest;
  bool above = false;

  /// False for what is no number.
  bool holds(double number) const {
    return (above ? number > lowest : number >= lowest) && number <= highest;
  }
};

/// A number as short text with nine digits.
inline std::string number_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", number);
  return text;
}

/// What is wrong with a number outside, and what to do about it.
inline std::string out_of_range(double number) {
  return "is " + number_text(number) + ", out of range";
}
inline std::string give_one_in(NumberRange range) {
  return std::string("give a number ") + (range.above ? "more than " : "from ") +
         number_text(range.lowest) + (range.above ? ", at most " : " to ") +
         number_text(range.highest);
}

}  // namespace crashrank::detail
