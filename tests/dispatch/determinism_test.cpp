#include "dispatch/sample_bodies.hpp"

#include "crashrank/collide/pair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace crashrank {
namespace {

using test::Body;

/// Threads that work and sleep by turns of random length, so that workers are held up at places
/// that differ from run to run.
class Disturbance {
public:
  explicit Disturbance(int threads) {
    for (int i = 0; i < threads; ++i) {
      threads_.emplace_back([this, i] {
        std::mt19937_64 random(static_cast<std::uint64_t>(i) + 1);
        while (!stop_.load()) {
          const auto until =
              std::chrono::steady_clock::now() + std::chrono::microseconds(random() % 200);
          while (std::chrono::steady_clock::now() < until) {
          }
          std::this_thread::sleep_for(std::chrono::microseconds(random() % 200));
        }
      });
    }
  }
  Disturbance(const Disturbance&) = delete;
  Disturbance& operator=(const Disturbance&) = delete;
  ~Disturbance() {
    stop_.store(true);
    for (std::thread& thread : threads_) thread.join();
  }

private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

std::string hash_of(const PairLists& lists, std::vector<Pair>& pairs) {
  std::string all;
  for (std::size_t query = 0; query < lists.queries(); ++query) {
    lists.gather_sorted(query, pairs);
    all += pairs_hash(pairs) + " ";
  }
  return all;
}

#if defined(__SANITIZE_THREAD__)  // fifteen times slower: fewer, of every kind
const std::vector<std::uint32_t> worker_counts{2, 4};
const std::vector<std::uint32_t> buffers{1, 8};
#else
const std::vector<std::uint32_t> worker_counts{1, 2, 4, 7};
const std::vector<std::uint32_t> buffers{1, 3, 8, 64};
#endif

/// A policy, and whether the calling thread works where the policy lets it.
struct Scheme {
  Policy policy;
  bool caller_works;
};
const std::vector<Scheme> schemes{{Policy::best_match, true}, {Policy::random, true},
                                  {Policy::lowest, true},     {Policy::best_match_load, true},
                                  {Policy::late_match, true}, {Policy::late_match, false}};

// Policies x depths x buffers x workers x stores and kernels.
TEST(Determinism, OneHashForEveryCombinationUnderShuffledTiming) {
  const Body ego(test::hull(24, 32, 1));
  const Body other(test::hull(20, 36, 2));
  const std::vector<Pose> poses = test::crash_poses(3, 0.7, 9);
  struct Engine {
    Kernel kernel;
    StoreMode store;
    std::vector<DispatchQuery> queries;
  };
  const Engine engines[] = {
      {Kernel::scalar, StoreMode::shared, test::queries_for(ego, other, poses)},
      {Kernel::scalar, StoreMode::private_copy, test::queries_for(ego, other, poses)},
      {Kernel::fast, StoreMode::shared, test::queries_for(ego, other, poses, Kernel::fast)}};
  std::vector<Pair> pairs;
  std::string expected;
  for (const Pose& pose : poses) {
    pairs = test::expected_pairs(ego, other, pose);
    ASSERT_GT(pairs.size(), 20U);
    expected += pairs_hash(pairs) + " ";
  }
  const Disturbance disturbance(2);
  PairLists lists;
  std::size_t combinations = 0;
  for (const std::uint32_t workers : worker_counts) {
    PoolOptions pool;
    pool.workers = workers;
    Result<Dispatcher> dispatcher = Dispatcher::start(pool);
    ASSERT_TRUE(dispatcher.ok());
    for (const Scheme& scheme : schemes) {
      for (std::uint32_t depth = auto_depth; depth <= max_distribution_depth; ++depth) {
        for (const std::uint32_t buffer : buffers) {
          for (const Engine& engine : engines) {
            DispatchOptions options;
            options.policy = scheme.policy;
            options.caller_works = scheme.caller_works;
            options.depth = depth;
            options.buffer = buffer;
            options.store = engine.store;
            options.kernel = engine.kernel;
            options.seed = combinations;
            ++combinations;
            const Result<DispatchReport> report = dispatcher->run(engine.queries, lists, options);
            ASSERT_TRUE(report.ok());
            ASSERT_EQ(report.value().end, DispatchEnd::ok);
            ASSERT_EQ(hash_of(lists, pairs), expected)
                << policy_name(scheme.policy) << " caller " << scheme.caller_works << " depth "
                << depth << " buffer " << buffer << " workers " << workers << " store "
                << static_cast<int>(engine.store) << " kernel " << static_cast<int>(engine.kernel);
          }
        }
      }
    }
  }
  for (const Policy policy : all_policies()) {
    EXPECT_TRUE(std::any_of(schemes.begin(), schemes.end(),
                            [&](const Scheme& scheme) { return scheme.policy == policy; }));
  }
  std::cout << combinations
            << " combinations of policy, depth, buffer, workers and mode: one hash\n";
  EXPECT_EQ(combinations, worker_counts.size() * schemes.size() * 17 * buffers.size() * 3);
}

}  // namespace
}  // namespace crashrank
