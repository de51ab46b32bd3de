#include "crash/exposure.hpp"

#include "base/random.hpp"
#include "crash/scene_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace crashrank::detail {
namespace {

using test::Random;

constexpr ExposedBody car{1500.0, true, 1.0};

/// A force along x that changes the velocity by `change_mps` in an interval.
ContactAction push(double change_mps) {
  ContactAction action;
  action.dvx_mps = change_mps;
  action.path_mps = std::abs(change_mps);
  return action;
}

std::vector<ExposureWindow> windows_of(View<const ExposureCell> cells, const ExposedBody& body) {
  std::vector<ExposureWindow> windows;
  list_windows(cells, body, windows);
  return windows;
}

double exposure_of(View<const ExposureCell> cells, const ExposedBody& body = car) {
  double most = 0.0;
  for (const ExposureWindow& w : windows_of(cells, body)) most = std::max(most, w.exposure_mps);
  return most;
}

/// A value that rises with exposure and intrusion, as a hazard does, and depends on the direction.
double value_of(const ExposureWindow& w) {
  const double size = w.change_mps.norm();
  const double along = size > 0.0 ? w.change_mps.dot(w.forward) / size : 0.0;
  const double direction = 0.2 * (1.0 - along * along) - (along > 0.0 ? 0.4 * along * along : 0.0);
  const double directed = w.exposure_mps > 0.0 ? size / w.exposure_mps : 0.0;
  return (1.0 + directed * direction) *
         (w.exposure_mps * w.exposure_mps + 5.0 * w.exposure_mps * w.intrusion_m);
}

/// The sum over separate impacts by its definition: over all begins and ends of windows that begin
/// with a cell or in which one is the last that counts whole, with time quadratic in the record's
/// length.
double sum_by_definition(View<const ExposureCell> cells, const ExposedBody& body) {
  constexpr int n = cells_per_window;
  constexpr int fading = 6;
  const auto share = [](int k) {
    return std::clamp((n + fading / 2 - k - 0.5) / fading, 0.0, 1.0);
  };
  const std::int32_t from = cells[0].index - n;
  const std::int32_t until = cells[cells.size() - 1].index + 1;
  std::vector<double> best;
  double most = 0.0;
  for (std::int32_t begin = from; begin < until; ++begin) {
    const bool counts = std::any_of(cells.begin(), cells.end(), [&](const ExposureCell& cell) {
      return cell.index == begin || cell.index + 1 - (n - fading / 2) == begin;
    });
    double value = 0.0;
    for (std::int32_t end = begin + 1; counts && end <= begin + n + fading / 2; ++end) {
      ContactAction sum;
      const ExposureCell* first = nullptr;
      for (const ExposureCell& cell : cells) {
        if (cell.index < begin || cell.index >= end) continue;
        if (first == nullptr) first = &cell;
        sum.add(cell.action, share(cell.index - begin));
      }
      if (first == nullptr) continue;
      ExposureWindow w;
      w.change_mps = {sum.dvx_mps, sum.dvy_mps};
      w.forward = {static_cast<double>(first->forward_x), static_cast<double>(first->forward_y)};
      const double change = w.change_mps.norm();
      w.exposure_mps = std::max(
          change, std::min(change + sum.cancelled_mps, std::sqrt(sum.crush_j / body.mass_kg)));
      w.intrusion_m = std::min(sum.intruded_m3 / (0.45 * 0.65), sum.deepest_m);
      value = std::max(value, value_of(w));
    }
    double here = value;
    for (std::size_t k = 0; k < best.size(); ++k) {
      const auto apart = static_cast<double>(begin - (from + static_cast<std::int32_t>(k)));
      here = std::max(here, best[k] + std::clamp(apart / n - 1.0, 0.0, 1.0) * value);
    }
    best.push_back(here);
    most = std::max(most, here);
  }
  return most;
}

/// A random record: forces and gaps of up to a second.
ExposureRecord any_record(Random& random, int steps) {
  ExposureRecord record;
  record.prepare();
  double time_s = random.uniform(0.0, 0.1);
  double heading = random.uniform(-3.0, 3.0);
  for (int i = 0; i < steps; ++i) {
    if (random.below(20) == 0) time_s += random.uniform(0.0, 1.0);
    const double step_s = random.uniform(0.0005, 0.02);
    heading += random.uniform(-0.1, 0.1);
    ExposureCell state;
    state.forward_x = static_cast<float>(std::cos(heading));
    state.forward_y = static_cast<float>(std::sin(heading));
    ContactAction action;
    action.dvx_mps = random.uniform(-1.0, 2.0);
    action.dvy_mps = random.uniform(-1.0, 1.0);
    action.path_mps = 1.5 * std::hypot(action.dvx_mps, action.dvy_mps);
    action.cancelled_mps = random.below(3) == 0 ? random.uniform(0.0, 1.0) : 0.0;
    action.crush_j = random.uniform(0.0, 2e4);
    action.intruded_m3 = random.below(4) == 0 ? random.uniform(0.0, 0.01) : 0.0;
    action.deepest_m = random.below(4) == 0 ? random.uniform(0.0, 0.1) : 0.0;
    record.add(time_s, time_s + step_s, state, action);
    time_s += step_s;
  }
  return record;
}

TEST(Exposure, OfASteadyPushIsItsAccelerationTimesTheWindow) {
  constexpr double acceleration = 20.0;
  for (const double duration_s : {0.05, 0.2, 0.27, 0.3, 0.33, 0.5, 2.0}) {
    ExposureRecord record;
    record.prepare();
    constexpr double step_s = 0.004;
    for (double t = 0.0; t < duration_s - 1e-9; t += step_s) {
      const double end_s = std::min(t + step_s, duration_s);
      record.add(t, end_s, {}, push(acceleration * (end_s - t)));
    }
    // The shares fall in a straight line from 0.24375 to 0.35625 s; cells take their mean.
    const double faded_s = std::clamp(duration_s - 0.24375, 0.0, 0.1125);
    const double counted_s = std::min(duration_s, 0.35625) - faded_s * faded_s / (2.0 * 0.1125);
    EXPECT_NEAR(exposure_of(record.cells()), acceleration * counted_s, 0.01) << duration_s;
    if (duration_s < 0.24) {
      EXPECT_NEAR(exposure_of(record.cells()), acceleration * duration_s, 1e-9);
    }
    if (duration_s > 0.4) {
      EXPECT_NEAR(exposure_of(record.cells()), acceleration * exposure_window_s, 1e-9);
    }
  }
}

TEST(Exposure, CancelledForcesCountUpToTheSpeedOfTheCrush) {
  const auto squeezed = [](double crush_j) {
    ContactAction action = push(2.0);
    action.path_mps = 22.0;
    action.cancelled_mps = 10.0;
    action.crush_j = crush_j;
    ExposureRecord record;
    record.prepare();
    record.add(0.0, 0.1, {}, action);
    return exposure_of(record.cells());
  };
  // sqrt(W/m), between the change of velocity alone and that with all that is cancelled.
  EXPECT_NEAR(squeezed(0.0), 2.0, 1e-9);
  EXPECT_NEAR(squeezed(1500.0 * 25.0), 5.0, 1e-9);
  EXPECT_NEAR(squeezed(1500.0 * 400.0), 12.0, 1e-9);
}

TEST(Exposure, RestitutionScalesTheReboundAlone) {
  ContactAction action = push(12.0);
  action.rebound_x_mps = 2.0;
  ExposureRecord record;
  record.prepare();
  record.add(0.0, 0.1, {}, action);
  EXPECT_NEAR(exposure_of(record.cells(), {1500.0, true, 0.5}), 11.0, 1e-9);
  EXPECT_NEAR(exposure_of(record.cells(), {1500.0, true, 1.5}), 13.0, 1e-9);
}

TEST(Exposure, AHitByACarStrikesAtItsClosingSpeed) {
  // Delta-v of a person of 75 kg: closing·M/(m + M).
  const auto struck = [](double striker_kg) {
    ContactAction action = push(10.0 * striker_kg / (75.0 + striker_kg));
    action.light_mps = action.path_mps * 75.0 / std::max(striker_kg, striking_car_kg);
    ExposureRecord record;
    record.prepare();
    record.add(0.0, 0.05, {}, action);
    double most = 0.0;
    for (const ExposureWindow& w : windows_of(record.cells(), {75.0, false, 1.0})) {
      most = std::max(most, w.struck_mps);
    }
    return most;
  };
  EXPECT_NEAR(struck(1500.0), 10.0, 1e-9);
  EXPECT_NEAR(struck(14000.0), 10.0, 1e-9);
  // A light body gives a person less than a car of the same speed.
  EXPECT_LT(struck(100.0), 6.5);
}

TEST(Exposure, TheSumOverImpactsIsThatOfItsDefinition) {
  constexpr std::uint64_t seed = 611;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (int i = 0; i < 60; ++i) {
    const ExposureRecord record = any_record(random, 5 + static_cast<int>(random.below(60)));
    const double expected = sum_by_definition(record.cells(), car);
    EXPECT_NEAR(spaced_sum(windows_of(record.cells(), car), value_of), expected, 1e-9 * expected)
        << "case " << i;
  }
}

TEST(Exposure, NoFurtherForceLowersASum) {
  constexpr std::uint64_t seed = 612;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  for (int i = 0; i < 40; ++i) {
    const ExposureRecord record = any_record(random, 100);
    const View<const ExposureCell> all = record.cells();
    double before = 0.0;
    for (std::size_t count = 1; count <= all.size(); ++count) {
      const double now = spaced_sum(windows_of({all.data(), count}, car), value_of);
      ASSERT_GE(now, before * (1.0 - 1e-12)) << "case " << i << ", " << count << " cells";
      before = now;
    }
  }
}

TEST(Exposure, ASecondImpactCountsContinuouslyWithItsTime) {
  const auto sum = [](double apart_s) {
    ExposureRecord record;
    record.prepare();
    record.add(0.0, 0.05, {}, push(10.0));
    record.add(0.05 + apart_s, 0.1 + apart_s, {}, push(8.0));
    return spaced_sum(windows_of(record.cells(), car),
                      [](const ExposureWindow& w) { return w.exposure_mps; });
  };
  double before = sum(0.0);
  EXPECT_NEAR(before, 18.0, 1e-9);
  for (double apart_s = 0.002; apart_s < 1.0; apart_s += 0.002) {
    const double now = sum(apart_s);
    EXPECT_LE(std::abs(now - before), 0.8) << apart_s;
    before = now;
  }
  EXPECT_NEAR(before, 18.0, 1e-9);
}

TEST(Exposure, AFullRecordSaysSo) {
  ExposureRecord record;
  record.prepare();
  bool has_room = true;
  for (int i = 0; i <= static_cast<int>(ExposureRecord::most_cells); ++i) {
    EXPECT_TRUE(has_room) << i;
    has_room = record.add(i * exposure_cell_s, (i + 0.5) * exposure_cell_s, {}, push(1.0));
  }
  EXPECT_FALSE(has_room);
  EXPECT_EQ(record.cells().size(), ExposureRecord::most_cells);
}

/// Share of a force at some time after the begin of a window.
double share_after(double time_s) { return std::clamp((0.35625 - time_s) / 0.1125, 0.0, 1.0); }

/// The velocity of every body after each step of a scene without road forces.
struct Velocities {
  std::vector<double> time_s;
  std::vector<std::vector<Eigen::Vector2d>> mps;

  /// Greatest change from any time on to any time, with the share of each step by its middle.
  double greatest_change_mps(std::size_t body) const {
    double most = 0.0;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      Eigen::Vector2d change = Eigen::Vector2d::Zero();
      for (std::size_t k = i + 1; k < time_s.size(); ++k) {
        const double share = share_after(0.5 * (time_s[k - 1] + time_s[k]) - time_s[i]);
        change += share * (mps[k][body] - mps[k - 1][body]);
        most = std::max(most, change.norm());
      }
    }
    return most;
  }
};

TEST(Exposure, InPileUpsIsTheGreatestChangeOfVelocityWithinAWindow) {
  constexpr std::uint64_t seed = 613;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  Random random(seed);
  int exposed = 0;
  int squeezed = 0;
  for (int round = 0; round < 30; ++round) {
    test::SceneSetup setup =
        round % 2 == 0 ? test::random_pile_up(random, 5, true) : test::random_queue(random, 5);
    SceneRun run;
    run.begin(setup.make_bodies(false), 0, 1, 0.0, Eigen::Vector3d::Zero(), {});
    Velocities log;
    do {
      log.time_s.push_back(run.now_s());
      log.mps.emplace_back();
      for (std::size_t i = 0; i < 5; ++i) {
        log.mps.back().push_back({run.body(i).vx, run.body(i).vy});
      }
    } while (run.advance(1));
    for (std::size_t i = 0; i < 5; ++i) {
      const View<const ExposureCell> cells = run.exposure_cells(i);
      if (cells.empty()) continue;
      ++exposed;
      const double mass_kg = setup.vehicles[i]->mass_kg;
      const double change = log.greatest_change_mps(i);
      double crush_j = 0.0;
      for (const ExposureCell& cell : cells) crush_j += cell.action.crush_j;
      const double exposure = exposure_of(cells, {mass_kg, true, 1.0});
      // Cells of 19 ms cut windows coarser than steps.
      EXPECT_GE(exposure, 0.98 * change - 0.05) << "round " << round << ", body " << i;
      EXPECT_LE(exposure, std::max(1.02 * change + 0.05, std::sqrt(crush_j / mass_kg)))
          << "round " << round << ", body " << i;
      squeezed += exposure > 1.05 * change ? 1 : 0;
    }
  }
  std::printf("%d bodies, %d of them squeezed\n", exposed, squeezed);
  EXPECT_GT(exposed, 60);
  EXPECT_GT(squeezed, 0);
}

}  // namespace
}  // namespace crashrank::detail
