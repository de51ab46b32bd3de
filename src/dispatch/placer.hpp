#pragma once

#include "crashrank/dispatch/policy.hpp"
#include "dispatch/holdings.hpp"

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
};

/// A job with its parts, as the main thread found it.
struct FoundJob {
  std::uint64_t number = 0;  ///< in the order found
  std::uint32_t query = 0;
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t node_a = 0;
  std::uint32_t node_b = 0;
};

/// The main thread's bookkeeping when it places jobs: one batch being filled per core, who is
/// claimed, what is held, what it costs. The same code places jobs on threads and on virtual cores:
/// `Cores` offers
///   outstanding(core)   batches sent to it and not done, 0 to 2
///   seen(), wait(seen)  blocks until a batch was done that was not at the time of `seen()`
///   fetch(core, body, node)      puts a part into the core's batch
///   append(core, job)            puts a job into the core's batch
///   send(core)                   sends the batch
template <class Cores> class Placer {
public:
  Placer(Cores& cores, Holdings& holdings, PlacementPolicy& policy, std::uint32_t count,
         const PlacerLimits& limits)
      : cores_(cores), holdings_(holdings), policy_(policy), limits_(limits) {
    at_.cores = count;
    at_.buffer = limits.buffer;
    at_.unclaimed = count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
    at_.batch = jobs_.data();
  }

  /// Places a job; false when a budget does not allow it.
  bool place(const FoundJob& job) {
    release_idle();
    at_.holds_a = holdings_.holders(job.body_a, job.node_a);
    at_.holds_b = holdings_.holders(job.body_b, job.node_b);
    const std::uint32_t core = policy_.choose(at_);
    const bool need_a = ((at_.holds_a >> core) & 1U) == 0;
    const bool same = job.body_a == job.body_b && job.node_a == job.node_b;
    const bool need_b = ((at_.holds_b >> core) & 1U) == 0 && !same;
    const std::uint64_t bytes = (need_a ? part_bytes(job.body_a, job.node_a) : 0) +
                                (need_b ? part_bytes(job.body_b, job.node_b) : 0);
    if (!affordable(core, bytes)) return false;
    if (need_a) take_part(core, job.body_a, job.node_a);
    if (need_b) take_part(core, job.body_b, job.node_b);
    transferred_ += bytes;
    cores_.append(core, job);
    ++placed_;
    if (++jobs_[core] == limits_.buffer) send(core);
    return true;
  }

  /// Sends what is left in the batches.
  void send_rest() {
    for (std::uint32_t core = 0; core < at_.cores; ++core) {
      if (jobs_[core] != 0) send(core);
    }
  }

  std::uint64_t placed() const noexcept { return placed_; }
  std::uint64_t batches() const noexcept { return batches_; }
  std::uint64_t transferred_bytes() const noexcept { return transferred_; }
  std::uint64_t peak_queue_bytes() const noexcept { return peak_queue_; }

private:
  struct Queue {
    std::array<std::uint64_t, 2> sent{};  ///< bytes of the last two batches sent
    std::uint64_t filling = 0;
  };

  std::uint64_t part_bytes(std::uint32_t body, std::uint32_t node) const {
    return holdings_.index(body).nodes()[node].bytes();
  }

  /// Cores whose batch was out of their hands stop being claimed; waits until there is one.
  void release_idle() {
    const std::uint64_t all =
        at_.cores == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << at_.cores) - 1;
    if (at_.unclaimed == all) return;
    for (;;) {
      const std::uint32_t seen = cores_.seen();
      for (std::uint32_t core = 0; core < at_.cores; ++core) {
        if (!at_.is_unclaimed(core) && cores_.outstanding(core) < 2) {
          at_.unclaimed |= std::uint64_t{1} << core;
        }
      }
      if (at_.unclaimed != 0) return;
      cores_.wait(seen);
    }
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
    jobs_[core] = 0;
    ++batches_;
    cores_.send(core);
    if (cores_.outstanding(core) == 2) at_.unclaimed &= ~(std::uint64_t{1} << core);
  }

  Cores& cores_;
  Holdings& holdings_;
  PlacementPolicy& policy_;
  PlacerLimits limits_;
  Placement at_;
  std::array<std::uint32_t, 64> jobs_{};
  std::array<Queue, 64> queue_{};
  std::uint64_t placed_ = 0;
  std::uint64_t batches_ = 0;
  std::uint64_t transferred_ = 0;
  std::uint64_t peak_queue_ = 0;
};

}  // namespace crashrank::detail
