#pragma once

#include <nanobind/nanobind.h>

#include <chrono>

namespace crashrank::python {

/// Between two looks at Python's signals: a Ctrl-C is seen within this and the step in hand.
inline constexpr std::chrono::milliseconds look_every{25};

/// For loops that run without the interpreter's lock: looks at the signals now and then.
class Interrupts {
public:
  /// Throws nanobind::python_error where a signal's handler raised, as on Ctrl-C. Costs a reading
  /// of the clock when it is not yet time.
  void look() {
    const auto now = std::chrono::steady_clock::now();
    if (now - seen_ < look_every) return;
    seen_ = now;
    const nanobind::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
  }

private:
  std::chrono::steady_clock::time_point seen_ = std::chrono::steady_clock::now();
};

}  // namespace crashrank::python
