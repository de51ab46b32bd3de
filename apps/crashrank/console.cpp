#include "console.hpp"

#include "interrupt.hpp"

#include "crashrank/internal/report/escape.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

int write_error = 0;
/// Whose thread writes the answer; none yet where it is no thread's.
std::atomic<std::thread::id> answering{};

/// The terminal is one, and so is what is drawn on it.
struct Shown {
  Shown() noexcept = default;

  std::mutex mutex;
  std::vector<Progress*> all;
  std::chrono::steady_clock::time_point next;
  bool drawn = false;
};
Shown shown;

}  // namespace

void say(const std::string& text) {
  Progress::clear();
  const std::string line = "crashrank: " + escape_terminal(text) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

ExitCode exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return exit_usage;
    case ErrorCode::bad_input:
    case ErrorCode::not_found:
    case ErrorCode::limit_exceeded:
      return exit_bad_input;
    case ErrorCode::out_of_budget:
    case ErrorCode::out_of_memory:
      return exit_budget;
    case ErrorCode::internal:
      break;
  }
  return exit_internal;
}

int fail(const Error& error) {
  if (is_interrupted()) return exit_interrupted;
  say(error.message());
  return exit_code(error.code);
}

void warn(const std::string& file, const std::string& text) {
  say("warning: " + (file.empty() ? text : file + ": " + text));
}

bool begin_answer() {
  std::thread::id writer;
  const std::thread::id own = std::this_thread::get_id();
  return answering.compare_exchange_strong(writer, own) || writer == own;
}

void print(const std::string& data) {
  Progress::clear();
  // An interruption that came first writes what was known then, and ends the process.
  while (!begin_answer()) std::this_thread::sleep_for(std::chrono::hours(1));
  if (write_error != 0) return;
  if (std::fwrite(data.data(), 1, data.size(), stdout) != data.size()) write_error = errno;
}

int finish(int code) {
  if (write_error == 0 && std::fflush(stdout) != 0) write_error = errno;
  if (write_error == 0) return code;
  say(std::string("standard output: cannot write: ") + std::strerror(write_error));
  return exit_internal;
}

bool colours_wanted() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  const bool refused = no_color != nullptr && *no_color != '\0';
  const bool dumb = term == nullptr || std::strcmp(term, "dumb") == 0;
  return isatty(STDOUT_FILENO) != 0 && !refused && !dumb;
}

std::size_t terminal_width() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col;
}

Progress::Progress(std::string what, std::size_t total) : what_(std::move(what)), total_(total) {
  const std::lock_guard<std::mutex> lock(shown.mutex);
  shown.all.push_back(this);
}

Progress::~Progress() {
  {
    const std::lock_guard<std::mutex> lock(shown.mutex);
    shown.all.erase(std::remove(shown.all.begin(), shown.all.end(), this), shown.all.end());
  }
  clear();
}

std::string Progress::line() const {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const std::size_t total = total_;
  if (total == 0) return fmt::format("{} {:.0f} s", what_, seconds);
  constexpr std::size_t width = 30;
  const std::size_t done = std::min<std::size_t>(done_, total);
  const std::size_t filled = width * done / total;
  return fmt::format("{} [{}{}] {}/{}", what_, std::string(filled, '#'),
                     std::string(width - filled, '.'), done, total);
}

void Progress::draw() {
  constexpr std::chrono::milliseconds wait(300);
  constexpr std::chrono::milliseconds pause(100);
  const std::lock_guard<std::mutex> lock(shown.mutex);
  if (shown.all.empty() || isatty(STDERR_FILENO) == 0) return;
  const Progress& last = *shown.all.back();
  const Clock::time_point now = Clock::now();
  if (now < shown.next || now < last.start_ + wait) return;
  shown.next = now + pause;
  shown.drawn = true;
  fmt::print(stderr, "\r{}\x1b[K", last.line());
  std::fflush(stderr);
}

void Progress::clear() {
  const std::lock_guard<std::mutex> lock(shown.mutex);
  if (shown.drawn) std::fputs("\r\x1b[K", stderr);
  shown.drawn = false;
}

}  // namespace crashrank::cli
