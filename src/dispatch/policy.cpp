#include "crashrank/dispatch/policy.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <random>

namespace crashrank {

namespace {

/// The unclaimed core for which `better(core, best so far)` keeps the lowest number on ties.
template <class Better> std::uint32_t best_unclaimed(const Placement& at, Better&& better) {
  assert(at.unclaimed != 0);
  std::uint32_t best = at.cores;
  for (std::uint32_t core = 0; core < at.cores; ++core) {
    if (at.is_unclaimed(core) && (best == at.cores || better(core, best))) best = core;
  }
  return best;
}

class BestMatch final : public PlacementPolicy {
public:
  Choice choose(const Placement& at) noexcept override {
    const WaitingJob& job = at.jobs[0];
    return {0, best_unclaimed(at, [&](std::uint32_t core, std::uint32_t best) {
              const std::uint32_t mine = job.similarity(core);
              const std::uint32_t theirs = job.similarity(best);
              return mine != theirs ? mine > theirs : at.batch[core] < at.batch[best];
            })};
  }
};

class Random final : public PlacementPolicy {  // NOLINT(cert-msc51-cpp): begin() seeds it
public:
  void begin(std::uint32_t cores, std::uint64_t seed) override {
    static_cast<void>(cores);
    random_.seed(seed);
  }

  Choice choose(const Placement& at) noexcept override {
    std::uint32_t count = 0;
    for (std::uint32_t core = 0; core < at.cores; ++core) count += at.is_unclaimed(core) ? 1U : 0U;
    auto skip = static_cast<std::uint32_t>(((random_() >> 32U) * count) >> 32U);
    return {0, best_unclaimed(at, [&](std::uint32_t, std::uint32_t) {
              if (skip == 0) return false;
              --skip;
              return true;
            })};
  }

private:
  std::mt19937_64 random_;
};

class Lowest final : public PlacementPolicy {
public:
  Choice choose(const Placement& at) noexcept override {
    const WaitingJob& job = at.jobs[0];
    return {0, best_unclaimed(at, [&](std::uint32_t core, std::uint32_t best) {
              const std::uint32_t mine = job.similarity(core);
              const std::uint32_t theirs = job.similarity(best);
              return mine != theirs ? mine < theirs : at.batch[core] < at.batch[best];
            })};
  }
};

class BestMatchLoad final : public PlacementPolicy {
public:
  Choice choose(const Placement& at) noexcept override {
    const WaitingJob& job = at.jobs[0];
    return {0, best_unclaimed(at, [&](std::uint32_t core, std::uint32_t best) {
              if (at.batch[core] != at.batch[best]) return at.batch[core] < at.batch[best];
              return job.similarity(core) > job.similarity(best);
            })};
  }
};

/// Binds jobs to cores as late as it can. The core with the least work before it takes, of all jobs
/// that wait, the one whose parts it holds and the others do not; a batch is sent once it holds the
/// core's share of the work that is left, so batches shrink towards the end and no core is left
/// with a long one. The calling thread, when no core can take more, works off the job that would be
/// dearest to send, since it need not be sent anything.
class LateMatch final : public PlacementPolicy {
public:
  /// A wider window finds nearer jobs, and costs the main thread a look at each of them per job.
  std::uint32_t window() const noexcept override { return 32; }

  /// A few microseconds of work: finer parts cost the main thread more to place than they spare.
  std::uint32_t whole_triangles() const noexcept override { return 16; }

  bool caller_works() const noexcept override { return true; }

  /// A core without work does not wait for a better choice; one that works on its last batch gets
  /// another, so that it need not be woken, when there is much to choose from.
  bool in_haste(const Placement& at) const noexcept override {
    if (at.jobs.size() < at.cores) return false;
    if (at.caller_works && at.waiting_work * at.seconds_per_work < worth_waking_s) return false;
    const bool many = at.jobs.size() >= 2 * std::size_t{at.cores};
    for (std::uint32_t core = 0; core < at.cores; ++core) {
      if (at.sent[core] == 0 || (many && at.sent[core] == 1)) return true;
    }
    return false;
  }

  Choice choose(const Placement& at) noexcept override {
    const std::uint32_t core = best_unclaimed(at, [&](std::uint32_t one, std::uint32_t best) {
      return at.batch_work[one] + at.sent_work[one] < at.batch_work[best] + at.sent_work[best];
    });
    std::uint32_t chosen = 0;
    std::int64_t most = advantage(at.jobs[0], core);
    for (std::uint32_t i = 1; i < at.jobs.size(); ++i) {
      const std::int64_t here = advantage(at.jobs[i], core);
      if (here > most) {
        most = here;
        chosen = i;
      }
    }
    return {chosen, core};
  }

  /// The last few microseconds of work, if no worker is busy, end before a worker could be
  /// woken.
  bool caller_takes(const Placement& at) const noexcept override {
    if (!at.all_found) return false;
    float left = at.waiting_work;
    for (std::uint32_t core = 0; core < at.cores; ++core) {
      if (at.sent[core] != 0) return false;
      left += at.batch_work[core];
    }
    return left * at.seconds_per_work < worth_waking_s;
  }

  std::uint32_t choose_for_caller(const Placement& at) const noexcept override {
    std::uint32_t chosen = 0;
    std::uint64_t most = 0;
    for (std::uint32_t i = 0; i < at.jobs.size(); ++i) {
      const std::uint64_t here = least_to_send(at.jobs[i]);
      if (here > most) {
        most = here;
        chosen = i;
      }
    }
    return chosen;
  }

  bool send_early(const Placement& at, std::uint32_t core) const noexcept override {
    const float seconds = at.batch_work[core] * at.seconds_per_work;
    if (!at.all_found && seconds < worth_waking_s) return false;
    if (at.caller_works && seconds >= enough_s) return true;
    float left = at.waiting_work;
    for (std::uint32_t other = 0; other < at.cores; ++other) left += at.batch_work[other];
    const std::uint32_t sharers = at.cores + (at.caller_works ? 1U : 0U);
    return at.batch_work[core] * static_cast<float>(sharers) >= left;
  }

private:
  /// About what waking a core takes.
  static constexpr float worth_waking_s = 10e-6F;
  /// A batch that long hides what sending it takes; longer ones make for uneven ends.
  static constexpr float enough_s = 40e-6F;

  /// Bytes that need not be sent if this core takes the job, less those if the best other one does.
  static std::int64_t advantage(const WaitingJob& job, std::uint32_t core) noexcept {
    const std::uint64_t mine = std::uint64_t{1} << core;
    const std::uint64_t a = *job.holders_a;
    const std::uint64_t b = *job.holders_b;
    const std::int64_t bytes_a = job.bytes_a;
    const std::int64_t bytes_b = job.bytes_b;
    const std::int64_t saved = ((a & mine) != 0 ? bytes_a : 0) + ((b & mine) != 0 ? bytes_b : 0);
    const std::uint64_t others_a = a & ~mine;
    const std::uint64_t others_b = b & ~mine;
    if ((others_a & others_b) != 0) return saved - bytes_a - bytes_b;
    return saved - std::max(others_a != 0 ? bytes_a : 0, others_b != 0 ? bytes_b : 0);
  }

  /// Bytes to send with the job to the core that holds most of it.
  static std::uint64_t least_to_send(const WaitingJob& job) noexcept {
    const std::uint64_t a = *job.holders_a;
    const std::uint64_t b = *job.holders_b;
    if ((a & b) != 0) return 0;
    const std::uint64_t all = std::uint64_t{job.bytes_a} + job.bytes_b;
    return all - std::max(a != 0 ? job.bytes_a : 0U, b != 0 ? job.bytes_b : 0U);
  }
};

struct Entry {
  Policy policy;
  const char* name;
};

constexpr std::array<Entry, 5> entries{{{Policy::best_match, "best-match"},
                                        {Policy::random, "random"},
                                        {Policy::lowest, "lowest"},
                                        {Policy::best_match_load, "best-match-load"},
                                        {Policy::late_match, "late-match"}}};
constexpr std::array<Policy, 5> policies{entries[0].policy, entries[1].policy, entries[2].policy,
                                         entries[3].policy, entries[4].policy};

}  // namespace

View<const Policy> all_policies() noexcept { return {policies.data(), policies.size()}; }

const char* policy_name(Policy policy) noexcept {
  for (const Entry& entry : entries) {
    if (entry.policy == policy) return entry.name;
  }
  return "?";
}

Result<Policy> policy_from_name(const std::string& name) {
  std::string known;
  for (const Entry& entry : entries) {
    if (name == entry.name) return entry.policy;
    known += known.empty() ? entry.name : std::string(", ") + entry.name;
  }
  return make_error(ErrorCode::usage, "no policy is called '" + name + "'",
                    "choose among " + known);
}

std::unique_ptr<PlacementPolicy> make_policy(Policy policy) {
  switch (policy) {
    case Policy::best_match:
      return std::make_unique<BestMatch>();
    case Policy::random:
      return std::make_unique<Random>();
    case Policy::lowest:
      return std::make_unique<Lowest>();
    case Policy::best_match_load:
      return std::make_unique<BestMatchLoad>();
    case Policy::late_match:
      return std::make_unique<LateMatch>();
  }
  return std::make_unique<BestMatch>();
}

}  // namespace crashrank
