#pragma once

#include "crashrank/dispatch/policy.hpp"
#include "dispatch/holdings.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashrank::detail {

/// Bytes of a job's own record in a queue.
inline constexpr std::size_t job_bytes = 32;

struct PlacerLimits {
  std::uint32_t buffer = 8;
  std::size_t store_bytes = 0;  ///< 0: no limit
  std::size_t queue_bytes = 0;  ///< 0: no limit
  bool copies = false;          ///< parts travel; otherwise their bytes are only counted
  bool caller_works = false;    ///< the main thread works off jobs, too
  float seconds_per_work = 0.0F;
};

/// A job with its parts, as the main thread found it.
struct FoundJob {
  std::uint64_t number = 0;  ///< in the order found
  std::uint32_t query = 0;
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t node_a = 0;
  std::uint32_t node_b = 0;
  float work = 0.0F;  ///< estimated, in triangles to look at
};

/// The main thread's bookkeeping when it places jobs: one batch being filled per core, who is
/// claimed, what is held, what it costs. The same code places jobs on threads and on virtual cores:
/// `Cores` offers
///   outstanding(core)   batches sent to it and not done, 0 to 2
///   seen(), wait(seen)  blocks until a batch was done that was not at the time of `seen()`
///   fetch(core, body, node)      puts a part into the core's batch
///   append(core, job)            puts a job into the core's batch
///   send(core)                   sends the batch
///   run_here(job)                the main thread works the job off
///   recall(core)                 takes back the oldest batch not begun and works it off here;
///                                false where there is none
template <class Cores> class Placer {
public:
  Placer(Cores& cores, Holdings& holdings, PlacementPolicy& policy, std::uint32_t count,
         const PlacerLimits& limits, std::vector<WaitingJob>& waiting, std::vector<FoundJob>& found)
      : cores_(cores),
        holdings_(holdings),
        policy_(policy),
        limits_(limits),
        waiting_(waiting),
        found_(found),
        window_(std::max(1U, policy.window())) {
    at_.cores = count;
    at_.buffer = limits.buffer;
    at_.unclaimed = everyone(count);
    at_.batch = jobs_.data();
    at_.batch_work = batch_work_.data();
    at_.sent = known_out_.data();
    at_.sent_work = sent_work_.data();
    at_.caller_works = limits.caller_works;
    at_.seconds_per_work = limits.seconds_per_work;
    waiting_.clear();
    found_.clear();
    waiting_.reserve(window_);
    found_.reserve(window_);
  }

  /// Takes a job, and places as many as the policy does not want to wait; false when a budget does
  /// not allow it.
  bool add(const FoundJob& job) {
    WaitingJob waiting;
    waiting.holders_a = holdings_.holders_of(job.body_a, job.node_a);
    waiting.holders_b = holdings_.holders_of(job.body_b, job.node_b);
    waiting.bytes_a = static_cast<std::uint32_t>(part_bytes(job.body_a, job.node_a));
    waiting.bytes_b = static_cast<std::uint32_t>(part_bytes(job.body_b, job.node_b));
    waiting.work = job.work;
    waiting_.push_back(waiting);
    found_.push_back(job);
    at_.waiting_work += job.work;
    for (;;) {
      at_.jobs = waiting_;
      if (at_.jobs.empty()) return true;
      if (at_.jobs.size() < window_) {
        take_finished();
        if (!policy_.in_haste(at_)) return true;
      }
      if (!place()) return false;
    }
  }

  /// Places all jobs that wait and sends what is in the batches; false when a budget does not allow
  /// it.
  bool finish() {
    at_.all_found = true;
    for (;;) {
      at_.jobs = waiting_;
      if (at_.jobs.empty()) break;
      if (!place()) return false;
    }
    for (std::uint32_t core = 0; core < at_.cores; ++core) {
      if (jobs_[core] != 0) send(core);
    }
    // Parts of a copied batch are in the core's store alone, or not yet there.
    if (limits_.caller_works && !limits_.copies) take_back();
    return true;
  }

  std::uint64_t placed() const noexcept { return placed_; }
  std::uint64_t batches() const noexcept { return batches_; }
  std::uint64_t transferred_bytes() const noexcept { return transferred_; }
  std::uint64_t peak_queue_bytes() const noexcept { return peak_queue_; }

private:
  struct Queue {
    std::array<std::uint64_t, 2> sent{};  ///< bytes of the last two batches sent
    std::uint64_t filling = 0;
    std::array<float, 2> work{};  ///< of the last two batches sent
  };

  std::uint64_t part_bytes(std::uint32_t body, std::uint32_t node) const {
    return holdings_.index(body).nodes()[node].bytes();
  }

  static std::uint64_t everyone(std::uint32_t cores) noexcept {
    return cores == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << cores) - 1;
  }

  /// Learns which batches are done. Cores that have one left at most are claimed no longer.
  void take_finished() {
    for (std::uint32_t core = 0; core < at_.cores; ++core) {
      if (known_out_[core] == 0) continue;
      const std::uint32_t out = cores_.outstanding(core);
      if (out == known_out_[core]) continue;
      known_out_[core] = out;
      sent_work_[core] = out == 0 ? 0.0F : queue_[core].work[0];
      at_.unclaimed |= std::uint64_t{1} << core;
    }
  }

  void wait_for_unclaimed() {
    for (;;) {
      const std::uint32_t seen = cores_.seen();
      take_finished();
      if (at_.unclaimed != 0) return;
      cores_.wait(seen);
    }
  }

  /// Works off one job that waits.
  void work_here() {
    const std::uint32_t index = policy_.choose_for_caller(at_);
    const FoundJob job = found_[index];
    no_longer_waiting(index);
    cores_.run_here(job);
    ++placed_;
  }

  void no_longer_waiting(std::uint32_t index) {
    at_.waiting_work -= found_[index].work;
    const auto offset = static_cast<std::ptrdiff_t>(index);
    waiting_.erase(waiting_.begin() + offset);
    found_.erase(found_.begin() + offset);
    at_.jobs = waiting_;
    if (waiting_.empty()) at_.waiting_work = 0.0F;  // whatever rounding left
  }

  /// Works off what cores have not begun, the longest queues first.
  void take_back() {
    for (;;) {
      take_finished();
      std::uint32_t core = at_.cores;
      for (std::uint32_t other = 0; other < at_.cores; ++other) {
        if (known_out_[other] == 0 || tried_[other] == known_out_[other]) continue;
        if (core == at_.cores || sent_work_[other] > sent_work_[core]) core = other;
      }
      if (core == at_.cores) return;
      if (!cores_.recall(core)) tried_[core] = known_out_[core];
    }
  }

  /// Places one job that waits, or works it off.
  bool place() {
    if (limits_.caller_works) {
      take_finished();
      if (at_.unclaimed == 0 || policy_.caller_takes(at_)) {
        work_here();
        return true;
      }
    }
    wait_for_unclaimed();
    const PlacementPolicy::Choice choice = policy_.choose(at_);
    const FoundJob job = found_[choice.job];
    const std::uint32_t core = choice.core;
    const bool need_a = !holdings_.holds(core, job.body_a, job.node_a);
    const bool same = job.body_a == job.body_b && job.node_a == job.node_b;
    const bool need_b = !holdings_.holds(core, job.body_b, job.node_b) && !same;
    const std::uint64_t bytes = (need_a ? part_bytes(job.body_a, job.node_a) : 0) +
                                (need_b ? part_bytes(job.body_b, job.node_b) : 0);
    if (!affordable(core, bytes)) return false;
    if (need_a) take_part(core, job.body_a, job.node_a);
    if (need_b) take_part(core, job.body_b, job.node_b);
    transferred_ += bytes;
    cores_.append(core, job);
    ++placed_;
    batch_work_[core] += job.work;
    no_longer_waiting(choice.job);
    if (++jobs_[core] == limits_.buffer || policy_.send_early(at_, core)) send(core);
    return true;
  }

  bool affordable(std::uint32_t core, std::uint64_t bytes) {
    if (limits_.copies && limits_.store_bytes != 0 &&
        holdings_.bytes(core) + bytes > limits_.store_bytes) {
      return false;
    }
    Queue& queue = queue_[core];
    queue.filling += job_bytes + (limits_.copies ? bytes : 0);
    std::uint64_t waiting = queue.filling;
    const std::uint32_t out = cores_.outstanding(core);
    if (out >= 1) waiting += queue.sent[0];
    if (out >= 2) waiting += queue.sent[1];
    if (waiting > peak_queue_) peak_queue_ = waiting;
    return limits_.queue_bytes == 0 || waiting <= limits_.queue_bytes;
  }

  void take_part(std::uint32_t core, std::uint32_t body, std::uint32_t node) {
    holdings_.add(core, body, node);
    if (limits_.copies) cores_.fetch(core, body, node);
  }

  void send(std::uint32_t core) {
    Queue& queue = queue_[core];
    queue.sent[1] = queue.sent[0];
    queue.sent[0] = queue.filling;
    queue.filling = 0;
    queue.work[1] = queue.work[0];
    queue.work[0] = batch_work_[core];
    sent_work_[core] += batch_work_[core];
    batch_work_[core] = 0.0F;
    jobs_[core] = 0;
    ++batches_;
    cores_.send(core);
    if (++known_out_[core] == 2) at_.unclaimed &= ~(std::uint64_t{1} << core);
  }

  Cores& cores_;
  Holdings& holdings_;
  PlacementPolicy& policy_;
  PlacerLimits limits_;
  std::vector<WaitingJob>& waiting_;
  std::vector<FoundJob>& found_;
  std::uint32_t window_;
  Placement at_;
  std::array<std::uint32_t, 64> jobs_{};       ///< in the batch being filled
  std::array<float, 64> batch_work_{};         ///< of those
  std::array<float, 64> sent_work_{};          ///< of batches sent and not known to be done
  std::array<std::uint32_t, 64> known_out_{};  ///< batches sent and not known to be done
  std::array<std::uint32_t, 64> tried_{};      ///< batches out when none could be taken back
  std::array<Queue, 64> queue_{};
  std::uint64_t placed_ = 0;
  std::uint64_t batches_ = 0;
  std::uint64_t transferred_ = 0;
  std::uint64_t peak_queue_ = 0;
};

}  // namespace crashrank::detail
