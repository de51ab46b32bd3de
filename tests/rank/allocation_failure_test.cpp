// Makes every allocation of building, saving and loading, and a dense sample of those of ranking,
// fail once. The result must be a typed error without leaks, and the same call must succeed
// afterwards.

#include "crashrank/model/make_model.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/rank/anytime/ranker.hpp"
#include "crashrank/rank/rank.hpp"
#include "crashrank/tree/build.hpp"
#include "rank/scenes.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace {

std::atomic<long> alive{0};
std::atomic<long> until_failure{-1};  // allocations before the failing one; negative: none fails

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (until_failure.load(std::memory_order_relaxed) >= 0 &&
      until_failure.fetch_sub(1, std::memory_order_relaxed) == 0) {
    throw std::bad_alloc();
  }
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
  if (memory == nullptr) throw std::bad_alloc();
  alive.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

void release(void* memory) noexcept {
  if (memory != nullptr) alive.fetch_sub(1, std::memory_order_relaxed);
  std::free(memory);
}

}  // namespace

// Not inlined: a compiler that sees only one function of the pair reports them as mismatched.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  return allocate(bytes, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new[](std::size_t bytes) {
  return allocate(bytes, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
// Callers of the non-throwing form handle its failure themselves, as std::stable_sort does.
[[gnu::noinline]] void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  const long wanted = until_failure.exchange(-1);
  void* const memory = allocate(bytes, alignof(std::max_align_t));
  until_failure = wanted;
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t&) noexcept {
  release(memory);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { release(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { release(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { release(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}

namespace crashrank {
namespace {

/// Outcome of one attempt, without its result.
enum class Outcome { done, out_of_memory, other };

template <class T> Outcome outcome(const Result<T>& result) {
  if (result) return Outcome::done;
  return result.error().code == ErrorCode::out_of_memory ? Outcome::out_of_memory : Outcome::other;
}

/// Calls `attempt` with the first, second, third ... allocation failing until all succeed; after
/// the first `dense` the steps are a sixteenth of the count.
void fail_each(const char* what, const std::function<Outcome()>& attempt,
               long dense = std::numeric_limits<long>::max()) {
  ASSERT_EQ(attempt(), Outcome::done) << what;  // allocate caches of the first call
  long n = 0;
  long tried = 0;
  for (;; n += n < dense ? 1 : 1 + n / 16) {
    const long before = alive.load();
    until_failure = n;
    const Outcome outcome = attempt();
    const bool failed = until_failure.exchange(-1) < 0;
    ASSERT_EQ(alive.load(), before)
        << what << ": allocation " << n << " failing leaves some behind";
    if (!failed) {
      ASSERT_EQ(outcome, Outcome::done) << what;
      break;
    }
    ++tried;
    ASSERT_EQ(outcome, Outcome::out_of_memory) << what << ": allocation " << n;
    ASSERT_EQ(attempt(), Outcome::done) << what << ": once more after allocation " << n;
  }
  std::printf("%s: about %ld allocations, %ld of them failed\n", what, n, tried);
  ASSERT_GT(tried, 0) << what;
}

TriangleMesh sample_mesh(int cells) { return scenes::box_mesh({2, 1, 0.75}, cells); }

TEST(AllocationFailure, BuildingATree) {
  const TriangleMesh mesh = sample_mesh(8);
  for (const BoxFrame frame : {BoxFrame::world, BoxFrame::gaussian}) {
    for (const SplitRule rule :
         {SplitRule::min_relative_segment, SplitRule::paper, SplitRule::sah, SplitRule::median}) {
      BuildOptions options;
      options.rule = rule;
      options.frame = frame;
      options.reinsertion_passes = 1;
      fail_each("build_tree", [&] { return outcome(build_tree(mesh, options)); });
    }
  }
}

TEST(AllocationFailure, BuildingATreeOnThreads) {
  const TriangleMesh mesh = sample_mesh(20);  // 4800 triangles are enough for several threads
  BuildOptions options;
  options.threads = 3;
  // The number of allocations depends on the threads: fail each that the previous run had.
  for (long n = 0; n < 200; n += 3) {
    until_failure = n;
    const Outcome result = outcome(build_tree(mesh, options));
    const bool failed = until_failure.exchange(-1) < 0;
    if (!failed) break;
    ASSERT_NE(result, Outcome::other) << "allocation " << n;
  }
  EXPECT_EQ(outcome(build_tree(mesh, options)), Outcome::done);
}

TEST(AllocationFailure, MakingAModel) {
  const TriangleMesh mesh = sample_mesh(8);
  fail_each("make_model", [&] {
    // The caller makes the copy and handles a failure to make it.
    std::optional<TriangleMesh> copy;
    const long wanted = until_failure.exchange(-1);
    copy.emplace(mesh);
    until_failure = wanted;
    return outcome(make_model(std::move(*copy)));
  });
}

class AllocationFailureOfFiles : public testing::Test {
protected:
  AllocationFailureOfFiles()
      : path_(testing::TempDir() + "allocation_failure." + std::to_string(::getpid())) {
    stored.model = *make_model(sample_mesh(4));
    stored.mass = shell_properties(stored.model.mesh);
  }
  ~AllocationFailureOfFiles() override { std::filesystem::remove(path_); }

  StoredModel stored;
  std::string path_;
};

TEST_F(AllocationFailureOfFiles, SavingAModel) {
  fail_each("encode_model", [&] { return outcome(encode_model(stored)); });
  fail_each("save_model", [&] { return outcome(save_model(stored, path_, true)); });
}

TEST_F(AllocationFailureOfFiles, LoadingAModel) {
  ASSERT_TRUE(save_model(stored, path_, true).ok());
  for (const ModelStorage storage : {ModelStorage::copied, ModelStorage::mapped}) {
    LoadModelOptions options;
    options.storage = storage;
    fail_each("load_model", [&] { return outcome(load_model(path_, options)); });
  }
}

scenes::Scene a_wall_ahead() {
  scenes::Scene scene;
  scene.models.push_back(*make_model(sample_mesh(1)));
  scene.scenario.models.emplace_back();
  scene.scenario.models[0].name = "car";
  scene.scenario.models[0].mass_kg = 1500.0;
  scene.scenario.ego.speed_mps = 15.0;
  scene.scenario.grid.reset();
  scene.scenario.add_straight_braking = false;
  scene.add_candidate("keep going", 0.0);
  scene.add_candidate("brake", -9.0);
  scene.add_actor("wall", 0, 15.0, 0.3);
  return scene;
}

TEST(AllocationFailure, RankingAScenario) {
  const scenes::Scene scene = a_wall_ahead();
  for (const Measure measure : {Measure::polygons, Measure::harm}) {
    RankOptions options;
    options.measure = measure;
    ASSERT_TRUE(scene.ranked(options).ranking[1].collides);
    fail_each(
        "rank", [&] { return outcome(rank(scene.scenario, scene.models, options)); }, 100);
  }
}

TEST(AllocationFailure, PreparingARanker) {
  const scenes::Scene scene = a_wall_ahead();
  for (const unsigned workers : {1U, 2U}) {
    RankerOptions options;
    options.rank.measure = Measure::harm;
    options.rank.workers = workers;
    options.limits.candidates = 16;
    fail_each(
        "Ranker::prepare",
        [&] { return outcome(Ranker::prepare(scene.scenario, scene.models, options)); }, 200);
  }
}

TEST(AllocationFailure, MovingTheActorsOfARankerAndRefusingACall) {
  const scenes::Scene scene = a_wall_ahead();
  RankerOptions options;
  options.rank.measure = Measure::harm;
  Result<Ranker> prepared = Ranker::prepare(scene.scenario, scene.models, options);
  ASSERT_TRUE(prepared.ok());
  Ranker& ranker = *prepared;
  const std::vector<Candidate> candidates = *make_candidates(scene.scenario, 4.0);
  const std::vector<Motion> stands{*make_motion(scene.scenario.actors[0])};
  Pose away = scene.scenario.actors[0].pose;
  away.translation.x() += 40.0;
  const auto timed = [&](double after_s) {
    return std::vector<Motion>{*Motion::timed(
        std::vector<TimedPose>{{0.0, scene.scenario.actors[0].pose}, {after_s, away}})};
  };
  const std::vector<Motion> soon = timed(1.0);
  const Pose start;
  ASSERT_TRUE(ranker.move_actors(start, stands).ok());
  const std::uint64_t before = ranker.rank(candidates).hash;
  for (long n = 0;; ++n) {
    until_failure = n;
    const Status moved = ranker.move_actors(start, soon);
    if (until_failure.exchange(-1) >= 0) {
      ASSERT_GT(n, 0);  // an allocation failed and was reported
      EXPECT_TRUE(moved.ok());
      break;
    }
    ASSERT_FALSE(moved.ok());
    EXPECT_EQ(moved.error().code, ErrorCode::out_of_memory);
    EXPECT_EQ(ranker.rank(candidates).hash, before) << "allocation " << n;
  }
  std::vector<Candidate> wrong = candidates;
  FreeMotion nowhere;
  nowhere.velocity.linear_mps.x() = NAN;
  wrong.front().motion = nowhere;
  for (long n = 0;; ++n) {
    until_failure = n;
    const RankerAnswer answer = ranker.rank(wrong);
    const bool failed = until_failure.exchange(-1) < 0;
    ASSERT_FALSE(answer.status.ok());
    EXPECT_EQ(answer.status.error().code, failed ? ErrorCode::out_of_memory : ErrorCode::bad_input);
    if (failed) continue;
    ASSERT_GT(n, 0);  // the text of the error was allocated
    break;
  }
}

}  // namespace
}  // namespace crashrank
