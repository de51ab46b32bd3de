#include "program.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace {

using cli_test::box_obj;
using cli_test::is_one_message;
using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

TEST(New, WhatItWritesIsRankedAndHasNotes) {
  const Workplace place;
  place.write("car.obj", box_obj("car", -1, -0.9, 0, 3.5, 0.9, 1.5));
  const Outcome made =
      place.crashrank({"new", "--ego", "car.obj@0,0,0,20", "--actor", "car.obj@30,1,180,10",
                       "--actor", "truck:9,2.5,3.5@40,-3,90", "-o", "first.json"});
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.out, "");
  EXPECT_NE(made.err.find("car.obj: probably a car of 4.5 x 1.8 x 1.5 m"), std::string::npos)
      << made.err;
  const Json scenario = Json::parse(place.read("first.json"));
  EXPECT_EQ(scenario["models"].size(), 2U);
  EXPECT_EQ(scenario["models"]["truck"]["box"], Json({9.0, 2.5, 3.5}));
  EXPECT_EQ(scenario["ego"]["speed_mps"], 20.0);
  EXPECT_EQ(scenario["actors"][1]["pose"], Json({{"x_m", 40.0}, {"y_m", -3.0}, {"yaw_deg", 90.0}}));
  for (const char* key : {"ego", "candidates"}) EXPECT_TRUE(scenario[key].contains("note"));
  const Outcome checked = place.crashrank({"check", "first.json"});
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_NE(checked.err.find("models.truck is a truck of 9 x 2.5 x 3.5 m"), std::string::npos);
}

TEST(New, AxesScaleAndOriginAreGuessed) {
  const Workplace place;
  // In millimetres, along y, its origin in the middle above the ground.
  place.write("van.obj", box_obj("van", -900, -2400, -800, 900, 2400, 800));
  const Outcome made = place.crashrank({"new", "--ego", "van.obj", "-o", "-"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Json van = made.json()["models"]["van"];
  EXPECT_EQ(van["scale"], 0.001);
  EXPECT_EQ(van["forward"], "+y");
  EXPECT_EQ(van["up"], "+z");
  EXPECT_EQ(van["kind"], "car");
  EXPECT_EQ(van["origin_m"], Json({-1.44, 0.0, -0.8}));  // a fifth of its length from the rear
}

TEST(New, WhatIsThereIsReplacedOnlyWithForce) {
  const Workplace place;
  const std::vector<std::string> call{"new", "--ego", "car:4.5,1.8,1.5", "-o", "s.json"};
  place.write("s.json", "{}");
  const Outcome refused = place.crashrank(call);
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(is_one_message(refused.err)) << refused.err;
  EXPECT_NE(refused.err.find("--force"), std::string::npos);
  EXPECT_EQ(place.read("s.json"), "{}");
  std::vector<std::string> forced = call;
  forced.emplace_back("--force");
  EXPECT_EQ(place.crashrank(forced).code, 0);
  EXPECT_NE(place.read("s.json"), "{}");
}

TEST(New, BodiesThatCannotBeReadAreRefusedInOneLine) {
  const Workplace place;
  place.write("notes.obj", "no mesh\n");
  for (const auto& [actor, code] : std::vector<std::pair<std::string, int>>{{"notes.obj@9,0,0", 3},
                                                                            {"gone.obj@9,0,0", 3},
                                                                            {"car:4,2@9,0,0", 2},
                                                                            {"car:4,2,0@9,0,0", 2},
                                                                            {"car@9,0,0", 2},
                                                                            {"cra:4,2,1@9,0,0", 2},
                                                                            {"car:4,2,1.5", 2},
                                                                            {"car:4,2,1.5@9,0", 2},
                                                                            {"-@9,0,0", 2}}) {
    const std::string ego = actor.substr(0, actor.find('@'));
    const Outcome refused =
        place.crashrank({"new", "--ego", ego, "--actor", actor, "-o", "s.json"});
    EXPECT_EQ(refused.code, code) << actor << ": " << refused.err;
    EXPECT_TRUE(is_one_message(refused.err)) << refused.err;
    EXPECT_EQ(place.list(".").size(), 1U) << actor;
  }
}

TEST(Check, AllErrorsOfAScenarioAreNamedWithTheirRemedies) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  Json scenario = Json::parse(place.read("scenario.json"));
  scenario["grip"] = 99;
  scenario["horizon"] = 3;
  scenario["models"]["gone"] = {{"mesh", "gone.obj"}, {"kind", "car"}};
  place.write("wrong.json", scenario.dump());
  const Outcome found = place.crashrank({"check", "wrong.json", "--plan", "plan.svg"});
  EXPECT_EQ(found.code, 3);
  EXPECT_EQ(found.out, "");
  for (const char* words :
       {"wrong.json: grip: is 99, out of range; give", "horizon: there is no such key; ",
        "models.gone.mesh", "no plan is drawn"}) {
    EXPECT_NE(found.err.find(words), std::string::npos) << words << '\n' << found.err;
  }
}

TEST(Check, APlanShowsTheBodiesAtTheStart) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Outcome found = place.crashrank({"check", "scenario.json", "--plan", "plan.svg"});
  EXPECT_EQ(found.code, 0) << found.err;
  EXPECT_NE(found.out.find("scenario.json: no errors"), std::string::npos) << found.out;
  const std::string plan = place.read("plan.svg");
  EXPECT_EQ(plan.rfind("<svg ", 0), 0U);
  EXPECT_NE(plan.find("class='ego'"), std::string::npos);
  EXPECT_NE(plan.find("class='bystander'"), std::string::npos);
  EXPECT_EQ(place.crashrank({"check", "scenario.json", "--plan", "-"}).code, 2);
}

}  // namespace
