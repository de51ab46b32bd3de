// How late a Ranker's answers are, beside an empty loop that waits for the same deadline, and what
// they know by then. Where the time goes without a deadline.
#include "bench/rank/situations.hpp"

#include "crashrank/rank/anytime/ranker.hpp"

#include <CLI/CLI.hpp>

#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace crashrank;
using Clock = std::chrono::steady_clock;

double micros(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

/// The least value that a share of the values does not exceed.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  const auto place = static_cast<std::size_t>(std::ceil(share * count));
  return values[std::min(values.size() - 1, place == 0 ? 0 : place - 1)];
}

struct Options {
  std::vector<std::string> scenarios;
  std::vector<double> deadlines_ms{1, 5, 20, 100};
  std::vector<std::size_t> calls{2000, 500, 150, 40};
  std::string measure = "harm";
  std::string load = "none";
  std::size_t triangles = 0;
  std::size_t variants = 8;
  unsigned workers = 2;
  double rest = 0.2;
  bool fifo = false;
};

void print_quantiles(std::vector<double>& late_us) {
  for (const double share : {0.5, 0.99, 0.999, 0.9999, 1.0}) {
    std::printf(",%.1f", quantile(late_us, share));
  }
}

/// What malloc has given out and not got back.
std::size_t allocated() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// Memory that Ranker::prepare sets aside, and how much more for each further thread.
void tell_memory(const bench::Situations& s, const std::string& measure) {
  std::size_t bytes[2] = {};
  for (const unsigned workers : {1U, 2U}) {
    const std::size_t before = allocated();
    const Result<Ranker> ranker = bench::prepare_ranker(s, measure, workers);
    if (!ranker) return;
    bytes[workers - 1] = allocated() - before;
  }
  std::printf("# %s, memory of a Ranker: %.1f MB with one thread, %.1f MB for each more\n",
              s.name.c_str(), 1e-6 * static_cast<double>(bytes[0]),
              1e-6 * static_cast<double>(bytes[1] - bytes[0]));
}

/// Which candidate is first in every variant, by a call without a deadline.
std::vector<std::size_t> right_answers(Ranker& ranker, const bench::Situations& s) {
  std::vector<std::size_t> first;
  for (const std::vector<Motion>& motions : s.motions) {
    if (!ranker.move_actors(s.scenario.ego.pose, motions)) return {};
    first.push_back(ranker.rank(s.candidates).ranking[0].candidate);
  }
  return first;
}

void time_whole(Ranker& ranker, const bench::Situations& s) {
  for (const bool first_only : {true, false}) {
    RankBudget budget;
    budget.first_place_only = first_only;
    std::vector<double> us;
    std::vector<double> bounds;
    RankerEffort sum;
    for (const std::vector<Motion>& motions : s.motions) {
      if (!ranker.move_actors(s.scenario.ego.pose, motions)) return;
      const auto start = Clock::now();
      const RankerAnswer answer = ranker.rank(s.candidates, budget);
      us.push_back(micros(Clock::now() - start));
      bounds.push_back(1e6 * answer.effort.bounds_s);
      sum.work += answer.effort.work;
      sum.without_search += answer.effort.without_search;
      sum.without_crash += answer.effort.without_crash;
      sum.fully_evaluated += answer.effort.fully_evaluated;
      sum.left_early += answer.effort.left_early;
      sum.prepare_s = answer.effort.prepare_s;
    }
    const auto share = [&](std::size_t n) {
      return static_cast<double>(n) / static_cast<double>(s.motions.size());
    };
    std::printf(
        "# %s, %s: %zu candidates, %zu triangles; load %.0f ms, trees %.0f ms, prepare "
        "%.1f ms; median call %.2f ms, of it swept boxes %.2f ms; by boxes %.1f, by contacts "
        "%.1f, by crashes %.1f, left early %.1f; %.0f tests\n",
        s.name.c_str(), first_only ? "first place" : "all places", s.candidates.size(), s.triangles,
        1e3 * s.load_s, 1e3 * s.build_s, 1e3 * sum.prepare_s, 1e-3 * quantile(us, 0.5),
        1e-3 * quantile(bounds, 0.5), share(sum.without_search), share(sum.without_crash),
        share(sum.fully_evaluated), share(sum.left_early),
        static_cast<double>(sum.work) / static_cast<double>(s.motions.size()));
  }
}

void time_deadline(Ranker& ranker, const bench::Situations& s, double deadline_ms,
                   std::size_t calls, double rest, const std::vector<std::size_t>& right,
                   const std::string& head) {
  RankBudget budget;
  budget.deadline_s = 1e-3 * deadline_ms;
  const auto deadline = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double, std::milli>(deadline_ms));
  const std::chrono::duration<double, std::milli> pause(2.0 * deadline_ms * rest / (1.0 - rest));
  std::vector<double> late;
  std::vector<double> moving;  // waits for workers that the call before left behind
  std::vector<double> spin;
  std::size_t correct = 0;
  std::size_t proved = 0;
  std::size_t complete = 0;
  for (std::size_t call = 0; call < calls; ++call) {
    const std::size_t variant = call % s.motions.size();
    auto start = Clock::now();
    if (!ranker.move_actors(s.scenario.ego.pose, s.motions[variant])) return;
    moving.push_back(micros(Clock::now() - start));
    start = Clock::now();
    const RankerAnswer answer = ranker.rank(s.candidates, budget);
    late.push_back(std::max(0.0, micros(Clock::now() - start - deadline)));
    if (answer.ranking[0].candidate == right[variant]) ++correct;
    if (answer.proved) ++proved;
    if (answer.complete) ++complete;
    start = Clock::now();
    while (Clock::now() - start < deadline) {
    }
    spin.push_back(std::max(0.0, micros(Clock::now() - start - deadline)));
    std::this_thread::sleep_for(pause);
  }
  const auto share = [calls](std::size_t n) {
    return static_cast<double>(n) / static_cast<double>(calls);
  };
  std::printf("%s,%s,%zu,%zu,%g,%zu", head.c_str(), s.name.c_str(), s.candidates.size(),
              s.triangles, deadline_ms, calls);
  print_quantiles(late);
  print_quantiles(spin);
  print_quantiles(moving);
  std::printf(",%.4f,%.4f,%.4f\n", share(correct), share(proved), share(complete));
  std::fflush(stdout);
}

int run(const Options& options) {
  bool fifo = false;
  if (options.fifo) {
    sched_param param{};
    param.sched_priority = 50;
    // Threads started later inherit it; memory that was touched stays.
    fifo =
        sched_setscheduler(0, SCHED_FIFO, &param) == 0 && mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    if (!fifo) std::printf("# SCHED_FIFO with locked memory is not permitted here\n");
  }
  utsname system{};
  uname(&system);
  const std::string head = "\"" + processor() + "\"," + system.release + "," +
                           (fifo ? "fifo" : "other") + "," + options.load + "," +
                           std::to_string(options.workers);
  std::printf(
      "processor,kernel,scheduler,load,threads,scenario,candidates,triangles,deadline_ms,"
      "calls,late_p50_us,late_p99_us,late_p999_us,late_p9999_us,late_worst_us,spin_p50_us,"
      "spin_p99_us,spin_p999_us,spin_p9999_us,spin_worst_us,move_p50_us,move_p99_us,move_p999_us,"
      "move_p9999_us,move_worst_us,first_right,first_proved,complete\n");
  for (const std::string& file : options.scenarios) {
    const Result<bench::Situations> s =
        bench::make_situations(file, options.triangles, options.variants, 7);
    if (!s) {
      std::fprintf(stderr, "%s\n", s.error().message().c_str());
      return 3;
    }
    tell_memory(*s, options.measure);
    Result<Ranker> ranker = bench::prepare_ranker(*s, options.measure, options.workers);
    if (!ranker) {
      std::fprintf(stderr, "%s\n", ranker.error().message().c_str());
      return 3;
    }
    const std::vector<std::size_t> right = right_answers(*ranker, *s);
    time_whole(*ranker, *s);
    for (std::size_t i = 0; i < options.deadlines_ms.size(); ++i) {
      const std::size_t calls = options.calls[std::min(i, options.calls.size() - 1)];
      time_deadline(*ranker, *s, options.deadlines_ms[i], calls, options.rest, right, head);
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Lateness of answers with a deadline; CSV on standard output");
  app.add_option("SCENARIO", options.scenarios, "Scenario files of shipped models")->required();
  app.add_option("--deadlines-ms", options.deadlines_ms, "Deadlines")->delimiter(',');
  app.add_option("--calls", options.calls,
                 "Calls for each deadline; 100000,10000,2000,500 is the long form")
      ->delimiter(',');
  app.add_option("--measure", options.measure, "As in crashrank rank");
  app.add_option("--triangles", options.triangles, "Of each model, 0: as shipped");
  app.add_option("--variants", options.variants, "Situations that calls take in turn");
  app.add_option("--workers", options.workers, "Threads, the caller's included");
  app.add_option(
         "--rest", options.rest,
         "Share of the time to sleep between calls: the kernel stops real-time threads that "
         "never do, for a twentieth of every second")
      ->check(CLI::Range(0.0, 0.9));
  app.add_option("--load", options.load, "What runs beside it, for the table");
  app.add_flag("--fifo", options.fifo, "Real-time scheduling and locked memory");
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
