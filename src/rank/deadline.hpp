#pragma once

#include <atomic>
#include <chrono>

namespace crashrank::detail {

/// End of a ranking: an optional point of time, and an optional flag that cancels it earlier. Read
/// by all threads of the ranking.
class Deadline {
public:
  using Clock = std::chrono::steady_clock;

  Deadline() = default;
  /// Expires when `cancel` is set; null: never.
  explicit Deadline(const std::atomic<bool>* cancel) : cancel_(cancel) {}
  /// Expires at the given time at the latest.
  explicit Deadline(Clock::time_point until, const std::atomic<bool>* cancel = nullptr)
      : time_(until), is_set_(true), cancel_(cancel) {}

  /// Returns true if there is a point of time.
  bool is_set() const { return is_set_; }
  Clock::time_point time() const { return time_; }
  /// The same deadline, earlier by the given duration.
  Deadline earlier_by(Clock::duration time) const { return Deadline(time_ - time, cancel_); }
  /// The same cancellation alone.
  Deadline without_time() const { return Deadline(cancel_); }
  bool expired() const {
    if (cancel_ != nullptr && cancel_->load(std::memory_order_relaxed)) return true;
    return is_set_ && Clock::now() >= time_;
  }
  /// Callback for ImpactOptions::stop; `deadline` points to a Deadline.
  static bool stop(void* deadline) { return static_cast<const Deadline*>(deadline)->expired(); }

private:
  Clock::time_point time_;
  bool is_set_ = false;
  const std::atomic<bool>* cancel_ = nullptr;
};

inline double seconds_between(Deadline::Clock::time_point from, Deadline::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace crashrank::detail
