#include "dispatch/virtual_cores.hpp"

#include "crashrank/collide/pair.hpp"

#include <algorithm>

namespace crashrank::detail {

void VirtualCores::send(std::uint32_t number) {
  Core& core = cores_[number];
  const bool asleep = core.queue.empty() && now_ - core.idle_since > machine_.spin_s;
  if (asleep) work(machine_.send_s);
  Batch batch = core.filling;
  core.filling = {};
  batch.remaining = batch.run_seconds;
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
  core.queue.push_back(batch);
  ++core.outstanding;
}

void VirtualCores::finish(Core& core) {
  double heard_at = now_;
  if (linked()) {
    const double bytes = static_cast<double>(core.queue.front().pairs * sizeof(Pair));
    back_free_ = std::max(back_free_, now_) + bytes / machine_.link_bytes_per_s;
    heard_at = back_free_ + machine_.link_latency_s;
  }
  core.heard.push_back(heard_at);
  core.queue.pop_front();
  core.idle_since = now_;
}

void VirtualCores::step(double until, bool main_works) {
  std::uint32_t active = 0;
  for (Core& core : cores_) {
    core.active = !core.queue.empty() && core.queue.front().ready_at <= now_;
    active += core.active ? 1U : 0U;
  }
  const double free = static_cast<double>(machine_.processors) - (main_works ? 1.0 : 0.0);
  const double rate = active == 0 ? 0.0 : std::min(1.0, free / active);
  double next = until;
  for (const Core& core : cores_) {
    if (core.active) {
      if (rate > 0.0) next = std::min(next, now_ + core.queue.front().remaining / rate);
    } else if (!core.queue.empty()) {
      next = std::min(next, core.queue.front().ready_at);
    }
    if (!core.heard.empty()) next = std::min(next, core.heard.front());
  }
  next = std::max(next, now_);
  const double passed = next - now_;
  now_ = next;
  if (main_works) main_ += passed;
  idle_ += passed * static_cast<double>(cores_.size() - active);
  for (Core& core : cores_) {
    if (core.active) {
      Batch& batch = core.queue.front();
      batch.remaining -= passed * rate;
      if (batch.remaining <= 1e-12) finish(core);  // a picosecond: below what doubles resolve
    }
    while (!core.heard.empty() && core.heard.front() <= now_) {
      core.heard.pop_front();
      --core.outstanding;
      ++heard_;
    }
  }
}

void VirtualCores::work(double seconds) {
  const double until = now_ + seconds;
  while (now_ < until) step(until, true);
}

void VirtualCores::wait(std::uint32_t seen) {
  while (heard_ == seen) step(never, false);
  const double until = now_ + machine_.main_wake_s;
  while (now_ < until) step(until, false);
}

void VirtualCores::wait_all() {
  const auto busy = [](const Core& core) { return core.outstanding != 0; };
  if (std::none_of(cores_.begin(), cores_.end(), busy)) return;
  while (std::any_of(cores_.begin(), cores_.end(), busy)) step(never, false);
  now_ += machine_.main_wake_s;
}

}  // namespace crashrank::detail
