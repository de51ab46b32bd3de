#pragma once

#include "crashrank/base/result.hpp"

#include <chrono>
#include <cstddef>
#include <string>

namespace crashrank::cli {

/// What the process answers its caller with.
enum ExitCode : int {
  exit_done = 0,
  exit_internal = 1,
  exit_usage = 2,
  exit_bad_input = 3,
  exit_budget = 4,  ///< a deadline or memory budget ended the work with a partial answer
};

ExitCode exit_code(ErrorCode code);

/// Prints "crashrank: MESSAGE" on stderr, escaped, on one line, and returns its exit code.
int fail(const Error& error);

/// Prints "crashrank: warning: FILE: TEXT" on stderr, escaped, on one line.
void warn(const std::string& file, const std::string& text);

/// Data on stdout. A write that fails is told once, by `finish`.
void print(const std::string& data);

/// Flushes stdout: `code`, or exit_internal with a message when something could not be written.
int finish(int code);

/// True when stdout is a terminal that wants colours (NO_COLOR unset or empty, TERM not dumb).
bool colours_wanted();

/// A bar on stderr, when that is a terminal; nothing otherwise. Redrawn ten times a second at most.
class Progress {
public:
  Progress(std::string what, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(std::size_t done);

private:
  std::string what_;
  std::size_t total_;
  bool shown_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace crashrank::cli
