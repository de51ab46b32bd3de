#pragma once

#include "crashrank/base/result.hpp"

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace crashrank::detail {

/// An open file descriptor, closed on destruction.
class FileDescriptor {
public:
  explicit FileDescriptor(int number = -1) noexcept : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(other.release()) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() { reset(); }

  int get() const noexcept { return number_; }
  bool valid() const noexcept { return number_ >= 0; }
  int release() noexcept;
  void reset() noexcept;

private:
  int number_;
};

/// A program run with a file as its standard input, whose output is read before a deadline. Killed
/// and reaped on destruction, so that no path leaves a zombie. One thread at a time; any number of
/// them side by side in one process.
class ChildProcess {
public:
  using Clock = std::chrono::steady_clock;

  ChildProcess() = default;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  /// Spawns `arguments[0]`. Errors: internal.
  Status start(const std::vector<std::string>& arguments, const FileDescriptor& standard_input,
               Clock::time_point deadline);

  /// Reads exactly `size` bytes of standard output; false at its end or the deadline.
  bool read(void* data, std::size_t size);

  /// Ends the program, by force if it has not ended by the deadline, and says in a clause how it
  /// ended. Text it wrote to standard error is added when it never got to run.
  std::string finish();

  bool timed_out() const noexcept { return timed_out_; }
  /// The signal that ended it, 0 if none did or it is unknown; valid after `finish`.
  int signal() const noexcept { return signal_; }

private:
  bool wait_readable();
  void drain_standard_error();
  void reap();
  int milliseconds_left() const;

  pid_t pid_ = -1;
  FileDescriptor output_;
  FileDescriptor errors_;
  std::string error_text_;
  Clock::time_point deadline_;
  bool timed_out_ = false;
  bool status_known_ = false;
  int status_ = 0;
  int signal_ = 0;
};

}  // namespace crashrank::detail
