#include "dispatch/study/virtual_cores.hpp"

#include "crashrank/collide/pair.hpp"

#include <algorithm>

namespace crashrank::detail {

void VirtualCores::rouse() {
  for (Core& core : cores_) {
    if (now_ - core.idle_since <= machine_.spin_s) continue;
    work(machine_.send_s);
    core.awake_at = now_ + machine_.wake_s;
    core.idle_since = core.awake_at;
  }
}

void VirtualCores::send(std::uint32_t number) {
  Core& core = cores_[number];
  work(machine_.post_s);
  const bool asleep = core.queue.empty() && now_ - core.idle_since > machine_.spin_s;
  if (asleep) work(machine_.send_s);
  Batch batch = core.filling;
  core.filling = {};
  batch.remaining = batch.run_seconds + machine_.batch_s;
  if (linked()) {
    const double bytes = static_cast<double>(batch.bytes + batch.jobs * job_bytes);
    out_free_ = std::max(out_free_, now_) + bytes / machine_.link_bytes_per_s;
    batch.ready_at = out_free_ + machine_.link_latency_s;
  } else {
    batch.remaining += static_cast<double>(batch.parts) * machine_.copy_part_s +
                       static_cast<double>(batch.bytes) / machine_.copy_bytes_per_s;
    batch.ready_at = now_;
  }
  if (asleep) batch.ready_at += machine_.wake_s;
  batch.ready_at = std::max(batch.ready_at, core.awake_at);
  core.queue.push_back(batch);
  ++core.outstanding;
}

bool VirtualCores::recall(std::uint32_t number) {
  Core& core = cores_[number];
  const auto waiting = std::find_if(core.queue.begin(), core.queue.end(),
                                    [](const Batch& batch) { return !batch.begun; });
  if (waiting == core.queue.end()) return false;
  const double seconds = waiting->run_seconds;
  core.queue.erase(waiting);
  --core.outstanding;
  work(seconds);
  return true;
}

void VirtualCores::finish(Core& core) {
  double heard_at = now_;
  if (linked()) {
    const double bytes = static_cast<double>(core.queue.front().pairs * sizeof(Pair));
    back_free_ = std::max(back_free_, now_) + bytes / machine_.link_bytes_per_s;
    heard_at = back_free_ + machine_.link_latency_s;
  }
  core.finished_at.push_back(heard_at);
  core.queue.pop_front();
  core.idle_since = now_;
  // Waking the main thread keeps the core busy.
  const bool main_sleeps = main_phase_ == Phase::idle && now_ - main_idle_since_ > machine_.spin_s;
  if (main_sleeps && !core.queue.empty()) core.queue.front().remaining += machine_.send_s;
}

void VirtualCores::assign() {
  for (std::uint32_t number = 0; number < cores_.size(); ++number) {
    Core& core = cores_[number];
    const bool has_work = !core.queue.empty() && core.queue.front().ready_at <= now_;
    if (has_work && core.phase == Phase::idle) {
      core.phase = Phase::queued;
      ready_.push_back(number);
    } else if (!has_work && core.phase == Phase::running) {
      core.phase = Phase::idle;
      ++free_;
    } else if (!has_work && core.phase == Phase::queued) {  // taken back
      core.phase = Phase::idle;
      ready_.erase(std::find(ready_.begin(), ready_.end(), number));
    } else if (core.phase == Phase::running && !ready_.empty() && free_ == 0 &&
               core.slice_ends <= now_) {
      core.phase = Phase::queued;
      ready_.push_back(number);
      ++free_;
    }
    if (core.phase == Phase::running) core.queue.front().begun = true;
  }
  while (free_ > 0 && !ready_.empty()) {
    const std::uint32_t next = ready_.front();
    ready_.pop_front();
    --free_;
    if (next == main_thread) {
      main_phase_ = Phase::running;
      continue;
    }
    Core& core = cores_[next];
    core.phase = Phase::running;
    core.slice_ends = now_ + machine_.slice_s;
    core.queue.front().begun = true;
  }
}

void VirtualCores::step(double until) {
  assign();
  double next = until;
  std::uint32_t running = 0;
  for (const Core& core : cores_) {
    if (core.phase == Phase::running) {
      ++running;
      next = std::min(next, now_ + core.queue.front().remaining);
      if (!ready_.empty() && core.slice_ends > now_) next = std::min(next, core.slice_ends);
    } else if (core.phase == Phase::idle && !core.queue.empty()) {
      next = std::min(next, core.queue.front().ready_at);
    }
    if (!core.finished_at.empty()) next = std::min(next, core.finished_at.front());
  }
  next = std::max(next, now_);
  const double passed = next - now_;
  now_ = next;
  if (main_phase_ == Phase::running) main_ += passed;
  idle_ += passed * static_cast<double>(cores_.size() - running);
  for (Core& core : cores_) {
    if (core.phase == Phase::running) {
      Batch& batch = core.queue.front();
      batch.remaining -= passed;
      if (batch.remaining <= 1e-12) finish(core);  // a picosecond: below what doubles resolve
    }
    while (!core.finished_at.empty() && core.finished_at.front() <= now_) {
      core.finished_at.pop_front();
      --core.outstanding;
      ++heard_;
    }
  }
  assign();
}

void VirtualCores::main_gives_its_processor() {
  main_phase_ = Phase::idle;
  main_idle_since_ = now_;
  ++free_;
  assign();
}

void VirtualCores::main_takes_a_processor() {
  if (main_phase_ == Phase::running) return;
  main_phase_ = Phase::queued;
  ready_.push_back(main_thread);
  assign();
  while (main_phase_ != Phase::running) step(never);
}

void VirtualCores::work(double seconds) {
  const double until = now_ + seconds;
  while (now_ < until) step(until);
}

void VirtualCores::wait(std::uint32_t seen) {
  main_gives_its_processor();
  while (heard_ == seen) step(never);
  if (now_ - main_idle_since_ > machine_.spin_s) {
    const double until = now_ + machine_.main_wake_s;
    while (now_ < until) step(until);
  }
  main_takes_a_processor();
}

void VirtualCores::wait_all() {
  const auto busy = [](const Core& core) { return core.outstanding != 0; };
  if (std::none_of(cores_.begin(), cores_.end(), busy)) return;
  main_gives_its_processor();
  while (std::any_of(cores_.begin(), cores_.end(), busy)) step(never);
  if (now_ - main_idle_since_ > machine_.spin_s) now_ += machine_.main_wake_s;
  main_phase_ = Phase::running;
  --free_;
}

}  // namespace crashrank::detail
