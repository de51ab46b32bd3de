// What the steps of the simulation cost and change: scores and first choices of a grid with steps
// of several lengths, against those with the first of them.
#include "bench/rank/situations.hpp"

#include "crashrank/rank/anytime/ranker.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

namespace {

using namespace crashrank;

struct Options {
  std::vector<std::string> scenarios;
  std::vector<double> steps{0.125, 0.5, 1.0, 2.0};
  bool lists = false;
};

/// All scores of a scene, and where they come from.
struct Answer {
  std::vector<double> score;  ///< by candidate
  std::size_t first = 0;      ///< candidate of the first place
  double seconds = 0.0;
  std::uint64_t work = 0;
};

/// Sums of one length of steps over the scenes.
struct Level {
  double step = 1.0;
  double seconds = 0.0;
  std::uint64_t work = 0;
  std::vector<double> errors;        ///< relative, of candidates with harm in the reference
  std::vector<double> correlations;  ///< of the ranks, by scene
  double regret = 0.0;               ///< sum over the scenes, on the reference's scores
  double most_regret = 0.0;
  std::size_t pairs = 0;
  std::size_t inverted = 0;
};

std::vector<double> ranks_of(const std::vector<double>& score) {
  std::vector<std::size_t> order(score.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&score](std::size_t a, std::size_t b) { return score[a] < score[b]; });
  std::vector<double> ranks(score.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && !(score[order[i]] < score[order[end]])) ++end;
    for (std::size_t k = i; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return ranks;
}

/// Spearman's correlation of ranks; equal scores share the mean of their ranks.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = ranks_of(a);
  const std::vector<double> y = ranks_of(b);
  const double middle = 0.5 * static_cast<double>(x.size() - 1);
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - middle) * (x[i] - middle);
    yy += (y[i] - middle) * (y[i] - middle);
    xy += (x[i] - middle) * (y[i] - middle);
  }
  return xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 1.0;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void compare(const Answer& reference, const Answer& answer, Level& level) {
  constexpr double least_persons = 0.001;
  const std::vector<double>& right = reference.score;
  for (std::size_t i = 0; i < right.size(); ++i) {
    if (right[i] > least_persons) {
      level.errors.push_back(std::abs(answer.score[i] / right[i] - 1.0));
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double apart = right[i] - right[j];
      if (apart == 0.0) continue;
      ++level.pairs;
      level.inverted += apart * (answer.score[i] - answer.score[j]) < 0.0 ? 1U : 0U;
    }
  }
  level.correlations.push_back(rank_correlation(right, answer.score));
  const double regret = right[answer.first] - right[reference.first];
  level.regret += regret;
  level.most_regret = std::max(level.most_regret, regret);
}

int run(const Options& options) {
  std::vector<Level> levels(options.steps.size());
  if (options.lists) std::printf("scenario,step,candidate,score\n");
  for (const std::string& file : options.scenarios) {
    Result<bench::Situations> s = bench::make_situations(file, 0, 1, 7);
    if (!s) {
      std::fprintf(stderr, "%s\n", s.error().message().c_str());
      return 3;
    }
    std::vector<Answer> answers;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      levels[k].step = options.steps[k];
      s->scenario.harm.step = options.steps[k];
      Result<Ranker> ranker = bench::prepare_ranker(*s, "harm", 1);
      if (!ranker) {
        std::fprintf(stderr, "%s\n", ranker.error().message().c_str());
        return 3;
      }
      const auto start = std::chrono::steady_clock::now();
      const RankerAnswer answer = ranker->rank(s->candidates);
      Answer& kept = answers.emplace_back();
      kept.seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      kept.work = answer.effort.work;
      kept.first = answer.ranking[0].candidate;
      kept.score.resize(s->candidates.size());
      for (const RankedCandidate& ranked : answer.ranking) {
        kept.score[ranked.candidate] = ranked.score;
      }
      levels[k].seconds += kept.seconds;
      levels[k].work += kept.work;
      compare(answers.front(), kept, levels[k]);
      for (std::size_t i = 0; options.lists && i < kept.score.size(); ++i) {
        std::printf("%s,%g,%zu,%.9g\n", s->name.c_str(), options.steps[k], i, kept.score[i]);
      }
    }
    std::fprintf(stderr, "%s\n", s->name.c_str());
  }
  const auto scenes = static_cast<double>(std::max<std::size_t>(options.scenarios.size(), 1));
  std::printf(
      "\n| steps, times | all scores, s of one thread | tests, million | rank correlation, mean "
      "| least | pairs inverted | median error | 90 %% within | mean regret, persons "
      "| largest |\n");
  std::printf("|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const Level& level : levels) {
    std::printf("| %g | %.2f | %.1f | %.4f | %.4f | %.2f %% | %.2f %% | %.1f %% | %.4f | %.3f |\n",
                level.step, level.seconds, 1e-6 * static_cast<double>(level.work),
                mean(level.correlations),
                *std::min_element(level.correlations.begin(), level.correlations.end()),
                100.0 * static_cast<double>(level.inverted) /
                    static_cast<double>(std::max<std::size_t>(level.pairs, 1)),
                100.0 * quantile(level.errors, 0.5), 100.0 * quantile(level.errors, 0.9),
                level.regret / scenes, level.most_regret);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Accuracy and time of a grid's scores by the length of the simulation's steps");
  app.add_option("SCENARIO", options.scenarios, "Scenario files of shipped models")->required();
  app.add_option("--steps", options.steps, "Times the default; the first is the reference")
      ->delimiter(',');
  app.add_flag("--list", options.lists, "Print every score as CSV first");
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
