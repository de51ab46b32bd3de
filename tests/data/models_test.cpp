#include "catalogue.hpp"
#include "obj.hpp"
#include "tidy.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

using generate::Entry;
using generate::Model;
using generate::NamedMesh;
using generate::Vec3;

std::string contents(const std::string& name) {
  std::ifstream file(std::string(CRASHRANK_MODELS) + "/" + name, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const Entry& entry_named(const std::string& name) {
  for (const Entry& entry : generate::catalogue()) {
    if (entry.name == name) return entry;
  }
  ADD_FAILURE() << "no model named " << name;
  return generate::catalogue().front();
}

// Each model at its shipped size is made once for all tests.
const Model& shipped(const std::string& name) {
  static std::map<std::string, Model> made;
  const auto known = made.find(name);
  if (known != made.end()) return known->second;
  const Entry& entry = entry_named(name);
  return made.emplace(name, build_sized(entry, entry.triangles)).first->second;
}

class Models : public testing::TestWithParam<std::string> {};

TEST_P(Models, CheckedInFileIsWhatTheGeneratorWrites) {
  const Entry& entry = entry_named(GetParam());
  const Model& model = shipped(entry.name);
  EXPECT_TRUE(contents(entry.name + ".obj") == to_obj(model, about(entry)))
      << "run `cmake --build DIR --target data` and look at what changed";
  const auto table = nlohmann::ordered_json::parse(contents("models.json"));
  const auto expected = nlohmann::ordered_json::parse(to_json(entry, model));
  const auto& rows = table.at("models");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), expected), 1);
  EXPECT_NE(contents("README.md").find("\n" + to_row(entry, model)), std::string::npos);
}

TEST_P(Models, HasNoDegenerateTriangleAndFewNeedles) {
  const Model& model = shipped(GetParam());
  std::size_t needles = 0;
  std::set<std::string> names;
  for (const NamedMesh& part : model.parts) {
    EXPECT_TRUE(names.insert(part.name).second) << part.name;
    for (const auto& t : part.mesh.triangles) {
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = part.mesh.vertices[static_cast<std::size_t>(t[k])];
        ASSERT_TRUE(p[k].allFinite());
      }
      const double fatness = generate::fatness(p[0], p[1], p[2]);
      EXPECT_GT(fatness, 0.005) << part.name;
      EXPECT_GT((p[1] - p[0]).cross(p[2] - p[0]).norm(), 1e-6) << part.name;
      if (fatness < 0.08) ++needles;
    }
  }
  EXPECT_LT(static_cast<double>(needles), 0.01 * static_cast<double>(model.triangle_count()));
}

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const Entry& entry : generate::catalogue()) names.push_back(entry.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, Models, testing::ValuesIn(all_names()),
                         [](const auto& tested) { return tested.param; });

TEST(Catalogue, TheTableOfModelsIsThatOfTheGenerator) {
  std::vector<std::string> names;
  const auto table = nlohmann::json::parse(contents("models.json"));
  for (const auto& row : table.at("models")) names.push_back(row.at("name"));
  EXPECT_EQ(names, all_names());
}

// Of lorries and their trailers in Directive 96/53/EC, m.
TEST(Catalogue, TheSemiTrailerKeepsToTheLegalLimitsAndIsOpenBelowAndAhead) {
  const Model& model = shipped("semitrailer");
  const auto json = nlohmann::json::parse(to_json(entry_named("semitrailer"), model));
  EXPECT_NEAR(json.at("length_m").get<double>(), 16.50, 0.01);
  EXPECT_LE(json.at("width_m").get<double>(), 2.55);
  EXPECT_LE(json.at("height_m").get<double>(), 4.00);
  constexpr double trailer_wheels_end_m = 2.0;
  constexpr double tractor_begins_m = 5.8;
  constexpr double box_front_m = 9.3;
  constexpr double cab_rear_m = 10.0;
  for (const NamedMesh& part : model.parts) {
    for (const Vec3& v : part.mesh.vertices) {
      // Frames and shafts alone join tractor and trailer; what is lower than a car's bonnet under
      // the trailer can be run under.
      if (v.x() > box_front_m && v.x() < cab_rear_m) {
        EXPECT_LT(v.z(), 1.2) << part.name;
      }
      if (v.x() > trailer_wheels_end_m && v.x() < tractor_begins_m && v.z() < 0.8) {
        EXPECT_EQ(part.name.rfind("landing_leg", 0), 0U) << part.name;
      }
    }
  }
}

TEST(Catalogue, CarsAreOfTheSizeOfRealOnesAndSymmetric) {
  for (const char* const name : {"hatch", "sedan"}) {
    const Entry& entry = entry_named(name);
    const Model model = build_sized(entry, 8000);
    const auto json = nlohmann::json::parse(to_json(entry, model));
    EXPECT_NEAR(json.at("length_m").get<double>(), entry.wheelbase_m + 1.8, 0.3) << name;
    EXPECT_NEAR(json.at("width_m").get<double>(), 1.8, 0.08) << name;
    EXPECT_NEAR(json.at("height_m").get<double>(), 1.47, 0.04) << name;
    const auto part = [&](const std::string& wanted) -> const NamedMesh& {
      const auto found = std::find_if(model.parts.begin(), model.parts.end(),
                                      [&](const NamedMesh& p) { return p.name == wanted; });
      EXPECT_NE(found, model.parts.end()) << wanted;
      return *found;
    };
    for (const char* const pair :
         {"door_front", "door_rear", "fender", "wheel_front", "headlamp", "window_front"}) {
      const generate::Mesh& left = part(std::string(pair) + "_left").mesh;
      const generate::Mesh& right = part(std::string(pair) + "_right").mesh;
      ASSERT_EQ(left.vertices.size(), right.vertices.size()) << pair;
      for (std::size_t i = 0; i < left.vertices.size(); ++i) {
        EXPECT_EQ(left.vertices[i].y(), -right.vertices[i].y());
        EXPECT_EQ(left.vertices[i].x(), right.vertices[i].x());
        EXPECT_GT(left.vertices[i].y(), 0.0);
      }
    }
    for (const char* const one : {"hood", "roof", "windshield", "front_bumper", "rear_bumper"}) {
      EXPECT_FALSE(part(one).mesh.triangles.empty());
    }
  }
}

TEST(Catalogue, SameShapeAtFourResolutions) {
  const Entry& entry = entry_named("hatch");
  double last_length = 0.0;
  for (const int wanted : {8000, 12000, 18000, 27000}) {
    const Model model = build_sized(entry, static_cast<std::size_t>(wanted));
    const double count = static_cast<double>(model.triangle_count());
    EXPECT_NEAR(count, wanted, 0.03 * wanted);
    const auto json = nlohmann::json::parse(to_json(entry, model));
    const double length = json.at("length_m").get<double>();
    if (last_length > 0.0) {
      EXPECT_NEAR(length, last_length, 0.02);
    }
    last_length = length;
  }
}

}  // namespace
