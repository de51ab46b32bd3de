#pragma once

#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/dispatch/pair_lists.hpp"
#include "crashrank/dispatch/part_index.hpp"
#include "crashrank/dispatch/policy.hpp"
#include "crashrank/dispatch/worker_pool.hpp"
#include "crashrank/internal/base/export.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace crashrank {

struct DispatchRecording;

/// Where the cores read the parts of their jobs.
enum class StoreMode {
  shared,        ///< in the one tree; the bytes that a copy would have taken are counted
  private_copy,  ///< in a store of their own, into which each part is copied once
};

/// Which engine works on a job.
enum class Kernel {
  scalar,  ///< the header-only engine
  fast,    ///< the vector engine; shared trees, and part indices made from models
};

/// `depth` that lets the dispatcher choose, also that the calling thread does all.
inline constexpr std::uint32_t auto_depth = 0;

/// How work is shared out.
struct DispatchOptions {
  Policy policy = Policy::late_match;   ///< which job goes where
  std::uint32_t depth = auto_depth;     ///< distribution depth, 1 to `max_distribution_depth`
  StoreMode store = StoreMode::shared;  ///< where cores read parts
  Kernel kernel = Kernel::scalar;       ///< what tests boxes and triangles
  std::uint32_t buffer = 8;             ///< K: jobs sent to a core en masse, 1 to 65536
  std::size_t store_bytes = 0;  ///< per core, parts held and on their way (private); 0: no limit
  std::size_t queue_bytes = 0;  ///< per core, batches not yet worked off: jobs, and parts that
                                ///< travel with them; 0: no limit
  std::uint64_t seed = 1;       ///< of the random policy
  /// Cores still hold what the dispatch before sent them: for callers whose part indices and trees
  /// are the same objects, unchanged. Has no effect after a dispatch that did not end well.
  bool keep_parts = false;
  /// The calling thread works off jobs, too, under a policy that lets it (late_match). It holds all
  /// parts, so nothing is sent for those. It needs a processor: of the workers only so many take
  /// part that each thread has one. False: it finds and places jobs, and waits.
  bool caller_works = true;
  bool sorted = false;  ///< every query's pairs in one run, sorted by a, then b
  /// Set from any thread to end the dispatch early.
  const std::atomic<bool>* cancel = nullptr;
  /// Filled with what every job took, for `replay` (dispatch/study/recording.hpp); measuring costs
  /// about a tenth of a microsecond a job. Estimates of work are recorded only under a policy that
  /// asks for them (late_match).
  DispatchRecording* recording = nullptr;
};

/// One question: which triangles of A and B share a point, B standing at `b_in_a`.
struct DispatchQuery {
  const PartIndex* a = nullptr;  ///< body A
  const PartIndex* b = nullptr;  ///< body B
  Pose b_in_a;                   ///< B's pose in A's frame
};

/// How a dispatch ended.
enum class DispatchEnd {
  ok,             ///< all pairs were found
  out_of_memory,  ///< a store or queue would have exceeded its budget; the pairs are incomplete
  cancelled,      ///< as asked; the pairs are incomplete
};

/// What a dispatch did.
struct DispatchReport {
  DispatchEnd end = DispatchEnd::ok;  ///< how it ended
  std::uint32_t depth = 0;            ///< used; `auto_depth` where the calling thread did all
  std::uint64_t jobs = 0;             ///< pairs of parts
  std::uint64_t batches = 0;          ///< sent en masse
  double seconds = 0.0;       ///< wall time from the call to all pairs in the lists, unsorted
  double sort_seconds = 0.0;  ///< on top of it, where sorted pairs were asked for
  std::uint64_t transferred_bytes = 0;  ///< of parts sent to cores
  std::uint64_t model_bytes = 0;        ///< of all models that appear in the queries
  std::uint64_t peak_part_bytes = 0;    ///< most that one core held at the end
  std::uint64_t peak_queue_bytes = 0;   ///< most that waited for one core
  CollideWork work;                     ///< the main thread's and the workers'

  /// Bytes of parts sent over bytes of the models: 1 when as much was sent as there is.
  double relative_transfer() const noexcept {
    return model_bytes == 0
               ? 0.0
               : static_cast<double>(transferred_bytes) / static_cast<double>(model_bytes);
  }
};

/// Hands the node pairs of collision queries to worker threads, after Wiseman & Grinberg 2016,
/// section 4. The calling thread descends both trees from their roots to the distribution depth;
/// each pair of parts whose boxes overlap is a job, and a policy finds its core. The answer is the
/// same for every policy, depth, buffer, number of workers and mode.
///
/// One thread at a time may use a dispatcher. Warm, a dispatch allocates only to grow.
class CRASHRANK_API Dispatcher {
public:
  /// Starts the threads. Errors as `WorkerPool::start`.
  static Result<Dispatcher> start(const PoolOptions& options = {});

  /// Moves; the workers go along.
  Dispatcher(Dispatcher&& other) noexcept;
  Dispatcher& operator=(Dispatcher&& other) noexcept;  ///< Moves; the workers go along.
  /// Ends the workers.
  ~Dispatcher();

  /// Answers all queries in one dispatch: parts stay where they are from query to query. With no
  /// workers, or where `auto_depth` finds the work too small to share, the calling thread does all.
  /// Errors: usage for options out of range or that exclude each other, or a query without models;
  /// internal when a worker
  /// failed (out of memory, say). The dispatcher can be used again after any of them.
  Result<DispatchReport> run(View<const DispatchQuery> queries, PairLists& pairs,
                             const DispatchOptions& options = {});

  /// Empties the cores' stores and gives their memory back.
  void forget_parts();

  /// The threads, for other work between dispatches: `pool().for_each(count, body)`.
  WorkerPool& pool() noexcept;

private:
  struct State;
  explicit Dispatcher(std::unique_ptr<State> state) noexcept;

  std::unique_ptr<State> state_;
};

}  // namespace crashrank
