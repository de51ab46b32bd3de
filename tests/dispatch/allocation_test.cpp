#include "counted_allocations.hpp"
#include "dispatch/sample_bodies.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace crashrank {
namespace {

using test::allocations;
using test::Body;
using test::other_threads_fail;

PoolOptions with_workers(std::uint32_t workers) {
  PoolOptions options;
  options.workers = workers;
  return options;
}

TEST(Allocation, AWarmDispatchAllocatesNothing) {
  const Body ego(test::hull(40, 50, 1));
  const Body other(test::hull(30, 70, 2));
  const std::vector<DispatchQuery> queries =
      test::queries_for(ego, other, test::crash_poses(6, 0.8, 3));
  // One worker: which core gets what is the same every time.
  Result<Dispatcher> dispatcher = Dispatcher::start(with_workers(1));
  ASSERT_TRUE(dispatcher.ok());
  PairLists lists;
  for (const StoreMode store : {StoreMode::shared, StoreMode::private_copy}) {
    for (const Policy policy : all_policies()) {
      DispatchOptions options;
      options.policy = policy;
      options.store = store;
      options.depth = 9;
      // Which job shares a batch with which depends on timing, and so does how much room the lists
      // need: warm is who has gone ten times without growing one, and even then one may grow now
      // and then. What allocates per job does so every time, and never gets warm.
      constexpr int in_a_row = 10;
      int quiet = 0;
      for (int runs = 0; quiet < in_a_row && runs < 500; ++runs) {
        const long before = allocations.load();
        ASSERT_TRUE(dispatcher->run(queries, lists, options).ok());
        quiet = allocations.load() == before ? quiet + 1 : 0;
      }
      ASSERT_EQ(quiet, in_a_row) << policy_name(policy);
      int grown = 0;
      for (int i = 0; i < 20; ++i) {
        const long before = allocations.load();
        ASSERT_TRUE(dispatcher->run(queries, lists, options).ok());
        if (allocations.load() != before) ++grown;
      }
      EXPECT_LE(grown, 3) << policy_name(policy);
    }
  }
}

TEST(Allocation, AFailureInAWorkerIsOneErrorAndTheNextRunWorks) {
  const Body ego(test::hull(40, 50, 1));
  const Body other(test::hull(30, 70, 2));
  const std::vector<Pose> poses = test::crash_poses(6, 0.8, 3);
  const std::vector<DispatchQuery> queries = test::queries_for(ego, other, poses);
  for (const StoreMode store : {StoreMode::shared, StoreMode::private_copy}) {
    Result<Dispatcher> dispatcher = Dispatcher::start(with_workers(4));
    ASSERT_TRUE(dispatcher.ok());
    PairLists lists;
    DispatchOptions options;
    options.store = store;
    options.depth = 9;
    options.caller_works = false;
    other_threads_fail = true;
    const Result<DispatchReport> report = dispatcher->run(queries, lists, options);
    other_threads_fail = false;
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.error().code, ErrorCode::internal);
    EXPECT_NE(report.error().reason.find("out of memory"), std::string::npos);
    ASSERT_TRUE(dispatcher->run(queries, lists, options).ok());
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      lists.gather_sorted(i, pairs);
      EXPECT_EQ(pairs, test::expected_pairs(ego, other, poses[i]));
    }
  }
}

}  // namespace
}  // namespace crashrank
