#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

/// The importer cannot be found, as in a vehicle that has none.
Outcome without_importer(const Workplace& place, const std::string& arguments) {
  return place.shell("CRASHRANK_IMPORTER=/nowhere/crashrank-import " CRASHRANK_PROGRAM " " +
                     arguments);
}

void write_boxes(const Workplace& place) {
  place.write("a.obj", cli_test::box_obj("body", -1, -0.9, 0.2, 3, 0.9, 1.5));
  place.write("b.obj", cli_test::box_obj("block", -1, -1, 0, 1, 1, 2));
}

Json pairs_of(const Outcome& run) {
  Json queries = run.json().at("queries");
  for (Json& query : queries) {
    for (const char* time : {"seconds", "sort_seconds", "predicted_seconds"}) query.erase(time);
  }
  return queries;
}

TEST(Compile, AModelFileStandsWhereAMeshDoes) {
  const Workplace place;
  write_boxes(place);
  for (const std::string name : {"a", "b"}) {
    const Outcome run = place.crashrank({"compile", name + ".obj", "-o", name + ".crm", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.json().at("model"), name + ".crm");
    EXPECT_EQ(run.json().at("triangles"), 12);
    EXPECT_EQ(run.json().at("bytes"), place.read(name + ".crm").size());
  }
  const std::vector<std::string> how{"--json", "--pose", "3.5,0.2,0,10,0,0"};
  std::vector<std::string> meshes{"collide", "a.obj", "b.obj"};
  std::vector<std::string> models{"collide", "a.crm", "b.crm"};
  meshes.insert(meshes.end(), how.begin(), how.end());
  models.insert(models.end(), how.begin(), how.end());
  const Outcome expected = place.crashrank(meshes);
  ASSERT_EQ(expected.code, 0) << expected.err;
  EXPECT_EQ(expected.json()["queries"][0]["intersecting"], true);
  const Outcome found = place.crashrank(models);
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_EQ(pairs_of(found), pairs_of(expected));

  const Outcome bare =
      without_importer(place, "collide a.crm b.crm --json --pose 3.5,0.2,0,10,0,0");
  ASSERT_EQ(bare.code, 0) << bare.err;
  EXPECT_EQ(pairs_of(bare), pairs_of(expected));
  EXPECT_NE(without_importer(place, "collide a.obj b.obj --json").code, 0)
      << "the importer was found after all, so the test shows nothing";

  place.write("poses", "1 0 0 3.5 0 1 0 0.2 0 0 1 0 0 0 0 1\n");
  const Outcome sweep = without_importer(
      place, "sweep a.crm b.crm --poses poses --depths 1:2 --policies lowest --workers 1 --json");
  EXPECT_EQ(sweep.code, 0) << sweep.err;

  const Outcome piped = place.shell(
      CRASHRANK_PROGRAM " collide - b.crm --format crm --json --pose 3.5,0.2,0,10,0,0 < a.crm");
  ASSERT_EQ(piped.code, 0) << piped.err;
  EXPECT_EQ(pairs_of(piped), pairs_of(expected));

  // A model says by itself what it is.
  const Outcome named = place.crashrank({"inspect", "a.crm", "--json"});
  const Outcome unnamed = place.shell(CRASHRANK_PROGRAM " inspect - --json < a.crm");
  ASSERT_EQ(unnamed.code, 0) << unnamed.err;
  cli_test::Json from_input = unnamed.json();
  EXPECT_EQ(from_input["files"][0]["file"], "-");
  from_input["files"][0]["file"] = "a.crm";
  EXPECT_EQ(from_input["files"], named.json()["files"]);
  const Outcome mesh = place.shell(CRASHRANK_PROGRAM " inspect - < a.obj");
  EXPECT_EQ(mesh.code, 2) << mesh.out;
  EXPECT_NE(mesh.err.find("--format"), std::string::npos) << mesh.err;
}

TEST(Compile, RanksFromModelFilesWithoutTheImporter) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const Outcome expected = place.crashrank({"rank", "scenario.json", "--json"});
  ASSERT_EQ(expected.code, 0) << expected.err;
  for (const std::string name : {"ego", "block"}) {
    const Outcome run = place.crashrank({"compile", name + ".obj", "-o", name + ".crm"});
    ASSERT_EQ(run.code, 0) << run.err;
  }
  std::string scenario = place.read("scenario.json");
  for (const std::string name : {"ego", "block"}) {
    const std::size_t at = scenario.find(name + ".obj");
    ASSERT_NE(at, std::string::npos);
    scenario.replace(at, name.size() + 4, name + ".crm");
  }
  place.write("compiled.json", scenario);
  const Outcome found = without_importer(place, "rank compiled.json --json");
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_EQ(found.json().at("ranking"), expected.json().at("ranking"));

  // Nothing outside the scenario's folder, compiled or not.
  place.shell("mkdir inner && cp compiled.json inner/");
  std::string outside = scenario;
  outside.replace(outside.find("ego.crm"), 7, "../ego.crm");
  place.write("inner/outside.json", outside);
  const Outcome refused = place.crashrank({"rank", "inner/outside.json"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("lies outside"), std::string::npos) << refused.err;
}

TEST(Compile, InspectTellsWhatAModelFileHolds) {
  const Workplace place;
  write_boxes(place);
  // y up, -z forward, millimetres.
  place.write("mm.obj", cli_test::box_obj("body", 0, 0, -4000, 1800, 1300, 0));
  const Outcome compiled =
      place.crashrank({"compile", "mm.obj", "-o", "mm.crm", "--scale", "0.001", "--up", "+y",
                       "--forward", "-z", "--mass-kg", "1450", "--json"});
  ASSERT_EQ(compiled.code, 0) << compiled.err;
  const Outcome run = place.crashrank({"inspect", "mm.crm", "--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json file = run.json()["files"][0];
  EXPECT_EQ(file.at("triangles"), 12);
  EXPECT_NEAR(file.at("extent_m")[0].get<double>(), 4.0, 1e-6);
  EXPECT_EQ(file.at("parts")[0].at("name"), "body");
  const Json& model = file.at("model");
  EXPECT_EQ(model.at("version"), 4);
  EXPECT_EQ(model.at("checksum"), compiled.json().at("checksum"));
  EXPECT_EQ(model.at("bytes"), compiled.json().at("bytes"));
  EXPECT_EQ(model.at("mass_kg"), 1450.0);
  EXPECT_NEAR(model.at("volume_m3").get<double>(), 4.0 * 1.8 * 1.3, 1e-5);
  EXPECT_EQ(model.at("scale"), 0.001);
  EXPECT_EQ(model.at("up"), "+y");
  EXPECT_EQ(model.at("forward"), "-z");
  const Outcome text = place.crashrank({"inspect", "mm.crm"});
  EXPECT_NE(text.out.find("model file version 4"), std::string::npos) << text.out;
  EXPECT_FALSE(
      place.crashrank({"inspect", "a.obj", "--json"}).json()["files"][0].contains("model"));

  // Written again with what it had: the same bytes.
  ASSERT_EQ(place.crashrank({"compile", "mm.crm", "-o", "again.crm"}).code, 0);
  EXPECT_EQ(place.read("again.crm"), place.read("mm.crm"));
}

TEST(Compile, StatedMassStandsInTheFileAndIsKept) {
  const Workplace place;
  write_boxes(place);
  ASSERT_EQ(
      place
          .crashrank({"compile", "a.obj", "-o", "a.crm", "--mass-kg", "1450", "--center-of-mass-m",
                      "1.234567,-0.1,0.55", "--yaw-inertia-kgm2", "2100.5"})
          .code,
      0);
  const auto model_of = [&](const std::string& file) {
    const Outcome run = place.crashrank({"inspect", file, "--json"});
    EXPECT_EQ(run.code, 0) << run.err;
    return run.json()["files"][0]["model"];
  };
  const Json stated = model_of("a.crm");
  EXPECT_EQ(stated.at("center_of_mass_m"), (Json{1.234567, -0.1, 0.55}));
  EXPECT_EQ(stated.at("yaw_inertia_kgm2"), 2100.5);
  const std::string text = place.crashrank({"inspect", "a.crm"}).out;
  EXPECT_NE(text.find("centre of mass at (1.23457, -0.1, 0.55) m"), std::string::npos) << text;
  EXPECT_NE(text.find("yaw inertia 2100.5 kg m2"), std::string::npos) << text;

  // Compiled again: what is not stated anew stays. A height that is left out is the box's middle.
  const std::vector<std::string> anew{"compile", "a.crm",   "-o",    "b.crm", "--center-of-mass-m",
                                      "-0.5,0",  "--force", "--json"};
  const Outcome told = place.crashrank(anew);
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_EQ(told.json().at("kept"), (Json{{"mass_kg", 1450.0}, {"yaw_inertia_kgm2", 2100.5}}));
  const std::string words = place.crashrank({anew.begin(), anew.end() - 1}).out;
  for (const char* part : {"kept from the input", "1450 kg (--mass-kg)",
                           "yaw inertia 2100.5 kg m2 (--yaw-inertia-kgm2)"}) {
    EXPECT_NE(words.find(part), std::string::npos) << words;
  }
  EXPECT_EQ(words.find("centre of mass"), std::string::npos) << words;
  const Json again = model_of("b.crm");
  EXPECT_EQ(again.at("mass_kg"), 1450.0);
  EXPECT_EQ(again.at("yaw_inertia_kgm2"), 2100.5);
  EXPECT_EQ(again.at("center_of_mass_m"), (Json{-0.5, 0.0, 0.85}));

  EXPECT_EQ(place.crashrank({"compile", "a.obj", "-o", "c.crm"}).out.find("kept"),
            std::string::npos);
  const Json nothing = model_of("c.crm");
  for (const char* key : {"mass_kg", "center_of_mass_m", "yaw_inertia_kgm2"}) {
    EXPECT_TRUE(nothing.at(key).is_null()) << key;
  }
}

// A ranking is the same whether scenario or model file states mass, centre and inertia; the
// scenario comes first.
TEST(Compile, RanksByWhatAModelFileStates) {
  const Workplace place;
  cli_test::write_box_scenario(place);
  const auto ranking = [&](const std::string& mesh, const char* stated) {
    Json scenario = Json::parse(place.read("scenario.json"));
    Json& ego = scenario["models"]["ego"];
    ego["mesh"] = mesh;
    for (const char* key : {"mass_kg", "center_of_mass_m", "yaw_inertia_kgm2"}) ego.erase(key);
    ego.update(Json::parse(stated));
    place.write("other.json", scenario.dump());
    const Outcome run = place.crashrank({"rank", "other.json", "--json", "--measure", "delta-v"});
    EXPECT_EQ(run.code, 0) << run.err;
    return run.json().at("ranking");
  };
  const auto compile = [&](const std::string& file, const char* center, const char* inertia) {
    const Outcome run =
        place.crashrank({"compile", "ego.obj", "-o", file, "--mass-kg", "1450",
                         "--center-of-mass-m", center, "--yaw-inertia-kgm2", inertia});
    EXPECT_EQ(run.code, 0) << run.err;
  };
  compile("stated.crm", "0.3,0.2,0.5", "1234.5");
  compile("other.crm", "0.9,-0.3,0.7", "2000");
  constexpr const char* all =
      R"({"mass_kg": 1450, "center_of_mass_m": [0.3, 0.2, 0.5], "yaw_inertia_kgm2": 1234.5})";
  const Json expected = ranking("ego.obj", all);
  EXPECT_EQ(ranking("stated.crm", "{}"), expected);
  EXPECT_EQ(ranking("other.crm", all), expected);
  EXPECT_NE(ranking("other.crm", "{}"), expected);
  EXPECT_NE(ranking("ego.obj", R"({"mass_kg": 1450})"), expected);
  EXPECT_NE(ranking("other.crm", R"({"center_of_mass_m": [0.3, 0.2, 0.5]})"), expected);
}

TEST(Compile, RefusesWhatMakesNoSense) {
  const Workplace place;
  write_boxes(place);
  ASSERT_EQ(place.crashrank({"compile", "a.obj", "-o", "a.crm"}).code, 0);
  const std::string before = place.read("a.crm");

  const Outcome taken = place.crashrank({"compile", "b.obj", "-o", "a.crm"});
  EXPECT_EQ(taken.code, 2);
  EXPECT_TRUE(cli_test::is_one_message(taken.err)) << taken.err;
  EXPECT_NE(taken.err.find("--force"), std::string::npos) << taken.err;
  EXPECT_EQ(place.read("a.crm"), before);
  EXPECT_EQ(place.crashrank({"compile", "b.obj", "-o", "a.crm", "--force"}).code, 0);
  EXPECT_NE(place.read("a.crm"), before);

  EXPECT_EQ(place.crashrank({"compile", "a.obj"}).code, 2);
  EXPECT_EQ(place.crashrank({"compile", "a.obj", "-o", "-"}).code, 2);
  EXPECT_EQ(place.crashrank({"compile", "a.obj", "-o", "x.crm", "--mass-kg", "-3"}).code, 2);
  for (const std::string mass : {"0", "1e-10", "1e9", "nan"}) {
    const Outcome run = place.crashrank({"compile", "a.obj", "-o", "x.crm", "--mass-kg", mass});
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find("from 0.1 to 1000000"), std::string::npos) << run.err;
  }
  struct Refused {
    const char* option;
    const char* value;
    int code;
    const char* part;
  };
  for (const Refused& bad : std::vector<Refused>{
           {"--center-of-mass-m", "1", 2,
            "--center-of-mass-m 1: has 1 number, but needs two or three finite numbers; write x,y "
            "or x,y,z in metres, such as 1.5,0"},
           {"--center-of-mass-m", "1,0,0.5,2", 2,
            "has 4 numbers, but needs two or three finite numbers"},
           {"--center-of-mass-m", "1,zero", 2,
            "holds something else than numbers, but needs two or three finite numbers"},
           {"--center-of-mass-m", "1,nan", 2,
            "is not finite, but needs two or three finite numbers"},
           {"--center-of-mass-m", "5 0", 3, "(5, 0, 0.85) m is not"},
           {"--yaw-inertia-kgm2", "abc", 2,
            "--yaw-inertia-kgm2: 'abc' is not a number: give kg m2, such as 2200"},
           {"--yaw-inertia-kgm2", "2,200", 2, "'2,200' is not a number"},
           {"--yaw-inertia-kgm2", "2200 kg", 2, "'2200 kg' is not a number"},
           {"--scale", "big", 2,
            "--scale: 'big' is not a number: give metres per file unit, such as 0.001"},
           {"--center-of-mass-m", "3.1,0", 3, "a.obj: centre of mass: (3.1, 0, 0.85) m is not"},
           {"--center-of-mass-m", "1,0,1500", 3, "centre of mass"},
           {"--yaw-inertia-kgm2", "0", 2, "a number above 0"},
           {"--yaw-inertia-kgm2", "-5", 2, "a number above 0"},
           {"--yaw-inertia-kgm2", "nan", 2, "a number above 0"},
           {"--yaw-inertia-kgm2", "2e9", 2, "a number above 0"},
           {"--yaw-inertia-kgm2", "9000", 3, "a.obj: yaw inertia: "},
           {"--yaw-inertia-kgm2", "10", 3, "a.obj: yaw inertia: "}}) {
    const Outcome run = place.crashrank(
        {"compile", "a.obj", "-o", "x.crm", "--mass-kg", "1450", bad.option, bad.value});
    EXPECT_EQ(run.code, bad.code) << bad.option << " " << bad.value << ": " << run.err;
    EXPECT_NE(run.err.find(bad.part), std::string::npos) << run.err;
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
  }
  const Outcome heavy = place.crashrank({"compile", "a.obj", "-o", "x.crm", "--mass-kg", "1.4t"});
  EXPECT_EQ(heavy.code, 2);
  EXPECT_NE(heavy.err.find("--mass-kg: '1.4t' is not a number: give kg, such as 1450"),
            std::string::npos)
      << heavy.err;
  const Outcome spaces =
      place.crashrank({"compile", "a.obj", "-o", "x.crm", "--center-of-mass-m", "1", "2", "3"});
  EXPECT_EQ(spaces.code, 2);
  EXPECT_NE(spaces.err.find("not expected: '2' '3'; numbers of one option stand together with "
                            "commas, such as 1,2,3"),
            std::string::npos)
      << spaces.err;
  EXPECT_TRUE(cli_test::is_one_message(spaces.err)) << spaces.err;
  const std::string mesh = place.read("a.obj");
  EXPECT_EQ(place.crashrank({"compile", "a.obj", "-o", "./a.obj", "--force"}).code, 2);
  EXPECT_EQ(place.read("a.obj"), mesh);
  EXPECT_EQ(place.crashrank({"compile", "nowhere.obj", "-o", "x.crm"}).code, 3);
  EXPECT_EQ(place.crashrank({"compile", "a.obj", "-o", "no/folder/x.crm"}).code, 3);
  EXPECT_EQ(place.crashrank({"collide", "a.crm", "b.obj", "--scale", "2"}).code, 2);
  EXPECT_EQ(place.crashrank({"collide", "a.crm", "b.obj", "--frame", "gaussian"}).code, 2);
  EXPECT_EQ(place.crashrank({"inspect", "a.crm", "--up", "+y"}).code, 2);

  const Outcome misspelt = place.crashrank({"inspect", "aa.crm"});
  EXPECT_EQ(misspelt.code, 3);
  EXPECT_NE(misspelt.err.find("aa.crm: cannot open"), std::string::npos) << misspelt.err;
  place.write("mesh.crm", cli_test::box_obj("a", 0, 0, 0, 1, 1, 1));
  const Outcome no_model = place.crashrank({"inspect", "mesh.crm"});
  EXPECT_EQ(no_model.code, 3);
  EXPECT_NE(no_model.err.find("model file"), std::string::npos) << no_model.err;

  std::string damaged = before;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  place.write("damaged.crm", damaged);
  for (const std::string command : {"inspect damaged.crm", "collide damaged.crm b.obj"}) {
    const Outcome run = place.shell(CRASHRANK_PROGRAM " " + command);
    EXPECT_EQ(run.code, 3);
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    EXPECT_NE(run.err.find("damaged.crm: checksum: the file is damaged; compile it again"),
              std::string::npos)
        << run.err;
  }
}

}  // namespace
