#include "cli/program.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

TEST(Inspect, JsonHasTheContractsShape) {
  const Workplace place;
  place.write("box.obj", cli_test::box_obj("body", -1, -0.9, 0.2, 3, 0.9, 1.5));
  const Outcome run = place.crashrank({"inspect", "box.obj", "--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json files = run.json().at("files");
  ASSERT_EQ(files.size(), 1U);
  const Json& file = files[0];
  EXPECT_EQ(file.at("file"), "box.obj");
  EXPECT_EQ(file.at("triangles"), 12);
  EXPECT_EQ(file.at("vertices"), 8);
  ASSERT_EQ(file.at("parts").size(), 1U);
  EXPECT_EQ(file.at("parts")[0].at("name"), "body");
  EXPECT_EQ(file.at("parts")[0].at("triangles"), 12);
  const std::vector<double> extent = file.at("extent_m");
  ASSERT_EQ(extent.size(), 3U);
  EXPECT_NEAR(extent[0], 4.0, 1e-6);
  EXPECT_NEAR(extent[1], 1.8, 1e-6);
  EXPECT_NEAR(extent[2], 1.3, 1e-6);
  for (const auto& [key, wanted] : std::vector<std::pair<std::string, std::vector<double>>>{
           {"min_m", {-1.0, -0.9, 0.2}}, {"max_m", {3.0, 0.9, 1.5}}}) {
    const std::vector<double> corner = file.at(key);
    ASSERT_EQ(corner.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(corner[i], wanted[i], 1e-6) << key;
  }
  EXPECT_TRUE(file.at("orientation_hint").is_null());
  const Json& vehicle = file.at("vehicle");
  EXPECT_EQ(vehicle.at("kind"), "car");
  EXPECT_EQ(vehicle.at("guessed"), false);
  EXPECT_EQ(vehicle.at("axles_seen"), false);
  EXPECT_NEAR(vehicle.at("rear_axle_x_m"), -0.2, 1e-6);
  EXPECT_EQ(vehicle.at("origin_m"), Json({0.0, 0.0, 0.0}));
  EXPECT_EQ(file.at("degenerate_triangles"), 0);
  EXPECT_EQ(file.at("non_finite_vertices"), 0);
  EXPECT_EQ(file.at("watertight"), true);
  EXPECT_TRUE(file.at("warnings").is_array());
}

/// Number of times that a text holds another.
std::size_t times(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

TEST(Inspect, DrawsOutlinesByHeightOfAMeshAndOfItsModel) {
  const Workplace place;
  // Between 0.2 and 1.5 m: six bands, of which the last is taken up to 1.5 m.
  place.write("box.obj", cli_test::box_obj("body", -1, -0.9, 0.2, 3, 0.9, 1.5));
  ASSERT_EQ(place.crashrank({"inspect", "box.obj", "--profile", "mesh.svg"}).code, 0);
  const std::string picture = place.read("mesh.svg");
  EXPECT_EQ(picture.rfind("<svg ", 0), 0U);
  EXPECT_EQ(times(picture, "<g "), 6U);
  EXPECT_EQ(times(picture, "1.2 to 1.6 m: body from 1.20 to 1.50 m, 2.16 m"), 1U);
  ASSERT_EQ(place.crashrank({"compile", "box.obj", "-o", "box.crm"}).code, 0);
  ASSERT_EQ(place.crashrank({"inspect", "box.crm", "--profile", "model.svg"}).code, 0);
  const std::string of_model = place.read("model.svg");
  EXPECT_EQ(of_model.substr(of_model.find("<g ")), picture.substr(picture.find("<g ")));
  place.write("high.obj", cli_test::box_obj("sign", -1, -1, 5, 1, 1, 6));
  ASSERT_EQ(place.crashrank({"inspect", "high.obj", "--profile", "high.svg"}).code, 0);
  EXPECT_NE(place.read("high.svg").find("nothing between 0 and 4 m"), std::string::npos);
  EXPECT_EQ(times(place.read("high.svg"), " m, forward to the right"), 0U);
}

/// The pixels of a PNG of 1200 x 900, from the row of the topmost view on: below the words.
std::vector<unsigned char> views_of(const std::string& bytes) {
  constexpr std::size_t rows_of_words = 70;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  std::vector<unsigned char> pixels(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0) << image.message;
  EXPECT_EQ(image.width, 1200U);
  EXPECT_EQ(image.height, 900U);
  return {pixels.begin() + rows_of_words * 3 * 1200, pixels.end()};
}

TEST(Inspect, DrawsThreeViewsOfAMeshAndOfItsModelAsAPng) {
  const Workplace place;
  place.write("box.obj", cli_test::box_obj("body", -1, -0.9, 0.2, 3, 0.9, 1.5));
  const Outcome run = place.crashrank({"inspect", "box.obj", "--picture", "mesh.png"});
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string bytes = place.read("mesh.png");
  views_of(bytes);
  ASSERT_EQ(place.crashrank({"compile", "box.obj", "-o", "box.crm"}).code, 0);
  ASSERT_EQ(place.crashrank({"inspect", "box.crm", "--picture", "model.png"}).code, 0);
  EXPECT_TRUE(place.read("model.png") == bytes);
}

TEST(Inspect, APictureShowsTheMeshAsItWillBeUsed) {
  const Workplace place;
  // y forward, in millimetres; the rear axle of a car of 5 m at -1.5 m.
  place.write("car.obj", cli_test::box_obj("car", -900, -2500, 0, 900, 2500, 1500));
  const Outcome guessed = place.crashrank({"inspect", "car.obj", "--picture", "guessed.png"});
  ASSERT_EQ(guessed.code, 0) << guessed.err;
  EXPECT_NE(guessed.out.find("rear axle, so read, at x = -1.5 m, wheelbase 3 m, where it "
                             "usually is; --origin -1.5,0,0 puts the origin below it\n"),
            std::string::npos)
      << guessed.out;
  const Json vehicle =
      place.crashrank({"inspect", "car.obj", "--json"}).json()["files"][0]["vehicle"];
  EXPECT_EQ(vehicle["guessed"], true);
  EXPECT_EQ(vehicle["scale"], 0.001);
  EXPECT_EQ(vehicle["forward"], "+y");
  EXPECT_EQ(vehicle["front_known"], false);
  EXPECT_EQ(vehicle["origin_m"], Json({-1.5, 0.0, 0.0}));
  const auto draw = [&](const std::string& forward) {
    const Outcome run =
        place.crashrank({"inspect", "car.obj", "--scale", "0.001", "--forward", forward, "--origin",
                         forward == "+y" ? "-1.5,0,0" : "0,0,0", "--picture", "given.png"});
    EXPECT_EQ(run.code, 0) << run.err;
    return views_of(place.read("given.png"));
  };
  EXPECT_TRUE(views_of(place.read("guessed.png")) == draw("+y"));
  EXPECT_FALSE(views_of(place.read("guessed.png")) == draw("+x"));
  // The caption says which.
  ASSERT_EQ(place
                .crashrank({"inspect", "car.obj", "--scale", "0.001", "--forward", "+y", "--origin",
                            "-1.44,0,0", "--picture", "given.png"})
                .code,
            0);
  EXPECT_FALSE(place.read("given.png") == place.read("guessed.png"));
}

TEST(Inspect, PicturesThatCannotBeDrawnOrWrittenAreRefused) {
  const Workplace place;
  place.write("box.obj", cli_test::box_obj("body", -1, -0.9, 0.2, 3, 0.9, 1.5));
  place.write("notes.txt", "kept\n");
  using Words = std::vector<std::string>;
  for (const std::string option : {"--picture", "--profile"}) {
    for (const auto& [words, reason] : std::vector<std::pair<Words, std::string>>{
             {{"box.obj", "box.obj", option, "x"}, option + " draws one mesh"},
             {{"box.obj", option, "-"}, option + " needs a file"},
             {{"box.obj", option, "box.obj"}, "would be written over what is read"},
             {{"box.obj", option, "notes.txt"}, "notes.txt"},
             {{"box.obj", option, "no/x"}, "no/x: cannot write"},
             {{"box.obj", "--picture", "x", "--profile", "./x"}, "name the same file"}}) {
      SCOPED_TRACE(reason);
      Words arguments{"inspect"};
      arguments.insert(arguments.end(), words.begin(), words.end());
      const Outcome run = place.crashrank(arguments);
      EXPECT_NE(run.code, 0);
      EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
      EXPECT_NE(run.err.find(reason), std::string::npos) << run.err;
    }
  }
  EXPECT_EQ(place.read("notes.txt"), "kept\n");
}

TEST(Inspect, BodiesThatACrashDoesNotSeeAreTold) {
  const Workplace place;
  const std::string unseen = "no material between 0.1 and 4 m over the ground";
  const std::string faces = "f 1 2 3\nf 1 3 4\n";
  place.write("box.obj", cli_test::box_obj("body", -1, -0.9, 0, 3, 0.9, 1.5));
  place.write("high.obj", cli_test::box_obj("sign", -1, -1, 5, 1, 1, 6));
  place.write("plate.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n" + faces);
  place.write("sheet.obj", "v 0 0 0\nv 0 2 0\nv 0 2 1\nv 0 0 1\n" + faces);
  for (const auto& [mesh, told] : std::vector<std::pair<std::string, std::string>>{
           {"box", ""},
           {"high", unseen},
           {"plate", "the mesh is flat, without extent along z: " + unseen},
           {"sheet", "the mesh is flat, without extent along x: as a body it encloses nothing"}}) {
    SCOPED_TRACE(mesh);
    const Outcome compiled = place.crashrank({"compile", mesh + ".obj", "-o", mesh + ".crm"});
    EXPECT_EQ(compiled.code, 0) << compiled.err;
    EXPECT_EQ(compiled.err.empty(), told.empty()) << compiled.err;
    EXPECT_NE(compiled.err.find(told), std::string::npos) << compiled.err;
    for (const char* extension : {".obj", ".crm"}) {
      const Json file = place.crashrank({"inspect", mesh + extension, "--json"}).json()["files"][0];
      ASSERT_EQ(file["warnings"].size(), told.empty() ? 0U : 1U) << file["warnings"];
      if (told.empty()) continue;
      EXPECT_EQ(file["warnings"][0].get<std::string>().rfind(told, 0), 0U);
    }
  }
}

TEST(Inspect, TheMeshOptionsTurnAndScale) {
  const Workplace place;
  // y up, -z forward, millimetres: 4 m long, 1.8 m wide, 1.3 m high.
  place.write("box.obj", cli_test::box_obj("body", 0, 0, -4000, 1800, 1300, 0));
  const Outcome run = place.crashrank(
      {"inspect", "box.obj", "--json", "--scale", "0.001", "--up", "+y", "--forward", "-z"});
  ASSERT_EQ(run.code, 0) << run.err;
  const std::vector<double> extent = run.json()["files"][0]["extent_m"];
  EXPECT_NEAR(extent[0], 4.0, 1e-6);
  EXPECT_NEAR(extent[1], 1.8, 1e-6);
  EXPECT_NEAR(extent[2], 1.3, 1e-6);
}

TEST(Inspect, TheBoundingBoxAndAHintForTurnedVehiclesArePrinted) {
  const Workplace place;
  place.write("side.obj", cli_test::box_obj("body", -0.9, -1, 0.2, 0.9, 3, 1.5));
  const Outcome side = place.crashrank({"inspect", "side.obj"});
  EXPECT_NE(side.out.find("  x -0.9 to 0.9, y -1 to 3, z 0.2 to 1.5 m\n"), std::string::npos)
      << side.out;
  EXPECT_NE(
      side.out.find(
          "read it with --scale 1 --up +z --forward +y, guessed by its size (or with the opposite"),
      std::string::npos)
      << side.out;
  // y up, as in glTF; what the hint says mends it.
  place.write("tall.obj", cli_test::box_obj("body", -0.9, 0.2, -1, 0.9, 1.5, 3));
  const Outcome tall = place.crashrank({"inspect", "tall.obj", "--json"});
  const std::string hint = tall.json()["files"][0]["orientation_hint"];
  EXPECT_NE(hint.find("read it with --scale 1 --up +y --forward +z, guessed by its size"),
            std::string::npos);
  for (const std::vector<std::string>& axes :
       std::vector<std::vector<std::string>>{{"tall.obj", "--forward", "+z", "--up", "+y"},
                                             {"side.obj", "--forward", "+y", "--up", "+z"}}) {
    std::vector<std::string> arguments{"inspect", "--json"};
    arguments.insert(arguments.end(), axes.begin(), axes.end());
    EXPECT_TRUE(place.crashrank(arguments).json()["files"][0]["orientation_hint"].is_null());
  }
  // Neither a wall nor what is too small for a vehicle.
  place.write("wall.obj", cli_test::box_obj("wall", 0, -5, 0, 0.25, 5, 2.5));
  place.write("crate.obj", cli_test::box_obj("crate", 0, 0, 0, 0.6, 1.2, 1));
  for (const std::string file : {"wall.obj", "crate.obj"}) {
    EXPECT_EQ(place.crashrank({"inspect", file}).out.find("hint"), std::string::npos) << file;
  }
}

TEST(Inspect, SizesNoRoadUserHasAreWarnedAbout) {
  const Workplace place;
  place.write("huge.obj", cli_test::box_obj("body", 0, 0, 0, 4000, 1800, 1300));
  const Outcome run = place.crashrank({"inspect", "huge.obj", "--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_FALSE(run.json()["files"][0]["warnings"].empty());
}

TEST(Inspect, StandardInputIsReadWhenItsFormatIsSaid) {
  const Workplace place;
  const std::string obj = cli_test::box_obj("body", 0, 0, 0, 1, 1, 1);
  const Outcome run = place.crashrank({"inspect", "-", "--format", "obj", "--json"}, obj);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.json()["files"][0]["file"], "-");
  EXPECT_EQ(run.json()["files"][0]["triangles"], 12);
}

TEST(Inspect, StandardInputIsNeverCalledByItsTemporaryName) {
  const Workplace place;
  const std::string off = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n";
  const Outcome good = place.crashrank({"inspect", "-", "--format", "off", "--json"}, off);
  ASSERT_EQ(good.code, 0) << good.err;
  EXPECT_EQ(good.json()["files"][0]["parts"][0]["name"], "stdin");
  for (const std::string& format :
       std::vector<std::string>{"obj", "stl", "glb", "off", "nonsense"}) {
    for (const std::string& input : std::vector<std::string>{"", "garbage", "v 0 0 0\nf 1 2 9\n"}) {
      const Outcome bad = place.crashrank({"inspect", "-", "--format", format}, input);
      EXPECT_EQ(bad.code, 3) << format << bad.out;
      EXPECT_EQ((bad.out + bad.err).find("crashrank-"), std::string::npos) << bad.out << bad.err;
      EXPECT_NE(bad.err.find("standard input"), std::string::npos) << bad.err;
    }
  }
}

TEST(Inspect, OneBadFileDoesNotHideTheOthers) {
  const Workplace place;
  place.write("good.obj", cli_test::box_obj("body", 0, 0, 0, 1, 1, 1));
  place.write("bad.obj", "v 0 0 0\n");
  const Outcome run = place.crashrank({"inspect", "missing.obj", "good.obj", "bad.obj", "--json"});
  EXPECT_EQ(run.code, 3);
  ASSERT_EQ(run.json()["files"].size(), 1U);
  EXPECT_EQ(run.json()["files"][0]["file"], "good.obj");
  EXPECT_NE(run.err.find("missing.obj"), std::string::npos);
  EXPECT_NE(run.err.find("bad.obj"), std::string::npos);
}

TEST(Inspect, EveryBadInputIsExitThreeAndOneLineThatNamesIt) {
  const Workplace place;
  place.write("empty.obj", "");
  place.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  place.write("garbage.stl", std::string(400, '\xa5'));
  place.write("cut.glb", std::string("glTF\x02\0\0\0\xff\0\0\0", 12));
  place.write("huge.obj", "v 0 0 0\nv 1e39 0 0\nv 0 1 0\nf 1 2 3\n");
  place.write("unknown.xyz", "nothing known");
  for (const std::string& file :
       std::vector<std::string>{"empty.obj", "points.obj", "garbage.stl", "cut.glb", "huge.obj",
                                "unknown.xyz", "missing.obj", "."}) {
    SCOPED_TRACE(file);
    const Outcome run = place.crashrank({"inspect", file});
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_TRUE(cli_test::is_one_message(run.err)) << run.err;
    EXPECT_NE(run.err.find(file), std::string::npos) << run.err;
  }
}

TEST(Inspect, HostileNamesReachTheTerminalEscaped) {
  const Workplace place;
  std::string obj = cli_test::box_obj("door\x1b[31m<b>\"quoted\",\xff", 0, 0, 0, 1, 1, 1);
  place.write("evil.obj", obj);
  place.write("name\x1b[2J.obj", obj);
  const Outcome text = place.crashrank({"inspect", "evil.obj"});
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_EQ(text.out.find('\x1b'), std::string::npos);
  EXPECT_NE(text.out.find("<b>"), std::string::npos);
  const Outcome json = place.crashrank({"inspect", "evil.obj", "--json"});
  ASSERT_EQ(json.code, 0) << json.err;
  EXPECT_EQ(json.out.find('\x1b'), std::string::npos);
  const std::string name = json.json()["files"][0]["parts"][0]["name"];
  EXPECT_NE(name.find("<b>\"quoted\","), std::string::npos);
  const Outcome file = place.crashrank({"inspect", "name\x1b[2J.obj"});
  EXPECT_EQ(file.out.find('\x1b'), std::string::npos);
  const Outcome missing = place.crashrank({"inspect", "miss\x1b[2J\n.obj"});
  EXPECT_EQ(missing.code, 3);
  EXPECT_TRUE(cli_test::is_one_message(missing.err)) << missing.err;
}

}  // namespace
