#include "crashrank/dispatch/worker_pool.hpp"
#include "dispatch/sample_bodies.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

namespace crashrank {
namespace {

TEST(WorkerPool, RunsEveryIndexOnce) {
  for (const std::uint32_t workers : {0U, 1U, 2U, 4U, 7U}) {
    Result<WorkerPool> pool = WorkerPool::start(test::with_workers(workers));
    ASSERT_TRUE(pool.ok());
    for (const std::size_t count : {0U, 1U, 3U, 1000U}) {
      std::vector<std::atomic<int>> calls(count);
      const Status status = pool->for_each(count, [&](std::size_t index, std::uint32_t worker) {
        EXPECT_LT(worker, std::max(1U, workers));
        calls[index].fetch_add(1);
      });
      EXPECT_TRUE(status.ok());
      for (const std::atomic<int>& call : calls) EXPECT_EQ(call.load(), 1);
    }
  }
}

TEST(WorkerPool, TasksOfAWorkerRunInOrderAndAreNeverLost) {
  Result<WorkerPool> pool = WorkerPool::start(test::with_workers(3));
  ASSERT_TRUE(pool.ok());
  struct Log {
    std::vector<int> seen;
  };
  struct Numbered {
    Log* log;
    int number;
  };
  constexpr int rounds = 5000;
  std::vector<Log> logs(3);
  std::vector<Numbered> tasks;
  tasks.reserve(3 * rounds);
  for (int i = 0; i < rounds; ++i) {
    for (std::uint32_t worker = 0; worker < 3; ++worker) {
      for (;;) {
        const std::uint32_t seen = pool->finished_tasks();
        if (pool->outstanding(worker) < 2) break;
        pool->wait_beyond(seen);
      }
      tasks.push_back({&logs[worker], i});
      pool->post(worker, {[](void* context, std::uint32_t) {
                            const Numbered& task = *static_cast<Numbered*>(context);
                            task.log->seen.push_back(task.number);
                          },
                          &tasks.back()});
    }
  }
  pool->wait_all();
  for (const Log& log : logs) {
    ASSERT_EQ(log.seen.size(), static_cast<std::size_t>(rounds));
    for (int i = 0; i < rounds; ++i) EXPECT_EQ(log.seen[static_cast<std::size_t>(i)], i);
  }
}

// Every task runs once, in a worker or by the owner who took it back, however the two race.
TEST(WorkerPool, TasksTakenBackRunOnce) {
  Result<WorkerPool> pool = WorkerPool::start(test::with_workers(3));
  ASSERT_TRUE(pool.ok());
  constexpr std::size_t count = 6000;
  std::vector<std::atomic<int>> ran(count);
  std::size_t here = 0;
  std::size_t posted = 0;
  for (std::size_t round = 0; posted < count; ++round) {
    if (round % 64 == 0) pool->set_spin(round % 128 == 0 ? 50e-6 : 0.0);
    for (std::uint32_t worker = 0; worker < 3 && posted < count; ++worker) {
      if (round % 7 == 0) pool->rouse(worker);
      if (pool->outstanding(worker) < 2) {
        pool->post(worker, {[](void* context, std::uint32_t) {
                              static_cast<std::atomic<int>*>(context)->fetch_add(1);
                            },
                            &ran[posted++]});
      }
    }
    WorkerPool::Task task;
    if (pool->recall(static_cast<std::uint32_t>(round % 3), task)) {
      task.run(task.context, 0);
      ++here;
    }
  }
  pool->set_spin(-1.0);
  pool->wait_all();
  WorkerPool::Task none;
  EXPECT_FALSE(pool->recall(0, none));
  for (const std::atomic<int>& times : ran) EXPECT_EQ(times.load(), 1);
  EXPECT_GT(here, 0U);
}

TEST(WorkerPool, WaitsForAllUntilATimeAtTheLatest) {
  using Clock = std::chrono::steady_clock;
  using std::chrono::milliseconds;
  for (const std::int32_t spin_us : {0, 50}) {
    PoolOptions options = test::with_workers(2);
    options.spin_us = spin_us;
    Result<WorkerPool> pool = WorkerPool::start(options);
    ASSERT_TRUE(pool.ok());
    EXPECT_TRUE(pool->wait_all_until(Clock::now() - milliseconds(1)));  // nothing to wait for
    std::atomic<bool> open{false};
    const WorkerPool::Task held{
        [](void* context, std::uint32_t) { static_cast<std::atomic<bool>*>(context)->wait(false); },
        &open};
    pool->post(1, held);
    const Clock::time_point until = Clock::now() + milliseconds(5);
    EXPECT_FALSE(pool->wait_all_until(until));
    EXPECT_GE(Clock::now(), until);
    EXPECT_EQ(pool->outstanding(1), 1U);
    open.store(true);
    open.notify_all();
    EXPECT_TRUE(pool->wait_all_until(Clock::now() + std::chrono::minutes(1)));

    // A wake-up that was lost would last until the test's time limit.
    std::atomic<int> done{0};
    const WorkerPool::Task quick{
        [](void* context, std::uint32_t) { static_cast<std::atomic<int>*>(context)->fetch_add(1); },
        &done};
    constexpr int rounds = 5000;
    for (int i = 1; i <= rounds; ++i) {
      pool->post(0, quick);
      pool->post(1, quick);
      ASSERT_TRUE(pool->wait_all_until(Clock::now() + std::chrono::hours(1)));
      ASSERT_EQ(done.load(), 2 * i);
    }
  }
}

TEST(WorkerPool, EndsAtAnyMoment) {
  for (int round = 0; round < 200; ++round) {
    std::atomic<int> ran{0};
    Result<WorkerPool> pool = WorkerPool::start(test::with_workers(4));
    ASSERT_TRUE(pool.ok());
    for (int i = 0; i < round % 9; ++i) {
      const auto worker = static_cast<std::uint32_t>(i) % 4;
      if (pool->outstanding(worker) < 2) {
        pool->post(worker, {[](void* context, std::uint32_t) {
                              static_cast<std::atomic<int>*>(context)->fetch_add(1);
                            },
                            &ran});
      }
    }
    WorkerPool moved = std::move(*pool);
    EXPECT_EQ(moved.size(), 4U);
  }
}

TEST(WorkerPool, AnExceptionBecomesOneErrorAndThePoolGoesOn) {
  Result<WorkerPool> pool = WorkerPool::start(test::with_workers(4));
  ASSERT_TRUE(pool.ok());
  Status status = pool->for_each(100, [](std::size_t index, std::uint32_t) {
    if (index % 10 == 3) throw std::runtime_error("index " + std::to_string(index % 10));
  });
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::internal);
  EXPECT_NE(status.error().reason.find("index 3"), std::string::npos);

  status = pool->for_each(4, [](std::size_t, std::uint32_t) { throw std::bad_alloc(); });
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().reason.find("out of memory"), std::string::npos);

  status = pool->for_each(4, [](std::size_t, std::uint32_t) { throw 7; });
  EXPECT_FALSE(status.ok());
  EXPECT_FALSE(pool->failed());

  std::atomic<int> ran{0};
  EXPECT_TRUE(pool->for_each(50, [&](std::size_t, std::uint32_t) { ran.fetch_add(1); }).ok());
  EXPECT_EQ(ran.load(), 50);
}

double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A spinning pool of eight would burn up to eight seconds of processor time a second; a sleeping
// one burns next to none.
TEST(WorkerPool, IdleWorkersSleep) {
  Result<WorkerPool> pool = WorkerPool::start(test::with_workers(8));
  ASSERT_TRUE(pool.ok());
  ASSERT_TRUE(pool->for_each(100, [](std::size_t, std::uint32_t) {}).ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const double before = process_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT(process_seconds() - before, 0.03);
}

TEST(WorkerPool, RefusesNumbersOutOfRange) {
  EXPECT_FALSE(WorkerPool::start(test::with_workers(65)).ok());
  PoolOptions options;
  options.spin_us = 2000;
  EXPECT_FALSE(WorkerPool::start(options).ok());
}

}  // namespace
}  // namespace crashrank
