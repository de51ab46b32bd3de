#include "crashrank/scenario/harm_options.hpp"

#include "crashrank/internal/base/guarded.hpp"
#include "scenario/json_object.hpp"
#include "scenario/json_text.hpp"
#include "scenario/read_harm.hpp"
#include "scenario/text_file.hpp"

namespace crashrank {
namespace {

constexpr std::size_t name_characters = 128;
constexpr std::size_t text_characters = 4000;

Result<HarmOptions> parse(const std::string& text, const std::string& file,
                          const HarmOptions& otherwise) {
  if (text.size() > harm_limits::file_bytes) {
    return Error{ErrorCode::limit_exceeded, file, {}, "is larger than 1 MiB", "shorten it"};
  }
  Result<nlohmann::json> document = detail::parse_json(text);
  if (!document) return detail::error_in_file(file, document.error());
  detail::Refusals refusals;
  const detail::JsonObject root(
      *document, {}, refusals,
      {"$schema", "profile_version", "name", "description", "risk_model", "weights", "people",
       "pedestrian", "friction", "ranges", "after_contact", "after_impact", "least_struck_share"});
  root.require("profile_version");
  root.text("$schema", text_characters);
  if (root.has("profile_version") && root.at("profile_version") != 1) {
    root.refuse("profile_version", "is not a version this program reads", "it reads version 1");
  }
  root.name("name", name_characters);
  root.text("description", text_characters);
  HarmOptions harm = otherwise;
  if (refusals.ok()) detail::read_harm(root, harm);
  if (!refusals.ok()) return detail::error_in_file(file, refusals.errors().front());
  return harm;
}

}  // namespace

Result<HarmOptions> parse_profile(const std::string& text, const std::string& file,
                                  const HarmOptions& otherwise) {
  return detail::guarded([&] { return parse(text, file, otherwise); });
}

Result<HarmOptions> load_profile_file(const std::string& file, const HarmOptions& otherwise) {
  return detail::guarded([&]() -> Result<HarmOptions> {
    const Result<std::string> text =
        detail::read_text_file(file, harm_limits::file_bytes, "name a profile in JSON");
    if (!text) return text.error();
    return parse(*text, file, otherwise);
  });
}

}  // namespace crashrank
