#include "crashrank/dispatch/study/study.hpp"

#include "dispatch/crew.hpp"
#include "dispatch/holdings.hpp"
#include "dispatch/placer.hpp"
#include "dispatch/study/virtual_cores.hpp"

#include <algorithm>
#include <exception>
#include <string>

namespace crashrank {

namespace {

Status check(const DispatchRecording& recording, const ReplayOptions& options) {
  const VirtualMachine& machine = options.machine;
  if (recording.jobs.empty()) {
    return make_error(ErrorCode::usage, "the recording holds no jobs",
                      "record a dispatch that was shared out");
  }
  if (machine.processors < 1 || machine.workers < 1 || machine.workers > max_workers) {
    return make_error(ErrorCode::usage, "a machine has processors, and 1 to 64 workers");
  }
  if (options.buffer < 1) {
    return make_error(ErrorCode::usage, "a buffer holds at least one job");
  }
  for (const double time :
       {machine.spin_s, machine.send_s, machine.wake_s, machine.main_wake_s, machine.copy_part_s,
        machine.link_bytes_per_s, machine.link_latency_s, machine.post_s, machine.batch_s}) {
    if (!(time >= 0.0)) return make_error(ErrorCode::usage, "times and rates are not negative");
  }
  if (!(machine.slice_s > 0.0)) {
    return make_error(ErrorCode::usage, "a time slice is longer than nothing");
  }
  if (!(machine.copy_bytes_per_s > 0.0)) {
    return make_error(ErrorCode::usage, "copying needs a rate above zero");
  }
  return Success{};
}

ReplayReport replay_checked(const DispatchRecording& recording, const ReplayOptions& options) {
  const std::unique_ptr<PlacementPolicy> policy = make_policy(options.policy);
  VirtualMachine machine = options.machine;
  const detail::Crew crew =
      detail::crew_for(*policy, machine.workers, machine.processors, options.caller_works);
  machine.workers = crew.workers;
  if (crew.awake) machine.spin_s = std::max(machine.spin_s, detail::crew_spin_s);
  detail::Holdings holdings;
  holdings.begin(machine.workers);
  ReplayReport report;
  double model_bytes = 0.0;
  for (const PartIndex* body : recording.bodies) {
    holdings.body(*body, recording.depth);
    model_bytes += static_cast<double>(body->model_bytes());
  }
  detail::VirtualCores cores(recording, holdings, machine);
  policy->begin(machine.workers, options.seed);
  std::vector<WaitingJob> waiting;
  std::vector<detail::FoundJob> found;
  detail::Placer<detail::VirtualCores> placer(
      cores, holdings, *policy, machine.workers,
      {options.buffer, options.store_bytes, options.queue_bytes,
       options.store == StoreMode::private_copy, crew.caller, recording.seconds_per_work},
      waiting, found);
  if (crew.awake) cores.rouse();
  cores.work(recording.begin_seconds);
  for (std::size_t i = 0; i < recording.jobs.size(); ++i) {
    const RecordedJob& job = recording.jobs[i];
    cores.work(job.find_seconds);
    if (!placer.add({i, job.query, job.body_a, job.body_b, job.node_a, job.node_b, job.work})) {
      report.end = DispatchEnd::out_of_memory;
      break;
    }
  }
  if (report.end == DispatchEnd::ok && !placer.finish()) report.end = DispatchEnd::out_of_memory;
  cores.wait_all();
  cores.work(recording.finish_seconds);
  report.seconds = cores.now();
  report.jobs = placer.placed();
  report.batches = placer.batches();
  report.transferred_bytes = placer.transferred_bytes();
  for (std::uint32_t core = 0; core < machine.workers; ++core) {
    report.peak_part_bytes = std::max(report.peak_part_bytes, holdings.bytes(core));
  }
  report.main_seconds = cores.main_seconds();
  report.idle_seconds = cores.idle_seconds();
  report.relative_transfer = static_cast<double>(report.transferred_bytes) / model_bytes;
  return report;
}

}  // namespace

Result<ReplayReport> replay(const DispatchRecording& recording, const ReplayOptions& options) {
  if (Status status = check(recording, options); !status) return status.error();
  try {
    return replay_checked(recording, options);
  } catch (const std::exception& error) {
    return make_error(ErrorCode::internal, std::string("the replay failed: ") + error.what());
  }
}

}  // namespace crashrank
