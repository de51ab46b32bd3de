#include "crashrank/crash/injury.hpp"

#include "base/random.hpp"
#include "tree/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace crashrank {
namespace {

constexpr double kmh = 1.0 / 3.6;
constexpr Person persons[] = {Person::occupant, Person::pedestrian, Person::cyclist,
                              Person::motorcyclist};
constexpr RiskModel models[] = {RiskModel::tum, RiskModel::malliaris_monfort,
                                RiskModel::malliaris_rosen, RiskModel::joksch_monfort};

Exposure occupant(double v, double pdof) {
  Exposure e;
  e.delta_v_mps = v;
  e.direction = force_direction(pdof);
  return e;
}

Exposure outside(Person person, double v, double edge = 0.75) {
  Exposure e;
  e.person = person;
  e.impact_speed_mps = v;
  e.leading_edge_m = edge;
  return e;
}

double logistic(double z) { return 1.0 / (1.0 + std::exp(-z)); }

/// Published logistic curve with argument z, transformed to be zero at its argument z0 of zero
/// exposure.
double through_zero(double z, double z0) {
  return (logistic(z) - logistic(z0)) / (1.0 - logistic(z0));
}

TEST(Injury, PublishedValuesAreReproduced) {
  // Rosén & Sander: 1.5, 3.6, 8.3 and 18.2 % at 30, 40, 50 and 60 km/h, before the transformation.
  const double at[][2] = {{30, 0.015}, {40, 0.036}, {50, 0.083}, {60, 0.182}};
  const double remainder = logistic(-6.9);
  for (const auto& [speed, risk] : at) {
    const double p =
        injury_risk(RiskModel::malliaris_rosen, outside(Person::pedestrian, speed * kmh));
    EXPECT_NEAR(p * (1.0 - remainder) + remainder, risk, 0.001);
  }
  EXPECT_NEAR(injury_risk(RiskModel::joksch_monfort, occupant(31.74 / 2, 0)), 1.0 / 16, 1e-12);
  EXPECT_EQ(injury_risk(RiskModel::joksch_monfort, occupant(40, 0)), 1.0);
  EXPECT_NEAR(injury_risk(RiskModel::tum, occupant(4.457 / 0.177, 0)), through_zero(0.0, -4.457),
              1e-12);
  EXPECT_NEAR(injury_risk(RiskModel::tum, occupant(10, 90)), through_zero(-2.443, -4.213), 1e-12);
  EXPECT_NEAR(injury_risk(RiskModel::tum, occupant(10, 180)), through_zero(-3.118, -4.888), 1e-12);
  EXPECT_NEAR(injury_risk(RiskModel::malliaris_monfort, occupant(20 * 0.44704, 90)),
              through_zero(-1.224, -5.264), 1e-12);
}

TEST(Injury, TenPercentAtTheSpeedsOfLubbe) {
  EXPECT_NEAR(injury_risk(RiskModel::tum, outside(Person::pedestrian, 29 * kmh)), 0.1, 1e-12);
  EXPECT_NEAR(injury_risk(RiskModel::tum, outside(Person::cyclist, 44 * kmh)), 0.1, 1e-12);
  EXPECT_NEAR(injury_risk(RiskModel::tum, outside(Person::motorcyclist, 48 * kmh)), 0.1, 1e-12);
}

TEST(Injury, RiskAtTouchingSpeedIsSmall) {
  for (const double pdof : {0.0, 45.0, 90.0, 135.0, 180.0}) {
    EXPECT_LE(injury_risk(RiskModel::tum, occupant(0.3, pdof)), 0.002);
  }
  EXPECT_LE(injury_risk(RiskModel::tum, outside(Person::pedestrian, 0.3)), 0.005);
  EXPECT_LE(injury_risk(RiskModel::tum, outside(Person::pedestrian, 1.0)), 0.02);
}

TEST(Injury, RiskRisesWithSpeedAndStaysAProbability) {
  for (const RiskModel model : models) {
    for (const Person person : persons) {
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

/// A random person, direction, leading edge and description, with exposures up to a risk of nearly
/// 1.
Exposure random_exposure(test::Random& random) {
  Exposure e;
  e.person = persons[random.below(4)];
  e.delta_v_mps = random.uniform(0, 50);
  e.direction = force_direction(random.uniform(0, 360));
  e.impact_speed_mps = random.uniform(0, 50);
  e.leading_edge_m = random.uniform(0.2, 1.6);
  e.intrusion_m = random.below(2) != 0 ? random.uniform(0, 0.8) : 0.0;
  if (random.below(2) != 0) e.description.age_years = random.uniform(0, 100);
  if (random.below(2) != 0) e.description.male_share = random.uniform(0, 1);
  return e;
}

TEST(Injury, RiskIsZeroAtZeroContinuousAndMonotone) {
  constexpr std::uint64_t seed = 31;
  test::Random random(seed);
  for (int i = 0; i < 20000; ++i) {
    const Exposure e = random_exposure(random);
    for (const RiskModel model : models) {
      const std::string where = "seed " + std::to_string(seed) + ", case " + std::to_string(i) +
                                ", " + risk_model_name(model);
      const double risk = injury_risk(model, e);
      ASSERT_GE(risk, 0.0) << where;
      ASSERT_LE(risk, 1.0) << where;
      Exposure more = e;
      more.delta_v_mps += random.uniform(0, 2);
      more.impact_speed_mps += random.uniform(0, 2);
      ASSERT_GE(injury_risk(model, more), risk) << where;
      more.intrusion_m += random.uniform(0, 0.1);
      ASSERT_GE(injury_risk(model, more), risk) << where;
      ASSERT_LE(risk, most_injury_risk(model, e) * (1.0 + 1e-14)) << where;
      Exposure next = e;
      next.delta_v_mps += 1e-6;
      next.impact_speed_mps += 1e-6;
      next.intrusion_m += 1e-6;
      ASSERT_LT(injury_risk(model, next) - risk, 5e-6) << where;
      Exposure none = e;
      none.delta_v_mps = none.impact_speed_mps = none.intrusion_m = 0.0;
      ASSERT_EQ(injury_risk(model, none), 0.0) << where;
    }
  }
}

TEST(Injury, RiskIsContinuousInTheDirection) {
  for (const RiskModel model : models) {
    // Bound from the steepest blend, Malliaris between rear and side: (1.462 + 1.921) · 0.01
    // degrees · 0.25.
    const double most = model == RiskModel::tum ? 1e-4 : 1.5e-4;
    const auto step = [&](double v, double pdof, double by) {
      return std::abs(injury_risk(model, occupant(v, pdof + by)) -
                      injury_risk(model, occupant(v, pdof)));
    };
    for (double v = 0.5; v < 50; v += 0.5) {
      for (double pdof = 0.0; pdof < 360.0; pdof += 0.5) {
        ASSERT_LT(step(v, pdof, 0.01), most) << pdof << " degrees, " << v << " m/s";
      }
      for (const double corner : {45.0, 135.0, 225.0, 315.0}) {
        EXPECT_LT(step(v, corner - 0.005, 0.01), most);
        EXPECT_LT(step(v, corner - 5e-7, 1e-6), 1e-4 * most);
      }
    }
  }
}

TEST(Injury, PureDirectionsAreTheExtremes) {
  for (const RiskModel model : models) {
    for (double v = 0.5; v < 50; v += 1.5) {
      double least = 1.0;
      double most = 0.0;
      for (const double pdof : {0.0, 90.0, 180.0}) {
        least = std::min(least, injury_risk(model, occupant(v, pdof)));
        most = std::max(most, injury_risk(model, occupant(v, pdof)));
      }
      for (int pdof = 0; pdof < 360; ++pdof) {
        const double risk = injury_risk(model, occupant(v, pdof));
        EXPECT_GE(risk, least * (1.0 - 1e-14));
        EXPECT_LE(risk, most * (1.0 + 1e-14));
      }
      EXPECT_EQ(most_injury_risk(model, occupant(v, 10)), most);
    }
  }
}

TEST(Injury, LargestRiskOverLeadingEdgesIsEnclosed) {
  for (const RiskModel model : models) {
    for (double v = 0.5; v < 30; v += 0.25) {
      double most = 0.0;
      for (double edge = 0.5; edge < 1.3; edge += 0.001) {
        most = std::max(most, injury_risk(model, outside(Person::pedestrian, v, edge)));
      }
      most = std::max(most, injury_risk(model, outside(Person::pedestrian, v, 1.3)));
      const double bound = most_injury_risk(model, outside(Person::pedestrian, v));
      EXPECT_GE(bound, most * (1.0 - 1e-14)) << v;
      EXPECT_LE(bound, most * (1.0 + 1e-5)) << v;
    }
    for (const double v : {1e-15, 1e-10, 1e-5, 1e-2}) {
      const double bound = most_injury_risk(model, outside(Person::pedestrian, v));
      for (double edge = 0.5; edge < 1.3; edge += 0.01) {
        EXPECT_GE(bound, injury_risk(model, outside(Person::pedestrian, v, edge)) * (1.0 - 1e-14));
      }
    }
  }
}

TEST(Injury, IntrusionMultipliesTheOdds) {
  for (const RiskModel model : models) {
    Exposure e = occupant(6, 30);
    const double without = injury_risk(model, e);
    e.intrusion_m = 0.15;
    EXPECT_GT(injury_risk(model, e), 1.5 * without);
    EXPECT_LT(injury_risk(model, e), 3.5 * without);
    e.person = Person::pedestrian;
    EXPECT_EQ(injury_risk(model, e), 0.0);
  }
  Exposure pushed_in;
  pushed_in.intrusion_m = 0.3;
  EXPECT_NEAR(injury_risk(RiskModel::tum, pushed_in), through_zero(-4.457 + std::log(4.0), -4.457),
              1e-6);
}

TEST(Injury, AgeAndSexMatterOnlyInCurvesThatUseThem) {
  for (const RiskModel model : models) {
    Exposure e = outside(Person::pedestrian, 11);
    const double mean = injury_risk(model, e);
    e.description.age_years = 42.42;
    e.description.male_share = 0.59;
    const bool monfort =
        model == RiskModel::malliaris_monfort || model == RiskModel::joksch_monfort;
    if (monfort) {
      EXPECT_NEAR(injury_risk(model, e), mean, 1e-12);
    }
    e.description.male_share.reset();
    e.description.age_years = 20;
    const double young = injury_risk(model, e);
    e.description.age_years = 80;
    const double old = injury_risk(model, e);
    if (model == RiskModel::tum) {
      EXPECT_EQ(old, young);
    } else {
      EXPECT_GT(old, 1.5 * young);
    }
    e.person = Person::cyclist;
    EXPECT_EQ(injury_risk(model, e), injury_risk(model, outside(Person::cyclist, 11)));
  }
  Exposure old = outside(Person::pedestrian, 50 * kmh);
  old.description.age_years = 70;
  EXPECT_NEAR(injury_risk(RiskModel::malliaris_rosen, old),
              through_zero(-9.1 + 0.095 * 50 + 0.040 * 70, -9.1 + 0.040 * 70), 1e-12);
  Exposure man = outside(Person::pedestrian, 11);
  Exposure woman = man;
  man.description.male_share = 1.0;
  woman.description.male_share = 0.0;
  EXPECT_GT(injury_risk(RiskModel::joksch_monfort, man),
            injury_risk(RiskModel::joksch_monfort, woman));
  EXPECT_LT(injury_risk(RiskModel::malliaris_monfort, man),
            injury_risk(RiskModel::malliaris_monfort, woman));
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
  // For a block it is the upper front edge, if the leaning edge reaches that high.
  EXPECT_NEAR(leading_edge_m(test::box_mesh({2, 0.9, 0.4}, {0, 0, 0.4}, 8)), 0.8, 1e-6);
  EXPECT_NEAR(leading_edge_m(test::box_mesh({2, 0.9, 0.2}, {0, 0, 0.2}, 8)), 0.4, 1e-6);
  // For a bonnet with a cabin behind it, the front edge of the bonnet.
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
