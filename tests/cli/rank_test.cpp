#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

Json ranked(const Workplace& place, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"rank", "scenario.json", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome run = place.crashrank(arguments);
  EXPECT_EQ(run.code, 0) << run.err;
  return run.json();
}

const Json& entry(const Json& answer, const std::string& candidate) {
  for (const Json& one : answer.at("ranking")) {
    if (one.at("candidate") == candidate) return one;
  }
  throw std::runtime_error("no candidate " + candidate);
}

TEST(Rank, JsonHasTheContractsShape) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Json answer = ranked(place);
  EXPECT_EQ(answer.at("scenario"), "box ahead");
  EXPECT_EQ(answer.at("measure"), "harm");
  EXPECT_EQ(answer.at("complete"), true);
  EXPECT_EQ(answer.at("proved"), true);
  EXPECT_TRUE(answer.at("in_race").is_array());
  EXPECT_GT(answer.at("elapsed_s").get<double>(), 0.0);
  ASSERT_EQ(answer.at("ranking").size(), 3U);
  double last = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& one = answer["ranking"][i];
    // Those that are tied share the rank of the first of them.
    const std::size_t rank = one.at("rank");
    if (rank != i + 1) {
      EXPECT_EQ(rank, answer["ranking"][i - 1].at("rank"));
      EXPECT_EQ(one.at("tied_with")[0], answer["ranking"][rank - 1].at("candidate"));
      EXPECT_EQ(answer["ranking"][i - 1].at("separable_from_next"), false);
    }
    EXPECT_TRUE(one.at("tied_with").is_array());
    EXPECT_TRUE(one.at("candidate").is_string());
    EXPECT_GE(one.at("score").get<double>(), last);
    last = one["score"];
    const std::vector<double> interval = one.at("score_interval");
    ASSERT_EQ(interval.size(), 2U);
    EXPECT_LE(interval[0], one["score"].get<double>());
    EXPECT_GE(interval[1], one["score"].get<double>());
    EXPECT_TRUE(one.at("separable_from_next").is_boolean());
    ASSERT_EQ(one.at("places").size(), 2U);
    EXPECT_LE(one["places"][0], rank);
    EXPECT_GE(one["places"][1], rank);
    EXPECT_TRUE(one.at("collides").is_boolean());
    EXPECT_EQ(one.at("contacts").empty(), !one["collides"].get<bool>());
    for (const char* key : {"damaged_triangles", "damaged_area_m2"}) {
      EXPECT_TRUE(one.at(key).at("ego").is_number()) << key;
      EXPECT_TRUE(one.at(key).at("other").is_number()) << key;
    }
    EXPECT_TRUE(one.at("damaged_parts").at("ego").is_array());
    EXPECT_TRUE(one.at("damaged_parts").at("other").is_array());
    for (const char* key : {"other", "time_of_impact_s", "closing_speed_mps"}) {
      EXPECT_EQ(one.at(key).is_null(), !one["collides"].get<bool>()) << key;
    }
  }
}

// 7 m between the faces, 10 m/s: contact after 0.7 s. Braking at 7.5 m/s2 stops within 6.67 m, a
// third of a metre before it; swerving passes it further away.
TEST(Rank, WhatIsHitWhenAndHowFast) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Json answer = ranked(place, {"--measure", "polygons"});
  EXPECT_EQ(answer["ranking"][0]["candidate"], "swerve");
  EXPECT_EQ(answer["ranking"][1]["candidate"], "brake");
  for (const std::size_t place_index : {0U, 1U}) {
    EXPECT_EQ(answer["ranking"][place_index]["score"], 0.0);
    EXPECT_EQ(answer["ranking"][place_index]["collides"], false);
  }
  EXPECT_NEAR(answer["ranking"][1]["least_distance_m"].get<double>(), 7.0 - 100.0 / 15.0, 0.01);
  EXPECT_GT(answer["ranking"][0]["least_distance_m"].get<double>(), 0.4);
  const Json& straight = entry(answer, "straight");
  EXPECT_EQ(straight["collides"], true);
  EXPECT_EQ(straight["other"], "stone");
  EXPECT_NEAR(straight["time_of_impact_s"].get<double>(), 0.7, 2e-5);  // 0.1 mm at 10 m/s
  EXPECT_NEAR(straight["closing_speed_mps"].get<double>(), 10.0, 1e-9);
  EXPECT_EQ(straight["damaged_parts"]["ego"], Json::array({"body"}));
  EXPECT_EQ(straight["damaged_parts"]["other"], Json::array({"stone"}));
  EXPECT_EQ(straight["contacts"][0]["other"], "stone");
  EXPECT_EQ(straight["contacts"][0]["time_of_impact_s"], straight["time_of_impact_s"]);
  EXPECT_EQ(straight["score"].get<double>(),
            straight["damaged_triangles"]["ego"].get<double>() +
                straight["damaged_triangles"]["other"].get<double>());
}

// It is part of the JSON answer, and the search within a budget does not record it.
TEST(Rank, MotionIsToldOrRefused) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Json answer = ranked(place, {"--motion"});
  const Json& motion = entry(answer, "straight").at("motion");
  ASSERT_EQ(motion.size(), 1U);  // nothing moves the stone
  EXPECT_EQ(motion[0]["body"], "ego");
  EXPECT_EQ(motion[0]["t_s"].size(), motion[0]["vx_mps"].size());
  EXPECT_TRUE(entry(answer, "swerve").at("motion").empty());
  EXPECT_FALSE(ranked(place)["ranking"][0].contains("motion"));
  for (const auto& [more, told] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, "add --json"},
           {{"--report", "page.html"}, "add --json"},
           {{"--json", "--deadline-ms", "1000"}, "leave out --deadline-ms"},
           {{"--json", "--work-budget", "1000"}, "--work-budget"},
           {{"--json", "--first-place"}, "--first-place"}}) {
    std::vector<std::string> arguments{"rank", "scenario.json", "--motion"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome run = place.crashrank(arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    EXPECT_NE(run.err.find(told), std::string::npos) << run.err;
  }
}

TEST(Rank, TheMeasureCanBeChosen) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Json area = ranked(place, {"--measure", "area"});
  EXPECT_EQ(area["measure"], "area");
  const Json& straight = entry(area, "straight");
  EXPECT_NEAR(straight["score"].get<double>(),
              straight["damaged_area_m2"]["ego"].get<double>() +
                  straight["damaged_area_m2"]["other"].get<double>(),
              1e-9);
  // Half of 1500 kg at 10 m/s against what does not move.
  const Json energy = ranked(place, {"--measure", "closing-energy"});
  EXPECT_NEAR(entry(energy, "straight")["score"].get<double>(), 75000.0, 1e-6);
}

TEST(Rank, WorkersDoNotChangeTheAnswer) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  Json one = ranked(place);
  one.erase("elapsed_s");
  for (const char* depth : {"auto", "1", "4"}) {
    for (const char* policy : {"best-match", "random", "lowest", "best-match-load", "late-match"}) {
      Json three = ranked(place, {"--workers", "3", "--depth", depth, "--policy", policy});
      three.erase("elapsed_s");
      EXPECT_EQ(one, three) << depth << ' ' << policy;
    }
  }
}

TEST(Rank, TheTableNamesEveryCandidateOrSaysHowManyAreMissing) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Outcome all = place.crashrank({"rank", "scenario.json"});
  ASSERT_EQ(all.code, 0) << all.err;
  for (const char* word : {"brake", "straight", "swerve", "stone", "0.700"}) {
    EXPECT_NE(all.out.find(word), std::string::npos) << word << "\n" << all.out;
  }
  const Outcome one = place.crashrank({"rank", "scenario.json", "--top", "1"});
  EXPECT_NE(one.out.find("and 2 more"), std::string::npos) << one.out;
}

TEST(Rank, AScenarioComesThroughStandardInput) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Outcome run = place.crashrank({"rank", "-", "--json"}, place.read("scenario.json"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.json()["ranking"].size(), 3U);
}

TEST(Rank, DamageIsWrittenInFormatsThatAreReadBack) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Json answer = ranked(place, {"--damage", "out"});
  const std::vector<std::string> files = place.list("out");
  const std::string rank = std::to_string(entry(answer, "straight")["rank"].get<int>());
  const std::string stem = "00" + rank + "-straight";
  for (const std::string& file : {stem + "-ego.glb", stem + "-ego.ply", stem + "-1-stone.glb",
                                  stem + "-1-stone.ply", stem + ".png", stem + "-ego.png"}) {
    EXPECT_NE(std::find(files.begin(), files.end(), file), files.end()) << file;
  }
  for (const std::string& file : files) EXPECT_EQ(file.find("brake"), std::string::npos) << file;

  // assimp reads both back: the same triangles; the GLB's axes are glTF's.
  const Outcome ply = place.crashrank({"inspect", "out/" + stem + "-ego.ply", "--json"});
  ASSERT_EQ(ply.code, 0) << ply.err;
  const Outcome glb = place.crashrank(
      {"inspect", "out/" + stem + "-ego.glb", "--json", "--up", "+y", "--forward", "+z"});
  ASSERT_EQ(glb.code, 0) << glb.err;
  for (const Outcome& run : {ply, glb}) {
    const Json file = run.json()["files"][0];
    EXPECT_EQ(file["triangles"], 12);
    const std::vector<double> extent = file["extent_m"];
    EXPECT_NEAR(extent[0], 4.0, 1e-5);
    EXPECT_NEAR(extent[1], 1.8, 1e-5);
    EXPECT_NEAR(extent[2], 1.3, 1e-5);
  }
  EXPECT_EQ(place.read("out/" + stem + ".png").substr(1, 3), "PNG");
}

TEST(Rank, BodiesThatOnlyOthersHitHaveDamageFilesToo) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  // A car before the stone: the ego pushes it into the stone.
  place.write("scenario.json", R"({
  "scenario_version": 1,
  "models": {
    "ego": {"mesh": "ego.obj", "kind": "car", "mass_kg": 1500},
    "block": {"mesh": "block.obj", "kind": "barrier"}
  },
  "ego": {"model": "ego", "speed_mps": 20},
  "candidates": {"listed": [{"name": "straight", "acceleration_mps2": 0}], "grid": false,
                 "add_straight_braking": false},
  "actors": [{"name": "parked", "model": "ego", "pose": {"x_m": 8}},
             {"name": "stone", "model": "block", "pose": {"x_m": 11.5}}],
  "horizon_s": 3
})");
  const Json answer = ranked(place, {"--damage", "out"});
  bool is_hit_by_ego = false;
  bool is_hit_by_parked = false;
  for (const Json& contact : answer.at("ranking")[0].at("contacts")) {
    const std::vector<std::string> bodies = contact.at("bodies");
    is_hit_by_ego = is_hit_by_ego || (bodies == std::vector<std::string>{"ego", "stone"});
    is_hit_by_parked = is_hit_by_parked ||
                       (bodies == std::vector<std::string>{"parked", "stone"}) ||
                       (bodies == std::vector<std::string>{"stone", "parked"});
  }
  ASSERT_TRUE(is_hit_by_parked && !is_hit_by_ego) << answer.at("ranking")[0].at("contacts").dump();
  const std::vector<std::string> files = place.list("out");
  EXPECT_EQ(files,
            (std::vector<std::string>{"001-straight-1-parked.glb", "001-straight-1-parked.ply",
                                      "001-straight-2-stone.glb", "001-straight-2-stone.ply",
                                      "001-straight-ego.glb", "001-straight-ego.ply",
                                      "001-straight-ego.png", "001-straight.png"}));
  // The files are the same for every number of threads.
  ranked(place, {"--damage", "again", "--workers", "3"});
  for (const std::string& file : files) {
    EXPECT_EQ(place.read("out/" + file), place.read("again/" + file)) << file;
  }
}

TEST(Rank, NothingIsWrittenOutsideTheDamageFolder) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  std::string scenario = place.read("scenario.json");
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"\"straight\"", "\"../../straight\""},
           {"\"stone\", \"model\"", "\"/../stone\", \"model\""}}) {
    const std::size_t at = scenario.find(from);
    ASSERT_NE(at, std::string::npos);
    scenario.replace(at, from.size(), to);
  }
  place.write("scenario.json", scenario);
  place.shell("mkdir out");
  const std::vector<std::string> before = place.list(".");
  ranked(place, {"--damage", "out"});
  EXPECT_EQ(place.list("."), before);
  EXPECT_GE(place.list("out").size(), 6U);
}

TEST(Rank, ALinkInTheDamageFolderIsNotFollowed) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Json answer = ranked(place);
  const std::string rank = std::to_string(entry(answer, "straight")["rank"].get<int>());
  place.write("precious", "kept");
  place.shell("mkdir out && ln -s ../precious out/00" + rank + "-straight-ego.glb");
  const Outcome run = place.crashrank({"rank", "scenario.json", "--damage", "out"});
  EXPECT_EQ(run.code, 3);
  EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
  EXPECT_EQ(place.read("precious"), "kept");
}

TEST(Rank, EveryBadScenarioIsExitThreeAndOneLineThatNamesIt) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const std::string good = place.read("scenario.json");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  for (const std::string& text : std::vector<std::string>{
           "", "{", "[]", "{\"scenario_version\": 1}",
           with("\"speed_mps\": 10", "\"speed_mps\": 1e9"), with("\"horizon_s\"", "\"horizon\""),
           with("ego.obj", "gone.obj"), with("ego.obj", "../../../etc/passwd"),
           with("\"model\": \"block\"", "\"model\": \"b\"")}) {
    SCOPED_TRACE(text.substr(0, 200));
    place.write("bad.json", text);
    const Outcome run = place.crashrank({"rank", "bad.json", "--json"});
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    const bool named = run.err.find("bad.json") != std::string::npos ||
                       run.err.find("gone.obj") != std::string::npos;
    EXPECT_TRUE(named) << run.err;
  }
  EXPECT_EQ(place.crashrank({"rank", "gone.json"}).code, 3);
  EXPECT_EQ(place.crashrank({"rank", "."}).code, 3);
}

TEST(Rank, AnImpossibleMassCentreOrInertiaIsNamedByFileAndKey) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const auto refused = [&](const Json& ego, const std::string& told) {
    Json scenario = Json::parse(place.read("scenario.json"));
    scenario["models"]["ego"].update(ego);
    place.write("s.json", scenario.dump());
    for (const char* how : {"--json", "--first-place"}) {
      const Outcome run = place.crashrank({"rank", "s.json", how});
      EXPECT_EQ(run.code, 3);
      EXPECT_EQ(run.err.rfind("crashrank: " + told, 0), 0U) << run.err;
      EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    }
  };
  refused({{"yaw_inertia_kgm2", 1}}, "s.json: models.ego.yaw_inertia_kgm2: ");
  refused({{"yaw_inertia_kgm2", 1e6}}, "s.json: models.ego.yaw_inertia_kgm2: ");
  refused({{"yaw_inertia_kgm2", 0}}, "s.json: models.ego.yaw_inertia_kgm2: ");
  refused({{"mass_kg", 1.0}, {"yaw_inertia_kgm2", 2400}}, "s.json: models.ego.yaw_inertia_kgm2: ");
  refused({{"center_of_mass_m", {3.5, 0, 0.5}}}, "s.json: models.ego.center_of_mass_m: ");
  refused({{"center_of_mass_m", {1e9, 0, 0.5}}}, "s.json: models.ego.center_of_mass_m[0]: ");
  for (const Json& mass : {Json(0), Json(-5), Json(1e9), Json("heavy")}) {
    refused({{"mass_kg", mass}}, "s.json: models.ego.mass_kg: ");
  }
  refused({{"kind", "pole"}, {"mass_kg", nullptr}}, "s.json: models.ego.mass_kg: ");

  // What the model file alone states is the model file's.
  ASSERT_EQ(place
                .crashrank({"compile", "ego.obj", "-o", "ego.crm", "--mass-kg", "1500",
                            "--yaw-inertia-kgm2", "2400"})
                .code,
            0);
  refused({{"mesh", "ego.crm"}, {"mass_kg", 10}}, place.path("ego.crm") + ": yaw inertia: ");
}

TEST(Rank, APageOnStandardOutputStandsAlone) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Outcome run = place.crashrank({"rank", "scenario.json", "--report", "-"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out.rfind("<!DOCTYPE html>", 0), 0U) << run.out.substr(0, 100);
  const std::string end = "</html>\n";
  ASSERT_GT(run.out.size(), end.size());
  EXPECT_EQ(run.out.substr(run.out.size() - end.size()), end);
}

TEST(Rank, NothingThatIsReadIsWrittenOver) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  for (const char* input : {"scenario.json", "./block.obj"}) {
    const std::string before = place.read(input);
    const Outcome run = place.crashrank({"rank", "scenario.json", "--report", input});
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find("over what is read"), std::string::npos) << run.err;
    EXPECT_EQ(place.read(input), before);
  }
}

TEST(Rank, AManoeuvreThatBeginsElsewhereIsRefusedAndOneTooFastIsTold) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const std::string text = place.read("scenario.json");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return changed;
  };
  const std::string steering =
      "{\"name\": \"swerve\", \"acceleration_mps2\": 0, \"steering_deg\": 12}";
  for (const auto& [x, code] : {std::pair("0.9", 0), std::pair("1.1", 3)}) {
    place.write("s.json",
                with(steering, std::string("{\"name\": \"swerve\", \"poses\": [{\"t_s\": 0, "
                                           "\"x_m\": ") +
                                   x + "}]}"));
    const Outcome run = place.crashrank({"rank", "s.json"});
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_EQ(run.err.find("candidates.listed[2].poses[0]") != std::string::npos, code == 3)
        << run.err;
  }
  place.write("s.json", with("\"speed_mps\": 10", "\"speed_mps\": 141"));
  const Outcome fast = place.crashrank({"rank", "s.json"});
  EXPECT_EQ(fast.code, 0);
  EXPECT_NE(fast.err.find("at more than 140 m/s"), std::string::npos) << fast.err;
  EXPECT_EQ(place.crashrank({"rank", "s.json", "--measure", "area"}).err.find("140 m/s"),
            std::string::npos);
}

TEST(Rank, BodiesThatOverlapAtTheStartAreMarkedAndWarnedOf) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  Json scenario = Json::parse(place.read("scenario.json"));
  for (const auto& [x_m, overlaps] : {std::pair(2.5, true), std::pair(3.5, false)}) {
    scenario["actors"][0]["pose"]["x_m"] = x_m;
    place.write("s.json", scenario.dump());
    const Outcome run = place.crashrank({"rank", "s.json", "--report", "r.html"});
    EXPECT_EQ(run.code, 0) << run.err;
    const auto says = [](const std::string& text, const char* part) {
      return text.find(part) != std::string::npos;
    };
    EXPECT_EQ(says(run.out, "stone (overlaps at start)"), overlaps) << run.out;
    EXPECT_EQ(says(run.out, "overlaps at start: what is deep inside"), overlaps) << run.out;
    EXPECT_EQ(says(run.err, "warning: s.json: the ego overlaps 'stone' at the start (3 of 3"),
              overlaps)
        << run.err;
    const std::string page = place.read("r.html");
    EXPECT_EQ(says(page, "Doubtful: the ego overlaps"), overlaps);
    EXPECT_EQ(says(page, "stone (overlaps at start)"), overlaps);
    EXPECT_EQ(says(page, "overlaps stone at the start"), overlaps);
  }
}

TEST(Rank, ManoeuvresBeyondTheGripAreTold) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const std::string text = place.read("scenario.json");
  const std::string gentle = "\"steering_deg\": 12";
  const auto with_steering = [&](const std::string& deg) {
    std::string changed = text;
    changed.replace(changed.find(gentle), gentle.size(), "\"steering_deg\": " + deg);
    place.write("s.json", changed);
    return place.crashrank({"rank", "s.json", "--json"});
  };
  const Outcome within = with_steering("2");
  EXPECT_EQ(within.err, "");
  const Json answer = Json::parse(within.out);
  for (const Json& one : answer.at("ranking")) {
    EXPECT_LE(one.at("grip_demand").get<double>(), 1.0);
  }
  const Outcome beyond = with_steering("40");
  EXPECT_EQ(beyond.code, 0);
  EXPECT_NE(beyond.err.find("1 manoeuvre asks for more than the vehicle can do"), std::string::npos)
      << beyond.err;
  EXPECT_NE(beyond.err.find("'swerve', in place "), std::string::npos) << beyond.err;

  Json two = Json::parse(place.read("s.json"));
  for (const char* name : {"hard left", "hard right"}) {
    two["candidates"]["listed"].push_back({{"name", name}, {"steering_deg", 30}});
  }
  place.write("s.json", two.dump());
  const Outcome three = place.crashrank({"rank", "s.json", "--json"});
  for (const char* part :
       {"3 manoeuvres ask for more", "'swerve'", "'hard left'", "'hard right'"}) {
    EXPECT_NE(three.err.find(part), std::string::npos) << three.err;
  }
}

}  // namespace
