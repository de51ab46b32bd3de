#include "crash/contact_run.hpp"
#include "crash/event_times.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace crashrank::detail {
namespace {

/// 0.8 km/h in 20 ms.
constexpr double end_of_event_mps2 = 0.8 / 3.6 / 0.02;

TEST(CountedShare, StaysAndThenFallsByOneIn300Milliseconds) {
  for (const double step_s : {0.001, 0.01, 0.07}) {
    CountedShare share;
    for (double time_s = step_s; time_s < 0.8; time_s += step_s) {
      share.pass(step_s);
      EXPECT_NEAR(share.share, std::clamp(1.0 - (time_s - 0.3) / 0.3, 0.0, 1.0), 1e-9) << time_s;
    }
  }
}

TEST(CountedShare, ForcesOfHardBrakingDoNotRaiseIt) {
  CountedShare share;
  share.pass(1.0);
  ASSERT_EQ(share.share, 0.0);
  share.take(end_of_event_mps2);
  EXPECT_EQ(share.share, 0.0);
  share.take(1.25 * end_of_event_mps2);
  EXPECT_NEAR(share.share, 0.25, 1e-12);
  share.take(50.0 * end_of_event_mps2);
  EXPECT_EQ(share.share, 1.0);
  // It stays after a strong force, and no weaker force lowers it.
  share.take(end_of_event_mps2);
  share.pass(0.15);
  EXPECT_EQ(share.share, 1.0);
  share.pass(0.15);
  EXPECT_NEAR(share.share, 0.5, 1e-12);
}

TEST(CountedShare, AFurtherContactContinuesUntilItIsOneOfItsOwn) {
  CountedShare scrape;
  scrape.pass(0.45);
  const CountedShare fresh;
  for (const double gap_s : {0.0, 0.03, 0.0999}) {
    CountedShare same = scrape;
    same.pass(gap_s);
    EXPECT_EQ(scrape.of_further_contact(gap_s).share, same.share) << gap_s;
    EXPECT_EQ(scrape.of_further_contact(gap_s).hold_s, same.hold_s) << gap_s;
  }
  for (const double gap_s : {apart_s, 0.5, 1e9}) {
    EXPECT_EQ(scrape.of_further_contact(gap_s).share, fresh.share) << gap_s;
    EXPECT_EQ(scrape.of_further_contact(gap_s).hold_s, fresh.hold_s) << gap_s;
  }
  // Continuous: no gap decides at a stroke.
  double before = scrape.share;
  for (double gap_s = 0.001; gap_s < 0.25; gap_s += 0.001) {
    const double share = scrape.of_further_contact(gap_s).share;
    EXPECT_LT(std::abs(share - before), 0.02) << gap_s;
    before = share;
  }
}

}  // namespace
}  // namespace crashrank::detail
