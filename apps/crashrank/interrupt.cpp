#include "interrupt.hpp"

#include "console.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <ctime>
#include <exception>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace crashrank::cli {
namespace {

constexpr std::chrono::milliseconds look_every(30);
constexpr std::chrono::milliseconds patience(2000);

// A signal handler reaches nothing else; without a lock it may run in the middle of any operation.
std::atomic<bool> signal_received{false};
static_assert(std::atomic<bool>::is_always_lock_free);
timespec first_received{};  // read and written by the handler alone

/// A second signal ends the process at once; senders such as timeout(1) send one twice.
extern "C" void receive_signal(int /*signal*/) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (!signal_received) first_received = now;
  if (now.tv_sec > first_received.tv_sec + 1) _exit(exit_budget);
  signal_received = true;
}

/// What is to be done on an interruption; one for the process, as signals are.
struct Pending {
  std::mutex mutex;
  std::vector<std::pair<const PartialAnswer*, std::function<Interruption()>>> answers;
  std::vector<std::string> files;
  std::atomic<int> end_themselves{0};  ///< actions that do

  /// Takes the mutex within some 50 ms. What holds it longer is in the middle of an answer.
  bool lock_soon() {
    for (int tries = 0; tries < 50; ++tries) {
      if (mutex.try_lock()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }

  static Pending& instance() {
    static Pending pending;
    return pending;
  }
};

void listen_to(int signal) {
  struct sigaction before {};
  if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = receive_signal;
  sigemptyset(&action.sa_mask);
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

[[noreturn]] void end_interrupted() {
  Pending& pending = Pending::instance();
  // Kept to the end, so that the work makes no further file.
  const bool locked = pending.lock_soon();
  Progress::clear();
  Interruption known{{}, "nothing is known yet"};
  if (!begin_answer()) {
    known.message = "a part of the answer is written";
  } else if (locked && !pending.answers.empty()) {
    known = pending.answers.back().second();
  }
  if (locked) {
    for (const std::string& file : pending.files) {
      std::error_code ignored;
      std::filesystem::remove_all(file, ignored);
    }
  }
  if (!known.answer.empty()) {
    print(known.answer);
    finish(exit_budget);
  }
  say("interrupted: " + known.message);
  _exit(exit_budget);
}

}  // namespace

bool is_interrupted() { return signal_received; }

int run_interruptible(const std::function<int()>& action) {
  listen_to(SIGINT);
  listen_to(SIGTERM);
  std::mutex mutex;
  std::condition_variable ended;
  bool done = false;
  int code = exit_internal;
  std::exception_ptr problem;
  const auto work = [&] {
    try {
      code = action();
    } catch (...) {
      problem = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(mutex);
    done = true;
    ended.notify_one();
  };
  std::thread worker;
  try {
    worker = std::thread(work);
  } catch (const std::system_error&) {
    work();  // the system refuses threads: no progress, and signals end nothing
  }
  {
    std::unique_lock<std::mutex> lock(mutex);
    std::chrono::milliseconds since_signal{0};
    while (!ended.wait_for(lock, look_every, [&] { return done; })) {
      if (signal_received) {
        const bool ends_itself = Pending::instance().end_themselves > 0;
        if (!ends_itself || since_signal > patience) end_interrupted();
        since_signal += look_every;
      }
      Progress::draw();
    }
  }
  if (worker.joinable()) worker.join();
  if (signal_received && (problem || code == exit_interrupted)) end_interrupted();
  if (problem) std::rethrow_exception(problem);
  return code;
}

PartialAnswer::PartialAnswer(std::function<Interruption()> tell) {
  Pending& pending = Pending::instance();
  const std::lock_guard<std::mutex> lock(pending.mutex);
  pending.answers.emplace_back(this, std::move(tell));
}

PartialAnswer::~PartialAnswer() {
  Pending& pending = Pending::instance();
  const std::lock_guard<std::mutex> lock(pending.mutex);
  auto& answers = pending.answers;
  answers.erase(std::remove_if(answers.begin(), answers.end(),
                               [this](const auto& answer) { return answer.first == this; }),
                answers.end());
}

EndsItself::EndsItself() { ++Pending::instance().end_themselves; }

EndsItself::~EndsItself() { --Pending::instance().end_themselves; }

UnfinishedFile::UnfinishedFile(std::string path) : path_(std::move(path)) {
  Pending& pending = Pending::instance();
  const std::lock_guard<std::mutex> lock(pending.mutex);
  pending.files.push_back(path_);
}

UnfinishedFile::~UnfinishedFile() {
  Pending& pending = Pending::instance();
  const std::lock_guard<std::mutex> lock(pending.mutex);
  const auto found = std::find(pending.files.begin(), pending.files.end(), path_);
  if (found != pending.files.end()) pending.files.erase(found);
}

}  // namespace crashrank::cli
