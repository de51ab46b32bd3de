#include "crashrank/dispatch/study/study.hpp"

#include "dispatch/sample_bodies.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace crashrank {
namespace {

using test::Body;

constexpr double ms = 1e-3;

/// Two bodies cut into two parts each, and jobs that cost what a test says.
struct Script {
  Body a{test::hull(10, 10, 1)};
  Body b{test::hull(10, 10, 2)};
  DispatchRecording recording;

  Script() {
    recording.depth = 1;
    recording.seconds_per_work = 1e-3F;
    recording.bodies = {&a.index, &b.index};
  }
  void job(std::uint32_t node_a, std::uint32_t node_b, double seconds, double found = 0.0) {
    RecordedJob job;
    job.body_b = 1;
    job.node_a = node_a;
    job.node_b = node_b;
    job.run_seconds = seconds;
    job.find_seconds = found;
    job.work = 1.0F;
    job.pairs = 10;
    recording.jobs.push_back(job);
  }
};

VirtualMachine free_machine(std::uint32_t processors, std::uint32_t workers) {
  VirtualMachine machine;
  machine.processors = processors;
  machine.workers = workers;
  machine.post_s = 0.0;
  machine.batch_s = 0.0;
  machine.send_s = 0.0;
  machine.wake_s = 0.0;
  machine.main_wake_s = 0.0;
  machine.copy_part_s = 0.0;
  return machine;
}

ReplayReport played(const Script& script, const ReplayOptions& options) {
  const Result<ReplayReport> report = replay(script.recording, options);
  EXPECT_TRUE(report.ok());
  return report.value();
}

TEST(Replay, EqualJobsShareProcessorsEvenly) {
  Script script;
  for (int i = 0; i < 8; ++i) script.job(1 + (i & 1), 1, ms);
  ReplayOptions options;
  options.buffer = 1;
  for (const Policy policy : {Policy::lowest, Policy::late_match}) {
    options.policy = policy;
    options.machine = free_machine(4, 4);
    EXPECT_NEAR(played(script, options).seconds, 2 * ms, 1e-9);
    options.machine = free_machine(2, 4);
    EXPECT_NEAR(played(script, options).seconds, 4 * ms, 1e-9);
    options.machine = free_machine(1, 1);
    EXPECT_NEAR(played(script, options).seconds, 8 * ms, 1e-9);
    options.machine = free_machine(8, 8);
    EXPECT_NEAR(played(script, options).seconds, 1 * ms, 1e-9);
  }
}

TEST(Replay, TheMainThreadTakesAProcessorWhileItWorks) {
  Script script;
  script.job(1, 1, ms, 0.0);
  script.job(2, 1, ms, 1 * ms);
  ReplayOptions options;
  options.policy = Policy::best_match_load;
  options.buffer = 1;
  options.machine = free_machine(1, 1);
  EXPECT_NEAR(played(script, options).seconds, 3 * ms, 1e-9);
  options.machine = free_machine(2, 1);  // the first job runs while the second is looked for
  EXPECT_NEAR(played(script, options).seconds, 2 * ms, 1e-9);
  EXPECT_NEAR(played(script, options).main_seconds, 1 * ms, 1e-9);
}

// Nobody is taken off a processor before he is done: with two processors a main thread that has
// slept waits in line behind the workers.
TEST(Replay, ThreadsTakeProcessorsInTurn) {
  Script script;
  for (int i = 0; i < 3; ++i) script.job(1, 1, (i + 1) * ms);
  script.job(2, 1, 1 * ms);
  ReplayOptions options;
  options.policy = Policy::best_match_load;
  options.buffer = 1;
  options.machine = free_machine(1, 2);
  // Both workers have two batches; the first one keeps the processor until it has done its own.
  EXPECT_NEAR(played(script, options).seconds, 7 * ms, 1e-9);
  options.machine = free_machine(2, 2);
  EXPECT_NEAR(played(script, options).seconds, 4 * ms, 1e-9);
  options.machine.slice_s = 0.5 * ms;
  EXPECT_NEAR(played(script, options).seconds, 4 * ms, 1e-9);
}

TEST(Replay, TheCallingThreadWorksWhereThePolicyLetsItAndTakesBackWhatWaits) {
  Script script;
  for (int i = 0; i < 6; ++i) script.job(1 + (i & 1), 1, ms);
  ReplayOptions options;
  options.policy = Policy::late_match;
  options.buffer = 1;
  options.machine = free_machine(2, 1);
  EXPECT_NEAR(played(script, options).seconds, 3 * ms, 1e-9);
  EXPECT_NEAR(played(script, options).main_seconds, 3 * ms, 1e-9);
  options.caller_works = false;
  EXPECT_NEAR(played(script, options).seconds, 6 * ms, 1e-9);
  options.policy = Policy::best_match;
  options.caller_works = true;
  EXPECT_NEAR(played(script, options).seconds, 6 * ms, 1e-9);
  EXPECT_EQ(played(script, options).main_seconds, 0.0);
  // A worker that wakes late finds its batches taken back.
  options.policy = Policy::late_match;
  options.machine.wake_s = 50 * ms;
  EXPECT_NEAR(played(script, options).seconds, 6 * ms, 1e-9);
}

TEST(Replay, WakingSendingAndCopyingAreCharged) {
  Script script;
  script.job(1, 1, ms);
  ReplayOptions options;
  options.buffer = 1;
  options.machine = free_machine(2, 1);
  options.machine.send_s = 2 * ms;
  options.machine.wake_s = 3 * ms;
  options.machine.main_wake_s = 4 * ms;
  EXPECT_NEAR(played(script, options).seconds, 10 * ms, 1e-9);

  options.store = StoreMode::private_copy;
  options.machine = free_machine(2, 1);
  options.machine.copy_part_s = 0.5 * ms;
  const std::size_t bytes = script.a.index.nodes()[1].bytes() + script.b.index.nodes()[1].bytes();
  options.machine.copy_bytes_per_s = static_cast<double>(bytes) / (7 * ms);
  EXPECT_NEAR(played(script, options).seconds, 9 * ms, 1e-9);
  EXPECT_EQ(played(script, options).transferred_bytes, bytes);
  options.store = StoreMode::shared;
  EXPECT_NEAR(played(script, options).seconds, 1 * ms, 1e-9);
}

TEST(Replay, ALinkDelaysBatchesAndAnswers) {
  Script script;
  script.job(1, 1, ms);
  script.job(2, 2, ms);
  ReplayOptions options;
  options.policy = Policy::best_match_load;
  options.store = StoreMode::private_copy;
  options.buffer = 1;
  options.machine = free_machine(4, 2);
  options.machine.link_latency_s = 1 * ms;
  const auto bytes = [&](std::uint32_t node) {
    return static_cast<double>(script.a.index.nodes()[node].bytes() +
                               script.b.index.nodes()[node].bytes() + 32);
  };
  const double rate = bytes(1) / (5 * ms);
  options.machine.link_bytes_per_s = rate;
  // Both batches pass one link, one after the other; the last one's pairs come back over another.
  const double sent = (bytes(1) + bytes(2)) / rate;
  const double back = 80.0 / rate;
  EXPECT_NEAR(played(script, options).seconds, sent + ms + ms + back + ms, 1e-9);
}

TEST(Replay, ABudgetEndsIt) {
  Script script;
  for (int i = 0; i < 4; ++i) script.job(1 + (i & 1), 1 + ((i >> 1) & 1), ms);
  ReplayOptions options;
  options.store = StoreMode::private_copy;
  options.machine = free_machine(4, 1);
  options.store_bytes = script.a.tree.bytes() + script.b.tree.bytes();
  EXPECT_EQ(played(script, options).end, DispatchEnd::ok);
  options.store_bytes /= 2;
  EXPECT_EQ(played(script, options).end, DispatchEnd::out_of_memory);
}

// Replayed transfer is what a real dispatch sends where nothing depends on timing: on one core.
TEST(Replay, SendsWhatOneRealCoreIsSent) {
  const Body ego(test::hull(40, 50, 1));
  const Body other(test::hull(30, 70, 2));
  const std::vector<DispatchQuery> queries =
      test::queries_for(ego, other, test::crash_poses(4, 0.8, 3));
  PoolOptions pool;
  pool.workers = 1;
  Result<Dispatcher> dispatcher = Dispatcher::start(pool);
  ASSERT_TRUE(dispatcher.ok());
  PairLists lists;
  for (const std::uint32_t depth : {2U, 6U, 11U}) {
    DispatchRecording recording;
    DispatchOptions options;
    options.depth = depth;
    options.store = StoreMode::private_copy;
    options.recording = &recording;
    options.caller_works = false;
    const Result<DispatchReport> real = dispatcher->run(queries, lists, options);
    ASSERT_TRUE(real.ok());
    EXPECT_EQ(recording.jobs.size(), real.value().jobs);
    std::size_t pairs = 0;
    for (const RecordedJob& job : recording.jobs) pairs += job.pairs;
    EXPECT_EQ(pairs, lists.total());
    std::uint64_t copied = 0;
    for (const RecordedBatch& batch : recording.batches) copied += batch.copied_bytes;
    EXPECT_EQ(copied, real.value().transferred_bytes);

    ReplayOptions replayed;
    replayed.store = StoreMode::private_copy;
    replayed.machine.workers = 1;
    replayed.caller_works = false;
    const Result<ReplayReport> report = replay(recording, replayed);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report.value().transferred_bytes, real.value().transferred_bytes);
    EXPECT_EQ(report.value().jobs, real.value().jobs);
  }
}

// On four virtual cores everything is deterministic, so the schemes can be compared by what they
// send: the ones that look at parts send less than the ones that do not.
TEST(Replay, SchemesThatLookAtPartsSendLess) {
  const Body ego(test::hull(60, 80, 1));
  const Body other(test::hull(60, 80, 2));
  const std::vector<DispatchQuery> queries =
      test::queries_for(ego, other, test::crash_poses(10, 0.8, 3));
  PoolOptions pool;
  pool.workers = 1;
  Result<Dispatcher> dispatcher = Dispatcher::start(pool);
  ASSERT_TRUE(dispatcher.ok());
  PairLists lists;
  DispatchRecording recording;
  DispatchOptions options;
  options.depth = 9;
  options.recording = &recording;
  ASSERT_TRUE(dispatcher->run(queries, lists, options).ok());
  for (RecordedJob& job : recording.jobs) {  // the same on every machine
    job.find_seconds = 0.1e-6;
    job.run_seconds = 1e-9 * static_cast<double>(job.work) * 20.0;
  }
  recording.begin_seconds = 0.0;
  recording.finish_seconds = 0.0;
  const auto sent = [&](Policy policy) {
    ReplayOptions replayed;
    replayed.policy = policy;
    replayed.store = StoreMode::private_copy;
    const Result<ReplayReport> report = replay(recording, replayed);
    EXPECT_TRUE(report.ok());
    return report.value().relative_transfer;
  };
  EXPECT_LT(sent(Policy::best_match), sent(Policy::best_match_load));
  EXPECT_LT(sent(Policy::best_match_load), sent(Policy::lowest));
  EXPECT_LT(sent(Policy::random), sent(Policy::lowest));
  EXPECT_LT(sent(Policy::late_match), 1.02 * sent(Policy::best_match));
}

TEST(Replay, RefusesWhatHasNoMeaning) {
  Script script;
  EXPECT_FALSE(replay(script.recording, {}).ok());
  script.job(1, 1, ms);
  ReplayOptions options;
  options.machine.workers = 65;
  EXPECT_FALSE(replay(script.recording, options).ok());
  options = {};
  options.machine.copy_bytes_per_s = 0.0;
  EXPECT_FALSE(replay(script.recording, options).ok());
  options = {};
  options.buffer = 0;
  EXPECT_FALSE(replay(script.recording, options).ok());
}

TEST(Recording, KeepsTheSmallerTimes) {
  Script script;
  script.job(1, 1, 2 * ms, 1 * ms);
  DispatchRecording again = script.recording;
  again.jobs[0].run_seconds = 1 * ms;
  again.jobs[0].find_seconds = 3 * ms;
  EXPECT_TRUE(keep_smaller(script.recording, again));
  EXPECT_EQ(script.recording.jobs[0].run_seconds, 1 * ms);
  EXPECT_EQ(script.recording.jobs[0].find_seconds, 1 * ms);
  again.jobs[0].node_a = 2;
  EXPECT_FALSE(keep_smaller(script.recording, again));
}

TEST(Recording, CopyingTimesAreFitted) {
  std::vector<DispatchRecording> recordings(1);
  for (std::uint32_t i = 1; i < 9; ++i) {
    RecordedBatch batch;
    batch.copied_parts = i;
    batch.copied_bytes = std::uint64_t{1000} * (i * 7 % 5 + 1);
    batch.copy_seconds = 3e-7 * i + static_cast<double>(batch.copied_bytes) / 2e9;
    recordings[0].batches.push_back(batch);
  }
  VirtualMachine machine;
  fit_copying(recordings, machine);
  EXPECT_NEAR(machine.copy_part_s, 3e-7, 1e-12);
  EXPECT_NEAR(machine.copy_bytes_per_s, 2e9, 1.0);
}

}  // namespace
}  // namespace crashrank
