#include "crashrank/dispatch/study/study.hpp"

#include "dispatch/core.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace crashrank {

namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void nothing(void* context, std::uint32_t worker) {
  static_cast<void>(context);
  static_cast<void>(worker);
}

struct Times {
  std::atomic<double> started{0.0};
  std::atomic<double> ended{0.0};
};

void note_times(void* context, std::uint32_t worker) {
  static_cast<void>(worker);
  Times& times = *static_cast<Times*>(context);
  times.started = detail::clock_seconds();
  // Long enough that the waiting thread has gone to sleep.
  const double until = times.started + 60e-6;
  double now = 0.0;
  do {
    now = detail::clock_seconds();
  } while (now < until);
  times.ended = now;
}

}  // namespace

Status measure_waking(WorkerPool& pool, VirtualMachine& machine) {
  constexpr int tries = 200;
  std::vector<double> post;
  std::vector<double> send;
  std::vector<double> wake;
  std::vector<double> main_wake;
  Times times;
  for (int i = 0; i < tries && pool.size() > 0; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    const double before = detail::clock_seconds();
    pool.post(0, {&note_times, &times});
    const double sent = detail::clock_seconds();
    pool.post(0, {&nothing, nullptr});  // to a worker that is awake, or about to be
    post.push_back(detail::clock_seconds() - sent);
    pool.wait_all();
    const double back = detail::clock_seconds();
    send.push_back(sent - before);
    wake.push_back(std::max(0.0, times.started - sent));
    main_wake.push_back(std::max(0.0, back - times.ended));
  }
  if (!send.empty()) {
    machine.post_s = median(post);
    machine.send_s = std::max(0.0, median(send) - machine.post_s);
    machine.wake_s = median(wake);
    machine.main_wake_s = median(main_wake);
    machine.spin_s = pool.spin_seconds();
  }
  return pool.take_failure();
}

void fit_copying(View<const DispatchRecording> recordings, VirtualMachine& machine) {
  // Normal equations of seconds = parts * x + bytes * y.
  double pp = 0.0;
  double pb = 0.0;
  double bb = 0.0;
  double ps = 0.0;
  double bs = 0.0;
  for (const DispatchRecording& recording : recordings) {
    for (const RecordedBatch& batch : recording.batches) {
      if (batch.copied_parts == 0) continue;
      const auto parts = static_cast<double>(batch.copied_parts);
      const auto bytes = static_cast<double>(batch.copied_bytes);
      pp += parts * parts;
      pb += parts * bytes;
      bb += bytes * bytes;
      ps += parts * batch.copy_seconds;
      bs += bytes * batch.copy_seconds;
    }
  }
  if (!(bb > 0.0)) return;
  const double determinant = pp * bb - pb * pb;
  double a_part = determinant > 1e-9 * pp * bb ? (ps * bb - bs * pb) / determinant : 0.0;
  a_part = std::max(0.0, a_part);
  const double a_byte = (bs - a_part * pb) / bb;
  machine.copy_part_s = a_part;
  if (a_byte > 0.0) machine.copy_bytes_per_s = 1.0 / a_byte;
}

}  // namespace crashrank
