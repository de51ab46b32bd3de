#pragma once

#include "crashrank/base/result.hpp"

#include <atomic>
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
  exit_interrupted =
      130,  ///< within the process only: exit_budget, once `run_interruptible` said it
};

ExitCode exit_code(ErrorCode code);

/// Prints "crashrank: TEXT" on stderr, escaped, on one line.
void say(const std::string& text);

/// The same with an error's message; returns its exit code. After an interruption, which has a
/// message of its own, prints nothing and returns exit_interrupted.
int fail(const Error& error);

/// Prints "crashrank: warning: FILE: TEXT" on stderr, escaped, on one line.
void warn(const std::string& file, const std::string& text);

/// Data on stdout, by the thread that began the answer: see `begin_answer`. A write that fails is
/// told once, by `finish`.
void print(const std::string& data);

/// Flushes stdout: `code`, or exit_internal with a message when something could not be written.
int finish(int code);

/// True when stdout is a terminal that wants colours (NO_COLOR unset or empty, TERM not dumb).
bool colours_wanted();

/// Characters that a line of stdout has room for; 0 where it is no terminal.
std::size_t terminal_width();

/// Takes it upon the calling thread to write the answer; false where another thread has done so.
/// Whoever interrupts has to end the process then. Safe from any thread.
bool begin_answer();

/// What takes long, on stderr when that is a terminal: a bar where there is a number to reach, else
/// the time so far. The thread that waits for the command draws the one made last, from 0.3 s on.
class Progress {
public:
  explicit Progress(std::string what, std::size_t total = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Safe from any thread.
  void update(std::size_t done) { done_ = done; }
  /// The same where the number to reach was not known. Safe from any thread.
  void update(std::size_t done, std::size_t total) {
    total_ = total;
    update(done);
  }
  /// One more is done. Safe from any thread.
  void advance() { ++done_; }

  /// Draws, ten times a second at most.
  static void draw();
  /// Takes away what is drawn.
  static void clear();

private:
  using Clock = std::chrono::steady_clock;
  std::string line() const;

  std::string what_;
  std::atomic<std::size_t> total_;
  std::atomic<std::size_t> done_{0};
  Clock::time_point start_ = Clock::now();
};

}  // namespace crashrank::cli
