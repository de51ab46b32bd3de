// How long a Ranker works between two looks at the clock: what an answer is late by at most, were
// the thread never stopped. Its steps are the same in every run, the machine's interruptions are
// not: of each stretch the shortest of many runs counts.
#include "bench/rank/situations.hpp"

#include "crashrank/rank/anytime/ranker.hpp"

#include <CLI/CLI.hpp>

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

/// Times of the looks at the clock since recording began, ns. Set aside beforehand.
std::vector<std::int64_t> looks;
bool recording = false;

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

}  // namespace

// Every steady_clock of the process ends up here. The system call costs some 0.1 µs more than what
// it stands in for.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const auto end = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  if (recording && looks.size() < looks.capacity()) looks.push_back(nanoseconds(*time));
  return end;
}

namespace {

using namespace crashrank;

struct Options {
  std::vector<std::string> scenarios;
  std::string measure = "harm";
  std::size_t triangles = 0;
  std::size_t variants = 8;
  std::size_t repeat = 20;
};

double quantile(const std::vector<std::int64_t>& sorted, double share) {
  const auto last = static_cast<double>(sorted.size() - 1);
  return 1e-3 * static_cast<double>(sorted[static_cast<std::size_t>(share * last)]);
}

/// Shortest of all runs, stretch by stretch; empty where runs took different steps.
std::vector<std::int64_t> stretches(Ranker& ranker, View<const Candidate> candidates,
                                    std::size_t repeat) {
  RankBudget budget;
  budget.deadline_s = 1e5;
  std::vector<std::int64_t> shortest;
  for (std::size_t run = 0; run < repeat; ++run) {
    looks.clear();
    recording = true;
    ranker.rank(candidates, budget);
    recording = false;
    if (looks.size() < 2 || looks.size() == looks.capacity()) return {};
    if (run == 0) shortest.assign(looks.size() - 1, INT64_MAX);
    if (shortest.size() != looks.size() - 1) return {};
    for (std::size_t i = 0; i < shortest.size(); ++i) {
      shortest[i] = std::min(shortest[i], looks[i + 1] - looks[i]);
    }
  }
  return shortest;
}

int run(const Options& options) {
  looks.reserve(std::size_t{1} << 22U);
  std::printf("scenario,situations,looks,p50_us,p99_us,p999_us,longest_us\n");
  for (const std::string& file : options.scenarios) {
    const Result<bench::Situations> s =
        bench::make_situations(file, options.triangles, options.variants, 7);
    if (!s) {
      std::fprintf(stderr, "%s\n", s.error().message().c_str());
      return 3;
    }
    Result<Ranker> ranker = bench::prepare_ranker(*s, options.measure, 1);
    if (!ranker) {
      std::fprintf(stderr, "%s\n", ranker.error().message().c_str());
      return 3;
    }
    std::vector<std::int64_t> all;
    for (const std::vector<Motion>& motions : s->motions) {
      if (!ranker->move_actors(s->scenario.ego.pose, motions)) return 1;
      const std::vector<std::int64_t> found = stretches(*ranker, s->candidates, options.repeat);
      if (found.empty()) {
        std::fprintf(stderr, "%s: runs differ in their looks at the clock\n", s->name.c_str());
        return 1;
      }
      all.insert(all.end(), found.begin(), found.end());
    }
    std::sort(all.begin(), all.end());
    std::printf("%s,%zu,%zu,%.1f,%.1f,%.1f,%.1f\n", s->name.c_str(), s->motions.size(), all.size(),
                quantile(all, 0.5), quantile(all, 0.99), quantile(all, 0.999), quantile(all, 1.0));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Work between two looks at the clock, in processor time; CSV on standard output");
  app.add_option("SCENARIO", options.scenarios, "Scenario files of shipped models")->required();
  app.add_option("--measure", options.measure, "As in crashrank rank");
  app.add_option("--triangles", options.triangles, "Of each model, 0: as shipped");
  app.add_option("--variants", options.variants, "Situations");
  app.add_option("--repeat", options.repeat, "Runs, of which the shortest counts")
      ->check(CLI::Range(1, 100000));
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
