#pragma once

#include "interrupts.hpp"

#include <nanobind/nanobind.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace crashrank::python {

/// How far work on another thread is, and whether it is to end early.
struct Progress {
  std::atomic<bool> cancel{false};
  std::atomic<std::size_t> done{0};
  std::atomic<std::size_t> all{0};  ///< 0: nothing to report yet
  std::function<void()> on_cancel;  ///< called once `cancel` is set; may be empty
};

/// Runs `work` on a thread of its own. The calling thread, which holds the interpreter's lock at
/// the call and after it but not while it waits, looks at Python's signals meanwhile and calls
/// `report(done, all)` where it is not None. On Ctrl-C, or when `report` returns False, sets
/// `progress.cancel`: the work ends soon with what it has. Returns whether it was Ctrl-C. Other
/// exceptions of handlers and of `report` cancel the work and are thrown when it has ended, as are
/// those of `work`.
bool run_waiting(Progress& progress, const nanobind::object& report,
                 const std::function<void()>& work);

}  // namespace crashrank::python
