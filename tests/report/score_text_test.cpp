#include "report/score_text.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using detail::fixed_text;
using detail::score_texts;

CandidateResult row(double score, double lowest, double highest) {
  CandidateResult ranked;
  ranked.score = score;
  ranked.score_interval = {lowest, highest};
  return ranked;
}

CandidateResult exact(double score) { return row(score, score, score); }

std::vector<std::string> texts(std::vector<CandidateResult> rows) {
  RankResult result;
  result.ranking = std::move(rows);
  return score_texts(result);
}

using Texts = std::vector<std::string>;

TEST(ScoreText, HasFiveDigitsAndNoneThatTheIntervalLeavesOpen) {
  EXPECT_EQ(texts({exact(0.0), exact(0.217412), exact(3.0), exact(1234.5678), exact(4321987.2)}),
            (Texts{"0", "0.21741", "3", "1234.6", "4321987"}));
  EXPECT_EQ(texts({row(0.2174, 0.1634, 0.3512), row(4321.987, 4000.0, 4999.0)}),
            (Texts{"0.2", "4300"}));
}

TEST(ScoreText, ACrashNeverPrintsAsZero) {
  EXPECT_EQ(texts({row(0.0, 0.0, 0.3), row(3.2e-4, 0.0, 0.3), row(0.02, 0.0, 900.0)}),
            (Texts{"0", "0.0003", "0.02"}));
  EXPECT_EQ(texts({row(4e-18, 0.0, 1e-17), exact(2e-14), row(0.7, 0.0, 500.0)}),
            (Texts{"4e-18", "2.0000e-14", "0.7"}));
}

TEST(ScoreText, DigitsNeverContradictTheOrder) {
  // Alone they would print as 0.3 and 0.27.
  EXPECT_EQ(texts({row(0.26, 0.1, 0.3), row(0.27, 0.26, 0.28)}), (Texts{"0.26", "0.27"}));
  EXPECT_EQ(texts({row(0.217, 0.1, 0.3), row(0.241, 0.1, 0.3)}), (Texts{"0.22", "0.24"}));
  EXPECT_EQ(texts({exact(1.0), exact(1.000004), exact(1.00001)}),
            (Texts{"1", "1.000004", "1.00001"}));
  // What the first two need makes the one before them finer.
  EXPECT_EQ(texts({row(0.94, 0.0, 3.0), row(0.96, 0.5, 1.5), row(0.963, 0.5, 1.5)}),
            (Texts{"0.9", "0.960", "0.963"}));
}

TEST(ScoreText, EqualScoresPrintAlike) {
  EXPECT_EQ(texts({row(0.26, 0.1, 0.3), row(0.26, 0.255, 0.265), exact(0.26)}),
            (Texts{"0.26", "0.26", "0.26"}));
}

TEST(ScoreText, NineDigitsAreTheMost) {
  EXPECT_EQ(texts({exact(0.123456789012), exact(0.123456789013)}),
            (Texts{"0.123456789", "0.123456789"}));
}

TEST(ScoreText, RandomScoresKeepTheirOrder) {
  std::uint64_t state = 7;
  const auto uniform = [&state] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state >> 11U) * 0x1p-53;
  };
  for (int round = 0; round < 300; ++round) {
    std::vector<CandidateResult> rows;
    double score = round % 3 == 0 ? 0.0 : 1e-3 * uniform();
    for (int i = 0; i < 40; ++i) {
      const double below = uniform() < 0.3 ? 0.0 : score * uniform();
      const double above = uniform() < 0.3 ? 0.0 : 10.0 * uniform() * score;
      rows.push_back(row(score, score - below, score + above));
      if (uniform() < 0.8) score = score * (1.0 + 0.2 * uniform() * uniform()) + 1e-7 * uniform();
    }
    const Texts printed = texts(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double shown = std::strtod(printed[i].c_str(), nullptr);
      EXPECT_EQ(shown == 0.0, *rows[i].score == 0.0) << printed[i];
      if (i == 0) continue;
      const double before = std::strtod(printed[i - 1].c_str(), nullptr);
      EXPECT_EQ(printed[i - 1] == printed[i], *rows[i - 1].score == *rows[i].score);
      EXPECT_LE(before, shown) << printed[i - 1] << " " << printed[i];
    }
  }
}

TEST(ScoreText, AScoreThatIsNotKnownIsItsInterval) {
  CandidateResult open;
  open.score_interval = {0.5, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(texts({exact(0.0), open, exact(2.0)}), (Texts{"0", "0.5 to inf", "2"}));
  open.score_estimate = 0.823;
  EXPECT_EQ(texts({open}), (Texts{"0.5 to inf (about 0.823)"}));
}

TEST(ScoreText, OnlyCertaintyIsPrintedAsCertain) {
  using detail::percent_text;
  EXPECT_EQ(percent_text(0.0), "0 %");
  EXPECT_EQ(percent_text(1e-9), "<1 %");
  EXPECT_EQ(percent_text(0.006), "1 %");
  EXPECT_EQ(percent_text(0.5), "50 %");
  EXPECT_EQ(percent_text(0.996), ">99 %");
  EXPECT_EQ(percent_text(1.0), "100 %");
}

TEST(ScoreText, FixedDecimalsShowWhatIsNotZero) {
  EXPECT_EQ(fixed_text(0.0, 1), "0.0");
  EXPECT_EQ(fixed_text(0.04, 1), "0.04");
  EXPECT_EQ(fixed_text(0.06, 1), "0.1");
  EXPECT_EQ(fixed_text(12.34, 1), "12.3");
}

}  // namespace
}  // namespace crashrank
