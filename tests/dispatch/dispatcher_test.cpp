#include "crashrank/dispatch/dispatcher.hpp"

#include "dispatch/sample_bodies.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace crashrank {
namespace {

using test::Body;

TEST(Dispatcher, GivesTheSerialAnswer) {
  const Body ego(test::hull(40, 50, 1));
  const Body other(test::hull(30, 70, 2));
  const std::vector<Pose> poses = test::crash_poses(6, 0.8, 3);
  std::vector<std::vector<Pair>> expected;
  std::size_t total = 0;
  for (const Pose& pose : poses) {
    expected.push_back(test::expected_pairs(ego, other, pose));
    total += expected.back().size();
  }
  ASSERT_GT(total, 500U);
  const std::vector<DispatchQuery> queries = test::queries_for(ego, other, poses);
  PairLists lists;
  std::vector<Pair> pairs;
  for (const std::uint32_t workers : {0U, 1U, 4U}) {
    Result<Dispatcher> dispatcher = Dispatcher::start(test::with_workers(workers));
    ASSERT_TRUE(dispatcher.ok());
    for (const Policy policy : all_policies()) {
      for (const StoreMode store : {StoreMode::shared, StoreMode::private_copy}) {
        for (const std::uint32_t depth : {auto_depth, 1U, 5U, 9U, 16U}) {
          for (const bool sorted : {false, true}) {
            DispatchOptions options;
            options.policy = policy;
            options.store = store;
            options.depth = depth;
            options.sorted = sorted;
            const Result<DispatchReport> report = dispatcher->run(queries, lists, options);
            ASSERT_TRUE(report.ok());
            EXPECT_EQ(report.value().end, DispatchEnd::ok);
            EXPECT_EQ(lists.total(), total);
            ASSERT_EQ(lists.queries(), poses.size());
            for (std::size_t i = 0; i < poses.size(); ++i) {
              if (sorted) {
                lists.gather(i, pairs);
              } else {
                lists.gather_sorted(i, pairs);
              }
              EXPECT_EQ(pairs, expected[i]);
              EXPECT_EQ(lists.count(i), expected[i].size());
            }
          }
        }
      }
    }
  }
}

TEST(Dispatcher, RefusesOptionsWithoutMeaning) {
  Result<Dispatcher> dispatcher = Dispatcher::start(test::with_workers(1));
  ASSERT_TRUE(dispatcher.ok());
  PairLists lists;
  DispatchOptions options;
  options.depth = 17;
  EXPECT_FALSE(dispatcher->run({}, lists, options).ok());
  options = {};
  options.buffer = 0;
  EXPECT_FALSE(dispatcher->run({}, lists, options).ok());
  const std::vector<DispatchQuery> nothing(1);
  EXPECT_FALSE(dispatcher->run(nothing, lists).ok());
  const Body ego(test::hull(10, 10, 1));
  const std::vector<DispatchQuery> scalar = test::queries_for(ego, ego, test::crash_poses(1, 1, 1));
  options = {};
  options.kernel = Kernel::fast;
  EXPECT_FALSE(dispatcher->run(scalar, lists, options).ok());
  options.store = StoreMode::private_copy;
  EXPECT_FALSE(dispatcher->run(scalar, lists, options).ok());
  EXPECT_TRUE(dispatcher->run({}, lists).ok());
  EXPECT_EQ(lists.queries(), 0U);
}

TEST(Dispatcher, EndsOnABudgetAndGoesOn) {
  const Body ego(test::hull(40, 50, 1));
  const Body other(test::hull(30, 70, 2));
  const std::vector<DispatchQuery> queries =
      test::queries_for(ego, other, test::crash_poses(3, 0.8, 3));
  Result<Dispatcher> dispatcher = Dispatcher::start(test::with_workers(4));
  ASSERT_TRUE(dispatcher.ok());
  PairLists lists;
  DispatchOptions options;
  options.depth = 3;
  options.store = StoreMode::private_copy;
  const Result<DispatchReport> free = dispatcher->run(queries, lists, options);
  ASSERT_TRUE(free.ok());
  ASSERT_EQ(free.value().end, DispatchEnd::ok);
  const std::size_t total = lists.total();
  EXPECT_GT(free.value().peak_part_bytes, 20000U);

  options.store_bytes = 20000;
  const Result<DispatchReport> tight = dispatcher->run(queries, lists, options);
  ASSERT_TRUE(tight.ok());
  EXPECT_EQ(tight.value().end, DispatchEnd::out_of_memory);
  EXPECT_LE(tight.value().peak_part_bytes, 20000U);

  options.store_bytes = 0;
  options.queue_bytes = 20000;
  const Result<DispatchReport> short_queue = dispatcher->run(queries, lists, options);
  ASSERT_TRUE(short_queue.ok());
  EXPECT_EQ(short_queue.value().end, DispatchEnd::out_of_memory);

  options.queue_bytes = 0;
  const Result<DispatchReport> again = dispatcher->run(queries, lists, options);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again.value().end, DispatchEnd::ok);
  EXPECT_EQ(lists.total(), total);
}

TEST(Dispatcher, CanBeCancelled) {
  const Body ego(test::hull(40, 50, 1));
  const Body other(test::hull(30, 70, 2));
  const std::vector<DispatchQuery> queries =
      test::queries_for(ego, other, test::crash_poses(3, 0.8, 3));
  for (const std::uint32_t workers : {0U, 2U}) {
    Result<Dispatcher> dispatcher = Dispatcher::start(test::with_workers(workers));
    ASSERT_TRUE(dispatcher.ok());
    PairLists lists;
    std::atomic<bool> cancel{true};
    DispatchOptions options;
    options.depth = 8;
    options.cancel = &cancel;
    Result<DispatchReport> report = dispatcher->run(queries, lists, options);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.value().end, DispatchEnd::cancelled);
    cancel = false;
    report = dispatcher->run(queries, lists, options);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.value().end, DispatchEnd::ok);
    EXPECT_GT(lists.total(), 0U);
  }
}

}  // namespace
}  // namespace crashrank
