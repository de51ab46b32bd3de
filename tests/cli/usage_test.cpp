#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace {

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
  EXPECT_NE(refused.err.find("or allow the mesh's folder with --allow FOLDER\n"), std::string::npos)
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
}

TEST(Usage, HowOftenAnOptionOrItsValueIsThereIsToldInPlainWords) {
  const Workplace place;
  place.write("a.obj", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  for (const auto& [arguments, told] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, "no command is given; choose inspect, compile, collide, rank, sweep, validate"},
           {{"rank", "s.json", "--deadline-ms"}, "--deadline-ms needs a value"},
           {{"rank", "s.json", "--top", "3", "--top", "4"}, "--top is given more than once"},
           {{"rank", "s.json", "--first-place=3"}, "--first-place takes no value"},
           {{"collide", "a.obj", "a.obj", "--any=5"}, "--any takes no value"},
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
