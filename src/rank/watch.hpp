#pragma once

#include <atomic>
#include <chrono>

namespace crashrank::detail {

/// When a ranking has to end: by a time, where there is one, or as soon as it is cancelled. Read by
/// all its threads.
class Watch {
public:
  using Clock = std::chrono::steady_clock;

  Watch() = default;
  /// Ends when `cancel` is set; null: never.
  explicit Watch(const std::atomic<bool>* cancel) : cancel_(cancel) {}
  /// Ends at that time at the latest.
  explicit Watch(Clock::time_point until, const std::atomic<bool>* cancel = nullptr)
      : until_(until), runs_(true), cancel_(cancel) {}

  /// Whether there is a time.
  bool runs() const { return runs_; }
  Clock::time_point until() const { return until_; }
  /// The same, by so much earlier.
  Watch earlier_by(Clock::duration time) const { return Watch(until_ - time, cancel_); }
  bool expired() const {
    if (cancel_ != nullptr && cancel_->load(std::memory_order_relaxed)) return true;
    return runs_ && Clock::now() >= until_;
  }
  /// For ImpactOptions::stop.
  static bool stop(void* watch) { return static_cast<const Watch*>(watch)->expired(); }

private:
  Clock::time_point until_;
  bool runs_ = false;
  const std::atomic<bool>* cancel_ = nullptr;
};

}  // namespace crashrank::detail
