#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace cli_test {

using Json = nlohmann::ordered_json;

/// What a run of the program left.
struct Outcome {
  int code = -1;
  std::string out;
  std::string err;

  Json json() const { return Json::parse(out); }
};

/// A folder of its own for a test, gone with it; programs run inside.
class Workplace {
public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  /// Runs the program under test.
  Outcome crashrank(const std::vector<std::string>& arguments, const std::string& input = {}) const;
  /// Runs a line of shell.
  Outcome shell(const std::string& line, const std::string& input = {}) const;

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  void write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;
  std::vector<std::string> list(const std::string& name) const;

private:
  std::string folder_;
};

/// OBJ text of an axis-aligned box with 12 triangles, one object of this name.
std::string box_obj(const std::string& name, double x0, double y0, double z0, double x1, double y1,
                    double z1);

/// Writes scenario.json, ego.obj and block.obj: at 10 m/s the ego drives towards a stone whose face
/// is 7 m before its own. Candidates "straight", "brake" (stops before it) and "swerve".
void write_box_scenario(const Workplace& place);

/// True for exactly one line that begins with "crashrank: " and has no control character.
bool is_one_message(const std::string& text);

}  // namespace cli_test
