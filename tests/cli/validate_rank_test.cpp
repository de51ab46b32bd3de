#include "cli/program.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

// Every row of data/validation as a scenario of `crashrank rank`, which knows nothing of crash
// tests. Meshes and start positions are made here from the table.
namespace {

using cli_test::Json;
using cli_test::Outcome;
using cli_test::Workplace;

const std::string data_folder = CRASHRANK_SOURCE_DATA;
const std::string car_mesh = data_folder + "/models/sedan.obj";

using Row = std::map<std::string, std::string>;
using Point = std::array<double, 2>;

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

std::vector<Row> rows_of(const std::string& table) {
  std::ifstream file(data_folder + "/validation/" + table + ".csv");
  std::vector<std::string> header;
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> fields = fields_of(line);
    if (header.empty()) {
      header = fields;
      continue;
    }
    rows.emplace_back();
    for (std::size_t i = 0; i < fields.size(); ++i) rows.back()[header[i]] = fields[i];
  }
  return rows;
}

Json validated_rows(const Workplace& place, const std::string& table) {
  const Outcome run = place.crashrank(
      {"validate", data_folder + "/validation/" + table + ".csv", "--json", "--car", car_mesh});
  EXPECT_EQ(run.code, 0) << run.err;
  return run.json().at("rows");
}

std::string vertex_text(double x, double y, double z) {
  return fmt::format("v {:.9g} {:.9g} {:.9g}\n", static_cast<float>(x), static_cast<float>(y),
                     static_cast<float>(z));
}

/// A car's mesh as the program reads it, from its model file (docs/model-file.md): the importer
/// does not round every number of a text to the nearest float.
struct Sedan {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  explicit Sedan(const Workplace& place) {
    EXPECT_EQ(place.crashrank({"compile", car_mesh, "-o", "sedan.model"}).code, 0);
    const std::string file = place.read("sedan.model");
    std::array<std::uint32_t, 4> counts{};  // parts, bytes of names, vertices, triangles
    std::memcpy(counts.data(), file.data() + 24, sizeof counts);
    const auto section = [](std::size_t bytes) { return (bytes + 63) / 64 * 64; };
    vertices.resize(counts[2]);
    triangles.resize(counts[3]);
    const std::size_t begin =
        section(448) + section(std::size_t{8} * counts[0]) + section(counts[1]);
    std::memcpy(vertices.data(), file.data() + begin, 12 * vertices.size());
    std::memcpy(triangles.data(), file.data() + begin + section(12 * vertices.size()),
                12 * triangles.size());
  }
};

struct Mesh {
  std::string obj;
  double front_m = 0.0;  ///< greatest x
};

/// The shipped saloon with its overhangs, its wheelbase, width and height scaled by themselves;
/// both overhangs alike where the table does not state the rear one. `suffix`: of the columns.
Mesh stretched(const Sedan& sedan, const Row& row, const std::string& suffix) {
  constexpr double sedan_wheelbase = 2.8;
  constexpr double sedan_width = 1.86;
  const auto size = [&](const char* name) { return number(row, name + suffix); };
  std::array<float, 3> least{};
  std::array<float, 3> greatest{};
  for (const auto& v : sedan.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      least[i] = std::min(least[i], v[i]);
      greatest[i] = std::max(greatest[i], v[i]);
    }
  }
  const double wheelbase = size("wheelbase");
  const double overhangs = size("length") - wheelbase;
  const double sedan_front = static_cast<double>(greatest[0]) - sedan_wheelbase;
  const double sedan_rear = -static_cast<double>(least[0]);
  double rear = overhangs / (sedan_front + sedan_rear);
  double front = rear;
  if (row.count("rear_overhang" + suffix) != 0) {
    rear = size("rear_overhang") / sedan_rear;
    front = (overhangs - size("rear_overhang")) / sedan_front;
  }
  Mesh mesh;
  for (const auto& v : sedan.vertices) {
    auto x = static_cast<double>(v[0]);
    if (x < 0.0) {
      x *= rear;
    } else if (x > sedan_wheelbase) {
      x = wheelbase + (x - sedan_wheelbase) * front;
    } else {
      x *= wheelbase / sedan_wheelbase;
    }
    const double y = static_cast<double>(v[1]) * (size("width") / sedan_width);
    const double z =
        static_cast<double>(v[2]) * (size("height") / static_cast<double>(greatest[2]));
    mesh.obj += vertex_text(x, y, z);
    mesh.front_m = std::max(mesh.front_m, static_cast<double>(static_cast<float>(x)));
  }
  for (const auto& [a, b, c] : sedan.triangles) {
    mesh.obj += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return mesh;
}

std::string prism_obj(const std::vector<Point>& outline, double low, double high) {
  std::string text = "o barrier\n";
  Point middle{};
  const std::size_t n = outline.size();
  for (const Point& p : outline) {
    for (std::size_t i = 0; i < 2; ++i) middle[i] += p[i] / static_cast<double>(n);
  }
  for (const double z : {low, high}) {
    for (const Point& p : outline) text += vertex_text(p[0], p[1], z);
  }
  for (const double z : {low, high}) text += vertex_text(middle[0], middle[1], z);
  for (std::size_t i = 1; i <= n; ++i) {
    const std::size_t j = i % n + 1;
    text += fmt::format("f {0} {1} {3}\nf {0} {3} {2}\nf {4} {1} {0}\nf {5} {2} {3}\n", i, j, n + i,
                        n + j, 2 * n + 1, 2 * n + 2);
  }
  return text;
}

void add_arc(const Point& center, double radius, double from_deg, double to_deg, int pieces,
             std::vector<Point>& outline) {
  for (int i = 0; i <= pieces; ++i) {
    const double angle = (from_deg + (to_deg - from_deg) * i / pieces) * (std::numbers::pi / 180.0);
    outline.push_back({center[0] + radius * std::cos(angle), center[1] + radius * std::sin(angle)});
  }
}

/// The barriers of data/validation/README.md, their faces at x = 0.
std::string barrier_obj(const Row& row) {
  const std::string& kind = row.at("barrier");
  const double r = number(row, "radius_m");
  const double inner = number(row, "width_m") * (0.5 - number(row, "overlap"));
  std::vector<Point> outline;
  if (kind == "full") return prism_obj({{2.5, -5}, {2.5, 5}, {0, 5}, {0, -5}}, 0, 4);
  if (kind == "pole") {
    add_arc({r, inner + r}, r, 0.0, 360.0 - 360.0 / 96, 95, outline);
    return prism_obj(outline, 0.0, 2 * 1.524);
  }
  outline.push_back({0.0, inner + 1.5});
  if (kind == "deformable") {
    outline.push_back({0.0, inner});
    outline.push_back({0.54, inner});
  } else {
    const double low = kind == "flat" ? inner - r : inner;
    add_arc({r, low + r}, r, 180.0, 295.0, 48, outline);
  }
  const Point last = outline.back();
  const double slope = std::tan(25.0 * (std::numbers::pi / 180.0));
  outline.push_back({2.5, last[1] + slope * (2.5 - last[0])});
  outline.push_back({2.5, inner + 1.5});
  return kind == "deformable" ? prism_obj(outline, 0.2, 0.85) : prism_obj(outline, 0.0, 1.524);
}

/// A car's model; columns as "mass" + suffix + "_kg".
Json car_json(const Row& row, const std::string& mesh, const std::string& suffix) {
  Json model{{"mesh", mesh}, {"kind", "car"}, {"mass_kg", number(row, "mass" + suffix + "_kg")}};
  const std::string inertia = "izz" + suffix + "_kgm2";
  if (!row.at(inertia).empty()) model["yaw_inertia_kgm2"] = number(row, inertia);
  return model;
}

/// Contacts of the only candidate.
Json ranked_contacts(const Workplace& place, const Json& models, const Json& ego,
                     const Json& actor) {
  Json scenario{{"scenario_version", 1},
                {"models", models},
                {"ego", ego},
                {"actors", Json::array({actor})},
                {"candidates", {{"listed", Json::array({{{"name", "straight on"}}})}}},
                {"horizon_s", 3}};
  scenario["candidates"]["grid"] = false;
  scenario["candidates"]["add_straight_braking"] = false;
  place.write("scenario.json", scenario.dump());
  const Outcome run = place.crashrank({"rank", "scenario.json", "--json"});
  EXPECT_EQ(run.code, 0) << run.err;
  const Json ranking = run.json().at("ranking");
  EXPECT_EQ(ranking.size(), 1U);
  return ranking.at(0).at("contacts");
}

/// Severity of the first contact of the only candidate.
Json ranked(const Workplace& place, const Json& models, const Json& ego, const Json& actor) {
  return ranked_contacts(place, models, ego, actor).at(0).at("severity");
}

void expect_same(const Json& one, const char* key, const Json& other,
                 const std::string& other_key) {
  const auto p = one.at(key).get<double>();
  const auto q = other.at(other_key).get<double>();
  EXPECT_NEAR(p, q, 1e-9 * std::max(1.0, std::abs(q))) << key;
}

TEST(ValidateRank, BarrierCrashesHaveTheNumbersOfTheirScenarios) {
  const Workplace place;
  const Sedan sedan(place);
  std::size_t crashes = 0;
  for (const char* const table : {"small_overlap", "full_width"}) {
    const Json answers = validated_rows(place, table);
    const std::vector<Row> rows = rows_of(table);
    ASSERT_EQ(answers.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Row& row = rows[i];
      SCOPED_TRACE(row.at("id"));
      constexpr double run_up_m = 0.5;
      const Mesh mesh = stretched(sedan, row, "_m");
      place.write("car.obj", mesh.obj);
      place.write("barrier.obj", barrier_obj(row));
      Json barrier{{"mesh", "barrier.obj"}, {"kind", "building"}, {"surface", "steel"}};
      if (row.at("barrier") == "deformable") {
        barrier["surface"] = "rubber";
        barrier["honeycomb"] = {
            {"pressure_pa", 342000}, {"depth_m", 0.54}, {"low_m", 0.2}, {"high_m", 0.85}};
      }
      const Json contacts =
          ranked_contacts(place, {{"car", car_json(row, "car.obj", "")}, {"barrier", barrier}},
                          {{"model", "car"},
                           {"pose", {{"x_m", -run_up_m - mesh.front_m}}},
                           {"speed_mps", number(row, "speed_mps")}},
                          {{"name", "barrier"}, {"model", "barrier"}});
      const Json& severity = contacts.at(0).at("severity");
      const Json& ego = severity.at("ego");
      const Json& answer = answers.at(i);
      ASSERT_EQ(answer.at("id"), row.at("id"));
      expect_same(answer, "delta_v_mps", ego, "delta_v_mps");
      expect_same(answer, "delta_v_x_mps", ego, "delta_v_x_mps");
      expect_same(answer, "delta_v_y_mps", ego, "delta_v_y_mps");
      expect_same(answer, "yaw_rate_dps", ego, "yaw_rate_change_dps");
      expect_same(answer, "pdof_deg", ego, "pdof_deg");
      expect_same(answer, "deepest_m", ego, "crush_m");
      expect_same(answer, "duration_s", severity, "duration_s");
      expect_same(answer, "dissipated_j", severity, "dissipated_j");
      EXPECT_EQ(answer.at("slides"), severity.at("slides"));
      ++crashes;
    }
  }
  EXPECT_EQ(crashes, 12U);
}

/// A car of a pair as it moves 0.3 s before its stated position.
Json motion_json(const Row& row, const std::string& suffix) {
  constexpr double run_up_s = 0.3;
  const double speed = number(row, "speed" + suffix + "_mps");
  const double yaw_deg = number(row, "heading" + suffix + "_deg");
  const double yaw = yaw_deg * (std::numbers::pi / 180.0);
  const double back = number(row, "cg_ahead_of_rear_axle" + suffix + "_m") + run_up_s * speed;
  return {{"model", "car" + suffix},
          {"pose",
           {{"x_m", number(row, "x" + suffix + "_m") - back * std::cos(yaw)},
            {"y_m", number(row, "y" + suffix + "_m") - back * std::sin(yaw)},
            {"yaw_deg", yaw_deg}}},
          {"speed_mps", speed}};
}

TEST(ValidateRank, CarToCarCrashesHaveTheNumbersOfTheirScenariosWithEitherCarAsTheEgo) {
  const Workplace place;
  const Sedan sedan(place);
  const Json answers = validated_rows(place, "car_to_car");
  const std::vector<Row> rows = rows_of("car_to_car");
  ASSERT_EQ(rows.size(), 4U);
  ASSERT_EQ(answers.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    Json models = Json::object();
    for (const std::string suffix : {"1", "2"}) {
      const std::string name = "car" + suffix;
      place.write(name + ".obj", stretched(sedan, row, suffix + "_m").obj);
      models[name] = car_json(row, name + ".obj", suffix);
      models[name]["center_of_mass_m"] = {number(row, "cg_ahead_of_rear_axle" + suffix + "_m"), 0.0,
                                          0.5 * number(row, "height" + suffix + "_m")};
    }
    const Json& answer = answers.at(i);
    ASSERT_EQ(answer.at("id"), row.at("id"));
    for (const auto& [own, other] : {std::pair<std::string, std::string>("1", "2"), {"2", "1"}}) {
      SCOPED_TRACE(fmt::format("{}, car {} is the ego", row.at("id"), own));
      Json actor = motion_json(row, other);
      actor["name"] = "other";
      const Json severity = ranked(place, models, motion_json(row, own), actor);
      for (const auto& [number, side] : {std::pair(own, "ego"), std::pair(other, "other")}) {
        const Json& body = severity.at(side);
        expect_same(body, "delta_v_mps", answer, "delta_v" + number + "_mps");
        expect_same(body, "yaw_rate_change_dps", answer, "yaw_rate" + number + "_dps");
        expect_same(body, "pdof_deg", answer, "pdof" + number + "_deg");
        expect_same(body, "crush_m", answer, "deepest" + number + "_m");
      }
      expect_same(severity, "duration_s", answer, "duration_s");
      expect_same(severity, "dissipated_j", answer, "dissipated_j");
      EXPECT_EQ(severity.at("slides"), answer.at("slides"));
    }
  }
}

}  // namespace
