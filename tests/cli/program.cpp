#include "cli/program.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace cli_test {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

Workplace::Workplace() {
  std::string name = (fs::temp_directory_path() / "crashrank-cli-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = name;
}

Workplace::~Workplace() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

Outcome Workplace::crashrank(const std::vector<std::string>& arguments,
                             const std::string& input) const {
  std::string line = quoted(CRASHRANK_PROGRAM);
  for (const std::string& argument : arguments) line.append(" ").append(quoted(argument));
  return shell(line, input);
}

Outcome Workplace::shell(const std::string& line, const std::string& input) const {
  const std::string streams = folder_ + ".streams";
  fs::create_directories(streams);
  std::ofstream(streams + "/in", std::ios::binary) << input;
  const std::string whole = fmt::format("cd {} && {{ {} ; }} <{}/in >{}/out 2>{}/err",
                                        quoted(folder_), line, streams, streams, streams);
  const int status = std::system(whole.c_str());
  Outcome run;
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  run.out = slurp(streams + "/out");
  run.err = slurp(streams + "/err");
  fs::remove_all(streams);
  return run;
}

void Workplace::write(const std::string& name, const std::string& content) const {
  std::ofstream(path(name), std::ios::binary) << content;
}

std::string Workplace::read(const std::string& name) const { return slurp(path(name)); }

std::vector<std::string> Workplace::list(const std::string& name) const {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(path(name))) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string box_obj(const std::string& name, double x0, double y0, double z0, double x1, double y1,
                    double z1) {
  std::string text = "o " + name + "\n";
  for (const double z : {z0, z1}) {
    text += fmt::format("v {} {} {}\nv {} {} {}\nv {} {} {}\nv {} {} {}\n", x0, y0, z, x1, y0, z,
                        x1, y1, z, x0, y1, z);
  }
  // Outward: bottom, top, then the four sides.
  return text +
         "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\n"
         "f 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";
}

void write_box_scenario(const Workplace& place) {
  place.write("ego.obj", box_obj("body", -1, -0.9, 0.2, 3, 0.9, 1.5));
  place.write("block.obj", box_obj("stone", 0, -1, 0, 1, 1, 1));
  place.write("scenario.json", R"({
  "scenario_version": 1,
  "name": "box ahead",
  "models": {
    "ego": {"mesh": "ego.obj", "kind": "car", "mass_kg": 1500},
    "block": {"mesh": "block.obj", "kind": "barrier"}
  },
  "ego": {"model": "ego", "speed_mps": 10},
  "candidates": {
    "listed": [
      {"name": "straight", "acceleration_mps2": 0},
      {"name": "brake", "acceleration_mps2": -7.5},
      {"name": "swerve", "acceleration_mps2": 0, "steering_deg": 12}
    ],
    "grid": false,
    "add_straight_braking": false
  },
  "actors": [{"name": "stone", "model": "block", "pose": {"x_m": 10}}],
  "horizon_s": 3,
  "grip": 0.95
})");
}

bool is_one_message(const std::string& text) {
  if (text.rfind("crashrank: ", 0) != 0 || text.empty() || text.back() != '\n') return false;
  return std::none_of(text.begin(), text.end() - 1,
                      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

}  // namespace cli_test
