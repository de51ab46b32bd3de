#include "waiting.hpp"

#include <optional>
#include <utility>

namespace crashrank::python {
namespace {

namespace nb = nanobind;

/// The thread that works, and its end.
class Work {
public:
  explicit Work(const std::function<void()>& work)
      : thread_([this, &work] {
          try {
            work();
          } catch (...) {
            problem_ = std::current_exception();
          }
          const std::lock_guard<std::mutex> lock(mutex_);
          ended_ = true;
          end_.notify_one();
        }) {}
  ~Work() { thread_.join(); }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Waits that long at most. Returns whether the work has ended.
  bool wait(std::chrono::milliseconds time) {
    std::unique_lock<std::mutex> lock(mutex_);
    return end_.wait_for(lock, time, [this] { return ended_; });
  }

  /// Throws what the work threw. After its end only.
  void rethrow() const {
    if (problem_) std::rethrow_exception(problem_);
  }

private:
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::exception_ptr problem_;
  std::thread thread_;  ///< last: it uses the others
};

/// Calls `report` where something has changed. Returns false where it asks to end.
bool tell(const Progress& progress, const nb::object& report, std::size_t& told) {
  const std::size_t all = progress.all;
  const std::size_t done = progress.done;
  if (report.is_none() || all == 0 || done == told) return true;
  told = done;
  const nb::object answer = report(done, all);
  return !answer.is(nb::bool_(false));
}

}  // namespace

bool run_waiting(Progress& progress, const nb::object& report, const std::function<void()>& work) {
  std::optional<nb::python_error> raised;
  bool interrupted = false;
  std::size_t told = static_cast<std::size_t>(-1);
  {
    std::optional<nb::gil_scoped_release> unlocked(std::in_place);
    Work running(work);
    while (!running.wait(look_every)) {
      if (progress.cancel) continue;
      const nb::gil_scoped_acquire lock;
      try {
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
        if (!tell(progress, report, told)) progress.cancel = true;
      } catch (nb::python_error& error) {
        progress.cancel = true;
        interrupted = error.matches(PyExc_KeyboardInterrupt);
        if (!interrupted) raised.emplace(std::move(error));
      }
      if (progress.cancel && progress.on_cancel) progress.on_cancel();
    }
    unlocked.reset();
    if (raised) throw nb::python_error(*raised);
    running.rethrow();
  }
  tell(progress, report, told);
  return interrupted;
}

}  // namespace crashrank::python
