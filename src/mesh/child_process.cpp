#include "mesh/child_process.hpp"

#include "mesh/text.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>

// POSIX leaves it to the program to declare it; glibc does so as well.
extern char** environ;  // NOLINT(readability-redundant-declaration)

namespace crashrank::detail {
namespace {

constexpr std::size_t max_error_text = 4096;

std::string describe(int error) { return std::generic_category().message(error); }

Error failure(const std::string& what, int error) {
  return make_error(ErrorCode::internal, what + ": " + describe(error));
}

std::string signal_name(int number) {
  switch (number) {
    case SIGABRT:
      return "SIGABRT";
    case SIGBUS:
      return "SIGBUS";
    case SIGFPE:
      return "SIGFPE";
    case SIGILL:
      return "SIGILL";
    case SIGKILL:
      return "SIGKILL";
    case SIGSEGV:
      return "SIGSEGV";
    case SIGXCPU:
      return "SIGXCPU";
    default:
      return "signal " + std::to_string(number);
  }
}

// Above the standard streams, so that a process that runs with some of them closed does not
// overwrite one end with another while they are put in place.
FileDescriptor above_standard_streams(FileDescriptor file) {
  if (!file.valid() || file.get() > STDERR_FILENO) return file;
  return FileDescriptor(::fcntl(file.get(), F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
}

struct Pipe {
  FileDescriptor reading;
  FileDescriptor writing;
};

Result<Pipe> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return failure("no pipe to the importer", errno);
  Pipe pipe{above_standard_streams(FileDescriptor(ends[0])),
            above_standard_streams(FileDescriptor(ends[1]))};
  if (!pipe.reading.valid() || !pipe.writing.valid()) {
    return failure("no pipe to the importer", errno);
  }
  return pipe;
}

// posix_spawn's two option objects, released together.
class SpawnOptions {
public:
  SpawnOptions() {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawnattr_init(&attributes_);
    // The caller's handlers and masks are not the importer's.
    sigset_t signals;
    ::sigfillset(&signals);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
    ::sigemptyset(&signals);
    ::posix_spawnattr_setsigmask(&attributes_, &signals);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  SpawnOptions(const SpawnOptions&) = delete;
  SpawnOptions& operator=(const SpawnOptions&) = delete;
  ~SpawnOptions() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  void connect(const FileDescriptor& file, int target) {
    ::posix_spawn_file_actions_adddup2(&actions_, file.get(), target);
  }
  const posix_spawn_file_actions_t* actions() const { return &actions_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  if (this != &other) {
    reset();
    number_ = other.release();
  }
  return *this;
}

int FileDescriptor::release() noexcept {
  const int number = number_;
  number_ = -1;
  return number;
}

void FileDescriptor::reset() noexcept {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

ChildProcess::~ChildProcess() {
  deadline_ = Clock::now();
  reap();
}

Status ChildProcess::start(const std::vector<std::string>& arguments,
                           const FileDescriptor& standard_input, Clock::time_point deadline) {
  deadline_ = deadline;
  Result<Pipe> output = make_pipe();
  if (!output) return output.error();
  Result<Pipe> errors = make_pipe();
  if (!errors) return errors.error();
  const FileDescriptor input = above_standard_streams(
      FileDescriptor(::fcntl(standard_input.get(), F_DUPFD_CLOEXEC, STDERR_FILENO + 1)));
  if (!input.valid()) return failure("cannot hand the mesh to the importer", errno);

  SpawnOptions options;
  options.connect(input, STDIN_FILENO);
  options.connect(output->writing, STDOUT_FILENO);
  options.connect(errors->writing, STDERR_FILENO);
  std::vector<std::string> owned = arguments;
  std::vector<char*> argv;
  argv.reserve(owned.size() + 1);
  for (std::string& argument : owned) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int error =
      ::posix_spawn(&pid_, argv[0], options.actions(), options.attributes(), argv.data(), environ);
  if (error != 0) {
    pid_ = -1;
    return failure("cannot start the importer " + arguments[0], error);
  }
  output_ = std::move(output->reading);
  errors_ = std::move(errors->reading);
  ::fcntl(errors_.get(), F_SETFL, O_NONBLOCK);
  return Success{};
}

int ChildProcess::milliseconds_left() const {
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
  return static_cast<int>(std::clamp<decltype(left)>(left, 0, 1'000'000'000));
}

void ChildProcess::drain_standard_error() {
  std::array<char, 1024> text{};
  const ssize_t got = ::read(errors_.get(), text.data(), text.size());
  if (got > 0) {
    const std::size_t room = max_error_text - error_text_.size();
    error_text_.append(text.data(), std::min(room, static_cast<std::size_t>(got)));
  } else if (got == 0 || (errno != EAGAIN && errno != EINTR)) {
    errors_.reset();
  }
}

bool ChildProcess::wait_readable() {
  for (;;) {
    // poll skips negative descriptors, so a closed standard error needs no case of its own.
    std::array<pollfd, 2> waiting{pollfd{output_.get(), POLLIN, 0},
                                  pollfd{errors_.get(), POLLIN, 0}};
    const int left = milliseconds_left();
    const int ready = ::poll(waiting.data(), waiting.size(), left);
    if (ready < 0 && errno != EINTR) return false;
    if (ready == 0 && left == 0) {
      timed_out_ = true;
      return false;
    }
    if (ready <= 0) continue;
    if (waiting[1].revents != 0) drain_standard_error();
    if (waiting[0].revents != 0) return true;
  }
}

bool ChildProcess::read(void* data, std::size_t size) {
  char* to = static_cast<char*>(data);
  while (size > 0) {
    if (!wait_readable()) return false;
    const ssize_t got = ::read(output_.get(), to, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

// Waits until the deadline, then kills. Where the caller's process ignores SIGCHLD, or reaps
// children it does not know, no one gets the status; the id must then not be signalled.
void ChildProcess::reap() {
  if (pid_ < 0) return;
  bool killed = false;
  while (pid_ > 0) {
    const pid_t got = ::waitpid(pid_, &status_, killed ? 0 : WNOHANG);
    if (got == pid_) {
      status_known_ = true;
      pid_ = -1;
    } else if (got < 0 && errno != EINTR) {
      pid_ = -1;
    } else if (got == 0 && milliseconds_left() == 0) {
      ::kill(pid_, SIGKILL);
      killed = true;
    } else if (got == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  if (status_known_ && WIFSIGNALED(status_)) signal_ = WTERMSIG(status_);
}

std::string ChildProcess::finish() {
  if (errors_.valid()) drain_standard_error();
  output_.reset();
  errors_.reset();
  reap();
  if (timed_out_) return "it ran out of time";
  if (!status_known_) return "its end is unknown";
  if (WIFSIGNALED(status_)) {
    return "it was ended by " + signal_name(signal_);
  }
  std::string text = "it ended with status " + std::to_string(WEXITSTATUS(status_));
  const std::string line = error_text_.substr(0, error_text_.find('\n'));
  if (!line.empty()) text += " (" + printable(line) + ")";
  return text;
}

}  // namespace crashrank::detail
