#pragma once

namespace crashrank::detail {

/// Callback by which long computations check whether to stop: the deadline has passed or the
/// ranking is cancelled. Once it returns true it keeps returning true. A function that was stopped
/// returns at once with a meaningless result; the caller must check again before using it.
struct StopCheck {
  bool (*ask)(void* context) = nullptr;  ///< null: never stops
  void* context = nullptr;

  bool operator()() const { return ask != nullptr && ask(context); }
};

}  // namespace crashrank::detail
