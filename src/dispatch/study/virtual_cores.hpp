#pragma once

#include "crashrank/dispatch/study/study.hpp"
#include "dispatch/holdings.hpp"
#include "dispatch/placer.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

namespace crashrank::detail {

/// Workers on virtual processors, as Placer sees cores: time passes when the main thread works or
/// waits. The model is VirtualMachine's.
class VirtualCores {
public:
  VirtualCores(const DispatchRecording& recording, const Holdings& holdings,
               const VirtualMachine& machine)
      : recording_(recording),
        holdings_(holdings),
        machine_(machine),
        cores_(machine.workers),
        free_(machine.processors - 1) {
    if (machine.awake_at_start) {
      for (Core& core : cores_) core.idle_since = 0.0;
    }
  }

  std::uint32_t outstanding(std::uint32_t core) const noexcept { return cores_[core].outstanding; }
  std::uint32_t seen() const noexcept { return heard_; }

  void fetch(std::uint32_t core, std::uint32_t body, std::uint32_t node) {
    cores_[core].filling.bytes += holdings_.index(body).nodes()[node].bytes();
    ++cores_[core].filling.parts;
  }
  void append(std::uint32_t core, const FoundJob& job) {
    const RecordedJob& recorded = recording_.jobs[job.number];
    cores_[core].filling.run_seconds += recorded.run_seconds;
    cores_[core].filling.pairs += recorded.pairs;
    ++cores_[core].filling.jobs;
  }
  void send(std::uint32_t core);
  void run_here(const FoundJob& job) { work(recording_.jobs[job.number].run_seconds); }
  bool recall(std::uint32_t core);
  /// The main thread sleeps until it learns of a finished batch.
  void wait(std::uint32_t seen);
  /// The main thread works.
  void work(double seconds);
  /// Waits until the main thread knows that all is done.
  void wait_all();
  /// The main thread wakes the workers, so that they spin when their work comes.
  void rouse();

  double now() const noexcept { return now_; }
  double main_seconds() const noexcept { return main_; }
  double idle_seconds() const noexcept { return idle_; }

private:
  static constexpr double never = std::numeric_limits<double>::infinity();
  static constexpr std::uint32_t main_thread = ~std::uint32_t{0};

  struct Batch {
    double run_seconds = 0.0;
    std::uint64_t bytes = 0;
    std::uint64_t parts = 0;
    std::uint64_t jobs = 0;
    std::uint64_t pairs = 0;
    double ready_at = 0.0;   ///< not before
    double remaining = 0.0;  ///< processor time
    bool begun = false;
  };
  enum class Phase {
    idle,     ///< without a batch that is there
    queued,   ///< waits for a processor
    running,  ///< has one
  };
  struct Core {
    Batch filling;
    std::deque<Batch> queue;         ///< sent; the front one is in work
    std::deque<double> finished_at;  ///< when the main thread will learn of finished ones
    std::uint32_t outstanding = 0;   ///< as the main thread knows
    Phase phase = Phase::idle;
    double slice_ends = never;  ///< when another thread that waits may take its processor
    double idle_since = -never;
    double awake_at = 0.0;  ///< not before: it is being woken
  };

  bool linked() const noexcept { return machine_.link_bytes_per_s > 0.0; }
  /// Lets time pass until `until` or the next event, whichever is first.
  void step(double until);
  void finish(Core& core);
  /// Gives free processors to threads in the order in which they came to need one.
  void assign();
  void main_takes_a_processor();
  void main_gives_its_processor();

  const DispatchRecording& recording_;
  const Holdings& holdings_;
  const VirtualMachine& machine_;
  std::vector<Core> cores_;
  std::deque<std::uint32_t> ready_;  ///< threads that wait for a processor
  std::uint32_t free_ = 0;           ///< processors
  Phase main_phase_ = Phase::running;
  double main_idle_since_ = 0.0;
  double now_ = 0.0;
  double main_ = 0.0;
  double idle_ = 0.0;
  double out_free_ = 0.0;   ///< when the link to the cores is free
  double back_free_ = 0.0;  ///< when the link back is
  std::uint32_t heard_ = 0;
};

}  // namespace crashrank::detail
