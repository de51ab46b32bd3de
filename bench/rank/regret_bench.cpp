// How harmful the first choice of a cut answer is, on the scores of the full answer, beside braking
// as hard as possible with the least steering and beside the best.
#include "bench/rank/situations.hpp"

#include "crashrank/rank/anytime/ranker.hpp"

#include <CLI/CLI.hpp>

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace crashrank;

struct Options {
  std::vector<std::string> scenarios;
  std::vector<double> deadlines_ms{5, 10, 20, 50, 100};
  std::vector<std::uint64_t> works;
  std::size_t calls = 3;
  unsigned workers = 2;
  bool fifo = false;
};

/// A limit of the time or of the work.
struct Cut {
  RankBudget budget;
  std::string name;
  std::size_t calls = 1;
  double regret = 0.0;  ///< sum over the scenes of the means of their calls
  double most = 0.0;    ///< largest of any call
  std::size_t scenes = 0;
  std::size_t worse = 0;  ///< scenes with a call that chose more harm than braking does
};

std::vector<Cut> cuts_of(const Options& options) {
  std::vector<Cut> cuts;
  for (const double ms : options.deadlines_ms) {
    Cut cut;
    cut.budget.deadline_s = 1e-3 * ms;
    cut.calls = options.calls;
    char name[32];
    std::snprintf(name, sizeof(name), "%g ms", ms);
    cut.name = name;
    cuts.push_back(cut);
  }
  for (const std::uint64_t work : options.works) {
    Cut cut;
    cut.budget.work = work;
    cut.name = "work " + std::to_string(work);
    cuts.push_back(cut);
  }
  return cuts;
}

/// What the full answer says of the candidates.
struct Truth {
  std::vector<double> score;  ///< by candidate
  std::size_t best = 0;
  std::size_t braking = 0;
};

Truth truth_of(Ranker& ranker, const std::vector<Candidate>& candidates) {
  Truth truth;
  truth.score.resize(candidates.size());
  const RankerAnswer answer = ranker.rank(candidates);
  truth.best = answer.ranking[0].candidate;
  truth.braking = truth.best;
  const bool demoted = !answer.ranking[0].feasible;
  for (const RankedCandidate& ranked : answer.ranking) {
    truth.score[ranked.candidate] = ranked.score;
    if (!ranked.feasible && !demoted) continue;
    const Candidate& c = candidates[ranked.candidate];
    const Candidate& hardest = candidates[truth.braking];
    if (std::pair(c.acceleration_mps2, std::abs(c.curvature_per_m)) <
        std::pair(hardest.acceleration_mps2, std::abs(hardest.curvature_per_m))) {
      truth.braking = ranked.candidate;
    }
  }
  return truth;
}

void try_cut(Ranker& ranker, const bench::Situations& s, const Truth& truth, Cut& cut) {
  const double best = truth.score[truth.best];
  const double braking = truth.score[truth.braking];
  double sum = 0.0;
  double most = 0.0;
  for (std::size_t call = 0; call < cut.calls; ++call) {
    const RankerAnswer answer = ranker.rank(s.candidates, cut.budget);
    const double chosen = truth.score[answer.ranking[0].candidate];
    sum += chosen;
    most = std::max(most, chosen);
    std::printf("%s,%zu,%s,%zu,%.5f,%.5f,%.5f,%s,%.2f,%llu\n", s.name.c_str(), s.candidates.size(),
                cut.name.c_str(), call, best, chosen, braking, basis_name(answer.basis),
                1e3 * answer.elapsed_s, static_cast<unsigned long long>(answer.effort.work));
  }
  cut.regret += sum / static_cast<double>(cut.calls) - best;
  cut.most = std::max(cut.most, most - best);
  cut.worse += most > braking ? 1 : 0;
  ++cut.scenes;
  std::fflush(stdout);
}

/// Gives this thread, and those that it starts from now on, real-time scheduling or takes it away.
/// Full answers take long and do without.
bool schedule(bool fifo) {
  sched_param param{};
  param.sched_priority = fifo ? 50 : 0;
  return sched_setscheduler(0, fifo ? SCHED_FIFO : SCHED_OTHER, &param) == 0;
}

int run(const Options& options) {
  std::vector<Cut> cuts = cuts_of(options);
  double braking_regret = 0.0;
  std::printf("scenario,candidates,cut,call,best,chosen,braking,basis,elapsed_ms,work\n");
  for (const std::string& file : options.scenarios) {
    const Result<bench::Situations> s = bench::make_situations(file, 0, 1, 7);
    if (!s) {
      std::fprintf(stderr, "%s\n", s.error().message().c_str());
      return 3;
    }
    Result<Ranker> full = bench::prepare_ranker(*s, "harm", options.workers);
    if (!full) {
      std::fprintf(stderr, "%s\n", full.error().message().c_str());
      return 3;
    }
    const Truth truth = truth_of(*full, s->candidates);
    braking_regret += truth.score[truth.braking] - truth.score[truth.best];
    if (options.fifo && !schedule(true)) std::printf("# SCHED_FIFO is not permitted here\n");
    Result<Ranker> ranker = bench::prepare_ranker(*s, "harm", options.workers);
    if (!ranker) return 3;
    for (Cut& cut : cuts) try_cut(*ranker, *s, truth, cut);
    schedule(false);
  }
  const auto scenes = static_cast<double>(std::max<std::size_t>(options.scenarios.size(), 1));
  std::printf("\n| cut | scenes | mean regret, persons | largest | worse than braking |\n");
  std::printf("|---|---:|---:|---:|---:|\n");
  for (const Cut& cut : cuts) {
    std::printf("| %s | %zu | %.4f | %.3f | %zu |\n", cut.name.c_str(), cut.scenes,
                cut.regret / scenes, cut.most, cut.worse);
  }
  std::printf("| braking always | %zu | %.4f | | |\n", options.scenarios.size(),
              braking_regret / scenes);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Harm of the first choice of cut answers: CSV, and a table of the regret");
  app.add_option("SCENARIO", options.scenarios, "Scenario files of shipped models")->required();
  app.add_option("--deadlines-ms", options.deadlines_ms, "Deadlines")->delimiter(',');
  app.add_option("--works", options.works, "Work budgets, the same on every machine")
      ->delimiter(',');
  app.add_option("--calls", options.calls, "Calls for each deadline");
  app.add_option("--workers", options.workers, "Threads, the caller's included");
  app.add_flag("--fifo", options.fifo, "Real-time scheduling of the cut answers");
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
