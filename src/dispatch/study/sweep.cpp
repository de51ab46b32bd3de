#include "crashrank/dispatch/study/study.hpp"

#include "crashrank/collide/pair.hpp"

#include <algorithm>
#include <exception>
#include <numeric>
#include <string>
#include <thread>
#include <utility>

namespace crashrank {

namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What was measured of one policy at one depth on one query (or on the batch).
struct Measured {
  std::vector<double> seconds;
  std::vector<double> relative_transfer;
  std::vector<double> transferred_bytes;
  double peak_part_bytes = 0.0;
  double jobs = 0.0;
  DispatchEnd end = DispatchEnd::ok;
  bool recorded = false;
  std::vector<double> replayed_seconds;
  std::vector<double> replayed_speedups;  ///< each against the serial time of its turn
  std::vector<double> replayed_transfer;
  DispatchEnd replayed_end = DispatchEnd::ok;
};

/// The calling thread alone.
struct Serial {
  std::vector<double> seconds;
  std::size_t pairs = 0;
};

class Sweeper {
public:
  Sweeper(const PartIndex& a, const PartIndex& b, View<const Pose> poses,
          const SweepOptions& options, Dispatcher here, Dispatcher one, Dispatcher many)
      : options_(options), here_(std::move(here)), one_(std::move(one)), many_(std::move(many)) {
    for (const Pose& pose : poses) queries_.push_back({&a, &b, pose});
    if (options.batch) {
      asked_.emplace_back(queries_.data(), queries_.size());
    } else {
      for (const DispatchQuery& query : queries_) asked_.emplace_back(&query, 1);
    }
  }

  Result<Sweep> run() {
    Sweep result;
    result.processors = std::max(1U, std::thread::hardware_concurrency());
    result.machine.processors = options_.workers;
    result.machine.workers = options_.workers;
    if (Status status = measure_waking(one_.pool(), result.machine); !status) {
      return status.error();
    }
    result.machine.spin_s = 0.0;  // as many cores as workers: the main thread needs one of them
    machine_ = result.machine;
    if (Status status = fit(); !status) return status.error();
    result.machine = machine_;
    for (std::size_t i = 0; i < options_.depths.size(); ++i) {
      if (Status status = measure(options_.depths[i]); !status) return status.error();
      if (options_.progress) options_.progress(i + 1, options_.depths.size());
    }
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      const std::size_t level = i / options_.policies.size();
      const Policy policy = options_.policies[i % options_.policies.size()];
      result.rows.push_back(summary(level, policy, measured_[i]));
    }
    return result;
  }

private:
  using PerQuery = std::vector<Measured>;

  Status measure(std::uint32_t depth) {
    const std::size_t first = measured_.size();
    measured_.resize(first + options_.policies.size(), PerQuery(asked_.size()));
    serial_.emplace_back(asked_.size());
    for (std::uint32_t turn = 0; turn < options_.repeat; ++turn) {
      for (std::size_t i = 0; i < asked_.size(); ++i) {
        if (Status status = serial(i); !status) return status;
        for (std::size_t p = 0; p < options_.policies.size(); ++p) {
          Measured& into = measured_[first + p][i];
          const std::uint64_t seed = options_.seed + turn;
          if (into.end == DispatchEnd::ok) {
            if (Status status = dispatch(depth, options_.policies[p], seed, i, into); !status) {
              return status;
            }
          } else if (into.recorded) {
            continue;
          }
          if (Status status = record(depth, options_.policies[p], seed, i, into); !status) {
            return status;
          }
        }
      }
    }
    return Success{};
  }

  DispatchOptions with(std::uint32_t depth, Policy policy) const {
    DispatchOptions how;
    how.depth = depth;
    how.policy = policy;
    how.store = options_.store;
    how.kernel = options_.kernel;
    how.buffer = options_.buffer;
    return how;
  }

  Status serial(std::size_t i) {
    DispatchOptions how;
    how.kernel = options_.kernel;
    Serial& into = serial_.back()[i];
    into.pairs = 0;
    double seconds = 0.0;
    for (const DispatchQuery& query : asked_[i]) {
      const Result<DispatchReport> report = here_.run({&query, 1}, lists_, how);
      if (!report) return report.error();
      seconds += report->seconds;
      into.pairs += lists_.total();
    }
    into.seconds.push_back(seconds);
    return Success{};
  }

  Status dispatch(std::uint32_t depth, Policy policy, std::uint64_t seed, std::size_t i,
                  Measured& into) {
    DispatchOptions how = with(depth, policy);
    how.store_bytes = options_.store_bytes;
    how.seed = seed;
    const Result<DispatchReport> report = many_.run(asked_[i], lists_, how);
    if (!report) return report.error();
    into.end = report->end;
    into.seconds.push_back(report->seconds);
    into.relative_transfer.push_back(report->relative_transfer());
    into.transferred_bytes.push_back(static_cast<double>(report->transferred_bytes));
    into.peak_part_bytes =
        std::max(into.peak_part_bytes, static_cast<double>(report->peak_part_bytes));
    if (report->end != DispatchEnd::ok) return Success{};
    return same_answer(i);
  }

  /// On one worker, and at once replayed on many.
  Status record(std::uint32_t depth, Policy policy, std::uint64_t seed, std::size_t i,
                Measured& into) {
    DispatchOptions how = with(depth, policy);
    how.recording = &recording_;
    how.caller_works = false;
    const Result<DispatchReport> report = one_.run(asked_[i], lists_, how);
    if (!report) return report.error();
    into.recorded = true;
    into.jobs = static_cast<double>(report->jobs);
    if (Status status = same_answer(i); !status || recording_.jobs.empty()) return status;
    ReplayOptions again;
    again.policy = policy;
    again.store = options_.store;
    again.buffer = options_.buffer;
    again.store_bytes = options_.store_bytes;
    again.seed = seed;
    again.machine = machine_;
    const Result<ReplayReport> replayed = replay(recording_, again);
    if (!replayed) return replayed.error();
    if (replayed->end != DispatchEnd::ok) into.replayed_end = replayed->end;
    into.replayed_seconds.push_back(replayed->seconds);
    into.replayed_speedups.push_back(serial_.back()[i].seconds.back() / replayed->seconds);
    into.replayed_transfer.push_back(replayed->relative_transfer);
    return Success{};
  }

  Status same_answer(std::size_t i) const {
    const std::size_t expected = serial_.back()[i].pairs;
    if (lists_.total() == expected) return Success{};
    return make_error(ErrorCode::internal, "a dispatch found " + std::to_string(lists_.total()) +
                                               " pairs where the calling thread alone found " +
                                               std::to_string(expected));
  }

  /// What copying costs on one worker, at all depths.
  Status fit() {
    if (options_.store != StoreMode::private_copy) return Success{};
    std::vector<DispatchRecording> all;
    for (const std::uint32_t depth : options_.depths) {
      DispatchOptions how = with(depth, Policy::best_match);
      how.recording = &recording_;
      for (const View<const DispatchQuery> query : asked_) {
        const Result<DispatchReport> report = one_.run(query, lists_, how);
        if (!report) return report.error();
        all.emplace_back().batches = recording_.batches;
      }
    }
    fit_copying(all, machine_);
    return Success{};
  }

  SweepRow summary(std::size_t level, Policy policy, const PerQuery& queries) const {
    SweepRow row;
    row.depth = options_.depths[level];
    row.policy = policy;
    const double share = 1.0 / static_cast<double>(queries.size());
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Measured& measured = queries[i];
      const double seconds = median(measured.seconds);
      const double serial = median(serial_[level][i].seconds);
      row.jobs += share * measured.jobs;
      row.seconds += share * seconds;
      row.serial_seconds += share * serial;
      row.speedup += share * serial / seconds;
      row.relative_transfer += share * median(measured.relative_transfer);
      row.transferred_bytes += share * median(measured.transferred_bytes);
      row.peak_part_bytes += share * measured.peak_part_bytes;
      if (measured.end != DispatchEnd::ok) row.end = measured.end;
      if (measured.replayed_end != DispatchEnd::ok) row.end = measured.replayed_end;
      row.replayed_seconds += share * median(measured.replayed_seconds);
      row.replayed_speedup += share * median(measured.replayed_speedups);
      row.replayed_relative_transfer += share * median(measured.replayed_transfer);
    }
    return row;
  }

  const SweepOptions& options_;
  Dispatcher here_;  ///< no workers
  Dispatcher one_;
  Dispatcher many_;
  std::vector<DispatchQuery> queries_;
  std::vector<View<const DispatchQuery>> asked_;  ///< what is dispatched together
  std::vector<std::vector<Serial>> serial_;       ///< by depth, then what is dispatched together
  std::vector<PerQuery> measured_;                ///< by depth, then policy
  PairLists lists_;
  DispatchRecording recording_;
  VirtualMachine machine_;
};

Result<SweepOptions> completed(const SweepOptions& options, View<const Pose> poses) {
  SweepOptions all = options;
  if (all.depths.empty()) {
    all.depths.resize(max_distribution_depth);
    std::iota(all.depths.begin(), all.depths.end(), 1U);
  }
  if (all.policies.empty()) all.policies.assign(all_policies().begin(), all_policies().end());
  for (const std::uint32_t depth : all.depths) {
    if (depth < 1 || depth > max_distribution_depth) {
      return make_error(ErrorCode::usage, "depths are 1 to 16");
    }
  }
  if (all.workers < 1 || all.workers > max_workers) {
    return make_error(ErrorCode::usage, "a sweep needs 1 to 64 workers");
  }
  if (all.repeat < 1) return make_error(ErrorCode::usage, "a sweep measures at least once");
  if (poses.empty()) return make_error(ErrorCode::usage, "a sweep needs at least one pose");
  return all;
}

Result<Dispatcher> with_workers(std::uint32_t workers) {
  PoolOptions pool;
  pool.workers = workers;
  return Dispatcher::start(pool);
}

}  // namespace

Result<Sweep> sweep(const Model& a, const Model& b, View<const Pose> poses,
                    const SweepOptions& options) {
  try {
    const Result<SweepOptions> all = completed(options, poses);
    if (!all) return all.error();
    const bool fast = options.kernel == Kernel::fast;
    const Result<PartIndex> index_a = fast ? PartIndex::make(a) : PartIndex::make(a.tree);
    if (!index_a) return index_a.error();
    const Result<PartIndex> index_b = fast ? PartIndex::make(b) : PartIndex::make(b.tree);
    if (!index_b) return index_b.error();
    Result<Dispatcher> here = with_workers(0);
    if (!here) return here.error();
    Result<Dispatcher> one = with_workers(1);
    if (!one) return one.error();
    Result<Dispatcher> many = with_workers(all->workers);
    if (!many) return many.error();
    return Sweeper(*index_a, *index_b, poses, *all, std::move(*here), std::move(*one),
                   std::move(*many))
        .run();
  } catch (const std::exception& error) {
    return make_error(ErrorCode::internal, std::string("the sweep failed: ") + error.what());
  }
}

}  // namespace crashrank
