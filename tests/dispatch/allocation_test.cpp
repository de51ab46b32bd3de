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

TEST(Allocation, AWarmDispatchAllocatesNothing) {
  const Body ego(test::hull(40, 50, 1));
  const Body other(test::hull(30, 70, 2));
  const std::vector<DispatchQuery> queries =
      test::queries_for(ego, other, test::crash_poses(6, 0.8, 3));
  // One worker: which core gets what is the same every time.
  Result<Dispatcher> dispatcher = Dispatcher::start(test::with_workers(1));
  ASSERT_TRUE(dispatcher.ok());
  PairLists lists;
  for (const StoreMode store : {StoreMode::shared, StoreMode::private_copy}) {
    for (const Policy policy : all_policies()) {
      DispatchOptions options;
      options.policy = policy;
      options.store = store;
      options.depth = 9;
      // Which job shares a batch with which depends on timing, and so does how much room the lists
      // need: one may grow now and then. What allocates for every job allocates more often in one
      // run than all of these do in twenty.
      constexpr int runs = 20;
      long before = 0;
      std::uint64_t jobs = 0;
      for (int run = -runs; run < runs; ++run) {
        if (run == 0) before = allocations.load();
        const Result<DispatchReport> report = dispatcher->run(queries, lists, options);
        ASSERT_TRUE(report.ok());
        jobs = report->jobs;
      }
      const long made = allocations.load() - before;
      EXPECT_LT(made, static_cast<long>(jobs) / 10)
          << policy_name(policy) << " " << jobs << " jobs";
    }
  }
}

TEST(Allocation, AFailureInAWorkerIsOneErrorAndTheNextRunWorks) {
  const Body ego(test::hull(40, 50, 1));
  const Body other(test::hull(30, 70, 2));
  const std::vector<Pose> poses = test::crash_poses(6, 0.8, 3);
  const std::vector<DispatchQuery> queries = test::queries_for(ego, other, poses);
  for (const StoreMode store : {StoreMode::shared, StoreMode::private_copy}) {
    Result<Dispatcher> dispatcher = Dispatcher::start(test::with_workers(4));
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
