#pragma once

#include "crashrank/base/export.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace crashrank {

/// The schemes by which a job finds its core.
enum class Policy {
  best_match,       ///< the core that holds most of the job's parts
  random,           ///< any unclaimed core
  lowest,           ///< the core that holds least of the job's parts
  best_match_load,  ///< the least loaded core, then the one that holds most
};

/// All policies, in the order of the enum.
CRASHRANK_API View<const Policy> all_policies() noexcept;
/// "best-match", "random", "lowest", "best-match-load".
CRASHRANK_API const char* policy_name(Policy policy) noexcept;
/// Errors: usage, naming the ones there are.
CRASHRANK_API Result<Policy> policy_from_name(const std::string& name);

/// What a policy knows when it places a job. Bit c of a word stands for core c.
struct Placement {
  std::uint32_t cores = 0;
  std::uint32_t buffer = 0;     ///< K: jobs a batch can take
  std::uint64_t unclaimed = 0;  ///< cores that can take the job; never 0
  std::uint64_t holds_a = 0;    ///< cores that hold the part of A, or will with their batch
  std::uint64_t holds_b = 0;    ///< the same for B
  const std::uint32_t* batch = nullptr;  ///< by core: jobs in the batch that is being filled

  bool is_unclaimed(std::uint32_t core) const noexcept { return ((unclaimed >> core) & 1U) != 0; }
  /// Parts of the job that the core holds: 0, 1 or 2.
  std::uint32_t similarity(std::uint32_t core) const noexcept {
    return static_cast<std::uint32_t>((holds_a >> core) & 1U) +
           static_cast<std::uint32_t>((holds_b >> core) & 1U);
  }
};

/// Decides where jobs go. Called by the main thread once per job, so an indirect call is cheap
/// against the rest; keep `choose` below a microsecond and free of allocation.
class CRASHRANK_API PlacementPolicy {
public:
  virtual ~PlacementPolicy() = default;
  /// Before the first job of a dispatch.
  virtual void begin(std::uint32_t cores, std::uint64_t seed) {
    static_cast<void>(cores);
    static_cast<void>(seed);
  }
  /// The core for the next job: one whose bit is set in `at.unclaimed`.
  virtual std::uint32_t choose(const Placement& at) noexcept = 0;

protected:
  PlacementPolicy() = default;
  PlacementPolicy(const PlacementPolicy&) = default;
  PlacementPolicy& operator=(const PlacementPolicy&) = default;
};

/// Makes one of the policies above.
CRASHRANK_API std::unique_ptr<PlacementPolicy> make_policy(Policy policy);

}  // namespace crashrank
