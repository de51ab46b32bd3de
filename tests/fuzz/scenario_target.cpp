// Scenario files: whatever the text, parsing it either names the key that is wrong or gives a
// scenario within the stated limits, whose manoeuvres can be made.

#include "crashrank/rank/candidate.hpp"
#include "crashrank/rank/scenario.hpp"
#include "fuzz/target.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace fuzz {
namespace {

using namespace crashrank;

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
}

}  // namespace

std::vector<Bytes> seeds() {
  namespace fs = std::filesystem;
  std::vector<fs::path> files{fs::path(CRASHRANK_SOURCE_DIR) / "tests/rank/data/sample.json"};
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(CRASHRANK_SOURCE_DIR) / "data/scenarios")) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Bytes> made;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    made.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return made;
}

void mutate(Bytes& bytes, std::mt19937_64& random) {
  if (bytes.empty() || random() % 3 == 0) {
    mutate_bytes(bytes, random);
    return;
  }
  // A value, or a key, becomes another.
  constexpr const char* tokens[] = {"1e999", "-1e999", "-0",   "1e-320", "null",  "true",
                                    "[]",    "{}",     "\"\"", "[[[",    "}",     "\"\\ud800\"",
                                    "NaN",   "1e400",  "-1",   "361",    "1e308", "0.0000001"};
  const std::size_t at = below(random, bytes.size());
  const auto is_token = [](std::uint8_t c) {
    return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == 'e' || (c >= 'a' && c <= 'z');
  };
  std::size_t first = at;
  while (first < bytes.size() && !is_token(bytes[first])) ++first;
  std::size_t last = first;
  while (last < bytes.size() && is_token(bytes[last])) ++last;
  const std::string token = tokens[below(random, std::size(tokens))];
  bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(first),
              bytes.begin() + static_cast<std::ptrdiff_t>(last));
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(first), token.begin(), token.end());
}

bool take(const Bytes& bytes) {
  const Result<Scenario> scenario =
      parse_scenario(std::string(bytes.begin(), bytes.end()), "fuzz.json");
  if (!scenario) {
    const Error& error = scenario.error();
    require(error.code == ErrorCode::bad_input || error.code == ErrorCode::limit_exceeded,
            "an error of another kind");
    require(!error.reason.empty() && error.file == "fuzz.json", "an error says nothing");
    return false;
  }
  check(*scenario);
  return true;
}

}  // namespace fuzz
