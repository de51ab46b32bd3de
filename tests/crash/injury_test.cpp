#include "crashrank/crash/injury.hpp"

#include "crash/shapes.hpp"

#include <gtest/gtest.h>

namespace crashrank {
namespace {

constexpr double kmh = 1.0 / 3.6;
constexpr RiskModel models[] = {RiskModel::tum, RiskModel::malliaris_monfort,
                                RiskModel::malliaris_rosen, RiskModel::joksch_monfort};

Exposure occupant(double v, double pdof) {
  Exposure e;
  e.delta_v_mps = v;
  e.pdof_deg = pdof;
  return e;
}

Exposure outside(Person person, double v, double edge = 0.75) {
  Exposure e;
  e.person = person;
  e.impact_speed_mps = v;
  e.leading_edge_m = edge;
  return e;
}

TEST(Injury, PublishedValuesAreReproduced) {
  // Rosén & Sander: 1.5, 3.6, 8.3 and 18.2 % at 30, 40, 50 and 60 km/h.
  const double at[][2] = {{30, 0.015}, {40, 0.036}, {50, 0.083}, {60, 0.182}};
  for (const auto& [speed, risk] : at) {
    EXPECT_NEAR(injury_risk(RiskModel::malliaris_rosen, outside(Person::pedestrian, speed * kmh)),
                risk, 0.001);
  }
  EXPECT_NEAR(injury_risk(RiskModel::joksch_monfort, occupant(31.74 / 2, 0)), 1.0 / 16, 1e-12);
  EXPECT_EQ(injury_risk(RiskModel::joksch_monfort, occupant(40, 0)), 1.0);
  EXPECT_NEAR(injury_risk(RiskModel::tum, occupant(4.457 / 0.177, 0)), 0.5, 1e-12);
  EXPECT_NEAR(injury_risk(RiskModel::tum, outside(Person::pedestrian, 3.164 / 0.288)), 0.5, 1e-12);
}

TEST(Injury, RiskRisesWithSpeedAndStaysAProbability) {
  for (const RiskModel model : models) {
    for (const Person person :
         {Person::occupant, Person::pedestrian, Person::cyclist, Person::motorcyclist}) {
      double last = 0.0;
      for (double v = 0; v < 60; v += 0.5) {
        Exposure e = outside(person, v);
        e.delta_v_mps = v;
        const double risk = injury_risk(model, e);
        ASSERT_GE(risk, last);
        ASSERT_LE(risk, 1.0);
        last = risk;
      }
      EXPECT_GT(last, 0.5);
      EXPECT_EQ(injury_risk(model, outside(person, 0.0)), 0.0);
    }
  }
}

TEST(Injury, SideIsWorseThanFrontAndRearIsBetter) {
  for (const RiskModel model :
       {RiskModel::tum, RiskModel::malliaris_monfort, RiskModel::malliaris_rosen}) {
    const double front = injury_risk(model, occupant(12, 10));
    EXPECT_GT(injury_risk(model, occupant(12, 90)), front);
    EXPECT_GT(injury_risk(model, occupant(12, 270)), front);
    EXPECT_LT(injury_risk(model, occupant(12, 180)), front);
    EXPECT_EQ(injury_risk(model, occupant(12, 350)), front);
  }
}

TEST(Injury, RidersFareBetterThanPedestriansAndHighFrontsAreWorse) {
  for (const RiskModel model : models) {
    const double walking = injury_risk(model, outside(Person::pedestrian, 10));
    const double cycling = injury_risk(model, outside(Person::cyclist, 10));
    EXPECT_LT(cycling, walking);
    EXPECT_LT(injury_risk(model, outside(Person::motorcyclist, 10)), cycling);
  }
  for (const RiskModel model : {RiskModel::malliaris_monfort, RiskModel::joksch_monfort}) {
    EXPECT_GT(injury_risk(model, outside(Person::pedestrian, 12, 1.09)),
              injury_risk(model, outside(Person::pedestrian, 12, 0.75)));
  }
}

TEST(Injury, TheLeadingEdgeIsWhereALeaningEdgeTouches) {
  // A wedge-free block: its upper front edge, if not above the reach of the edge.
  EXPECT_NEAR(leading_edge_m(test::box_mesh({2, 0.9, 0.4}, {0, 0, 0.4}, 8)), 0.8, 1e-6);
  EXPECT_NEAR(leading_edge_m(test::box_mesh({2, 0.9, 0.2}, {0, 0, 0.2}, 8)), 0.4, 1e-6);
  // Bonnet over bumper, cabin behind: the bonnet's.
  TriangleMesh car = test::box_mesh({2, 0.9, 0.35}, {0, 0, 0.35}, 8);
  const TriangleMesh cabin = test::box_mesh({0.8, 0.8, 0.3}, {-0.4, 0, 1.0}, 8);
  const auto base = static_cast<std::uint32_t>(car.vertices.size());
  for (const Eigen::Vector3f& v : cabin.vertices) car.vertices.push_back(v);
  for (const auto& t : cabin.triangles) {
    car.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  EXPECT_NEAR(leading_edge_m(car), 0.7, 1e-6);
}

TEST(Injury, ModelsAreFoundByName) {
  for (const RiskModel model : models) {
    const Result<RiskModel> found = risk_model_from_name(risk_model_name(model));
    ASSERT_TRUE(found.ok());
    EXPECT_EQ(*found, model);
  }
  EXPECT_EQ(risk_model_from_name("guess").error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace crashrank
