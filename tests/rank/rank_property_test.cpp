#include "crashrank/collide/collide.hpp"
#include "crashrank/model/make_model.hpp"
#include "crashrank/rank/rank.hpp"

#include "oracle/random.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using scenes::box_mesh;
using scenes::Scene;

// A body without symmetry: a box with a smaller one at its left front.
TriangleMesh lopsided_mesh(oracle::Random& random, int n) {
  const auto real = [&random](double low, double high) {
    return static_cast<float>(random.real(low, high));
  };
  const Eigen::Vector3f half(real(0.4, 2.4), real(0.3, 1.0), real(0.5, 0.9));
  TriangleMesh mesh = box_mesh(half, n);
  const TriangleMesh bump = box_mesh({0.3F, 0.2F, real(0.1, 0.3)}, 2,
                                     {0.8F * half.x(), 1.1F * half.y(), real(-0.2, 0.2)});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  mesh.vertices.insert(mesh.vertices.end(), bump.vertices.begin(), bump.vertices.end());
  for (auto [a, b, c] : bump.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  mesh.parts.push_back({"bump", triangles, static_cast<std::uint32_t>(bump.size())});
  return mesh;
}

// A crossing with traffic from all directions.
Scene random_scene(std::uint64_t seed, std::size_t actors = 10) {
  oracle::Random random(seed);
  Scene scene;
  scene.scenario.ego.model =
      scene.add_model("ego", lopsided_mesh(random, 4), BodyKind::car, random.real(800, 2500));
  for (int i = 0; i < 3; ++i) {
    scene.add_model("m" + std::to_string(i), lopsided_mesh(random, 3),
                    i == 0 ? BodyKind::truck : BodyKind::car);
  }
  scene.add_model("wall", lopsided_mesh(random, 2), BodyKind::barrier);
  scene.scenario.ego.pose =
      pose_from_angles({random.real(-1, 1), random.real(-1, 1), 0.0}, random.real(-3, 3), 0.0, 0.0);
  scene.scenario.ego.speed_mps = random.real(5, 30);
  scene.scenario.horizon_s = random.real(1.0, 3.0);
  scene.scenario.grid = CandidateGrid{3, 5};
  for (std::size_t i = 0; i < actors; ++i) {
    const auto model = static_cast<std::size_t>(random.integer(1, 4));
    const double range = random.real(4, 45);
    const double bearing = random.real(-3.14, 3.14);
    ScenarioActor& actor =
        scene.add_actor("actor " + std::to_string(i), model, range * std::cos(bearing),
                        range * std::sin(bearing), bearing + 3.14 + random.real(-0.4, 0.4));
    actor.pose.translation.z() = random.real(-0.1, 0.1);
    if (model == 4) continue;
    actor.speed_mps = random.real(0, 20);
    actor.acceleration_mps2 = random.real(-4, 2);
    actor.yaw_rate_radps = random.real(-0.4, 0.4);
  }
  return scene;
}

Pose mirrored(const Pose& pose) {
  const Eigen::Vector3d flip(1.0, -1.0, 1.0);
  Pose result;
  result.rotation = flip.asDiagonal() * pose.rotation * flip.asDiagonal();
  result.translation = flip.cwiseProduct(pose.translation);
  return result;
}

Scene mirrored(const Scene& scene) {
  Scene image;
  image.scenario = scene.scenario;
  Scenario& s = image.scenario;
  s.ego.pose = mirrored(s.ego.pose);
  for (ScenarioActor& actor : s.actors) {
    actor.pose = mirrored(actor.pose);
    actor.yaw_rate_radps = -actor.yaw_rate_radps;
  }
  for (const Model& model : scene.models) {
    TriangleMesh mesh = model.mesh;
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex.y() = -vertex.y();
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    image.models.push_back(*make_model(std::move(mesh)));
  }
  return image;
}

// All values of a contact to the last bit, with the actor by name.
void write(std::ostream& out, const Scenario& scenario, const Contact& c) {
  out << scenario.actors[c.actor].name << ' ' << static_cast<int>(c.state) << ' '
      << c.time_of_impact_s << ' ' << c.gap_m << ' ' << c.point_m.transpose() << ' '
      << c.normal.transpose() << ' ' << c.closing_speed_mps << ' ' << c.normal_speed_mps << ' '
      << c.closing_energy_j << ' ' << c.crush_s << ' ' << c.travel_m;
  for (const BodyDamage* damage : {&c.ego, &c.other}) {
    out << " | " << damage->area_m2 << ' ' << damage->region.min.transpose() << ' '
        << damage->region.max.transpose() << ' ' << damage->pose.translation.transpose() << ':';
    for (const auto triangle : damage->triangles) out << ' ' << triangle;
    out << ';';
    for (const auto part : damage->parts) out << ' ' << part;
  }
  out << '\n';
}

std::string text_of(const Scenario& scenario, const RankResult& result) {
  std::ostringstream out;
  out << std::hexfloat;
  for (const CandidateResult& c : result.ranking) {
    out << result.candidates[c.candidate].name << ' ' << c.score.value_or(-1.0) << ' '
        << c.score_interval.lowest << ' ' << c.score_interval.highest << ' ' << c.collides << '\n';
    for (const Contact& contact : c.contacts) write(out, scenario, contact);
    for (const FurtherContact& f : c.further) {
      out << scenario.actors[f.a].name << ' ' << scenario.actors[f.b].name << ' ' << f.time_s << ' '
          << f.outcome_a.delta_v_mps << ' ' << f.outcome_b.delta_v_mps << ' '
          << f.damage_a.triangles.size() << ' ' << f.damage_b.triangles.size() << '\n';
    }
  }
  out << result.complete << result.proved << result.in_race.at(0);
  return out.str();
}

std::string work_of(const RankResult& result) {
  const RankWork& w = result.work;
  std::ostringstream out;
  out << w.box_tests << ' ' << w.body_pairs << ' ' << w.impact.bv_tests << ' '
      << w.impact.primitive_tests << ' ' << w.impact.poses << ' ' << w.damage_queries << ' '
      << w.paths;
  return out.str();
}

TEST(RankProperty, WorkersChangeNothing) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = random_scene(seed);
    const RankResult alone = scene.ranked();
    for (const unsigned workers : {0U, 2U, 3U, 64U}) {
      RankOptions options;
      options.workers = workers;
      for (const std::uint32_t depth : {auto_depth, 1U, 5U, 16U}) {
        options.depth = depth;
        options.policy = all_policies()[(seed + depth) % all_policies().size()];
        const RankResult shared = scene.ranked(options);
        EXPECT_EQ(text_of(scene.scenario, shared), text_of(scene.scenario, alone));
        EXPECT_EQ(work_of(shared), work_of(alone));
      }
    }
  }
}

TEST(RankProperty, TheOrderOfTheActorsChangesNothing) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Scene scene = random_scene(seed);
    const std::string before = text_of(scene.scenario, scene.ranked());
    oracle::Random random(seed);
    for (std::size_t i = scene.scenario.actors.size(); i > 1; --i) {
      const auto j = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i) - 1));
      std::swap(scene.scenario.actors[i - 1], scene.scenario.actors[j]);
    }
    EXPECT_EQ(text_of(scene.scenario, scene.ranked()), before);
  }
}

// Contacts are the same. The contact law divides outlines into pieces from one end, so a motion and
// its mirror image differ by millimetres: triangles at the border of the damage can be in only one
// of them.
TEST(RankProperty, AMirrorImageIsRankedAlike) {
  std::size_t hits = 0;
  std::size_t triangles = 0;
  std::size_t at_rims = 0;
  const auto compare = [&](const BodyDamage& damage, const BodyDamage& image) {
    std::vector<std::uint32_t> differ;
    std::set_symmetric_difference(damage.triangles.begin(), damage.triangles.end(),
                                  image.triangles.begin(), image.triangles.end(),
                                  std::back_inserter(differ));
    triangles += damage.triangles.size() + image.triangles.size();
    at_rims += differ.size();
    return static_cast<double>(differ.size());
  };
  std::vector<double> delta_v;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = random_scene(seed);
    const RankResult here = scene.ranked();
    const RankResult there = mirrored(scene).ranked();
    ASSERT_EQ(here.ranking.size(), there.ranking.size());
    for (const CandidateResult& c : here.ranking) {
      const Candidate& candidate = here.candidates[c.candidate];
      const auto image = std::find_if(there.ranking.begin(), there.ranking.end(),
                                      [&](const CandidateResult& other) {
                                        const Candidate& o = there.candidates[other.candidate];
                                        return o.acceleration_mps2 == candidate.acceleration_mps2 &&
                                               o.curvature_per_m == -candidate.curvature_per_m;
                                      });
      ASSERT_NE(image, there.ranking.end());
      ASSERT_EQ(c.collides, image->collides);
      if (!c.collides) continue;
      ++hits;
      const Contact& first = c.contacts[0];
      const Contact& mirror = image->contacts[0];
      EXPECT_EQ(first.actor, mirror.actor);
      EXPECT_NEAR(first.time_of_impact_s, mirror.time_of_impact_s, 1e-5);
      // Chains of contacts diverge if outlines are divided from the other end; the first contact
      // does not.
      delta_v.push_back(std::abs(first.severity.ego.delta_v_mps - mirror.severity.ego.delta_v_mps) /
                        first.closing_speed_mps);
      if (c.contacts.size() > 1 || image->contacts.size() > 1 || !c.further.empty() ||
          !image->further.empty()) {
        continue;
      }
      const double differ = compare(c.ego, image->ego) + compare(first.other, mirror.other);
      EXPECT_NEAR(c.score.value(), image->score.value(), differ) << candidate.name;
    }
  }
  std::sort(delta_v.begin(), delta_v.end());
  std::printf(
      "%zu of %zu triangles in one of the images alone; delta-v over closing speed of %zu "
      "first contacts: p50 %.3g, p95 %.3g\n",
      at_rims, triangles, hits, delta_v[hits / 2], delta_v[hits * 95 / 100]);
  EXPECT_LT(delta_v[hits / 2], 1e-3);
  EXPECT_LT(static_cast<double>(at_rims), 0.002 * static_cast<double>(triangles));
  EXPECT_GT(hits, 50U);
}

// Brute force: every actor over the full horizon, without broad phase, slices or bounds.
TEST(RankProperty, FirstContactsEqualBruteForce) {
  std::size_t hits = 0;
  std::size_t misses = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = random_scene(seed);
    const Scenario& s = scene.scenario;
    const RankResult result = scene.ranked();
    ImpactWorkspace workspace;
    for (const CandidateResult& c : result.ranking) {
      double first = std::numeric_limits<double>::infinity();
      for (const ScenarioActor& actor : s.actors) {
        const Impact impact = time_of_impact(
            scene.models[s.ego.model].tree, result.candidates[c.candidate].motion,
            scene.models[actor.model].tree, *make_motion(actor), 0.0, s.horizon_s, workspace);
        if (impact.hit()) first = std::min(first, impact.time_s);
      }
      ASSERT_EQ(c.collides, std::isfinite(first));
      ++(c.collides ? hits : misses);
      const double told = c.collides ? c.contacts.front().time_of_impact_s : first;
      EXPECT_TRUE(told == first || std::abs(told - first) < 1e-5) << told << " and " << first;
    }
  }
  EXPECT_GT(hits, 50U);
  EXPECT_GT(misses, 50U);
}

// Exact collision queries at sampled times find no contact that the ranking missed.
TEST(RankProperty, NoSampledPoseTouchesBeforeTheReportedTime) {
  for (std::uint64_t seed = 31; seed <= 36; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = random_scene(seed, 5);
    const Scenario& s = scene.scenario;
    std::vector<Pair> pairs;
    CollideOptions any;
    any.any = true;
    const RankResult result = scene.ranked();
    for (const CandidateResult& c : result.ranking) {
      const Motion& ego = result.candidates[c.candidate].motion;
      const double end = c.collides ? c.contacts.front().time_of_impact_s : s.horizon_s;
      for (const ScenarioActor& actor : s.actors) {
        const Motion motion = *make_motion(actor);
        for (double t = 0.0; t < end; t += 0.01) {
          ASSERT_FALSE(collide(scene.models[s.ego.model].tree, scene.models[actor.model].tree,
                               relative(ego.pose_at(t), motion.pose_at(t)), pairs, any)
                           .intersecting)
              << result.candidates[c.candidate].name << " meets " << actor.name << " at " << t;
        }
      }
    }
  }
}

TEST(RankProperty, TheRankingIsATotalOrderOverAllCandidates) {
  for (std::uint64_t seed = 51; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const Measure measure : {Measure::polygons, Measure::area, Measure::closing_energy}) {
      const RankResult result = random_scene(seed).ranked(measure);
      std::vector<char> seen(result.candidates.size(), 0);
      EXPECT_EQ(result.measure, measure);
      ASSERT_EQ(result.ranking.size(), result.candidates.size());
      for (std::size_t i = 0; i < result.ranking.size(); ++i) {
        const CandidateResult& c = result.ranking[i];
        EXPECT_FALSE(seen[c.candidate]++);
        ASSERT_TRUE(c.score.has_value());
        EXPECT_EQ(c.collides, *c.score > 0.0);
        EXPECT_GE(*c.score, *result.ranking[i == 0 ? 0 : i - 1].score);
        for (std::size_t k = 1; k < c.contacts.size(); ++k) {
          EXPECT_GE(c.contacts[k].time_of_impact_s, c.contacts[k - 1].time_of_impact_s);
        }
      }
      EXPECT_EQ(result.in_race, std::vector<std::size_t>{result.ranking[0].candidate});
    }
  }
}

}  // namespace
}  // namespace crashrank
