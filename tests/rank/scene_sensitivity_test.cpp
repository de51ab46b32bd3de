// Sensitivity of a score to irrelevant changes: the start moved by 1 mm, and simulation steps
// halved.

#include "campaign.hpp"
#include "rank/random_scene.hpp"
#include "rank/shipped_cast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace crashrank {
namespace {

using scenes::Scene;
using test::wished;

/// A contact of a scene between any two bodies.
struct Touch {
  double begin_s = 0.0;
  std::size_t a = ego_body;
  std::size_t b = 0;
  int again = 0;  ///< number of earlier contacts of the pair
  double delta_v_a_mps = 0.0;
  double delta_v_b_mps = 0.0;
};

std::vector<Touch> touches_of(const CandidateResult& result) {
  std::vector<Touch> all;
  for (const Contact& c : result.contacts) {
    all.push_back({c.time_of_impact_s, ego_body, c.actor, 0, c.severity.ego.delta_v_mps,
                   c.severity.other.delta_v_mps});
  }
  for (const FurtherContact& c : result.further) {
    all.push_back({c.time_s, std::min(c.a, c.b), std::max(c.a, c.b), 0,
                   (c.a < c.b ? c.outcome_a : c.outcome_b).delta_v_mps,
                   (c.a < c.b ? c.outcome_b : c.outcome_a).delta_v_mps});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Touch& p, const Touch& q) { return p.begin_s < q.begin_s; });
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (all[k].a == all[i].a && all[k].b == all[i].b) ++all[i].again;
    }
  }
  return all;
}

const Touch* same_in(const std::vector<Touch>& all, const Touch& touch) {
  for (const Touch& t : all) {
    if (t.a == touch.a && t.b == touch.b && t.again == touch.again) return &t;
  }
  return nullptr;
}

std::string body_name(const Scenario& scenario, std::size_t body) {
  if (body == ego_body) return "ego";
  const ScenarioActor& actor = scenario.actors[body];
  return scenario.models[actor.model].name + " of " + actor.name;
}

/// Text for a contact and its counterpart in the other run.
std::string describe(const Scenario& scenario, const Touch& t, const Touch* twin) {
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(), "contact %d of %s and %s at %.3f s, %.2f and %.2f m/s",
                t.again + 1, body_name(scenario, t.a).c_str(), body_name(scenario, t.b).c_str(),
                t.begin_s, t.delta_v_a_mps, t.delta_v_b_mps);
  std::string told = text.data();
  if (twin == nullptr) return told + ", in one run alone";
  std::snprintf(text.data(), text.size(), ", in the other run at %.3f s, %.2f and %.2f m/s",
                twin->begin_s, twin->delta_v_a_mps, twin->delta_v_b_mps);
  return told + text.data();
}

/// Cause of a difference between the scores of two runs of one scene.
enum class Cause {
  first_contact,  ///< the first contact differs by more than 5 %
  same_contacts,  ///< all contacts are in both runs, the first differs little
  /// a contact is in one run only, before any common one differs by more than 5 %
  extra_contact,
  /// a common later contact differs by more than 5 % before one is in one run only
  later_contact,
};

struct Branch {
  Cause cause = Cause::same_contacts;
  double begin_s = std::numeric_limits<double>::infinity();
  std::string text = "no contact differs by over 5 %";
};

/// The earliest contact that is in one run only or whose delta-v differs by more than 5 % (0.05 m/s
/// if it is below 1 m/s).
Branch branch_of(const Scenario& scenario, const CandidateResult& p, const CandidateResult& q) {
  const std::array<std::vector<Touch>, 2> all{touches_of(p), touches_of(q)};
  Branch first;
  for (std::size_t side = 0; side < 2; ++side) {
    for (const Touch& t : all[side]) {
      const Touch* const twin = same_in(all[1 - side], t);
      const double differ = twin == nullptr
                                ? 1.0
                                : std::max(std::abs(t.delta_v_a_mps - twin->delta_v_a_mps),
                                           std::abs(t.delta_v_b_mps - twin->delta_v_b_mps)) /
                                      std::max({t.delta_v_a_mps, t.delta_v_b_mps, 1.0});
      if (differ <= 0.05 || t.begin_s >= first.begin_s) continue;
      first.begin_s = t.begin_s;
      first.text = describe(scenario, t, twin);
      first.cause = twin == nullptr            ? Cause::extra_contact
                    : &t == &all[side].front() ? Cause::first_contact
                                               : Cause::later_contact;
    }
  }
  return first;
}

/// Contribution to the score, by body.
std::map<std::size_t, double> harm_by_body(const CandidateResult& result) {
  std::map<std::size_t, double> harm;
  for (const Contact& c : result.contacts) {
    harm[ego_body] += c.severity.ego.harm;
    harm[c.actor] += c.severity.other.harm;
  }
  for (const FurtherContact& c : result.further) {
    harm[c.a] += c.outcome_a.harm;
    harm[c.b] += c.outcome_b.harm;
  }
  return harm;
}

/// The body whose harm differs most, with its contacts in both runs.
std::string worst_body(const Scenario& scenario, const CandidateResult& p,
                       const CandidateResult& q) {
  const std::array<std::map<std::size_t, double>, 2> harm{harm_by_body(p), harm_by_body(q)};
  std::size_t worst = ego_body;
  double most = -1.0;
  const auto of = [&](std::size_t side, std::size_t body) {
    const auto found = harm[side].find(body);
    return found == harm[side].end() ? 0.0 : found->second;
  };
  for (const std::map<std::size_t, double>& one : harm) {
    for (const auto& [body, own] : one) {
      const double differ = std::abs(of(0, body) - of(1, body));
      if (differ <= most) continue;
      most = differ;
      worst = body;
    }
  }
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "most of it by %s: harm %.5f and %.5f, delta-v",
                body_name(scenario, worst).c_str(), of(0, worst), of(1, worst));
  std::string told = text.data();
  for (const CandidateResult* result : {&p, &q}) {
    told += result == &p ? "" : " against";
    for (const Touch& t : touches_of(*result)) {
      if (t.a != worst && t.b != worst) continue;
      std::snprintf(text.data(), text.size(), " %.2f",
                    t.a == worst ? t.delta_v_a_mps : t.delta_v_b_mps);
      told += text.data();
    }
  }
  return told;
}

/// A crash in a queue of shipped models, with one random manoeuvre.
Scene crash_in_queue(std::uint64_t seed) {
  oracle::Random random(seed);
  Scene scene;
  scenes::name_shipped_cast(scene.scenario);
  scenes::add_queue(random, scene);
  scene.add_candidate("drives", random.real(-6, 1), random.real(-0.04, 0.04));
  scene.scenario.measure = Measure::harm;
  // Only the numerical samples: all ranges are single values.
  HarmOptions& harm = scene.scenario.harm;
  HarmRanges& r = harm.ranges;
  r.least_friction = r.most_friction = harm.friction;
  r.least_strength = r.most_strength = r.least_restitution = r.most_restitution = 1.0;
  r.least_risk_speed = r.most_risk_speed = 1.0;
  r.all_models = false;
  return scene;
}

RankResult ranked_shipped(const Scene& scene) {
  Result<RankResult> result = rank(scene.scenario, scenes::shipped_cast());
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message());
  return result.ok() ? std::move(*result) : RankResult{};
}

/// Relative changes of scores.
struct ScoreChanges {
  std::vector<double> all;

  /// Returns it.
  double add(double p, double q) {
    const double most = std::max(p, q);
    all.push_back(most > 0.0 ? std::abs(p - q) / most : 0.0);
    return all.back();
  }
  double within(double share) const {
    const auto count = std::count_if(all.begin(), all.end(), [&](double c) { return c <= share; });
    return static_cast<double>(count) / static_cast<double>(all.size());
  }
  double percentile(double share) const {
    std::vector<double> sorted = all;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
  }
  void print(const char* name) const {
    std::printf(
        "%s: score changes by at most 5 %% in %.1f %% of %zu scenes, 1 %% in %.1f %%; p50 %.3g, "
        "p90 %.3g, p95 %.3g, most %.3g\n",
        name, 100.0 * within(0.05), all.size(), 100.0 * within(0.01), percentile(0.5),
        percentile(0.9), percentile(0.95), percentile(1.0));
  }
};

struct Outlier {
  double change = 0.0;
  Cause cause = Cause::same_contacts;
  std::string text;
};

void print_outliers(std::vector<Outlier> outliers) {
  std::sort(outliers.begin(), outliers.end(),
            [](const Outlier& p, const Outlier& q) { return p.change > q.change; });
  const auto count = [&](Cause cause) {
    return std::count_if(outliers.begin(), outliers.end(),
                         [&](const Outlier& o) { return o.cause == cause; });
  };
  std::printf(
      "%zu outliers by what differs first: first contact %td, a later one of both %td, one that "
      "one run alone has %td, no contact %td\n",
      outliers.size(), count(Cause::first_contact), count(Cause::later_contact),
      count(Cause::extra_contact), count(Cause::same_contacts));
  for (std::size_t i = 0; i < std::min<std::size_t>(outliers.size(), 12); ++i) {
    std::printf("  %s\n", outliers[i].text.c_str());
  }
}

// Campaigns set CRASHRANK_SCENE_COUNT and CRASHRANK_SCENE_SEED.
TEST(SceneSensitivity, AMillimetreAndLongerStepsChangeScoresLittle) {
  const std::uint64_t begin = wished("CRASHRANK_SCENE_SEED", 1);
  const std::uint64_t count = wished("CRASHRANK_SCENE_COUNT", 60);
  std::printf("seeds from %llu, %llu scenes\n", static_cast<unsigned long long>(begin),
              static_cast<unsigned long long>(count));
  ScoreChanges moved;
  ScoreChanges moved_pair;
  ScoreChanges longer;
  ScoreChanges aside;
  std::vector<Outlier> outliers;
  std::size_t contacts = 0;
  std::size_t pairs = 0;
  std::size_t crowded = 0;
  for (std::uint64_t seed = begin; seed < begin + count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Scene scene = crash_in_queue(seed);
    const RankResult here = ranked_shipped(scene);
    ASSERT_EQ(here.ranking.size(), 1U);
    const CandidateResult& p = here.ranking.front();
    if (!p.collides) continue;
    const std::size_t own = p.contacts.size() + p.further.size();
    contacts += own;
    crowded += p.crowded ? 1U : 0U;
    ASSERT_GT(p.sample_scores.size(), numerical_samples);
    const double* const numerical = p.sample_scores.data() + p.sample_scores.size() - 3;
    longer.add(*p.score, numerical[0]);
    aside.add(*p.score, numerical[1]);
    aside.add(*p.score, numerical[2]);
    oracle::Random random(seed + 1'000'000);
    const double direction = random.real(-3.14159, 3.14159);
    scene.scenario.ego.pose.translation +=
        0.001 * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0.0);
    const RankResult there = ranked_shipped(scene);
    const CandidateResult& q = there.ranking.front();
    const double change = moved.add(*p.score, q.score.value_or(0.0));
    if (p.further.empty()) {
      ++pairs;
      moved_pair.add(*p.score, q.score.value_or(0.0));
    }
    if (change <= 0.05) continue;
    const Branch branch = branch_of(scene.scenario, p, q);
    outliers.push_back({change, branch.cause,
                        "seed " + std::to_string(seed) + ", score " + std::to_string(*p.score) +
                            " and " + std::to_string(q.score.value_or(0.0)) + ": " + branch.text +
                            "; " + worst_body(scene.scenario, p, q)});
  }
  ASSERT_GT(moved.all.size(), count / 2);
  std::printf("%zu contacts in %zu scenes, %zu without one between others, %zu crowded\n", contacts,
              moved.all.size(), pairs, crowded);
  moved.print("1 mm at the start");
  if (!moved_pair.all.empty()) moved_pair.print("1 mm at the start, contacts of the ego alone");
  aside.print("1 mm aside at first contact");
  longer.print("longer steps");
  print_outliers(outliers);
  // The goal is 95 % of all scenes; short runs have few scenes, so chance allows some more
  // outliers.
  const auto scenes = static_cast<double>(moved.all.size());
  EXPECT_LE(static_cast<double>(outliers.size()), 0.05 * scenes + 2.0 * std::sqrt(0.0475 * scenes));
}

}  // namespace
}  // namespace crashrank
