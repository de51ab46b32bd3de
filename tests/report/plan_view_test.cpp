#include "report/plan_view.hpp"

#include "crashrank/model/make_model.hpp"
#include "crashrank/report/ranking.hpp"
#include "tree/shapes.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace crashrank::detail {
namespace {

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

TEST(ConvexHull, IsConvexAndHoldsEveryPoint) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 200; ++round) {
    std::vector<Eigen::Vector2d> points;
    const std::size_t n = 1 + random() % 40;
    // Small integers: many points coincide or stand in line, and every turn is exact.
    for (std::size_t i = 0; i < n; ++i) {
      points.emplace_back(static_cast<double>(random() % 9), static_cast<double>(random() % 9));
    }
    const Outline hull = convex_hull(points);
    ASSERT_FALSE(hull.empty());
    if (hull.size() < 3) continue;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d& a = hull[i];
      const Eigen::Vector2d& b = hull[(i + 1) % hull.size()];
      EXPECT_GT(turn(a, b, hull[(i + 2) % hull.size()]), 0.0) << "round " << round;
      for (const Eigen::Vector2d& point : points) {
        EXPECT_GE(turn(a, b, point), 0.0) << "round " << round;
      }
    }
  }
}

TEST(ConvexHull, OfPointsInLineIsTheirEnds) {
  const Outline hull = convex_hull({{1, 1}, {3, 3}, {2, 2}, {0, 0}, {3, 3}});
  ASSERT_EQ(hull.size(), 2U);
  EXPECT_EQ(hull[0], Eigen::Vector2d(0, 0));
  EXPECT_EQ(hull[1], Eigen::Vector2d(3, 3));
}

/// Letters and their place: x, y and the text of every label.
struct Label {
  double x;
  double y;
  std::string text;
};

std::vector<Label> labels_of(const std::string& svg) {
  std::vector<Label> labels;
  for (std::size_t at = 0; (at = svg.find("<text x='", at)) != std::string::npos; ++at) {
    const std::size_t y = svg.find("y='", at) + 3;
    const std::size_t text = svg.find('>', at) + 1;
    labels.push_back({std::strtod(&svg[at + 9], nullptr), std::strtod(&svg[y], nullptr),
                      svg.substr(text, svg.find('<', text) - text)});
  }
  return labels;
}

TEST(ScenarioPlan, LabelsLieWithinThePage) {
  Scenario scenario;
  scenario.models.resize(1);
  std::vector<Model> models(1);
  models[0] = *make_model(test::box_mesh({2.0, 0.9, 0.7}, {0, 0, 0.7}));
  const auto add = [&](double x, double y, const std::string& name) {
    ScenarioActor actor;
    actor.name = name;
    actor.pose.translation = {x, y, 0.0};
    scenario.actors.push_back(actor);
  };
  add(60, 0, "a saloon that waits at the far right");
  add(60, 20, std::string(128, 'w'));
  add(-3, -20, "\u4e00\u4e8c\u4e09");
  add(20, -20, "in the middle");
  const std::string svg = scenario_plan(scenario, models);
  const double width = std::strtod(&svg[svg.find("viewBox='0 0 ") + 13], nullptr);
  ASSERT_EQ(width, 640.0);
  const std::vector<Label> labels = labels_of(svg);
  ASSERT_EQ(labels.size(), 6U);  // of the ego, the actors and the scale
  for (const Label& label : labels) {
    double letters = 0.0;
    for (const char c : label.text) letters += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    EXPECT_GE(label.x, 0.0) << label.text;
    EXPECT_LE(label.x + 7.0 * letters, width) << label.text;
    EXPECT_GE(label.y, 12.0) << label.text;
  }
  EXPECT_EQ(labels[1].text, scenario.actors[0].name);
  EXPECT_NE(labels[2].text, scenario.actors[1].name);
  EXPECT_EQ(labels[2].text.substr(labels[2].text.size() - 3), "\u2026");
}

}  // namespace
}  // namespace crashrank::detail
