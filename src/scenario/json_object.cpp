#include "scenario/json_object.hpp"

#include "base/nearest_word.hpp"
#include "base/utf8.hpp"
#include "crashrank/scenario/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string_view>

namespace crashrank::detail {
namespace {

std::size_t characters(const std::string& utf8) {
  return static_cast<std::size_t>(std::count_if(utf8.begin(), utf8.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// One printable line of a text that is not trusted, cut between characters.
std::string printable(std::string_view text, std::size_t most_bytes) {
  std::string shown;
  while (!text.empty()) {
    const CodePoint point = decode_utf8(text);
    const bool control = point.value < 0x20 || (point.value >= 0x7F && point.value < 0xA0);
    const std::string_view piece = point.valid && !control ? text.substr(0, point.bytes) : "?";
    if (shown.size() + piece.size() > most_bytes) return shown + "...";
    shown += piece;
    text.remove_prefix(point.bytes);
  }
  return shown;
}

}  // namespace

void refuse_at(Refusals& refusals, const std::string& path, const std::string& reason,
               const std::string& remedy, ErrorCode code) {
  refusals.add(Error{code, {}, path, reason, remedy});
}

Error error_in_file(const std::string& file, Error error) {
  error.file = file;
  for (std::string* const text : {&error.place, &error.reason, &error.remedy}) {
    *text = printable(*text, 4096);
  }
  return error;
}

double checked_number(const nlohmann::json& value, const std::string& path, NumberRange range,
                      Refusals& refusals, double otherwise) {
  if (!value.is_number()) {
    refuse_at(refusals, path, std::string("is ") + value.type_name() + ", not a number",
              give_one_in(range));
    return otherwise;
  }
  const double number = value.get<double>();
  if (!range.holds(number)) {
    refuse_at(refusals, path, out_of_range(number), give_one_in(range));
    return otherwise;
  }
  return number;
}

void check_name(const std::string& text, const std::string& path, std::size_t max_characters,
                Refusals& refusals) {
  if (text.empty()) refuse_at(refusals, path, "is empty", "give it a name");
  if (characters(text) > max_characters) {
    refuse_at(refusals, path, "is longer than " + std::to_string(max_characters) + " characters",
              "shorten it", ErrorCode::limit_exceeded);
  }
  const bool control = std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
  if (control) refuse_at(refusals, path, "holds a control character", "remove it");
}

JsonObject::JsonObject(const nlohmann::json& value, std::string path, Refusals& refusals,
                       std::initializer_list<const char*> known)
    : value_(&value), path_(std::move(path)), refusals_(&refusals) {
  if (!value.is_object()) {
    static const nlohmann::json empty = nlohmann::json::object();
    value_ = &empty;
    refuse_at(refusals, path_, std::string("is ") + value.type_name() + ", not an object",
              "write it as {...}");
    return;
  }
  for (const auto& item : value.items()) {
    const bool is_known = std::any_of(known.begin(), known.end(),
                                      [&item](const char* key) { return item.key() == key; });
    if (is_known) continue;
    std::string list;
    for (const char* key : known) list.append(list.empty() ? "" : ", ").append(key);
    const std::string meant = nearest_word(item.key(), {known.begin(), known.end()});
    std::string remedy = meant.empty() ? "the" : "did you mean '" + meant + "'? The";
    remedy.append(" keys here are ").append(list);
    refuse_at(refusals, path_of(printable(item.key(), 64).c_str()), "there is no such key", remedy);
  }
  text("note", scenario_limits::description_characters);
}

std::string JsonObject::path_of(const char* key) const {
  return path_.empty() ? key : path_ + "." + key;
}

void JsonObject::refuse(const char* key, const std::string& reason,
                        const std::string& remedy) const {
  refuse_at(*refusals_, path_of(key), reason, remedy);
}

const nlohmann::json* JsonObject::find(const char* key) const {
  const auto found = value_->find(key);
  return found == value_->end() ? nullptr : &*found;
}

bool JsonObject::has(const char* key) const { return find(key) != nullptr; }

void JsonObject::require(const char* key) const {
  if (!has(key)) refuse(key, "is missing", "add it");
}

std::string JsonObject::text(const char* key, std::size_t max_characters) const {
  const nlohmann::json* value = find(key);
  if (value == nullptr) return {};
  if (!value->is_string()) {
    refuse(key, std::string("is ") + value->type_name() + ", not text", "write it in quotes");
    return {};
  }
  std::string text = value->get<std::string>();
  if (characters(text) > max_characters) {
    refuse_at(*refusals_, path_of(key),
              "is longer than " + std::to_string(max_characters) + " characters", "shorten it",
              ErrorCode::limit_exceeded);
  }
  return text;
}

std::string JsonObject::name(const char* key, std::size_t max_characters) const {
  std::string name = text(key, max_characters);
  if (has(key)) check_name(name, path_of(key), max_characters, *refusals_);
  return name;
}

double JsonObject::number(const char* key, NumberRange range, double otherwise) const {
  const nlohmann::json* value = find(key);
  return value == nullptr ? otherwise
                          : checked_number(*value, path_of(key), range, *refusals_, otherwise);
}

std::optional<double> JsonObject::optional_number(const char* key, NumberRange range) const {
  if (!has(key)) return std::nullopt;
  return number(key, range, range.highest);
}

std::size_t JsonObject::count(const char* key, NumberRange range, std::size_t otherwise) const {
  const double number = this->number(key, range, static_cast<double>(otherwise));
  if (number != std::floor(number)) {
    refuse(key, "is " + number_text(number) + ", not a whole number", "round it");
    return otherwise;
  }
  return static_cast<std::size_t>(number);
}

bool JsonObject::flag(const char* key, bool otherwise) const {
  const nlohmann::json* value = find(key);
  if (value == nullptr) return otherwise;
  if (!value->is_boolean()) {
    refuse(key, std::string("is ") + value->type_name() + ", not true or false",
           "write true or false");
    return otherwise;
  }
  return value->get<bool>();
}

const nlohmann::json* JsonObject::array(const char* key, std::size_t lowest,
                                        std::size_t highest) const {
  const nlohmann::json* value = find(key);
  if (value == nullptr) return nullptr;
  if (!value->is_array()) {
    refuse(key, std::string("is ") + value->type_name() + ", not an array", "write it as [...]");
    return nullptr;
  }
  if (value->size() < lowest || value->size() > highest) {
    refuse_at(*refusals_, path_of(key), "has " + std::to_string(value->size()) + " elements",
              "give " + std::to_string(lowest) + " to " + std::to_string(highest),
              value->size() > highest ? ErrorCode::limit_exceeded : ErrorCode::bad_input);
    return nullptr;
  }
  return value;
}

}  // namespace crashrank::detail
