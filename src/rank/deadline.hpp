#pragma once

#include <atomic>
#include <chrono>

namespace crashrank::detail {

/// When a ranking has to end: by a time, where there is one, or as soon as it is cancelled. Read by
/// all its threads.
class Deadline {
public:
  using Clock = std::chrono::steady_clock;

  Deadline() = default;
  /// Ends when `cancel` is set; null: never.
  explicit Deadline(const std::atomic<bool>* cancel) : cancel_(cancel) {}
  /// Ends at that time at the latest.
  explicit Deadline(Clock::time_point until, const std::atomic<bool>* cancel = nullptr)
      : time_(until), is_set_(true), cancel_(cancel) {}

  /// Whether there is a time.
  bool is_set() const { return is_set_; }
  Clock::time_point time() const { return time_; }
  /// The same, by so much earlier.
  Deadline earlier_by(Clock::duration time) const { return Deadline(time_ - time, cancel_); }
  bool expired() const {
    if (cancel_ != nullptr && cancel_->load(std::memory_order_relaxed)) return true;
    return is_set_ && Clock::now() >= time_;
  }
  /// For ImpactOptions::stop.
  static bool stop(void* watch) { return static_cast<const Deadline*>(watch)->expired(); }

private:
  Clock::time_point time_;
  bool is_set_ = false;
  const std::atomic<bool>* cancel_ = nullptr;
};

}  // namespace crashrank::detail
