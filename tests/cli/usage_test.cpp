#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

using cli_test::Outcome;
using cli_test::Workplace;

TEST(Usage, HelpAndVersionAreData) {
  const Workplace place;
  const Outcome version = place.crashrank({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out, "crashrank " CRASHRANK_VERSION "\n");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--help"},
                                             {"inspect", "--help"},
                                             {"collide", "--help"},
                                             {"rank", "--help"},
                                             {"sweep", "--help"}}) {
    const Outcome help = place.crashrank(arguments);
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_NE(help.out.find("Example"), std::string::npos) << help.out;
  }
}

TEST(Usage, HelpIsACommandToo) {
  const Workplace place;
  EXPECT_EQ(place.crashrank({"help"}).out, place.crashrank({"--help"}).out);
  for (const std::string command : {"inspect", "compile", "collide", "rank", "view", "new", "check",
                                    "sweep", "validate", "completion"}) {
    const Outcome help = place.crashrank({"help", command});
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.out, place.crashrank({command, "--help"}).out);
  }
  const Outcome wrong = place.crashrank({"help", "rnak"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.err.find("there is no command 'rnak'"), std::string::npos) << wrong.err;
  EXPECT_NE(wrong.err.find("did you mean 'rank'?"), std::string::npos) << wrong.err;
}

TEST(Usage, ImportNamesThePackageThatHasTheReaders) {
  const Workplace place;
  const Outcome readers = place.crashrank({"import", "commonroad", "scene.xml"});
  EXPECT_EQ(readers.code, 2);
  EXPECT_NE(readers.err.find("pip install '.[formats]'"), std::string::npos) << readers.err;
  EXPECT_NE(readers.err.find("python -m crashrank import"), std::string::npos) << readers.err;
}

TEST(Usage, BenchmarkNamesThePackage) {
  const Workplace place;
  const Outcome benchmark = place.crashrank({"benchmark", "--scenes", "3"});
  EXPECT_EQ(benchmark.code, 2);
  EXPECT_NE(benchmark.err.find("python -m crashrank benchmark"), std::string::npos)
      << benchmark.err;
}

TEST(Usage, HelpShowsRangesDefaultsAndKnownWords) {
  const Workplace place;
  const std::string sweep = place.crashrank({"sweep", "--help"}).out;
  const std::string rank = place.crashrank({"rank", "--help"}).out;
  for (const auto& [help, words] : std::vector<std::pair<std::string, std::string>>{
           {sweep, "[1 to 65536, default 8]"},
           {sweep, "[1 to 64, default 4]"},
           {sweep, "--store private|shared"},
           {sweep, "[default private]"},
           {rank, "[0 to 1000000, default 20]"},
           {rank, "--measure harm|delta-v|energy|intrusion|polygons|area|closing-energy"},
           {rank, "--damage FOLDER"}}) {
    EXPECT_NE(help.find(words), std::string::npos) << words << '\n' << help;
  }
}

TEST(Usage, CompletionKnowsCommandsOptionsAndTheirWords) {
  const Workplace place;
  const std::string script = place.crashrank({"completion", "bash"}).out;
  place.write("complete.bash", script);
  const auto completed = [&](const std::string& line) {
    const Outcome run = place.shell(
        "bash -c 'source complete.bash && COMP_WORDS=(" + line +
        ") && COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) && _crashrank && echo \"${COMPREPLY[*]}\"'");
    EXPECT_EQ(run.err, "");
    return run.out;
  };
  EXPECT_EQ(completed("crashrank in"), "inspect\n");
  EXPECT_EQ(completed("crashrank rank --mea"), "--measure\n");
  EXPECT_EQ(completed("crashrank rank --measure de"), "delta-v\n");
  EXPECT_EQ(completed("crashrank rank --top 1"), "\n");
  EXPECT_EQ(completed("crashrank inspect comp"), "complete.bash\n");
  EXPECT_EQ(completed("crashrank help va"), "validate\n");
  EXPECT_EQ(completed("crashrank completion z"), "zsh\n");
  // Every option that a command's help shows is in both scripts.
  const std::string zsh = place.crashrank({"completion", "zsh"}).out;
  EXPECT_EQ(zsh.rfind("#compdef crashrank\n", 0), 0U);
  for (const char* command :
       {"inspect", "compile", "collide", "rank", "view", "new", "check", "sweep", "validate"}) {
    std::istringstream help(place.crashrank({command, "--help"}).out);
    for (std::string line; std::getline(help, line);) {
      const std::size_t at = line.find("--");
      if (line.rfind("  -", 0) != 0 || at > 6) continue;
      const std::string option = line.substr(at, line.find_first_of(" ,", at) - at);
      EXPECT_NE(script.find(option), std::string::npos) << option;
      EXPECT_NE(zsh.find("'" + option + "["), std::string::npos) << option;
    }
  }
  EXPECT_EQ(place.crashrank({"completion", "fish"}).code, 2);
}

TEST(Usage, AScenarioIsNoProfileAndAProfileNoScenario) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  place.write("profile.json", R"({"profile_version": 1, "friction": 0.4})");
  const Outcome scenario = place.crashrank({"rank", "scenario.json", "--profile", "scenario.json"});
  EXPECT_EQ(scenario.code, 3);
  EXPECT_NE(scenario.err.find("scenario.json: is a scenario, not a profile; name it without"),
            std::string::npos)
      << scenario.err;
  const Outcome profile = place.crashrank({"rank", "profile.json"});
  EXPECT_EQ(profile.code, 3);
  EXPECT_NE(profile.err.find("profile.json: is a profile, not a scenario; name a scenario"),
            std::string::npos)
      << profile.err;
}

TEST(Usage, ErrorsOfMeshesNameTheScenarioAndItsKey) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  fs::remove(place.path("block.obj"));
  const Outcome missing = place.crashrank({"rank", "scenario.json"});
  EXPECT_EQ(missing.code, 3);
  EXPECT_NE(missing.err.find("block.obj: cannot open it: No such file or directory (it is "
                             "models.block.mesh of scenario.json); check the path"),
            std::string::npos)
      << missing.err;
  cli_test::write_box_scenario(place);
  place.write("ego.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  for (const std::vector<std::string>& budget :
       std::vector<std::vector<std::string>>{{}, {"--first-place"}}) {
    std::vector<std::string> arguments{"rank", "scenario.json"};
    arguments.insert(arguments.end(), budget.begin(), budget.end());
    const Outcome flat = place.crashrank(arguments);
    EXPECT_EQ(flat.code, 3);
    EXPECT_EQ(flat.err.rfind("crashrank: scenario.json: models.ego.mesh: ", 0), 0U) << flat.err;
    EXPECT_NE(flat.err.find("ego.obj has no material between 0.1 and 4 m over its ground"),
              std::string::npos)
        << flat.err;
  }
}

TEST(Usage, AWrongCommandIsNamedBesideTheRightOnes) {
  const Workplace place;
  const Outcome run = place.crashrank({"rnak", "scenario.json"});
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("no command 'rnak'"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("rank"), std::string::npos) << run.err;
}

TEST(Usage, WhatWasMeantIsSaid) {
  const Workplace place;
  place.write("a.obj", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  for (const auto& [arguments, meant] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"rnak", "s.json"}, "did you mean 'rank'?"},
           {{"colide", "a.obj", "a.obj"}, "did you mean 'collide'?"},
           {{"compile", "a.obj", "-o", "a.crm", "--mass", "3"}, "did you mean '--mass-kg'?"},
           {{"inspect", "a.obj", "--jsno"}, "did you mean '--json'?"},
           {{"inspect", "a.obj", "--scael=2"}, "did you mean '--scale'?"},
           {{"rank", "s.json", "--mesure", "area"}, "did you mean '--measure'?"}}) {
    const Outcome run = place.crashrank(arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find(meant), std::string::npos) << run.err;
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
  }
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"fly"}, {"inspect", "a.obj", "--elephant"}, {std::string(100'000, 'r')}}) {
    const Outcome run = place.crashrank(arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_EQ(run.err.find("did you mean"), std::string::npos) << run.err;
  }
}

TEST(Usage, AMisspeltKeyIsSaidToBeTheNearestOneThatIsThere) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const std::string good = place.read("scenario.json");
  const auto error_with = [&](const std::string& key, const std::string& wrong) {
    std::string text = good;
    text.replace(text.find("\"" + key + "\""), key.size() + 2, "\"" + wrong + "\"");
    place.write("s.json", text);
    const Outcome run = place.crashrank({"rank", "s.json"});
    EXPECT_EQ(run.code, 3);
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    EXPECT_NE(run.err.find(wrong + ": there is no such key; "), std::string::npos) << run.err;
    return run.err;
  };
  for (const auto& [key, wrong, meant] :
       std::vector<std::tuple<std::string, std::string, std::string>>{
           {"mass_kg", "mass", "mass_kg"},
           {"mass_kg", "mass_lb", "mass_kg"},
           {"horizon_s", "horizont_s", "horizon_s"},
           {"speed_mps", "speed_kmh", "speed_mps"},
           {"speed_mps", "speed", "speed_mps"},
           {"kind", "knid", "kind"},
           {"actors", "Actor", "actors"},
           {"grip", "girp", "grip"},
           {"steering_deg", "stering_deg", "steering_deg"}}) {
    const std::string error = error_with(key, wrong);
    EXPECT_NE(error.find("did you mean '" + meant + "'? The keys here are "), std::string::npos)
        << error;
  }
  for (const std::string wrong : {"weather", "x", "zz"}) {
    const std::string error = error_with("grip", wrong);
    EXPECT_NE(error.find("there is no such key; the keys here are $schema"), std::string::npos)
        << error;
  }
}

TEST(Usage, AMeshOutsideTheScenariosFolderIsAllowedByTheOptionThatTheErrorNames) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  place.shell(
      "mkdir inner && sed 's#ego.obj#../ego.obj#' scenario.json > inner/s.json && "
      "cp block.obj inner/");
  const Outcome refused = place.crashrank({"rank", "inner/s.json"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("inner/s.json: models.ego.mesh: "), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("or allow its folder with --allow FOLDER\n"), std::string::npos)
      << refused.err;
  const Outcome piped = place.shell("cd inner && " CRASHRANK_PROGRAM " rank - < s.json");
  EXPECT_NE(piped.err.find("--allow FOLDER"), std::string::npos) << piped.err;
  EXPECT_EQ(place.crashrank({"rank", "inner/s.json", "--allow", "."}).code, 0);
}

TEST(Usage, WhatIsNotExpectedIsToldInItsOrder) {
  const Workplace place;
  const Outcome run = place.crashrank({"rank", "s.json", "--elephant", "grey"});
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("not expected: '--elephant' 'grey'"), std::string::npos) << run.err;
  const Outcome dash = place.crashrank({"rank", "s.json", "-top", "3"});
  EXPECT_EQ(dash.code, 2);
  EXPECT_NE(dash.err.find("not expected: '-top' '3'; write --top"), std::string::npos) << dash.err;
}

TEST(Usage, HowOftenAnOptionOrItsValueIsThereIsToldInPlainWords) {
  const Workplace place;
  place.write("a.obj", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  for (const auto& [arguments, told] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{},
            "no command is given; choose inspect, compile, collide, rank, view, new, check, "
            "sweep, validate"},
           {{"rank", "s.json", "--deadline-ms"}, "--deadline-ms needs a value"},
           {{"rank", "s.json", "--top", "3", "--top", "4"}, "--top is given more than once"},
           {{"rank", "s.json", "--first-place=3"}, "--first-place takes no value"},
           {{"collide", "a.obj", "a.obj", "--any=5"}, "--any takes no value"},
           {{"--verson"},
            "there is no option '--verson' before a command; did you mean '--version'?"},
           {{"rank", "s.json", "--deadline-ms", "abc"},
            "--deadline-ms: 'abc' is not a number: give milliseconds from 0 to"},
           {{"rank", "s.json", "--deadline-ms", "-1"}, "-1 is out of range: give milliseconds"},
           {{"rank", "s.json", "--workers", "99"},
            "--workers: 99 is out of range: give a whole number from 1 to 64"},
           {{"inspect", "a.obj", "--scale", "2m"},
            "'2m' is not a number: give metres per file unit"},
           {{"rank", "s.json", "--measure", "arae"}, "did you mean 'area'?"},
           {{"rank", "s.json", "--allow", "nix"}, "'nix' is no folder"},
           {{"inspect", "a.obj", "--origin", "1e300,0,0"}, "lies farther than 1e7 m"}}) {
    const Outcome run = place.crashrank(arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find(told), std::string::npos) << run.err;
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
  }
}

TEST(Usage, ACountIsAWholeNumber) {
  const Workplace place;
  for (const std::string wrong : {"-4", "1.5", "1e3", "many", "99999999999999999999"}) {
    const Outcome run = place.crashrank({"rank", "s.json", "--work-budget", wrong});
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find("'" + wrong + "' is no count"), std::string::npos) << run.err;
  }
}

TEST(Usage, HelpShowsTheCommandOnce) {
  const Workplace place;
  const Outcome help = place.crashrank({"inspect", "--help"});
  EXPECT_NE(help.out.find("Usage: crashrank inspect [OPTIONS]"), std::string::npos) << help.out;
}

TEST(Usage, EveryMistakeIsExitTwoAndOneLine) {
  const Workplace place;
  place.write("a.obj", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {},
           {"fly"},
           {"rank", "s.json", "--damage", ""},
           {"rank", "s.json", "--damage", "-"},
           {"rank", "s.json", "--top", "-1"},
           {"rank", "s.json", "--allow", "no-such-folder"},
           {"inspect"},
           {"inspect", "a.obj", "--nonsense"},
           {"inspect", "a.obj", "--scale", "0"},
           {"inspect", "a.obj", "--scale", "-1"},
           {"inspect", "a.obj", "--scale", "nan"},
           {"inspect", "a.obj", "--scale", "big"},
           {"inspect", "a.obj", "--up", "sideways"},
           {"inspect", "a.obj", "--up", "+x"},
           {"inspect", "a.obj", "--origin", "1,2"},
           {"inspect", "a.obj", "--origin", "1,2,inf"},
           {"inspect", "a.obj", "--origin", "1e999,2,3"},
           {"inspect", "-", "-", "--format", "obj"},
           {"rank", "s.json", "--json", "--report", "-"},
           {"inspect", "-"},
           {"collide", "a.obj"},
           {"collide", "a.obj", "a.obj", "--pose", "1,2,3"},
           {"collide", "a.obj", "a.obj", "--pose", "1,2,3,4,5,six"},
           {"collide", "a.obj", "a.obj", "--pose", "nan,0,0,0,0,0"},
           {"collide", "a.obj", "a.obj", "--pose", "1e999,0,0,0,0,0"},
           {"collide", "a.obj", "a.obj", "--repeat", "0"},
           {"collide", "a.obj", "a.obj", "--split", "guess"},
           {"collide", "a.obj", "a.obj", "--frame", "moving"},
           {"collide", "a.obj", "a.obj", "--up-b", "sideways"},
           {"collide", "a.obj", "a.obj", "--up-b", "+x"},
           {"collide", "a.obj", "a.obj", "--scale-b", "0"},
           {"collide", "a.obj", "a.obj", "--kernel", "quick"},
           {"collide", "a.obj", "a.obj", "--workers", "0"},
           {"collide", "a.obj", "a.obj", "--workers", "2", "--policy", "best"},
           {"collide", "a.obj", "a.obj", "--workers", "2", "--depth", "17"},
           {"collide", "a.obj", "a.obj", "--json", "--pairs", "-"},
           {"collide", "-", "a.obj", "--poses", "-", "--format", "obj"},
           {"rank"},
           {"rank", "s.json", "--measure", "beauty"},
           {"rank", "s.json", "--workers", "0"},
           {"rank", "s.json", "--workers", "65"},
           {"rank", "s.json", "--workers", "2", "--policy", "best"},
           {"rank", "s.json", "--workers", "2", "--depth", "0"},
           {"rank", "s.json", "--workers", "2", "--depth", "deep"},
           {"rank", "s.json", "--profile", ""},
           {"rank", "s.json", "--measure="},
           {"compile", "a.obj", "-o", ""},
           {"compile", "a.obj", "-o", ".", "--force"},
           {"compile", "a.obj", "-o", "a.crm", "--mass-kg", ""},
           {"collide", "a.obj", "a.obj", "--pairs", "a.obj"},
           {"collide", "a.obj", "a.obj", "--pairs", "./a.obj"},
           {"inspect", "a.obj", "--scale", "1e300"},
           {"sweep", "a.obj", "a.obj"},
           {"sweep", "a.obj", "--poses", "p.txt"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--depths", "0:4"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--depths", "4:3"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--depths", "1:17"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--depths", "1:2:3"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--depths", ""},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--policies", "best"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--policies", "random,"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--workers", "0"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--workers", "65"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--buffer", "0"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--memory", "-1"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--memory", "lots"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--store", "cloud"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--kernel", "quick"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--kernel", "fast", "--store",
            "private"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--json", "--csv"},
           {"sweep", "a.obj", "a.obj", "--poses", "p.txt", "--plot", "-"},
           {"validate", "rows.csv", "--plot", "-"},
           {"inspect", "a.obj", "--profile", "-"},
           {"inspect", "a.obj", "a.obj", "--profile", "p.svg"},
           {"sweep", "-", "a.obj", "--poses", "-", "--format", "obj"},
       }) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const Outcome run = place.crashrank(arguments);
    EXPECT_EQ(run.code, 2) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
  }
}

TEST(Usage, LostOutputIsNotSuccess) {
  const Workplace place;
  place.write("a.obj", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  const std::string program = CRASHRANK_PROGRAM;
  const Outcome run = place.shell("'" + program + "' inspect a.obj >/dev/full");
  EXPECT_EQ(run.code, 1);
  EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
  const Outcome pairs = place.crashrank({"collide", "a.obj", "a.obj", "--pairs", "/dev/full"});
  EXPECT_EQ(pairs.code, 1);
  EXPECT_NE(pairs.err.find("/dev/full"), std::string::npos) << pairs.err;
}

}  // namespace
