#pragma once

#include <chrono>

namespace crashrank::detail {

/// The time by which a ranking has to end. Read by all its threads.
class Watch {
public:
  using Clock = std::chrono::steady_clock;

  Watch() = default;
  explicit Watch(Clock::time_point until) : until_(until), runs_(true) {}

  bool runs() const { return runs_; }
  Clock::time_point until() const { return until_; }
  bool expired() const { return runs_ && Clock::now() >= until_; }
  /// For ImpactOptions::stop.
  static bool stop(void* watch) { return static_cast<const Watch*>(watch)->expired(); }

private:
  Clock::time_point until_;
  bool runs_ = false;
};

}  // namespace crashrank::detail
