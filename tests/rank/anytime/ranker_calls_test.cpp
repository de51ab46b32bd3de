#include "crashrank/rank/anytime/ranker.hpp"

#include "counted_allocations.hpp"
#include "rank/random_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <string>
#include <thread>
#include <vector>

#if defined(__linux__) && defined(__x86_64__)
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace crashrank {
namespace {

struct Ready {
  scenes::Scene scene;
  std::vector<Candidate> candidates;
  std::vector<Motion> motions;

  explicit Ready(std::uint64_t seed) : scene(scenes::traffic(seed)) {
    Result<std::vector<Candidate>> made = make_candidates(scene.scenario, 4.0);
    if (made) candidates = std::move(*made);
    for (const ScenarioActor& actor : scene.scenario.actors) {
      motions.push_back(*make_motion(actor));
    }
  }

  Result<Ranker> ranker(Measure measure, unsigned workers) const {
    RankerOptions options;
    options.rank.measure = measure;
    options.rank.workers = workers;
    return Ranker::prepare(scene.scenario, scene.models, options);
  }
};

constexpr std::array<Measure, 5> without_allocation{
    Measure::harm, Measure::delta_v, Measure::energy, Measure::closing_energy, Measure::intrusion};

TEST(RankerCalls, NothingIsAllocatedFromTheFirstCallOn) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Ready ready(seed);
    for (const Measure measure : without_allocation) {
      for (const unsigned workers : {1U, 2U}) {
        Result<Ranker> ranker = ready.ranker(measure, workers);
        ASSERT_TRUE(ranker.ok());
        std::vector<Motion> moved = ready.motions;
        const Pose start = ready.scene.scenario.ego.pose;
        const long before = test::allocations.load();
        const RankerAnswer answer = ranker->rank(ready.candidates);
        RankBudget budget;
        budget.deadline_s = 1e-3;
        const RankerAnswer cut = ranker->rank(ready.candidates, budget);
        const Status status = ranker->move_actors(start, moved);
        EXPECT_EQ(test::allocations.load(), before) << measure_name(measure) << ", seed " << seed;
        EXPECT_TRUE(answer.complete);
        EXPECT_TRUE(cut.status);
        EXPECT_TRUE(status);
      }
    }
  }
}

TEST(RankerCalls, ErrorsOfStatesAllocateNothing) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Ready ready(seed);
    ready.scene.scenario.ego.uncertainty = {0.3, 0.02, 1.0};
    for (ScenarioActor& actor : ready.scene.scenario.actors) {
      if (actor.model < scenes::pole_model) actor.perception = {0.2, 0.05, 0.5};
    }
    RankerOptions options;
    options.rank.measure = Measure::harm;
    options.rank.sampled_futures = 8;
    Result<Ranker> ranker = Ranker::prepare(ready.scene.scenario, ready.scene.models, options);
    ASSERT_TRUE(ranker.ok());
    const std::vector<double> probabilities(ready.motions.size(), 1.0);
    const long before = test::allocations.load();
    const RankerAnswer answer = ranker->rank(ready.candidates);
    const Status moved = ranker->move_actors(ready.scene.scenario.ego.pose, ready.motions);
    const Status weighed = ranker->weigh_plans(probabilities);
    EXPECT_EQ(test::allocations.load(), before) << "seed " << seed;
    EXPECT_TRUE(answer.complete);
    EXPECT_TRUE(moved);
    EXPECT_TRUE(weighed);
  }
}

TEST(RankerCalls, EnteringAndLeavingAllocateNothing) {
  std::size_t entered = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Ready ready(seed);
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < ready.motions.size(); ++i) {
      ScenarioActor& actor = ready.scene.scenario.actors[i];
      if (actor.model >= scenes::pole_model) continue;
      actor.existence_probability = 0.0;
      actor.model = scenes::person_model;
      places.push_back(i);
    }
    for (const unsigned workers : {1U, 2U}) {
      Result<Ranker> ranker = ready.ranker(Measure::harm, workers);
      ASSERT_TRUE(ranker.ok());
      const long before = test::allocations.load();
      std::size_t sound = 0;
      for (const std::size_t model : {scenes::truck_model, scenes::two_wheeler_model}) {
        for (const std::size_t i : places) {
          sound += ranker->enter(i, model, ready.motions[i]) ? 1U : 0U;
        }
        sound += ranker->rank(ready.candidates).complete ? 1U : 0U;
        for (const std::size_t i : places) sound += ranker->leave(i) ? 1U : 0U;
      }
      EXPECT_EQ(test::allocations.load(), before) << "seed " << seed;
      EXPECT_EQ(sound, 2 * (2 * places.size() + 1));
      entered += places.size();
    }
  }
  EXPECT_GT(entered, 0U);
}

#if defined(__linux__) && defined(__x86_64__)

/// Makes the kernel kill the process at any system call except those that wake and await threads
/// and the one that ends the process. Returns false if the system does not allow such a filter.
bool allow_only_waiting() {
  const auto load = [](std::uint32_t at) {
    return sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, at);
  };
  const auto allow_if = [](std::uint32_t number, std::uint8_t otherwise) {
    return sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, otherwise);
  };
  const auto answer = [](std::uint32_t value) {
    return sock_filter BPF_STMT(BPF_RET | BPF_K, value);
  };
  std::vector<sock_filter> filter;
  filter.push_back(load(offsetof(seccomp_data, nr)));
  for (const std::uint32_t number :
       {static_cast<std::uint32_t>(SYS_futex), static_cast<std::uint32_t>(SYS_sched_yield),
        static_cast<std::uint32_t>(SYS_exit_group)}) {
    filter.push_back(allow_if(number, 1));
    filter.push_back(answer(SECCOMP_RET_ALLOW));
  }
  filter.push_back(answer(SECCOMP_RET_KILL_PROCESS));
  sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program) == 0;
}

/// Waits until all other threads sleep, since starting threads make system calls.
void await_sleeping_workers() {
  const std::string self = std::to_string(::getpid());
  for (int quiet = 0; quiet < 5;) {
    ++quiet;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
      if (task.path().filename() == self) continue;
      std::ifstream file(task.path() / "stat");
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      const std::size_t state = text.rfind(')') + 2;
      if (state >= text.size() || text[state] != 'S') quiet = 0;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

constexpr int not_allowed = 77;

/// Ends the process without destroying the Ranker, which makes system calls.
[[noreturn]] void rank_under_the_filter(const Ready& ready, bool misbehave) {
  Result<Ranker> ranker = ready.ranker(Measure::harm, 3);
  if (!ranker) _exit(1);
  RankBudget budget;
  budget.deadline_s = 2e-3;
  await_sleeping_workers();
  // The first calls touch reserved memory, which the kernel maps without a system call.
  if (!allow_only_waiting()) _exit(not_allowed);
  for (int i = 0; i < 5; ++i) {
    if (!ranker->rank(ready.candidates, budget).status) _exit(2);
    if (!ranker->rank(ready.candidates).complete) _exit(3);
  }
  if (misbehave) syscall(SYS_getppid);
  _exit(0);
}

int outcome_of(const Ready& ready, bool misbehave) {
  const pid_t child = fork();
  if (child == 0) rank_under_the_filter(ready, misbehave);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(RankerCalls, TheOnlySystemCallsWakeAndAwaitWorkers) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "sanitizers make system calls of their own";
#endif
  const Ready ready(3);
  const int outcome = outcome_of(ready, false);
  if (outcome == not_allowed) GTEST_SKIP() << "this system does not allow seccomp filters";
  EXPECT_EQ(outcome, 0);
  // Checks that the filter works.
  EXPECT_LT(outcome_of(ready, true), 0);
}

#endif

}  // namespace
}  // namespace crashrank
