#pragma once

#include "crashrank/base/box.hpp"
#include "crashrank/base/pose.hpp"
#include "crashrank/base/result.hpp"
#include "crashrank/base/view.hpp"
#include "crashrank/collide/pair.hpp"
#include "crashrank/dispatch/policy.hpp"
#include "crashrank/dispatch/worker_pool.hpp"
#include "crashrank/internal/base/export.hpp"
#include "crashrank/internal/dispatch/found_pairs.hpp"
#include "crashrank/internal/tree/tree_view.hpp"
#include "crashrank/model/model.hpp"
#include "crashrank/tree/aabb_tree.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace crashrank {

/// Deepest level at which trees are cut into parts.
inline constexpr std::uint32_t max_distribution_depth = 16;

/// A node of the tree's top and what lies below it: a part, when it stands at the distribution
/// depth or is a leaf above it.
struct IndexedNode {
  Box box;                    ///< m
  float half_area_m2 = 0.0F;  ///< of the box, m²
  std::uint32_t left = 0;     ///< index here of the left child, the right one follows; 0: none here
  std::uint32_t parent = 0;   ///< index here; the root's is 0
  std::uint32_t depth = 0;    ///< below the root
  std::uint32_t tree_node = 0;  ///< index in the tree
  Range below;                  ///< its descendants in the tree
  Range slots;                  ///< its triangles

  /// Bytes that a core needs to work on it: nodes, triangles, and their numbers.
  std::size_t bytes() const noexcept {
    return (std::size_t{below.count} + 1) * sizeof(Node) +
           std::size_t{slots.count} * (sizeof(Triangle) + sizeof(std::uint32_t));
  }
};

/// The upper levels of a tree, which the main thread searches for jobs, level by level: nodes at or
/// above any depth D are a prefix. Made once per model; it refers to the tree it was made from,
/// which has to stay at its address. Reading from many threads is safe. The two sides of a query
/// are two models, also when they look alike: make one index each.
class CRASHRANK_API PartIndex {
public:
  /// O(nodes down to `deepest` + leaves of the cut · depth). Errors: bad_input for an empty tree,
  /// usage for a depth above `max_distribution_depth`.
  static Result<PartIndex> make(const AabbTree& tree,
                                std::uint32_t deepest = max_distribution_depth);
  /// The same for the vector engine, whose smallest pieces are clusters of up to eight triangles:
  /// nodes are not cut below those. The model has to stay where it is.
  static Result<PartIndex> make(const Model& model, std::uint32_t deepest = max_distribution_depth);

  /// Level by level, the root first.
  View<const IndexedNode> nodes() const noexcept { return nodes_; }
  /// The tree it is about.
  const AabbTree& tree() const noexcept { return *tree_; }
  /// The model it was made from, null where it was made from a tree.
  const Model* model() const noexcept { return model_; }
  /// The depth that it reaches down to.
  std::uint32_t deepest() const noexcept { return deepest_; }
  /// Number of nodes at depths 0 to `depth`.
  std::uint32_t nodes_down_to(std::uint32_t depth) const noexcept;
  /// Whether this node is handed out whole when trees are cut at `depth`.
  bool is_part(const IndexedNode& node, std::uint32_t depth) const noexcept {
    return node.left == 0 || node.depth >= depth;
  }
  /// Axes and root box alone: what box_transform reads.
  const AabbTree& frame() const noexcept { return frame_; }
  /// Levels of the tree below its root.
  std::uint32_t tree_depth() const noexcept { return tree_depth_; }
  /// Bytes of the whole model: nodes, triangles, and their numbers.
  std::size_t model_bytes() const noexcept { return model_bytes_; }

private:
  PartIndex() = default;

  static Result<PartIndex> make(const AabbTree& tree, const Model* model, std::uint32_t deepest);

  const AabbTree* tree_ = nullptr;
  const Model* model_ = nullptr;
  std::uint32_t deepest_ = 0;
  std::uint32_t tree_depth_ = 0;
  std::size_t model_bytes_ = 0;
  std::vector<IndexedNode> nodes_;
  std::vector<std::uint32_t> level_end_;  ///< by depth
  AabbTree frame_;
};

/// All pairs of many queries in the buffers that the workers wrote. The caller reuses it between
/// dispatches so that later ones allocate nothing. A query's pairs lie in a few runs, each written
/// by one worker; `for_each_run` reads them without copying.
class CRASHRANK_API PairLists {
public:
  /// Number of queries.
  std::size_t queries() const noexcept { return counts_.size(); }
  /// Pairs of one query.
  std::size_t count(std::size_t query) const noexcept { return counts_[query]; }
  /// Pairs of all queries.
  std::size_t total() const noexcept;

  /// Calls `use(View<const Pair>)` for each run of a query's pairs, in no particular order.
  template <class Use> void for_each_run(std::size_t query, Use&& use) const {
    for (std::size_t i = first_run_[query]; i < first_run_[query + 1]; ++i) {
      const PairRun& run = runs_[i];
      use(View<const Pair>(found_[run.worker].pairs.data() + run.first, run.count));
    }
  }

  /// Copies a query's pairs into `pairs`, which is cleared first.
  void gather(std::size_t query, std::vector<Pair>& pairs) const;
  /// The same, sorted by a, then b.
  void gather_sorted(std::size_t query, std::vector<Pair>& pairs) const;

private:
  friend class Dispatcher;

  void begin(std::size_t workers, std::size_t queries);
  /// Orders the workers' runs by query.
  void finish();
  /// Makes room for all pairs in one more buffer, a run for each query, into which `sort_query`
  /// copies and sorts; safe from one thread a query. `end_sort` makes that buffer the lists.
  void begin_sort();
  void sort_query(std::size_t query);
  void end_sort();

  std::vector<FoundPairs> found_;
  std::vector<PairRun> runs_;
  std::vector<std::size_t> first_run_;
  std::vector<std::size_t> counts_;
  std::vector<PairRun> sorted_runs_;
};

struct DispatchRecording;

/// Where cores read the parts of their jobs.
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

/// How work is distributed.
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
  /// Filled with what every job took, for `replay` (dispatch/study/study.hpp); measuring costs
  /// about a tenth of a microsecond a job. Estimates of work are recorded only under a policy that
  /// asks for them (late_match).
  DispatchRecording* recording = nullptr;
};

/// One query: which triangles of A and B share a point, B being at `b_in_a` in A's frame.
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

/// Result and cost of a dispatch.
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

/// Distributes the node pairs of collision queries over worker threads (Wiseman & Grinberg 2016,
/// section 4). The calling thread descends both trees from their roots to the distribution depth;
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

  /// Answers all queries in one dispatch: parts stay in their stores between queries. With no
  /// workers, or where `auto_depth` finds the work too small to share, the calling thread does all.
  /// Errors: usage for options out of range or that exclude each other, or a query without models;
  /// internal when a worker
  /// failed (out of memory, say). The dispatcher can be used again after any of them.
  Result<DispatchReport> run(View<const DispatchQuery> queries, PairLists& pairs,
                             const DispatchOptions& options = {});

  /// Empties the cores' stores and frees their memory.
  void forget_parts();

  /// The threads, for other work between dispatches: `pool().for_each(count, body)`.
  WorkerPool& pool() noexcept;

private:
  struct State;
  explicit Dispatcher(std::unique_ptr<State> state) noexcept;

  std::unique_ptr<State> state_;
};

}  // namespace crashrank
