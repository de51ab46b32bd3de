// Scenario files: whatever the text, parsing it either names the key that is wrong or gives a
// scenario within the stated limits, whose manoeuvres can be made.

#include "base/utf8.hpp"
#include "crashrank/scenario/candidate.hpp"
#include "crashrank/scenario/scenario.hpp"
#include "fuzz/target.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace fuzz {
namespace {

using namespace crashrank;
namespace fs = std::filesystem;

/// UTF-8 without control characters.
bool plain(std::string_view text) {
  while (!text.empty()) {
    const detail::CodePoint point = detail::decode_utf8(text);
    if (!point.valid || point.value < 0x20) return false;
    if (point.value >= 0x7F && point.value < 0xA0) return false;
    text.remove_prefix(point.bytes);
  }
  return true;
}

bool within(double value, double limit) { return std::isfinite(value) && std::abs(value) <= limit; }

void check(const Scenario& scenario) {
  namespace limits = scenario_limits;
  require(!scenario.models.empty() && scenario.models.size() <= limits::models, "models");
  require(scenario.ego.model < scenario.models.size(), "the ego's model");
  require(scenario.actors.size() <= limits::actors, "actors");
  require(scenario.listed.size() <= limits::listed_candidates, "candidates");
  require(scenario.horizon_s > 0.0 && within(scenario.horizon_s, limits::horizon_s), "horizon");
  require(within(scenario.ego.speed_mps, limits::speed_mps), "the ego's speed");
  require(within(scenario.grip, limits::max_grip), "grip");
  for (const ScenarioActor& actor : scenario.actors) {
    require(actor.model < scenario.models.size(), "an actor's model");
    require(within(actor.speed_mps, limits::speed_mps), "an actor's speed");
    require(actor.pose.translation.cwiseAbs().maxCoeff() <= limits::position_m, "a place");
    require(actor.poses.size() <= limits::poses, "poses");
  }
  for (const ScenarioModel& model : scenario.models) {
    require(model.transform.scale > 0.0, "a scale");
    require(!model.mass_kg || within(*model.mass_kg, limits::max_mass_kg), "a mass");
    require(model.path.empty(), "parsing does not look for files");
  }
  // The motions are few enough to be made every time; what is refused of them says why.
  for (const ScenarioActor& actor : scenario.actors) {
    const Result<Motion> motion = make_motion(actor);
    require(motion.ok() || !motion.error().reason.empty(), "a motion's error says nothing");
  }
  if (scenario.grid && scenario.grid->accelerations * scenario.grid->steerings > 40) return;
  const Result<std::vector<Candidate>> candidates = make_candidates(scenario, 4.5);
  require(candidates.ok() || !candidates.error().reason.empty(), "an error says nothing");
  if (!candidates) return;
  for (const Candidate& candidate : *candidates) {
    const Pose end = candidate.motion.pose_at(scenario.horizon_s);
    require(rigidity_error(end) <= max_rigidity_error, "a manoeuvre ends at no pose");
  }
}

fs::path source(const char* file) { return fs::path(CRASHRANK_SOURCE_DIR) / file; }

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Without the space between tokens: what a mutation hits there, tells nothing.
Bytes dense(const std::string& json) {
  Bytes made;
  bool quoted = false;
  for (const char c : json) {
    if (c == '"') quoted = !quoted;
    if (quoted || (c != ' ' && c != '\n')) made.push_back(static_cast<std::uint8_t>(c));
  }
  return made;
}

/// Every word of the format, quoted: keys, and what is chosen among.
std::vector<std::string> words_of_the_schema() {
  const std::string schema = contents(source("data/scenario.schema.json"));
  std::vector<std::string> words;
  for (std::size_t at = schema.find('"'); at != std::string::npos;) {
    const std::size_t end = schema.find('"', at + 1);
    if (end == std::string::npos) break;
    std::string word = schema.substr(at, end + 1 - at);
    if (word.size() < 40 && word.find(' ') == std::string::npos) words.push_back(std::move(word));
    at = schema.find('"', end + 1);
  }
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

struct Span {
  std::size_t first = 0;
  std::size_t last = 0;
};

std::size_t next(const Bytes& bytes, std::size_t at, const char* among) {
  const std::string wanted = among;
  while (at < bytes.size() && wanted.find(static_cast<char>(bytes[at])) == std::string::npos) ++at;
  return at;
}

/// From there to the end of the value, or of the key and the value, that begins there.
Span value_from(const Bytes& bytes, std::size_t first) {
  int depth = 0;
  bool quoted = false;
  std::size_t at = first;
  for (; at < bytes.size(); ++at) {
    const auto c = static_cast<char>(bytes[at]);
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (depth == 0 && (c == ',' || c == '}' || c == ']')) break;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
  }
  return {first, at};
}

Bytes part(const Bytes& bytes, Span span) {
  return {bytes.begin() + static_cast<std::ptrdiff_t>(span.first),
          bytes.begin() + static_cast<std::ptrdiff_t>(span.last)};
}

void replace(Bytes& bytes, Span span, const Bytes& with) {
  const auto first = bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(span.first),
                                 bytes.begin() + static_cast<std::ptrdiff_t>(span.last));
  bytes.insert(first, with.begin(), with.end());
}

const std::string& any_word(std::mt19937_64& random) {
  static const std::vector<std::string> words = words_of_the_schema();
  return words[below(random, words.size())];
}

std::string any_value(std::mt19937_64& random) {
  constexpr const char* telling[] = {
      "1e999", "-1e999", "-0",  "1e-320", "null", "true",        "false", "[]",        "{}",
      "\"\"",  "[[[",    "}",   "NaN",    "-1",   "0",           "1",     "2",         "3",
      "0.5",   "15",     "101", "102",    "361",  "1e308",       "-360",  "0.0000001", "[0,0,0]",
      "[0,1]", "10",     "60",  "80",     "720",  "\"\\ud800\"", "1e400"};
  if (random() % 4 == 0) return any_word(random);
  return telling[below(random, std::size(telling))];
}

Bytes bytes_of(const std::string& text) { return Bytes(text.begin(), text.end()); }

}  // namespace

std::vector<Bytes> seeds() {
  std::vector<fs::path> files{source("tests/scenario/data/sample.json")};
  for (const fs::directory_entry& entry : fs::directory_iterator(source("data/scenarios"))) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Bytes> made;
  for (const fs::path& file : files) made.push_back(dense(contents(file)));
  made.push_back(bytes_of(R"({"scenario_version":1,"models":{"a":{"box":[4,2,1],"kind":"car"}},)"
                          R"("ego":{"model":"a","speed_mps":9}})"));
  return made;
}

void mutate(Bytes& bytes, std::mt19937_64& random) {
  const std::size_t at = below(random, bytes.size());
  const std::size_t colon = next(bytes, at, ":");
  const std::size_t opening = next(bytes, at, "{,");
  switch (bytes.empty() ? 0 : random() % 6) {
    case 0:
      mutate_bytes(bytes, random);
      break;
    case 1:  // a value becomes another
      if (colon == bytes.size()) break;
      replace(bytes, value_from(bytes, colon + 1), bytes_of(any_value(random)));
      break;
    case 2: {  // a value becomes that of another key
      const std::size_t other = next(bytes, below(random, bytes.size()), ":");
      if (colon == bytes.size() || other == bytes.size()) break;
      const Bytes copied = part(bytes, value_from(bytes, other + 1));
      replace(bytes, value_from(bytes, colon + 1), copied);
      break;
    }
    case 3: {  // a key is put in, or an element
      if (opening == bytes.size()) break;
      const std::string key = random() % 8 == 0 ? "" : any_word(random) + ":";
      replace(bytes, {opening + 1, opening + 1}, bytes_of(key + any_value(random) + ","));
      break;
    }
    case 4: {  // a key and its value, or an element, is taken out, or is there twice
      if (opening == bytes.size()) break;
      Span span = value_from(bytes, opening + 1);
      if (span.last < bytes.size() && bytes[span.last] == ',') ++span.last;
      if (random() % 2 == 0) {
        replace(bytes, span, {});
      } else {
        replace(bytes, {span.first, span.first}, part(bytes, span));
      }
      break;
    }
    default: {  // a key becomes another
      const std::size_t first = next(bytes, at, "\"");
      if (first == bytes.size()) break;
      const std::size_t last = next(bytes, first + 1, "\"");
      replace(bytes, {first, std::min(last + 1, bytes.size())}, bytes_of(any_word(random)));
      break;
    }
  }
}

bool take(const Bytes& bytes) {
  const std::string text(bytes.begin(), bytes.end());
  const Result<Scenario> scenario = parse_scenario(text, "fuzz.json");
  if (!scenario) {
    const std::vector<Error> all = check_scenario(text, "fuzz.json").errors;
    require(!all.empty() && all.size() <= 100, "a check finds less than the parser");
    for (const Error& each : all) require(plain(each.message()), "an error is not plain");
    const Error& error = scenario.error();
    require(error.code == ErrorCode::bad_input || error.code == ErrorCode::limit_exceeded,
            "an error of another kind");
    require(!error.reason.empty() && error.file == "fuzz.json", "an error says nothing");
    require(plain(error.message()), "an error has characters that a terminal obeys");
    return false;
  }
  check(*scenario);
  return true;
}

}  // namespace fuzz
