#include "console.hpp"

#include "crashrank/report/escape.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace crashrank::cli {
namespace {

void say(const std::string& text) {
  const std::string line = "crashrank: " + escape_terminal(text) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

int write_error = 0;

}  // namespace

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
  say(error.message());
  return exit_code(error.code);
}

void warn(const std::string& file, const std::string& text) {
  say("warning: " + (file.empty() ? text : file + ": " + text));
}

void print(const std::string& data) {
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

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)),
      total_(total),
      shown_(isatty(STDERR_FILENO) != 0),
      next_(std::chrono::steady_clock::now() + std::chrono::milliseconds(300)) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void Progress::update(std::size_t done) {
  if (!shown_ || total_ == 0) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  drawn_ = true;
  constexpr std::size_t width = 30;
  const std::size_t filled = width * done / total_;
  const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
  fmt::print(stderr, "\r{} [{}] {}/{}", what_, bar, done, total_);
  std::fflush(stderr);
}

}  // namespace crashrank::cli
