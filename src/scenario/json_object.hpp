#pragma once

#include "crashrank/base/result.hpp"
#include "scenario/number_range.hpp"
#include "scenario/refusals.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>

namespace crashrank::detail {

/// Reads one JSON object and refuses unknown keys. Errors go to the Refusals shared by a whole
/// document; after one, reads return what they were given as default, so that callers need to
/// look once, at the end.
class JsonObject {
public:
  /// Refuses a value that is no object and keys that are not in `known`; of those, "note" is text
  /// for people.
  JsonObject(const nlohmann::json& value, std::string path, Refusals& refusals,
             std::initializer_list<const char*> known);

  bool has(const char* key) const;
  /// Refuses with "KEY is missing" when it is.
  void require(const char* key) const;

  std::string text(const char* key, std::size_t max_characters) const;
  /// Text without control characters, at least one character.
  std::string name(const char* key, std::size_t max_characters) const;
  double number(const char* key, NumberRange range, double otherwise) const;
  std::optional<double> optional_number(const char* key, NumberRange range) const;
  /// A whole number.
  std::size_t count(const char* key, NumberRange range, std::size_t otherwise) const;
  bool flag(const char* key, bool otherwise) const;
  /// An array of at most that many elements; null when it is absent or wrong.
  const nlohmann::json* array(const char* key, std::size_t lowest, std::size_t highest) const;
  /// The value as it is; only for keys that are there.
  const nlohmann::json& at(const char* key) const { return (*value_)[key]; }

  std::string path_of(const char* key) const;
  const std::string& path() const { return path_; }
  Refusals& refusals() const { return *refusals_; }
  void refuse(const char* key, const std::string& reason, const std::string& remedy) const;

private:
  const nlohmann::json* find(const char* key) const;

  const nlohmann::json* value_;
  std::string path_;
  Refusals* refusals_;
};

/// The error as callers get it: with its file, and with nothing in its texts, some of which quote
/// the document, that a terminal or a log would obey.
Error error_in_file(const std::string& file, Error error);

/// Adds an error to those of a document.
void refuse_at(Refusals& refusals, const std::string& path, const std::string& reason,
               const std::string& remedy, ErrorCode code = ErrorCode::bad_input);

double checked_number(const nlohmann::json& value, const std::string& path, NumberRange range,
                      Refusals& refusals, double otherwise);

/// Whether text is a name: not empty, at most that many characters, no control characters.
void check_name(const std::string& text, const std::string& path, std::size_t max_characters,
                Refusals& refusals);

}  // namespace crashrank::detail
