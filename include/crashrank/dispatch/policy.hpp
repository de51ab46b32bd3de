#pragma once

#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/internal/base/export.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace crashrank {

/// Policies that assign a job to a core: four of Wiseman & Grinberg 2016, section 4, and one of
/// this project.
enum class Policy {
  best_match,       ///< the core that holds most of the job's parts
  random,           ///< any unclaimed core
  lowest,           ///< the core that holds least of the job's parts
  best_match_load,  ///< the least loaded core, then the one that holds most
  late_match,       ///< jobs wait unassigned; the core with least work before it takes the job it
               ///< is nearest to, in batches that shrink towards the end, and the calling thread,
               ///< which holds every part, those that would be dearest to send
};

/// All policies, in the order of the enum.
CRASHRANK_API View<const Policy> all_policies() noexcept;
/// "best-match", "random", "lowest", "best-match-load", "late-match".
CRASHRANK_API const char* policy_name(Policy policy) noexcept;
/// Errors: usage, listing the names.
CRASHRANK_API Result<Policy> policy_from_name(const std::string& name);

/// A job that has no core yet. Bit c of a word stands for core c.
struct WaitingJob {
  const std::uint64_t* holders_a = nullptr;  ///< cores that hold A's part, or will with their batch
  const std::uint64_t* holders_b = nullptr;  ///< the same for B
  std::uint32_t bytes_a = 0;                 ///< of A's part
  std::uint32_t bytes_b = 0;                 ///< of B's part
  float work = 0.0F;                         ///< estimated, in triangles to look at

  /// True where the core has A's part.
  bool holds_a(std::uint32_t core) const noexcept { return ((*holders_a >> core) & 1U) != 0; }
  /// True where the core has B's part.
  bool holds_b(std::uint32_t core) const noexcept { return ((*holders_b >> core) & 1U) != 0; }
  /// Parts of the job that the core holds: 0, 1 or 2.
  std::uint32_t similarity(std::uint32_t core) const noexcept {
    return (holds_a(core) ? 1U : 0U) + (holds_b(core) ? 1U : 0U);
  }
};

/// What a policy knows when it places a job.
struct Placement {
  std::uint32_t cores = 0;               ///< number of them
  std::uint32_t buffer = 0;              ///< K: jobs a batch can take
  std::uint64_t unclaimed = 0;           ///< cores that can take a job; never 0 in `choose`
  const std::uint32_t* batch = nullptr;  ///< by core: jobs in the batch that is being filled
  const float* batch_work = nullptr;     ///< by core: their estimated work
  const std::uint32_t* sent = nullptr;   ///< by core: batches sent and not known to be done, 0 to 2
  const float* sent_work = nullptr;      ///< by core: of batches sent and not known to be done
  View<const WaitingJob> jobs;           ///< in the order found; never empty in `choose`
  float waiting_work = 0.0F;             ///< their estimated work
  float seconds_per_work = 0.0F;         ///< what a unit of estimated work takes, about
  bool caller_works = false;             ///< the calling thread works off jobs, too
  bool all_found = false;                ///< no more will come

  /// True where the core may be given a job.
  bool is_unclaimed(std::uint32_t core) const noexcept { return ((unclaimed >> core) & 1U) != 0; }
};

/// Assigns jobs to cores. The main thread calls it once per job, so that the cost of an indirect
/// call is small; members should take less than a microsecond and allocate nothing.
class CRASHRANK_API PlacementPolicy {
public:
  /// A job and its core.
  struct Choice {
    std::uint32_t job = 0;   ///< index in `Placement::jobs`
    std::uint32_t core = 0;  ///< the core that runs it
  };

  virtual ~PlacementPolicy() = default;  ///< Destroys it.
  /// Before the first job of a dispatch.
  virtual void begin(std::uint32_t cores, std::uint64_t seed) {
    static_cast<void>(cores);
    static_cast<void>(seed);
  }
  /// Jobs that the main thread may find ahead of placing them; 1: each is placed when found.
  virtual std::uint32_t window() const noexcept { return 1; }
  /// Number of triangles below which nodes are not divided: a node of no more is a part at any
  /// depth above the distribution depth. 0: all parts lie at that depth, or are leaves above it.
  virtual std::uint32_t whole_triangles() const noexcept { return 0; }
  /// True if the calling thread, which holds every part, may run jobs where it would wait.
  virtual bool caller_works() const noexcept { return false; }
  /// True if a job is to be placed now although more can be found and the window has room.
  virtual bool in_haste(const Placement& at) const noexcept {
    static_cast<void>(at);
    return false;
  }
  /// A job, and a core whose bit is set in `at.unclaimed`.
  virtual Choice choose(const Placement& at) noexcept = 0;
  /// True if the calling thread should run a waiting job rather than place it.
  virtual bool caller_takes(const Placement& at) const noexcept {
    static_cast<void>(at);
    return false;
  }
  /// Returns the job that the calling thread runs: index in `Placement::jobs`.
  virtual std::uint32_t choose_for_caller(const Placement& at) const noexcept {
    static_cast<void>(at);
    return 0;
  }
  /// True if this core's batch is to be sent although it is not full.
  virtual bool send_early(const Placement& at, std::uint32_t core) const noexcept {
    static_cast<void>(at);
    static_cast<void>(core);
    return false;
  }

protected:
  PlacementPolicy() = default;                                   ///< For derived classes.
  PlacementPolicy(const PlacementPolicy&) = default;             ///< For derived classes.
  PlacementPolicy& operator=(const PlacementPolicy&) = default;  ///< For derived classes.
};

/// Makes one of the policies above.
CRASHRANK_API std::unique_ptr<PlacementPolicy> make_policy(Policy policy);

}  // namespace crashrank
