#pragma once

namespace crashrank::detail {

/// Tells work that it has to end: time is up, or the ranking is cancelled. Once it says so it says
/// so for good. What ends for it returns at once, and what it returns is score nothing: whoever
/// called asks again before using it.
struct StopCheck {
  bool (*ask)(void* context) = nullptr;  ///< none: nothing ends it
  void* context = nullptr;

  bool operator()() const { return ask != nullptr && ask(context); }
};

}  // namespace crashrank::detail
