#include "catalogue.hpp"
#include "obj.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>

namespace {

using generate::Entry;

bool write(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::cout << text;
    return static_cast<bool>(std::cout.flush());
  }
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) std::cerr << path << ": cannot be written\n";
  return static_cast<bool>(file);
}

/// Puts the rows in place of those of the table in README.md.
bool write_rows(const std::string& path, const std::string& rows) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  std::string page = text.str();
  const std::size_t rule = page.find("\n|---");
  const std::size_t first = rule == std::string::npos ? rule : page.find('\n', rule + 1) + 1;
  const std::size_t end = first == std::string::npos ? first : page.find("\n\n", first);
  if (end == std::string::npos) {
    std::cerr << path << ": has no table\n";
    return false;
  }
  return write(path, page.replace(first, end + 1 - first, rows));
}

bool write_all(const std::string& folder) {
  nlohmann::ordered_json table;
  std::string rows;
  for (const Entry& entry : generate::catalogue()) {
    const generate::Model model = build_sized(entry, entry.triangles);
    std::cerr << entry.name << ": " << model.triangle_count() << " triangles\n";
    if (!write(folder + "/" + entry.name + ".obj", to_obj(model, about(entry)))) return false;
    table["models"].push_back(nlohmann::ordered_json::parse(to_json(entry, model)));
    rows += to_row(entry, model);
  }
  return write(folder + "/models.json", table.dump(2) + "\n") &&
         write_rows(folder + "/README.md", rows);
}

int run(int argc, char** argv) {
  CLI::App app("Makes the models that crashrank ships, at any resolution");
  std::string name;
  std::string output = "-";
  std::string folder;
  std::size_t triangles = 0;
  std::vector<std::string> names;
  for (const Entry& entry : generate::catalogue()) names.push_back(entry.name);
  app.add_option("model", name, "Model to make")->check(CLI::IsMember(names));
  app.add_option("--triangles", triangles, "How many triangles, about")
      ->check(CLI::Range(std::size_t{500}, std::size_t{4'000'000}));
  app.add_option("-o,--output", output, "OBJ file to write, - for standard output");
  app.add_option("--all", folder,
                 "Write every model, models.json and the table of README.md into this folder");
  CLI11_PARSE(app, argc, argv);
  if (!folder.empty()) return write_all(folder) ? 0 : 1;
  for (const Entry& entry : generate::catalogue()) {
    if (entry.name != name) continue;
    const auto model = build_sized(entry, triangles == 0 ? entry.triangles : triangles);
    std::cerr << entry.name << ": " << model.triangle_count() << " triangles\n";
    return write(output, to_obj(model, about(entry))) ? 0 : 1;
  }
  std::cerr << "name a model to make, or --all FOLDER; --help says more\n";
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "crashrank-generate: " << error.what() << '\n';
    return 1;
  }
}
