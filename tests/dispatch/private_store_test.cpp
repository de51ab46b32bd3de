#include "dispatch/sample_bodies.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CRASHRANK_TEST_SANITIZED 1
#else
#define CRASHRANK_TEST_SANITIZED 0
#endif

namespace crashrank {
namespace {

using test::Body;

/// The whole pages inside an array: unreadable while this lives.
class TakenAway {
public:
  template <class T> explicit TakenAway(const Column<T>& array) {
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto begin = reinterpret_cast<std::uintptr_t>(array.data());
    const auto end = reinterpret_cast<std::uintptr_t>(array.data() + array.size());
    const std::uintptr_t first = (begin + page - 1) / page * page;
    const std::uintptr_t last = end / page * page;
    if (last <= first) return;
    memory_ = reinterpret_cast<void*>(first);
    bytes_ = last - first;
    if (mprotect(memory_, bytes_, PROT_NONE) != 0) std::abort();
  }
  TakenAway(const TakenAway&) = delete;
  TakenAway& operator=(const TakenAway&) = delete;
  ~TakenAway() {
    if (bytes_ != 0 && mprotect(memory_, bytes_, PROT_READ | PROT_WRITE) != 0) std::abort();
  }

  std::size_t bytes() const { return bytes_; }

private:
  void* memory_ = nullptr;
  std::size_t bytes_ = 0;
};

struct Scene {
  Body ego{test::hull(100, 100, 1)};
  Body other{test::hull(100, 100, 2)};
  std::vector<Pose> poses = test::crash_poses(8, 0.9, 3);
  std::vector<DispatchQuery> queries = test::queries_for(ego, other, poses);
};

/// Sends all halves of the models that the queries need to every core.
void fill_all_cores(Dispatcher& dispatcher, const Scene& scene, PairLists& lists) {
  DispatchOptions options;
  options.policy = Policy::lowest;
  options.store = StoreMode::private_copy;
  options.depth = 1;
  options.buffer = 1;
  options.caller_works = false;
  for (int quiet = 0; quiet < 20;) {
    const Result<DispatchReport> report = dispatcher.run(scene.queries, lists, options);
    ASSERT_TRUE(report.ok());
    ASSERT_EQ(report.value().end, DispatchEnd::ok);
    options.keep_parts = true;
    quiet = report.value().transferred_bytes == 0 ? quiet + 1 : 0;
  }
}

TEST(PrivateStore, WorkersReadTheirCopiesAloneAndSmallerPartsInHeldOnesAreHeld) {
  const Scene scene;
  PoolOptions pool;
  pool.workers = 4;
  Result<Dispatcher> dispatcher = Dispatcher::start(pool);
  ASSERT_TRUE(dispatcher.ok());
  PairLists lists;
  ASSERT_NO_FATAL_FAILURE(fill_all_cores(*dispatcher, scene, lists));

  DispatchOptions options;
  options.store = StoreMode::private_copy;
  options.keep_parts = true;
  options.caller_works = false;  // it reads the trees
  std::vector<PairLists> answers(4);
  {
    const TakenAway nodes_a(scene.ego.tree.nodes);
    const TakenAway nodes_b(scene.other.tree.nodes);
    const TakenAway triangles_a(scene.ego.tree.triangles);
    const TakenAway triangles_b(scene.other.tree.triangles);
    const TakenAway order_a(scene.ego.tree.order);
    const TakenAway order_b(scene.other.tree.order);
    ASSERT_GT(nodes_a.bytes(), 100'000U);
    ASSERT_GT(triangles_b.bytes(), 500'000U);
    ASSERT_GT(order_b.bytes(), 50'000U);
    std::size_t i = 0;
    for (const std::uint32_t depth : {1U, 4U, 9U, 16U}) {
      options.depth = depth;
      const Result<DispatchReport> report = dispatcher->run(scene.queries, answers[i++], options);
      ASSERT_TRUE(report.ok());
      EXPECT_EQ(report.value().end, DispatchEnd::ok);
      EXPECT_EQ(report.value().transferred_bytes, 0U);
      EXPECT_GT(report.value().jobs, scene.queries.size());
    }
  }
  std::vector<Pair> pairs;
  for (std::size_t query = 0; query < scene.queries.size(); ++query) {
    const std::vector<Pair> expected =
        test::expected_pairs(scene.ego, scene.other, scene.poses[query]);
    EXPECT_GT(expected.size(), 50U);
    for (const PairLists& answer : answers) {
      answer.gather_sorted(query, pairs);
      EXPECT_EQ(pairs, expected);
    }
  }
}

// The test above would say nothing if reading the tree did no harm.
TEST(PrivateStoreDeathTest, SharedTreesAreRead) {
  if (CRASHRANK_TEST_SANITIZED) GTEST_SKIP() << "a sanitizer answers the fault in its own way";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        const Scene scene;
        PoolOptions pool;
        pool.workers = 2;
        Result<Dispatcher> dispatcher = Dispatcher::start(pool);
        PairLists lists;
        DispatchOptions options;
        options.depth = 6;
        const TakenAway triangles(scene.ego.tree.triangles);
        if (dispatcher->run(scene.queries, lists, options).ok()) std::exit(0);
      },
      testing::KilledBySignal(SIGSEGV), "");
}

TEST(PrivateStore, CopiesEveryPartOnceAndKeepsItFromQueryToQuery) {
  const Scene scene;
  PoolOptions pool;
  pool.workers = 1;
  Result<Dispatcher> dispatcher = Dispatcher::start(pool);
  ASSERT_TRUE(dispatcher.ok());
  PairLists lists;
  DispatchOptions options;
  options.store = StoreMode::private_copy;
  options.depth = 5;
  options.caller_works = false;  // all goes through the store
  const Result<DispatchReport> batch = dispatcher->run(scene.queries, lists, options);
  ASSERT_TRUE(batch.ok());
  // One core: each part that any query needs, once.
  EXPECT_LE(batch.value().relative_transfer(), 1.0);
  EXPECT_EQ(batch.value().transferred_bytes, batch.value().peak_part_bytes);
  std::uint64_t singly = 0;
  for (const DispatchQuery& query : scene.queries) {
    const Result<DispatchReport> single = dispatcher->run({&query, 1}, lists, options);
    ASSERT_TRUE(single.ok());
    singly += single.value().transferred_bytes;
  }
  EXPECT_GT(singly, 2 * batch.value().transferred_bytes);

  // One body in the other: both halves of both are needed.
  const std::vector<DispatchQuery> amid =
      test::queries_for(scene.ego, scene.other, {pose_from_angles({0.0, 0.0, 0.0}, 0.0, 0.0, 0.0)});
  options.depth = 1;
  const Result<DispatchReport> whole = dispatcher->run(amid, lists, options);
  ASSERT_TRUE(whole.ok());
  const std::size_t roots = 2 * sizeof(Node);
  EXPECT_EQ(whole.value().transferred_bytes,
            scene.ego.tree.bytes() + scene.other.tree.bytes() - roots);

  options.store = StoreMode::shared;  // counted alike
  const Result<DispatchReport> counted = dispatcher->run(amid, lists, options);
  ASSERT_TRUE(counted.ok());
  EXPECT_EQ(counted.value().transferred_bytes, whole.value().transferred_bytes);
}

}  // namespace
}  // namespace crashrank
