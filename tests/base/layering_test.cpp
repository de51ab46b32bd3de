#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> stages{"base",     "interop",  "mesh",   "tree",    "model",
                                      "collide",  "dispatch", "motion", "vehicle", "crash",
                                      "scenario", "rank",     "report", "c"};

int level(const std::string& stage) {
  for (std::size_t i = 0; i < stages.size(); ++i) {
    if (stages[i] == stage) return static_cast<int>(i);
  }
  return -1;
}

// Data flows in this order: a stage may include itself and the stages to its left.
std::vector<std::string> violations(const fs::path& root) {
  static const std::regex include(
      R"re(^\s*#\s*include\s*[<"](?:crashrank/)?(?:internal/)?([a-z]+)/)re");
  std::vector<std::string> found;
  for (const std::string& stage : stages) {
    const fs::path folder = root / stage;
    if (!fs::exists(folder)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      const std::string suffix = entry.path().extension().string();
      if (suffix != ".hpp" && suffix != ".cpp" && suffix != ".h") continue;
      std::ifstream in(entry.path());
      std::string line;
      while (std::getline(in, line)) {
        std::smatch match;
        if (std::regex_search(line, match, include) && level(match[1]) > level(stage)) {
          found.push_back(entry.path().string() + ": " + line);
        }
      }
    }
  }
  return found;
}

TEST(Layering, NoStageKnowsALaterOne) {
  const fs::path source(CRASHRANK_SOURCE_DIR);
  for (const fs::path& root :
       {source / "include/crashrank", source / "include/crashrank/internal", source / "src"}) {
    ASSERT_TRUE(fs::exists(root / "base"));
    EXPECT_EQ(violations(root), std::vector<std::string>{});
  }
}

TEST(Layering, AnUpwardIncludeIsSeen) {
  const fs::path root = fs::path(testing::TempDir()) / "layering";
  fs::create_directories(root / "tree");
  std::ofstream(root / "tree/bad.hpp") << "#include \"crashrank/rank/rank.hpp\"\n";
  EXPECT_EQ(violations(root).size(), 1U);
  fs::remove_all(root);
}

// Public headers neither declare nor name what is internal: inline definitions that need it are in
// the internal headers that they include.
TEST(Layering, PublicHeadersNameNothingInternal) {
  static const std::regex names(R"re(\bdetail\b)re");
  const fs::path include = fs::path(CRASHRANK_SOURCE_DIR) / "include/crashrank";
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(include)) {
    const fs::path within = entry.path().lexically_relative(include);
    if (!entry.is_regular_file() || *within.begin() == "internal") continue;
    std::ifstream in(entry.path());
    std::string line;
    while (std::getline(in, line)) {
      if (std::regex_search(line, names)) found.push_back(within.string() + ": " + line);
    }
  }
  EXPECT_EQ(found, std::vector<std::string>{});
}

// Ranking within a budget is built on ranking, not the reverse.
TEST(Layering, RankIncludesNothingOfAnytime) {
  const fs::path root = fs::path(CRASHRANK_SOURCE_DIR) / "src/rank";
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path());
    std::string line;
    while (std::getline(in, line)) {
      if (line.find("#include") == 0 && line.find("/anytime/") != std::string::npos) {
        found.push_back(entry.path().filename().string() + ": " + line);
      }
    }
  }
  EXPECT_EQ(found, std::vector<std::string>{});
}

// Except those of the targets crashrank::study and crashrank::import.
TEST(Layering, TheUmbrellaHeaderIncludesEveryPublicHeader) {
  const fs::path include = fs::path(CRASHRANK_SOURCE_DIR) / "include";
  std::ifstream in(include / "crashrank/crashrank.hpp");
  const std::string umbrella{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::string> missing;
  for (const char* const stage :
       {"base", "interop", "mesh", "tree", "collide", "dispatch", "motion", "vehicle", "model",
        "crash", "scenario", "rank", "report"}) {
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(include / "crashrank" / stage)) {
      const std::string name = entry.path().lexically_relative(include).generic_string();
      const bool elsewhere = name.find("/study/") != std::string::npos ||
                             name == "crashrank/mesh/import.hpp" ||
                             name == "crashrank/scenario/scenario_models.hpp";
      if (!entry.is_regular_file() || elsewhere) continue;
      if (umbrella.find('"' + name + '"') == std::string::npos) missing.push_back(name);
    }
  }
  EXPECT_EQ(missing, std::vector<std::string>{});
}

// Who includes a public header needs Eigen, the language's library and the system's, nothing else.
std::vector<std::string> strangers(const fs::path& root) {
  static const std::regex include(R"re(^\s*#\s*include\s*<([^>]+/[^>]+|[^>]+\.h(?:pp)?)>)re");
  static const std::regex name(R"re(\b(?:Assimp|assimp|fmt|nlohmann|hwy)::)re");
  static const std::regex known(R"re(^(?:Eigen/.*|sys/.*|std(?:def|int)\.h)$)re");
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path());
    std::string line;
    while (std::getline(in, line)) {
      std::smatch match;
      const bool foreign =
          std::regex_search(line, match, include) && !std::regex_match(match[1].str(), known);
      if (foreign || std::regex_search(line, name)) {
        found.push_back(entry.path().string() + ": " + line);
      }
    }
  }
  return found;
}

TEST(Layering, PublicHeadersNameNoOtherLibraryButEigen) {
  EXPECT_EQ(strangers(fs::path(CRASHRANK_SOURCE_DIR) / "include"), std::vector<std::string>{});
}

TEST(Layering, AForeignIncludeIsSeen) {
  const fs::path root = fs::path(testing::TempDir()) / "strangers";
  fs::create_directories(root);
  std::ofstream(root / "bad.hpp") << "#include <nlohmann/json.hpp>\n#include <png.h>\n"
                                  << "std::string f(fmt::string_view);\n#include <vector>\n";
  EXPECT_EQ(strangers(root).size(), 3U);
  fs::remove_all(root);
}

}  // namespace
