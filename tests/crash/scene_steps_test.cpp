#include "campaign.hpp"
#include "crash/contact_checks.hpp"
#include "crash/scene_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace crashrank {
namespace {

using detail::SceneContact;
using detail::SceneRun;
using test::percentile;
using test::Random;
using test::run_to_end;
using test::SceneSetup;

/// Results of a scene for each of its bodies.
struct SceneResult {
  std::vector<double> delta_v_mps;     ///< sum over the contacts
  std::vector<Eigen::Vector2d> place;  ///< rest position of the centre of mass
  double energy_j = 0.0;               ///< energy dissipated in contacts
  std::size_t contacts = 0;
};

SceneResult result_of(const SceneSetup& setup, const SceneRun& run) {
  SceneResult end;
  end.delta_v_mps.assign(setup.plans.size(), 0.0);
  for (const SceneContact& c : run.contacts()) {
    end.delta_v_mps[c.a] += c.outcome.a.delta_v_mps.norm();
    end.delta_v_mps[c.b] += c.outcome.b.delta_v_mps.norm();
    end.energy_j += c.outcome.dissipated_j;
  }
  end.contacts = run.contacts().size();
  for (std::size_t i = 0; i < setup.plans.size(); ++i) {
    end.place.emplace_back(run.body(i).x, run.body(i).y);
  }
  return end;
}

void print_percentiles(const char* name, const std::vector<double>& values) {
  std::printf("%s: p50 %.3g, p90 %.3g, p95 %.3g, p99 %.3g, most %.3g of %zu\n", name,
              percentile(values, 0.5), percentile(values, 0.9), percentile(values, 0.95),
              percentile(values, 0.99), percentile(values, 1.0), values.size());
}

// Campaigns set CRASHRANK_SCENE_COUNT and CRASHRANK_SCENE_SEED.
TEST(SceneSteps, HalvedStepsChangeChainsLittle) {
  const auto [seed, count] = test::scene_campaign(421, 120);
  for (const double factor : {1.0, 0.5}) {
    Random random(seed);
    SceneRun run;
    std::vector<double> delta_v;
    std::vector<double> worst;
    std::vector<double> places;
    std::vector<double> energies;
    std::size_t other_contacts = 0;
    std::size_t contacts = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      SceneSetup setup = test::random_queue(random, 3 + random.below(5));
      const double closing = setup.plans[0].velocity_at(0.0).linear_mps.norm();
      const View<const detail::SceneBody> bodies = setup.make_bodies(true);
      run.begin(bodies, 0, 1, 0.0, Eigen::Vector3d::Zero(), test::options_with_steps(factor));
      run_to_end(run);
      const SceneResult p = result_of(setup, run);
      run.begin(bodies, 0, 1, 0.0, Eigen::Vector3d::Zero(), test::options_with_steps(0.5 * factor));
      run_to_end(run);
      const SceneResult q = result_of(setup, run);
      contacts += p.contacts;
      other_contacts += p.contacts != q.contacts ? 1U : 0U;
      if (p.contacts == 0 && q.contacts == 0) continue;
      double most = 0.0;
      for (std::size_t k = 0; k < p.place.size(); ++k) {
        if (!(p.delta_v_mps[k] + q.delta_v_mps[k] > 0.0)) continue;
        delta_v.push_back(std::abs(p.delta_v_mps[k] - q.delta_v_mps[k]) / closing);
        places.push_back((p.place[k] - q.place[k]).norm());
        most = std::max(most, delta_v.back());
      }
      worst.push_back(most);
      energies.push_back(std::abs(p.energy_j - q.energy_j) / std::max(p.energy_j, q.energy_j));
    }
    std::printf(
        "steps %.2g against %.2g: %zu contacts, their number differs in %zu of %zu scenes\n",
        factor, 0.5 * factor, contacts, other_contacts, worst.size());
    print_percentiles("  delta-v of a body over closing speed", delta_v);
    print_percentiles("  greatest of a scene's bodies", worst);
    print_percentiles("  dissipated energy, relative", energies);
    print_percentiles("  rest position of a body, m", places);
    EXPECT_LT(percentile(delta_v, 0.5), 0.01);
    EXPECT_LT(percentile(energies, 0.9), 0.05);
  }
}

}  // namespace
}  // namespace crashrank
